# Questions that a fit answers later. Nothing is fitted again.

ww_ask <- function(fit, predict, level = 0.9) {
  if (!is.numeric(level) || length(level) != 1 || !isTRUE(level > 0 && level < 1)) {
    stop_input("level is ", shown_value(level), "; it lies between 0 and 1")
  }
  run <- run_again(fit)
  text <- paste0(without_table(fit$study$text, "predict"), "\n", toml_table("predict", predict))
  answers <- core(C_asked, run, read_again(fit$study, text), as.double(level))
  answers[intersect(c("predictions", "quantities", "life"), names(answers))]
}

keys_of_law <- function(fit) {
  study <- core(C_keys, fit$study$text)
  if (!identical(study$model, "law")) {
    stop_input("predict and ww_life are of studies of a law (model = \"law\"), and this one is of the model ", study$model,
               "; ww_ask(fit, predict) asks it by the keys of its own [predict]")
  }
  study
}

# Units of the columns by name; "" where there is none.
column_units <- function(study) {
  vapply(study$data$columns, function(entry) {
    if (is.list(entry) && !is.null(entry$unit)) return(entry$unit)
    heading <- if (is.list(entry)) entry$column else entry
    found <- regmatches(heading, regexec("[[(](.*)[])]\\s*$", heading))[[1]]
    if (length(found)) found[2] else ""
  }, "")
}

# Columns that are neither measured nor name the items.
conditions_of <- function(study, units) setdiff(names(units), c(names(study$likelihood), names(study$varies), special))

axis_of <- function(study, units, along) {
  if (is.null(along)) along <- study$predict$along
  if (!is.null(along)) {
    if (!isTRUE(along %in% names(units))) {
      stop_input("along: the study has no column '", words(along), "' (columns: ", words(names(units)), ")")
    }
    return(along)
  }
  texts <- c(unlist(study$law), unlist(study$likelihood))
  if (any(startsWith(c(names(study$law), ""), "d(")) || any(grepl("cum(", texts, fixed = TRUE))) {
    stop_input("along is missing: this law is a rate or a running sum along a column")
  }
  NULL
}

in_unit <- function(value, unit) {
  if (is.factor(value)) value <- as.character(value)
  if (inherits(value, "units")) return(quantity(value, "newdata"))
  if (is.character(value) || unit == "") return(value)
  paste(number_text(value), unit)
}

predict.ww_fit <- function(object, newdata, level = 0.9, kind = "mean", along = NULL, ...) {
  if (!isTRUE(kind %in% c("mean", "next", "unit"))) stop_input("kind is ", shown_value(kind), "; it is 'mean' or 'next'")
  if (kind == "unit") {
    stop_input("kind = 'unit', a measurement of an item that was seen, is not computed yet; its remaining life is: ww_life(fit, ",
               "limit = ..., unit = ...)")
  }
  study <- keys_of_law(object)
  units <- column_units(study)
  conditions <- conditions_of(study, units)
  if (is_path(newdata)) stop_input("newdata is a text; it is a data frame or a named list of columns")
  require_columns(newdata, "newdata")
  newdata <- as.data.frame(newdata, check.names = FALSE, optional = TRUE)
  if (nrow(newdata) == 0) stop_input("newdata has no rows")
  unknown <- setdiff(names(newdata), names(units))
  if (length(unknown)) stop_input("newdata: the study has no column '", unknown[1], "' (columns: ", words(conditions), ")")
  asked <- intersect(names(newdata), conditions)
  for (name in asked) {
    column_values(newdata[[name]], paste0("newdata, column '", name, "'"))
    row <- which(is.na(newdata[[name]]))
    if (length(row)) stop_input("newdata, row ", row[1], ", column '", name, "': a value is missing")
  }
  axis <- axis_of(study, units, along)
  if (is.null(axis)) axis <- Filter(function(name) is.numeric(newdata[[name]]) || is.logical(newdata[[name]]), asked)[1]
  if (!isTRUE(axis %in% asked)) stop_input("newdata has no column '", if (is.na(axis)) conditions[1] else axis, "'")
  others <- setdiff(asked, axis)
  several <- length(study$likelihood) > 1
  # Rows of the same conditions are one question.
  written <- lapply(stats::setNames(asked, asked), function(name) {
    vapply(seq_len(nrow(newdata)), function(i) toml_value(in_unit(newdata[[name]][i], units[[name]]), name), "")
  })
  group <- if (length(others)) do.call(paste, c(written[others], sep = "\r")) else rep("", nrow(newdata))
  answers <- vector("list", nrow(newdata))
  for (places in split(seq_len(nrow(newdata)), factor(group, unique(group)))) {
    question <- list(along = axis, at = lapply(places, function(i) in_unit(newdata[[axis]][i], units[[axis]])))
    if (length(others)) {
      question$given <- lapply(stats::setNames(others, others), function(name) in_unit(newdata[[name]][places[1]], units[[name]]))
    }
    found <- ww_ask(object, question, level)$predictions
    each <- length(found) / length(places)  # one for each measured column
    for (i in seq_along(places)) answers[[places[i]]] <- found[(i - 1) * each + seq_len(each)]
  }
  ends <- if (kind == "mean") c("ci05", "ci95") else c("pi05", "pi95")
  result <- data.frame(row.names = rownames(newdata))
  for (which in seq_along(answers[[1]])) {
    rows <- lapply(answers, function(answer) best(answer[[which]]))
    prefix <- if (several) paste0(rows[[1]]$quantity, " ") else ""
    keys <- stats::setNames(c("mean", ends), paste0(prefix, c("mean", "lower", "upper")))
    for (name in names(keys)) result[[name]] <- column(rows, keys[[name]])
  }
  if (!several) attr(result, "unit") <- answers[[1]][[1]]$unit
  result
}

