# Survival, hazard, percentiles and remaining lives under conditions: one question to the posterior for each condition. The answers are those
# of fit.survival_function(), fit.hazard(), fit.percentile(), fit.conditional() and fit.predict() of the Python module.

of_lives <- c("status", "lower", "upper", "entry")
asks_for_lives <- c("b_lives", "survival_to", "hazard_at", "mean_life")

# Whether what a study of a formula measures are lives: it says how they ended, or asks for them without a threshold.
is_of_lives <- function(study) {
  is.null(study$predict$limit) && (any(of_lives %in% names(study$data$columns)) || any(asks_for_lives %in% names(study$predict)))
}

study_of_lives <- function(fit, what) {
  study <- keys_of(fit)
  if (!is_of_lives(study)) {
    stop_input(what, " is of lives that are measured, and this study measures ", words(names(study$likelihood)), "; lives to a failure threshold are those of ",
               "ww_life(fit, limit = ...)")
  }
  study
}

# By label its levels, of labels that parameters are indexed by.
indexed_levels <- function(fit, study, units) {
  text <- paste(unlist(list(study$formula, study$likelihood)), collapse = " ")
  found <- regmatches(text, gregexpr("[A-Za-z][A-Za-z0-9_]*[[][A-Za-z][A-Za-z0-9_]*[]]", text))[[1]]
  levels <- list()
  for (each in unique(found)) {
    base <- sub("[[].*", "", each)
    label <- sub(".*[[](.*)[]]", "\\1", each)
    if (!label %in% names(units) || label %in% names(levels) || identical(label, study$failure_modes$column)) next
    rows <- rownames(fit$parameters)
    rows <- rows[startsWith(rows, paste0(base, "[")) & endsWith(rows, "]")]
    levels[[label]] <- substring(rows, nchar(base) + 2, nchar(rows) - 1)
  }
  levels
}

# A frame of conditions, a row for each answer, and for each row what [predict] given says of it.
lives_conditions <- function(fit, study, given, what = "given") {
  units <- column_units(study)
  names <- conditions_of(study, units)
  levels <- indexed_levels(fit, study, units)
  usual <- as.list(study$predict$given)
  if (is.null(given)) {
    frame <- rev(expand.grid(rev(levels), stringsAsFactors = FALSE, KEEP.OUT.ATTRS = FALSE))
    if (!length(levels)) frame <- data.frame(row.names = 1L)
  } else {
    if (is.list(given) && !is.data.frame(given) && any(vapply(given, is.list, NA))) {  # a distribution over the units
      return(list(frame = data.frame(row.names = 1L), given = list(utils::modifyList(usual, given))))
    }
    if (is.atomic(given)) given <- as.list(given)
    require_columns(given, what)
    frame <- as.data.frame(given, check.names = FALSE, optional = TRUE, stringsAsFactors = FALSE)
    if (!nrow(frame)) stop_input(what, " has no rows")
  }
  unknown <- setdiff(names(frame), names)
  if (length(unknown)) stop_input(what, ": the study has no condition '", unknown[1], "' (conditions: ", if (length(names)) words(names) else "none", ")")
  require_values(frame, names(frame), what)
  each <- lapply(seq_len(nrow(frame)), function(i) {
    row <- lapply(stats::setNames(names(frame), names(frame)), function(name) {
      value <- frame[[name]][i]
      if (!is.null(levels[[name]])) {
        value <- if (is.numeric(value)) number_text(value) else as.character(value)
        if (!value %in% levels[[name]]) stop_input(what, ": ", name, " has no '", value, "' (", words(levels[[name]]), ")")
        return(value)
      }
      if (is.logical(value)) value <- as.character(value)
      in_unit(value, units[[name]])
    })
    utils::modifyList(usual, row)
  })
  list(frame = frame, given = each)
}

# What the library answers under conditions; of failure modes that of the part, which comes first. `argument`: what the caller calls the key.
lives_asked <- function(fit, given, question, argument = NULL) {
  found <- tryCatch(ww_ask(fit, c(if (length(given)) list(given = given), question))$quantities, wearwell_input_error = function(error) {
    message <- conditionMessage(error)
    for (key in names(argument)) message <- sub(paste0("^", key, ":"), paste0(argument[[key]], ":"), message)
    stop_input(message)
  })
  of <- sub("^new ", "", column(found, "of", ""))
  found[of == of[1]]
}

# The same places of each condition: `rows_of(given)` has a frame of the answers under one.
lives_frame <- function(fit, study, given, rows_of) {
  conditions <- lives_conditions(fit, study, given)
  rows <- lapply(conditions$given, rows_of)
  unit <- attr(rows[[1]], "unit")
  found <- do.call(rbind, rows)
  frame <- conditions$frame[rep(seq_along(rows), vapply(rows, nrow, 0L)), , drop = FALSE]
  found <- if (length(frame)) cbind(frame, found) else found
  rownames(found) <- NULL
  attr(found, "unit") <- unit
  found
}

# Null of a life is never.
life_numbers <- function(answers, keys, null = Inf) {
  as.data.frame(lapply(stats::setNames(keys, keys), function(key) vapply(answers, function(each) {
    if (!key %in% names(each)) NA_real_ else if (is.null(each[[key]]) || is.na(each[[key]])) null else as.double(each[[key]])
  }, 0)))
}

require_places <- function(values, what, study) {
  if (!length(values) || !(is.numeric(values) || is.character(values) || inherits(values, "units"))) {
    stop_input(what, " is ", shown_value(values), "; it holds lives, numbers or texts with a unit")
  }
  if (anyNA(values)) stop_input(what, " holds a missing value")
  for (each in as.list(values)) require_lives(study, if (inherits(values, "units")) as.double(each) else each, what)
}

