# Lives that are asked of a fit later, at any level.

# What each other model's [predict] has that a life needs.
kept_of <- list(`archard-joint` = c("limit", "risk", "work_per_cycle"),
                `bearing-wear` = c("limit", "risk", "pressure", "speed", "contact", "radius", "clearance"),
                sn = c("types", "stress"))

require_levels <- function(b, confidence) {
  if (!is.numeric(b) || is.object(b) || length(b) == 0 || anyNA(b) || any(b <= 0 | b >= 100)) {
    stop_input("b is ", shown_value(b), "; B-lives are percentages between 0 and 100, like c(1, 10)")
  }
  fine <- is.numeric(confidence) && !is.object(confidence) && length(confidence) == 1
  if (!fine || !isTRUE(confidence > 0 && confidence < 1)) {
    stop_input("confidence is ", shown_value(confidence), "; it lies between 0 and 1, like 0.95")
  }
}

# Families of lives that may lie below 0.
of_both_signs <- c("normal", "student-t", "smallest-extreme-value", "largest-extreme-value")

require_lives <- function(study, survived, what = "survived") {
  slots <- study$likelihood[[1]]
  if (isTRUE(slots$family %in% of_both_signs) || !is.null(slots$threshold)) return()
  number <- if (is.character(survived)) suppressWarnings(as.double(sub("^\\s*([^ ]+).*$", "\\1", survived))) else as.double(survived)
  if (isTRUE(number < 0)) stop_input(what, " is ", shown_value(survived), "; lives of this study are 0 or more")
}

# The keys of [predict] for a study of a formula.
asked_of_formula <- function(study, limit, unit, survived, along) {
  question <- if (is.null(survived)) list() else list(survived = quantity(survived, "survived"))
  units <- column_units(study)
  if (is.null(limit)) {
    if (!is.null(unit)) {
      stop_input("unit needs a limit, ww_life(fit, limit = ..., unit = ...): where the data are lives, the life of each item is ",
                 "known, and ww_life predicts that of the next one: leave unit out")
    }
    # A plain number is in the unit of the measured life.
    if (!is.null(survived)) {
      measured <- names(study$likelihood)[1]
      if (is.double(question$survived) && grepl("^[0-9]", units[[measured]])) {  # "1e6 cycles": multiples, or cycles?
        stop_input("survived is ", survived, " without a unit, and ", measured, " is in '", units[[measured]], "': write the number with its unit")
      }
      require_lives(study, survived)
      question$survived <- in_unit(question$survived, units[[measured]])
    }
    return(question)
  }
  if (is.null(names(limit))) {
    measured <- names(study$likelihood)
    if (length(measured) != 1) stop_input("limit: of which? list(", measured[1], " = \"...\") says so")
    limit <- stats::setNames(list(limit), measured)
  }
  axis <- axis_of(study, units, along)
  if (is.null(axis)) {
    stop_input("along is missing: the column along which it wears (", words(conditions_of(study, units)), ")")
  }
  # Expressions do not name what is measured, but that of a process.
  of <- vapply(names(limit), function(name) {
    slots <- study$likelihood[[name]]
    if (is_process(slots)) name else if (!is.null(slots$mean)) slots$mean else if (!is.null(slots$median)) slots$median else name
  }, "")
  limit <- lapply(stats::setNames(names(limit), of), function(name) quantity(limit[[name]], "limit"))
  c(question, list(along = axis, limit = limit))
}

is_process <- function(slots) isTRUE(endsWith(as.character(slots$family), "process"))

asked_of_preset <- function(study, limit, unit, survived, along) {
  model <- study$model
  if (!is.null(unit)) {
    stop_input("unit needs a study of a formula with random effects; the model ", model, " predicts the next item: leave unit out")
  }
  if (!is.null(survived)) {
    stop_input("survived needs a study of a formula; for the model ", model, if (model == "sn")
      " ww_ask(fit, predict) with survival_to gives the probability of survival" else
      " fit$summary$life has the time within which to inspect")
  }
  if (!is.null(along)) stop_input("along needs a study of a formula; lives of the model ", model, " have their axis: leave along out")
  question <- study$predict[intersect(names(study$predict), kept_of[[model]])]
  if (model == "sn") {
    if (!is.null(limit)) stop_input("limit is of wear; a life of an S-N study ends with failure: leave limit out")
    return(if (length(question)) question else list(types = "all"))
  }
  if (!is.null(limit)) question$limit <- quantity(limit, "limit")
  if (is.null(question$limit)) {
    stop_input("limit is missing: ww_life(fit, limit = \"", if (model == "archard-joint") "100 mm^3" else "80 um", "\")")
  }
  question
}

