# Degradation in one line: repeated readings of units along an axis.

degradation_families <- c("normal", "lognormal", "wiener-process", "gamma-process", "inverse-gaussian-process")
degradation_paths <- c("line", "power")

# y ~ x | unit, or y ~ x + load | unit: the axis first, then conditions of the rate.
degradation_sides <- function(x, unit) {
  if (length(x) != 3) stop_input("the formula has no left side: wear ~ km | machine")
  right <- x[[3]]
  if (has_bar(right)) {
    if (!is.null(unit)) stop_input("unit stands in the formula already, behind the bar: leave one out")
    if (!is.symbol(right[[3]])) stop_input("the formula: ", shown_value(right[[3]]), " is no column; wear ~ km | machine names that of the units")
    unit <- as.character(right[[3]])
    right <- right[[2]]
  }
  split <- split_terms(right)
  if (length(split$random)) {
    stop_input("the formula: (", shown_value(split$random[[1]]), "): the rate differs from unit to unit; write wear ~ km | machine")
  }
  sum <- summands(split$fixed)
  if (!is.symbol(sum[[1]])) stop_input("the formula: the axis comes first on its right side, and ", shown_value(sum[[1]]), " is no column")
  rest <- if (length(sum) > 1) Reduce(function(a, b) call("+", a, b), sum[-1]) else 1
  list(axis = as.character(sum[[1]]), fixed = rest, unit = unit)
}

ww_degradation <- function(x, ...) UseMethod("ww_degradation")

ww_degradation.default <- function(x, ...) {
  stop_input("ww_degradation() takes a formula, like wear ~ km | machine, or a data frame with y, x and unit; not ", kind_of(x))
}

ww_degradation.data.frame <- function(x, y, along, unit = NULL, ...) {
  call <- match.call()
  call[[1]] <- quote(ww_degradation)
  columns <- frame_columns(x, list(...)$units)
  for (name in c(y = one_text(y, "y"), along = one_text(along, "along"))) find_column(columns, name, "data")
  formula <- stats::as.formula(call("~", as.name(y), as.name(along)), env = parent.frame())
  with_call(ww_degradation.formula(formula, data = x, unit = unit, ...), call)
}