ww_life <- function(fit, limit = NULL, b = c(1, 10), confidence = 0.9, unit = NULL, survived = NULL, along = NULL, given = NULL) {
  study <- keys_of_law(fit)
  units <- column_units(study)
  if (!is.numeric(b) || length(b) == 0 || anyNA(b)) stop_input("b is ", shown_value(b), "; it holds percentages, like c(1, 10)")
  question <- if (length(given)) list(given = as.list(given)) else list()
  if (is.null(limit)) {
    if (!is.null(unit)) stop_input("unit is of lives to a limit: ww_life(fit, limit = ..., unit = ...)")
    question <- c(question, list(b_lives = as.list(b), credible_level = confidence))
    if (!is.null(survived)) question$survival_to <- list(quantity(survived, "survived"))
  } else {
    if (!is.null(survived)) stop_input("survived is of lives that are measured; a life to a limit counts from the item's last row")
    if (!identical(as.double(confidence), 0.9)) {
      stop_input("confidence is ", shown_value(confidence), "; of lives to a limit the interval of 90 % is computed, not another yet")
    }
    unknown <- setdiff(b, c(1, 10, 50))
    if (length(unknown)) stop_input("b: B", unknown[1], " of a life to a limit is not computed yet; B1, B10 and B50 are")
    if (is.null(names(limit))) {
      measured <- names(study$likelihood)
      if (length(measured) != 1) stop_input("limit: of which? list(", measured[1], " = \"...\") says so")
      limit <- stats::setNames(list(limit), measured)
    }
    axis <- axis_of(study, units, along)
    if (is.null(axis)) {
      stop_input("along is missing: the column along which it wears (", words(conditions_of(study, units)), ")")
    }
    # What is measured is no name in expressions; its law is.
    of <- vapply(names(limit), function(name) {
      slots <- study$likelihood[[name]]
      if (!is.null(slots$mean)) slots$mean else if (!is.null(slots$median)) slots$median else name
    }, "")
    limit <- lapply(stats::setNames(names(limit), of), function(name) quantity(limit[[name]], "limit"))
    question <- c(question, list(along = axis, limit = limit))
  }
  lives_among(ww_ask(fit, question)$quantities, limit, b, unit)
}

lives_among <- function(found, limit, b, unit) {
  item <- function(of) sub("^[^ ]* ", "", of)
  name <- column(found, "name", "")
  of <- column(found, "of", "")
  if (!is.null(limit)) {
    wanted <- name == if (is.null(unit)) "life" else "remaining life"
    if (!is.null(unit)) wanted <- wanted & item(of) == as.character(unit)
    if (!is.null(unit) && !any(wanted)) {
      stop_input("the study has no item '", unit, "' (items: ", words(item(sort(unique(of[name == "remaining life"])))), ")")
    }
    found <- found[wanted]
  }
  rows <- lapply(found, best)
  frame <- data.frame(name = column(rows, "name", ""), of = column(rows, "of", ""), at = column(rows, "at", ""),
                      unit = column(rows, "unit", ""))
  keys <- c("q05", "q50", "q95", if (is.null(limit)) c("predictive", "bound") else paste0("b", format(b, trim = TRUE)))
  for (key in keys) frame[[key]] <- if (is.null(limit)) column(rows, key) else vapply(rows, function(row) if (is.null(row[[key]])) NA_real_ else life(row[[key]]), 0)
  frame
}