ww_life.ww_fit <- function(x, limit = NULL, b = c(1, 10), confidence = 0.9, unit = NULL, survived = NULL, along = NULL, given = NULL,
                           ...) {
  if (...length()) stop_input("ww_life(fit, ...) has no argument '", c(names(list(...)), "")[1], "'")
  fit <- x
  study <- keys_of(fit, c("formula", names(kept_of)))
  require_levels(b, confidence)
  b <- unique(as.double(b))
  formula <- study$model == "formula"
  question <- (if (formula) asked_of_formula else asked_of_preset)(study, limit, unit, survived, along)
  if (length(given)) question <- c(question, if (formula) list(given = as.list(given)) else as.list(given))
  answers <- ww_ask(fit, c(question, list(b_lives = as.list(b), credible_level = as.double(confidence))))
  rows <- life_rows(answers, study$model)
  wanted <- if (!is.null(unit) || (formula && !is.null(survived))) "remaining useful life" else "life"
  item <- sub("^[^ ]* ", "", rows$of)
  is_new <- startsWith(rows$of, "new ")
  if (is.null(unit)) {
    mine <- if (formula) is_new | !grepl(" ", rows$of, fixed = TRUE) else !startsWith(rows$of, "median ")
  } else {
    mine <- item == as.character(unit) & !is_new
    seen <- sort(unique(item[rows$name == wanted & !is_new]))
    if (!as.character(unit) %in% seen) stop_input("the study has no item '", unit, "' (items: ", words(seen), ")")
    if (!is.null(survived)) require_after(rows, wanted, mine, is_new, unit, survived)
  }
  of_all <- grepl("^B[^ ]+ (remaining useful )?life$", rows$name) & endsWith(rows$name, paste0(" ", wanted)) &
    grepl("remaining", rows$name) == (wanted != "life")
  keep <- mine & (rows$name == wanted | startsWith(rows$name, "survival to ") | of_all)
  rows <- rows[keep, ]
  of_all <- of_all[keep]
  require_determined(rows, if (is.null(unit)) "a new item" else unit, survived)
  # Of one thing, whose life only the posterior spreads, the bound is that of its life, and B-lives are its quantiles.
  spread <- function() !is.null(study$random_effects) || any(vapply(study$likelihood, is_process, NA))
  one <- study$model == "archard-joint" || (formula && !is.null(limit) && (!is.null(unit) || !spread()))
  levels <- paste0("b", format(b, trim = TRUE, digits = 6, drop0trailing = TRUE))
  columns <- c("name", "of", "at", "unit", "q05", "q50", "q95", levels, "predictive", "bound")
  rows[levels] <- NA_real_
  for (i in which(rows$name == wanted)) {
    same <- which(of_all & rows$at == rows$at[i])
    percents <- as.double(sub("^B([^ ]+) .*$", "\\1", rows$name[same]))
    for (j in seq_along(same)) rows[i, levels[which.min(abs(b - percents[j]))]] <- rows$predictive[same[j]]
    if (one && length(same)) rows$bound[i] <- rows$bound[same[1]]
  }
  if (one) rows <- rows[!of_all, ]
  rows <- rows[columns]
  rownames(rows) <- NULL
  rows
}

# A frame of what was answered; null of a life is never.
life_rows <- function(answers, model) {
  of <- answers$quantities
  never <- function(key) vapply(of, function(row) if (is.null(row[[key]])) NA_real_ else life(row[[key]]), 0)
  rows <- data.frame(name = column(of, "name", ""), of = column(of, "of", ""), at = column(of, "at", ""), unit = column(of, "unit", ""))
  for (key in c("q05", "q50", "q95", "predictive", "bound")) rows[[key]] <- never(key)
  rows$undetermined <- vapply(of, function(row) isTRUE(row$undetermined), NA)
  if (model != "archard-joint" || is.null(answers$life)) return(rows)
  answer <- answers$life
  first <- data.frame(name = "life", of = if (is.null(answer$of) || answer$of == "") "joint" else answer$of,
                      at = paste("to", format(answer$limit, digits = 6), answer$limit_unit), unit = answer$unit, q05 = life(answer$q05),
                      q50 = life(answer$b50), q95 = life(answer$q95), predictive = NA_real_, bound = NA_real_, undetermined = FALSE)
  rbind(first, rows)
}

require_after <- function(rows, wanted, mine, is_new, unit, survived) {
  begins <- sub("^.*from ", "", rows$at[rows$name == wanted & (mine | is_new)])
  if (length(unique(begins)) < 2) return()
  last <- sub(" on$", "", sub("^.*from ", "", rows$at[rows$name == wanted & mine][1]))
  stop_input("survived: the last row of ", unit, " is at ", last, ", and ", survived, " lies before: leave survived out; the remaining ",
             "life counts from the last row")
}

# No row begins where hardly any survive: the library determines no life from there on.
require_determined <- function(rows, what, survived) {
  if (!any(rows$undetermined)) return()
  survival <- rows[startsWith(rows$name, "survival to "), ]
  left <- max(0, min(ifelse(is.na(survival$predictive), survival$q50, survival$predictive)))
  stop_input("survived: ", what, " survives to ", survived, " with a probability of ", format(left, digits = 2),
             " %; lives from there on need at least 0.1 %")
}