# Lives as the study reads them: plain numbers are in the unit of the measured life.
lives_in_unit <- function(values, study) {
  units <- column_units(study)
  measured <- names(study$likelihood)[1]
  unit <- units[intersect(c(measured, "lower"), names(units))][1]
  lapply(seq_along(values), function(i) in_unit(values[i], if (is.na(unit)) "" else unname(unit)))
}

# What a study says of lives at these times: by `key` of [predict], the rows whose names begin with `what`.
at_times <- function(fit, study, times, given, key, what, read) {
  require_places(times, "times", study)
  lives_frame(fit, study, given, function(at) {
    found <- lives_asked(fit, at, stats::setNames(list(lives_in_unit(times, study)), key), stats::setNames(list("times"), key))
    read(found[startsWith(column(found, "name", ""), what)])
  })
}

ww_survival_function <- function(fit, times, given = NULL) {
  at_times(fit, study_of_lives(fit, "ww_survival_function()"), times, given, "survival_to", "survival to ", function(found) {
    structure(cbind(data.frame(time = times), life_numbers(found, c("q05", "q50", "q95", "predictive"), NA) / 100), unit = "1")
  })
}

ww_hazard <- function(fit, times, given = NULL) {
  at_times(fit, study_of_lives(fit, "ww_hazard()"), times, given, "hazard_at", "hazard at ", function(found) {
    structure(cbind(data.frame(time = times), life_numbers(found, c("q05", "q50", "q95"), NA)), unit = found[[1]]$unit)
  })
}

require_percentages <- function(p, what) {
  if (!is.numeric(p) || is.object(p) || !length(p) || anyNA(p) || any(p <= 0 | p >= 100)) {
    stop_input(what, " is ", shown_value(p), "; it holds percentages that have failed, like 10")
  }
  part <- p[p < 1]
  if (length(part)) {
    stop_input(what, " holds ", part[1], ", which may be a percentage, the life by which ", part[1], " % have failed: ww_life(fit, b = ", part[1],
               ") has it; or a fraction: then write ", 100 * part[1])
  }
}

ww_percentile <- function(fit, p, given = NULL, confidence = 0.9) {
  study <- study_of_lives(fit, "ww_percentile()")
  require_percentages(p, "p")
  require_levels(p, confidence)
  p <- unique(as.double(p))
  lives_frame(fit, study, given, function(at) {
    found <- lives_asked(fit, at, list(b_lives = as.list(p), credible_level = as.double(confidence)), list(b_lives = "p", credible_level = "confidence"))
    found <- found[match(paste0("B", format_percent(p), " life"), column(found, "name", ""))]
    structure(cbind(data.frame(p = p), life_numbers(found, c("q05", "q50", "q95", "predictive", "bound"))), unit = found[[1]]$unit)
  })
}

# As the names of B-lives have percentages.
format_percent <- function(p) vapply(p, function(each) sprintf("%.6g", each), "")

ww_conditional <- function(fit, survived, b = c(1, 10, 50), given = NULL, confidence = 0.9) {
  study <- study_of_lives(fit, "ww_conditional()")
  if (length(survived) != 1) stop_input("survived is ", shown_value(survived), "; it is one life, a number or a text with a unit")
  require_places(survived, "survived", study)
  require_percentages(b, "b")
  require_levels(b, confidence)
  question <- list(survived = lives_in_unit(survived, study)[[1]], b_lives = as.list(unique(as.double(b))), mean_life = TRUE, credible_level = as.double(confidence))
  lives_frame(fit, study, given, function(at) {
    found <- lives_asked(fit, at, question, list(credible_level = "confidence"))
    rows <- data.frame(name = column(found, "name", ""), q50 = life_numbers(found, "q50")$q50, predictive = life_numbers(found, "predictive")$predictive,
                       undetermined = vapply(found, function(row) isTRUE(row$undetermined), NA))
    require_determined(rows, "a new item", survived)
    keep <- c(which(startsWith(rows$name, "survival to ")), which(rows$name == "mean remaining useful life"),
              grep("^B.* remaining useful life$", rows$name))
    found <- found[keep]
    cbind(data.frame(quantity = rows$name[keep], unit = column(found, "unit", "")), life_numbers(found, c("q05", "q50", "q95", "predictive", "bound")))
  })
}

# For each row of conditions the mean life of all items, or the life of the next one.
predicted_lives <- function(fit, study, newdata, level, kind) {
  if (!isTRUE(all.equal(level, 0.9))) {
    stop_input("level is ", level, "; intervals of lives hold 90 %, and ww_percentile(fit, p, given, confidence) has bounds at any level")
  }
  if (kind == "unit") stop_input("kind = 'unit' predicts measurements of an item along its path; lives are those of new items: kind = 'next'")
  names <- conditions_of(study, column_units(study))
  known <- intersect(names(newdata), names)
  # A condition that is missing has its usual value, unless another column may mean it.
  if (length(known) < length(newdata)) require_conditions(newdata, names)
  conditions <- lives_conditions(fit, study, newdata[known], "newdata")
  unit <- ""
  rows <- lapply(conditions$given, function(at) {
    found <- lives_asked(fit, at, c(list(mean_life = TRUE), if (kind == "next") list(b_lives = list(50))))
    names <- column(found, "name", "")
    mean <- found[match("mean life", names)]
    ends <- if (kind == "mean") mean else found[match("life", names)]
    unit <<- mean[[1]]$unit
    stats::setNames(cbind(life_numbers(mean, "predictive"), life_numbers(ends, c("q05", "q95"))), c("mean", "lower", "upper"))
  })
  structure(do.call(rbind, rows), row.names = rownames(conditions$frame), unit = unit)
}