ww_degradation.formula <- function(x, data = NULL, limit = NULL, family = "normal", path = "line", starts_at_zero = NULL, start = FALSE,
                                   unit = NULL, priors = NULL, units = NULL, given = NULL, b = c(1, 10), confidence = 0.9, predict = NULL, title = NULL, unused = NULL,
                                   fit = TRUE, ...) {
  call <- match.call()
  call[[1]] <- quote(ww_degradation)
  require_options("ww_degradation", ..., own = c("data", "limit", "family", "path", "starts_at_zero", "start", "unit", "priors", "units", "given", "b", "confidence", "predict", "title",
                                                 "unused", "fit"))
  if (!is_path(family) || !family %in% degradation_families) stop_input("family is ", shown_value(family), "; it is one of ", words(degradation_families))
  if (!is_path(path) || !path %in% degradation_paths) stop_input("path is ", shown_value(path), "; it is one of ", words(degradation_paths))
  process <- endsWith(family, "process")
  start <- one_truth(start, "start")
  if (!is.null(starts_at_zero)) one_truth(starts_at_zero, "starts_at_zero")
  if (start && isTRUE(starts_at_zero)) stop_input("start = TRUE says that each unit begins at a value of its own; leave starts_at_zero = TRUE out")
  if ((start || identical(starts_at_zero, FALSE)) && (process || family == "lognormal")) {
    stop_input(if (start) "start = TRUE" else "starts_at_zero = FALSE", " needs family = \"normal\": paths of the family ", family, " begin at 0")
  }
  if (is.null(data)) data <- data_of_formula(x)
  columns <- frame_columns(data, units)
  one_unit <- identical(unit, FALSE)
  sides <- degradation_sides(x, if (!one_unit) unit)
  measured <- evaluated(x[[2]], columns, environment(x), "the formula's left side")
  if (!is.symbol(x[[2]])) measured$name <- "wear"
  readings <- numbers_for(measured, "the formula's left side")
  axis <- find_column(columns, sides$axis, "the formula")
  along <- numbers_for(list(values = plain_values(axis), heading = axis$heading, of = axis$of), "the formula")
  if (!length(readings)) stop_input("data has no rows")
  effects <- effects_of(sides$fixed, columns, list(), "the formula")
  y <- language_name(measured$name)
  s <- language_name(sides$axis, y)
  study <- stats::setNames(list(study_column(readings, measured$unit), study_column(along, axis$unit)), c(y, s))
  for (condition in effects$conditions) study[[condition$name]] <- study_column(condition$values, condition$unit)
  label <- NULL
  if (!is.null(sides$unit)) {
    of_unit <- find_column(columns, sides$unit, "unit")
    label <- language_name(sides$unit, names(study))
    values <- column_values(plain_values(of_unit), place_of(of_unit))
    row <- which(is.na(values))
    if (length(row)) stop_input("data, row ", row[1], ", column '", of_unit$heading, "': a value is missing")
    study[[label]] <- study_column(if (is.double(values)) number_text(values) else values, "")
  }
  look_at_unused(columns, c(all.vars(x), sides$unit), TRUE, unused, "",
                 units = if (is.null(sides$unit)) "| %s in the formula, or unit = \"%s\" of a frame")
  require_finite(readings, measured$heading)
  require_finite(along, axis$heading)
  rows <- table_of(stats::setNames(list(along, readings), c(sides$axis, measured$heading)))
  core(C_require_rows_of_family, rows, sides$axis, measured$heading, family)
  if (is.null(label) && !one_unit) require_one_path(along, sides$axis, measured$name)
  line <- line_of_readings(study, s, y, label, family, if (start) FALSE else starts_at_zero)
  middle <- path_of_degradation(path, line, s, axis$unit, along, effects)
  start <- start && !is.null(label)
  proposed <- degradation_priors(readings, measured$unit, axis$unit, path, line, start, family, !is.null(label), effects)
  likelihood <- switch(family,
    normal = list(family = family, mean = middle, sd = "sigma"),
    lognormal = list(family = family, median = middle, log_sd = "sigma"),
    list(family = family, mean = middle, scale = "step_ratio"))
  entries <- if (!is.null(label) && !process) {
    stats::setNames(list(c(list(rate = list(distribution = "lognormal", log_sd = "rate_scatter")),
                           if (start) list(start = list(distribution = "normal", sd = "start_scatter")))), label)
  }
  given <- lives_given(given, effects$conditions, NULL)
  of <- if (process) y else "path"
  questions <- c(list(along = s, at = list(quantity_text(2 * max(abs(along)), axis$unit))), if (length(given)) list(given = given),
                 if (!is.null(limit)) list(limit = stats::setNames(list(quantity(limit, "limit")), of), b_lives = as.list(b), credible_level = confidence))
  if (!process) likelihood[[2]] <- "path"
  text <- study_text(title = if (is.null(title)) paste(measured$name, "along", sides$axis) else one_text(title, "title"), columns = study,
                     constants = effects$constants[vapply(names(effects$constants), function(name) grepl(name, middle, fixed = TRUE), NA)],
                     likelihood = stats::setNames(list(likelihood), y), priors = proposed, own_priors = priors,
                     random = list(entries = entries, labels = label), predict = predict_of(predict, questions),
                     formula = if (!process) list(path = middle))
  notes <- c(reference_notes(effects$conditions, "rate", NULL, NULL),
             if (is.null(limit)) "no limit is given: wear is fitted, and no life is predicted; limit = \"100 um\" gives lives",
             if (process && !is.null(label)) paste0("one rate for all: the increments of each ", sides$unit, " are random, its rate is not"))
  if (!line$at_zero && is.null(starts_at_zero) && !start) {
    notes <- c(notes, "paths begin at start, since a line through the readings does not begin at 0: starts_at_zero = TRUE or FALSE decides")
  }
  known <- list(path = path, family = family, start = !line$at_zero, start_differs = start, falls = line$falls, differs = length(entries) > 0, along = along, power_of = power_unit(along),
                item = if (is.null(label)) rep("", length(along)) else study[[label]]$values, unit = measured$unit, rows = length(along),
                effects = Map(function(parameter, value) list(parameter = parameter, value = value), names(effects$values), effects$values),
                units = lapply(proposed[names(proposed) %in% c("rate", "start", "start_scatter", "step_ratio", if (family == "normal") "sigma")], unit_of_prior))
  one_line(text$text, study, text$proposed, notes, fit, call, ..., replicates = known, values = list(limit = limit),
           arguments = c(credible_level = "confidence", b_lives = "b"))
}

