# Questions that a fit answers later. Nothing is fitted again.

ww_ask <- function(fit, predict, level = 0.9) {
  if (!is.numeric(level) || length(level) != 1 || !isTRUE(level > 0 && level < 1)) {
    stop_input("level is ", shown_value(level), "; it lies between 0 and 1")
  }
  run <- run_again(fit)
  text <- paste0(without_table(fit$study$text, "predict"), "\n", toml_table("predict", predict))
  # An answer's `predict.units` is read by predict().
  tryCatch(core(C_asked, run, read_again(fit$study, text), as.double(level)), wearwell_input_error = function(error) {
    if (grepl("predict.units: ", conditionMessage(error), fixed = TRUE)) stop(error)
    stop_input(in_words_of_caller(conditionMessage(error), predict))
  })
}

# The study's tables and keys; of a study of these models alone.
keys_of <- function(fit, models = "formula") {
  study <- core(C_keys, fit$study$text)
  if (!isTRUE(study$model %in% models)) {
    stop_input("this needs a study of the model ", paste(models, collapse = " or "), ", and this study is of the model ", study$model,
               ": use ww_ask(fit, predict) with the keys of its [predict], or fit$quantities and fit$tables")
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
conditions_of <- function(study, units) setdiff(names(units), c(names(study$likelihood), names(study$random_effects), special))

axis_of <- function(study, units, along) {
  if (is.null(along)) along <- study$predict$along
  if (!is.null(along)) {
    if (!isTRUE(along %in% names(units))) {
      stop_input("along: the study has no column '", words(along), "' (columns: ", words(names(units)), ")")
    }
    return(along)
  }
  texts <- c(unlist(study$formula), unlist(study$likelihood))
  if (any(startsWith(c(names(study$formula), ""), "d(")) || any(grepl("cum(", texts, fixed = TRUE))) {
    stop_input("along is missing: the column along which the formula is a rate or a running sum")
  }
  NULL
}

in_unit <- function(value, unit) {
  if (is.factor(value)) value <- as.character(value)
  if (inherits(value, "units")) return(quantity(value, "newdata"))
  if (is.list(value)) return(value)  # a distribution over the units, as a study file has it
  if (is.character(value) || unit == "") return(value)
  paste(number_text(value), unit)
}

# For each row the item that it is of, NA for a new one.
whose_of <- function(newdata, label) {
  if (!label %in% names(newdata)) {
    stop_input("newdata has no column '", label, "', which says of which ", label, " each row is (NA: of a new one)")
  }
  values <- column_values(newdata[[label]], paste0("newdata, column '", label, "'"))
  names <- if (is.double(values)) ifelse(is.na(values), NA, number_text(values)) else values
  ifelse(names %in% "", NA, names)
}

require_values <- function(newdata, columns, what = "newdata") {
  for (name in columns) {
    column <- newdata[[name]]
    column_values(column, paste0(what, ", column '", name, "'"))
    row <- which(is.na(column))
    if (length(row)) stop_input(what, ", row ", row[1], ", column '", name, "': a value is missing")
    row <- if (is.numeric(column)) which(is.infinite(column))
    if (length(row)) stop_input(what, ", row ", row[1], ", column '", name, "': ", column[row[1]], " is not a finite number")
  }
}

# Of each place its predictions by measured column, of the item of that name or, NA, of a new one.
answers_of <- function(fit, question, level, name, newdata) {
  question$units <- if (is.na(name)) list() else list(name)  # none: no paths of items are computed
  found <- tryCatch(ww_ask(fit, question, level)$predictions, wearwell_input_error = function(error) {
    unknown <- regmatches(conditionMessage(error),
                          regexec("predict.units: the data have no (.*) '(.*)' ([(].*[)])", conditionMessage(error)))[[1]]
    if (!length(unknown)) {
      needed <- regmatches(conditionMessage(error), regexec("needs (predict[.]given[.]|given = list[(])([A-Za-z0-9_]+)", conditionMessage(error)))[[1]]
      if (length(needed)) require_conditions(newdata, needed[3])
      stop(error)
    }
    stop_input("newdata, column '", unknown[2], "': the data have no ", unknown[2], " '", unknown[3], "' ", unknown[4],
               "; NA is a new one")
  })
  # Entries come by measured column, then by whom they are of, then by place.
  seen <- vapply(found, function(entry) !is.null(entry$mean_of) && identical(entry$mean_of, entry$pi_of), NA)
  found <- found[seen == !is.na(name)]
  by_column <- split(found, factor(column(found, "quantity", ""), unique(column(found, "quantity", ""))))
  lapply(seq_along(question$at), function(i) unname(lapply(by_column, `[[`, i)))
}

# That a frame has these columns; of one that lacks, another column may be meant.
require_conditions <- function(frame, needed) {
  missing <- setdiff(needed, names(frame))
  if (!length(missing)) return()
  stop_input("newdata has no column '", paste(missing, collapse = "' and no column '"), "' (its columns: ", words(names(frame)), ")",
             did_you_mean(missing[1], setdiff(names(frame), needed)))
}

predict.ww_fit <- function(object, newdata, level = 0.9, kind = "mean", along = NULL, ...) {
  if (!isTRUE(kind %in% c("mean", "next", "unit"))) stop_input("kind is ", shown_value(kind), "; it is 'mean', 'next' or 'unit'")
  study <- keys_of(object)
  units <- column_units(study)
  conditions <- conditions_of(study, units)
  if (is_path(newdata)) stop_input("newdata is a text; it is a data frame or a named list of columns")
  require_columns(newdata, "newdata")
  newdata <- as.data.frame(newdata, check.names = FALSE, optional = TRUE)
  if (nrow(newdata) == 0) stop_input("newdata has no rows")
  if (is.null(along) && is_of_lives(study) && is.null(axis_of(study, units, NULL))) return(predicted_lives(object, study, newdata, level, kind))
  label <- names(study$random_effects)[1]
  if (kind == "unit" && is.null(label)) {
    stop_input("kind = 'unit' needs a study with random effects, and this one has none: kind = 'next' predicts a measurement of ",
               "a new item")
  }
  whose <- if (kind == "unit") whose_of(newdata, label) else rep(NA_character_, nrow(newdata))
  asked <- intersect(names(newdata), conditions)
  numbers <- Filter(function(name) is.numeric(newdata[[name]]) || is.logical(newdata[[name]]), asked)
  axis <- axis_of(study, units, along)
  if (is.null(axis) && kind == "unit" && length(numbers) > 1) {
    stop_input("along is missing: the column along which it wears (", words(numbers), "), since beyond its last row an item goes on ",
               "from where it stands")
  }
  if (is.null(axis)) axis <- numbers[1]
  if (!isTRUE(axis %in% asked)) {
    needed <- if (is.na(axis)) conditions[1] else axis
    require_conditions(newdata, needed)
    stop_input("newdata: column '", needed, "' holds no numbers")
  }
  require_values(newdata, asked)
  predictions_at(object, newdata, asked, axis, units, level, kind, whose, several = length(study$likelihood) > 1)
}

predictions_at <- function(fit, newdata, asked, axis, units, level, kind, whose, several) {
  others <- setdiff(asked, axis)
  # Rows of one item under the same conditions are one question.
  written <- lapply(stats::setNames(asked, asked), function(name) {
    vapply(seq_len(nrow(newdata)), function(i) toml_value(in_unit(newdata[[name]][i], units[[name]]), name), "")
  })
  group <- do.call(paste, c(list(whose), unname(written[others]), sep = "\r"))
  answers <- vector("list", nrow(newdata))
  for (places in split(seq_len(nrow(newdata)), factor(group, unique(group)))) {
    question <- list(along = axis, at = lapply(places, function(i) in_unit(newdata[[axis]][i], units[[axis]])))
    if (length(others)) {
      question$given <- lapply(stats::setNames(others, others), function(name) in_unit(newdata[[name]][places[1]], units[[name]]))
    }
    answers[places] <- answers_of(fit, question, level, whose[places[1]], newdata)
  }
  if (!all(lengths(answers) > 0)) {
    stop_input("measurements of a new item are not predicted with two random effects, or of a process; its path is: ",
               "ww_ask(fit, list(along = ..., at = ...))$quantities")
  }
  ends <- if (kind == "mean") c("ci05", "ci95") else c("pi05", "pi95")
  result <- data.frame(row.names = rownames(newdata))
  for (which in seq_along(answers[[1]])) {
    rows <- lapply(answers, function(answer) answer[[which]])
    prefix <- if (several) paste0(rows[[1]]$quantity, " ") else ""
    keys <- stats::setNames(c("mean", ends), paste0(prefix, c("mean", "lower", "upper")))
    for (name in names(keys)) result[[name]] <- column(rows, keys[[name]])
  }
  if (!several) attr(result, "unit") <- answers[[1]][[1]]$unit
  result
}