# Without a column of units all rows are of one.
require_one_path <- function(along, axis, measured) {
  row <- which(diff(along) < 0)[1] + 1
  if (is.na(row)) return()
  stop_input("unit is missing: ", axis, " falls at row ", row, " from ", number_text(along[row - 1]), " to ", number_text(along[row]), ", so the rows are of several ",
             "units; | UNIT in the formula names the column that tells them apart, or unit = FALSE says that all rows of ", measured, " are of one")
}

# Where a power of the axis is 1.
power_unit <- function(along) rounded_up(max(along))

# "um/km" of a prior of "0.5 um/km".
unit_of_prior <- function(prior) {
  size <- c(prior$median, prior$scale, prior$mean)[[1]]
  if (is.character(size)) sub("^[^ ]+ ", "", size) else ""
}

# The straight line that `wearwell new` proposes priors with: whether paths begin at 0 and fall, and their rate.
line_of_readings <- function(study, axis, measured, label, family, at_zero) {
  table <- table_of(lapply(study[c(axis, measured, label)], `[[`, "values"))
  line <- core(C_straight_line, table, axis, measured, if (is.null(label)) "" else label)
  begins <- line$at_zero
  line$at_zero <- if (is.null(at_zero)) begins || family == "lognormal" else at_zero
  if (endsWith(family, "process") && is.null(at_zero) && !begins) {
    stop_input("family \"", family, "\": the path of a process begins at 0, and a line through the readings of ", measured, " does not: give the growth ",
               "since the first reading, or starts_at_zero = TRUE")
  }
  if (line$falls && family %in% c("lognormal", "gamma-process", "inverse-gaussian-process")) {
    stop_input("family \"", family, "\": its paths only rise, and ", measured, " falls; give the loss since the first reading")
  }
  line
}

path_of_degradation <- function(path, line, axis, unit, along, effects) {
  rate <- if (length(effects$terms)) paste0("rate * exp(", paste(effects$terms, collapse = " + "), ")") else "rate"
  if (path == "power") {
    if (any(along < 0)) stop_input("path = \"power\" needs an axis from 0 on, and data, row ", which(along < 0)[1], " is at ", along[along < 0][1])
    one <- if (unit == "") number_text(power_unit(along)) else paste0(number_text(power_unit(along)), " [", unit, "]")
    grown <- paste0(rate, " * ", one, " * (", axis, "/", if (unit == "") one else paste0("(", one, ")"), ")^power")
  } else {
    grown <- paste0(rate, " * ", axis)
  }
  if (line$at_zero) paste0(if (line$falls) "-", grown) else paste0("start ", if (line$falls) "-" else "+", " ", grown)
}

require_finite <- function(values, heading) {
  row <- which(!is.finite(values))[1]
  if (is.na(row)) return()
  what <- if (is.na(values[row])) "a value is missing; the formula uses it" else paste(values[row], "is not a finite number")
  stop_input("data, row ", row, ", column '", heading, "': ", what)
}

# As `wearwell new` proposes them: from the size of the data.
degradation_priors <- function(y, y_unit, x_unit, path, line, own_starts, family, differs, effects) {
  size <- rounded_up(max(abs(y)))
  unit <- if (y_unit == "" && x_unit == "") "" else if (x_unit == "") y_unit else paste0(if (y_unit == "") "1" else y_unit, "/(", x_unit, ")")
  if (grepl("^[A-Za-z%]+$", x_unit)) unit <- sub("\\((.*)\\)$", "\\1", unit)
  all <- list(rate = ww_lognormal(quantity_text(rounded_up(line$rate), unit), log_sd = 2))
  if (path == "power") all$power <- ww_lognormal(1, log_sd = 0.5)
  if (!line$at_zero) {
    all$start <- ww_normal(quantity_text(size / 2, y_unit), quantity_text(size, y_unit))
    if (own_starts) all$start_scatter <- ww_half_normal(quantity_text(size, y_unit))
  }
  if (family == "normal") all$sigma <- ww_half_normal(quantity_text(size, y_unit))
  if (family == "lognormal") all$sigma <- ww_half_normal(1)
  if (endsWith(family, "process")) all$step_ratio <- ww_half_normal(quantity_text(size, y_unit))
  if (differs && !endsWith(family, "process")) all$rate_scatter <- ww_half_normal(1)
  c(all, effects$priors)
}
