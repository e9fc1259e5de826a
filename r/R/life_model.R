# Lives in one line: a formula model with the priors of `wearwell new`.

ww_life <- function(x, ...) UseMethod("ww_life")

ww_life.default <- function(x, ...) {
  stop_input("ww_life() takes a formula, like Surv(hours, event) ~ temperature, a data frame with the name of its life, or a fit; not ",
             kind_of(x))
}

# The same of a frame and names of columns.
ww_life.data.frame <- function(x, life, event = NULL, entry = NULL, unit = NULL, ...) {
  columns <- frame_columns(x, list(...)$units)
  name <- function(text, what) {
    find_column(columns, one_text(text, what), what)
    as.name(text)
  }
  life <- name(life, "life")
  event <- if (!is.null(event)) name(event, "event")
  side <- if (!is.null(entry)) {
    if (is.null(event)) stop_input("entry needs event: the column that says how each life ended")
    call("Surv", name(entry, "entry"), life, event)
  } else if (!is.null(event)) call("Surv", life, event) else life
  call <- match.call()
  call[[1]] <- quote(ww_life)
  terms <- if (is.null(unit)) 1 else call("(", call("|", 1, name(unit, "unit")))
  fit <- ww_life.formula(stats::as.formula(call("~", side, terms), env = parent.frame()), data = x, ...)
  with_call(fit, call)
}

ww_life.formula <- function(x, data = NULL, family = "weibull", standard = NULL, threshold = FALSE, share_defective = FALSE, share_dead_on_arrival = FALSE,
                            subpopulations = NULL, by = NULL, mode = NULL, shape = NULL, stress = NULL, priors = NULL, units = NULL, count = NULL, weights = NULL,
                            unit = NULL, given = NULL, b = c(1, 10, 50), confidence = 0.9, classical = FALSE, predict = NULL, title = NULL, unused = NULL,
                            fit = TRUE, ...) {
  call <- match.call()
  call[[1]] <- quote(ww_life)
  require_options("ww_life", ..., own = c("data", "family", "standard", "threshold", "share_defective", "share_dead_on_arrival", "subpopulations", "by", "mode", "shape", "stress", "priors", "units", "count", "weights", "given", "b", "confidence", "classical", "predict", "title",
                                          "unused", "fit"))
  require_family(family, standard)
  populations <- population_names(subpopulations)
  shares <- list(share_defective = share_defective, share_dead_on_arrival = share_dead_on_arrival)
  if (!is.null(unit)) stop_input("unit: in a formula, random effects of a label are (1 | label)")
  if (length(x) != 3) stop_input("the formula has no left side: Surv(hours, event) ~ 1")
  if (is.null(data)) data <- data_of_formula(x)
  columns <- frame_columns(data, units)
  if (!length(columns) || length(columns[[1]]$values) == 0) stop_input("data has no rows")
  stress <- stress_laws(stress)
  parameters <- parameters_of_family(family, stress)
  location <- parameters[1]
  if (!is.null(count)) {
    if (!is.null(weights)) stop_input("count and weights are one: leave weights out")
    weights <- count
  }
  reader <- list(x = x, location = location, by = by, mode = mode, stress = stress, units = units, weights = weights, unused = unused,
                 dead = is_asked(share_dead_on_arrival, "share_dead_on_arrival"))
  read <- read_lives(reader, columns)
  study <- read$columns
  lives <- read$lives
  effects <- read$effects
  effect <- read$random
  by <- read$by
  modes <- read$modes
  refuse_beside(shares, populations, by, modes, effect)
  index <- c(by$name, modes$name, if (length(populations)) "subpopulation")
  index <- if (is.null(index)) "" else paste0("[", index, "]")
  middle <- paste0(location, index)
  if (length(effects$terms)) middle <- paste0(middle, " * exp(", paste(effects$terms, collapse = " + "), ")")
  likelihood <- life_slots(family, middle, if (has_own_shapes(shape, by, modes, populations)) index else "", standard)
  size <- life_size(study, modes, stress_columns(effects, stress))
  proposed <- life_priors(family, size$median, lives$unit, size$log_sd, location)
  further <- further_of_lives(threshold, shares, populations, study, lives$unit)
  likelihood <- c(likelihood, further$slots)
  proposed <- c(proposed, effects$priors, effect$priors, further$priors)
  given <- lives_given(given, effects$conditions, by)
  text <- study_text(
    title = if (is.null(title)) paste0("Life of ", lives_name(lives, x)) else one_text(title, "title"), columns = study,
    constants = c(effects$constants, further$constants), populations = further$table,
    likelihood = list(life = likelihood), priors = proposed, own_priors = priors, random = effect, modes = modes$table,
    predict = predict_of(predict, c(if (length(given)) list(given = given), list(b_lives = as.list(b), credible_level = confidence),
                                   if (one_truth(classical, "classical")) list(classical = TRUE))))
  notes <- reference_notes(effects$conditions, location, parameters, by)
  known <- simulator_of(if (is.null(standard)) family else standard, parameters, lives, study, effects, effect, by)
  known$populations <- further
  if (isTRUE(threshold)) known$units$threshold <- lives$unit
  known$modes <- !is.null(modes)
  reader$used <- read$used
  reader$made <- names(study)
  one_line(text$text, study, text$proposed, notes, fit, call, ..., replicates = known, reader = reader,
           arguments = c(credible_level = "confidence", b_lives = "b"))
}

# The columns of a study, as the formula and the arguments of ww_life() read those of a frame. `fitted`: of rows for a fit.
read_lives <- function(reader, columns, fitted = FALSE) {
  x <- reader$x
  by <- reader$by
  lives <- lives_of_side(x[[2]], columns, environment(x))
  sides <- split_terms(without_dot(x[[3]], columns, lives$used))
  effects <- effects_of(sides$fixed, columns, reader$stress, "the formula", fitted)
  random <- random_of(sides$random, reader$location, effects, columns, "the formula")
  if (!is.null(by) && length(random)) stop_input("by gives each level of ", words(by), " its own ", reader$location, ", which then has no random effects: write ~ ",
                                                 words(by), " + (1 | ...)")
  study <- life_columns(lives, reader$weights, columns, isTRUE(reader$dead))
  for (condition in effects$conditions) study[[condition$name]] <- study_column(condition$values, condition$unit)
  if (!is.null(by)) {
    by <- condition_of(one_text(by, "by"), columns, names(study), "by", fitted)
    study[[by$name]] <- study_column(if (by$label) by$values else number_text(by$values), "")
    by$levels <- sort(unique(study[[by$name]]$values))
  }
  modes <- modes_of(reader$mode, columns, names(study))
  if (!is.null(modes)) {
    if (!is.null(by)) stop_input("by and mode: each failure mode has its own ", reader$location, ", for all groups; leave one out")
    if (length(random)) stop_input("mode: failure modes have no random effects; leave out (1 | ...), or mode")
    study[[modes$name]] <- modes$column
  }
  effect <- with_random(random, reader$location, effects, columns, names(study), "the formula")
  used <- c(lives$used, names(effects$conditions), by$source, modes$source, unlist(lapply(random, `[[`, "label")), reader$weights)
  instead <- if (!is.null(by)) " in place of by" else if (!is.null(modes)) " in place of mode"
  look_at_unused(columns, used, lives$known, reader$unused, paste0("Surv(", lives$name, ", ", "EVENT)"),
                 counts = if (is.null(reader$weights)) "count = \"%s\"",
                 units = if (!length(random)) paste0("+ (1 | %s) in the formula, or unit = \"%s\" of a frame", instead))
  list(columns = c(study, effect$columns), lives = lives, effects = effects, random = effect, by = by, modes = modes, used = unique(used))
}

# The column of failure modes, and what [failure_modes] says of it.
modes_of <- function(mode, columns, taken) {
  if (is.null(mode)) return(NULL)
  table <- if (is.list(mode)) mode else list(column = mode)
  unknown <- setdiff(c(names(table), if (is.null(names(table))) ""), c("column", "runout", "unknown"))
  if (length(unknown) || is.null(table$column)) {
    stop_input("mode is ", shown_value(mode), "; it is the name of a column, or like list(column = \"cause\", runout = 0)")
  }
  each <- find_column(columns, one_text(table$column, "mode"), "mode")
  values <- column_values(plain_values(each), place_of(each))
  if (is.double(values)) values <- ifelse(is.na(values), NA_character_, number_text(values))
  name <- language_name("mode", taken)
  table$column <- name
  table[-1] <- lapply(table[-1], as.character)
  list(name = name, source = each$heading, column = study_column(values, ""), table = table[c("column", setdiff(names(table), "column"))])
}

# Whether groups, failure modes or subpopulations have shapes of their own: by default the latter two do.
has_own_shapes <- function(shape, by, modes, populations) {
  if (is.null(shape)) return(!is.null(modes) || length(populations) > 0)
  if (!isTRUE(shape %in% c("shared", "separate"))) stop_input("shape is ", shown_value(shape), "; it is 'shared', one for all groups, failure modes or subpopulations, or 'separate'")
  if (shape == "separate" && is.null(by) && is.null(modes) && !length(populations)) {
    stop_input("shape = 'separate' needs by or mode: the column of the groups or failure modes that differ; or subpopulations")
  }
  shape == "separate"
}

# What simulate() needs of the model.
simulator_of <- function(family, parameters, lives, study, effects, random, by) {
  rows <- length(study[[1]]$values)
  labels <- lapply(names(random$entries), function(label) {
    level <- as.integer(factor(random$columns[[label]]$values))
    entries <- random$entries[[label]]
    correlation <- entries$correlation
    entries$correlation <- NULL
    list(level = level, levels = max(level), correlation = correlation, entries = lapply(names(entries), function(name) {
      list(scatter = if (is.null(entries[[name]]$log_sd)) entries[[name]]$sd else entries[[name]]$log_sd,
           value = if (name == parameters[[1]]) 1 else effects$values[[name]])
    }))
  })
  list(family = family, parameters = parameters, unit = lives$unit, rows = rows, by = if (!is.null(by)) study[[by$name]]$values,
       effects = Map(function(parameter, value) list(parameter = parameter, value = value), names(effects$values), effects$values),
       fixed = effects$fixed, random = labels, entry = study$entry$values,
       units = stats::setNames(list(lives$unit), parameters[[1]]))
}

lives_name <- function(lives, x) if (is_surv_call(x[[2]]) && lives$name == "life") words(all.vars(x[[2]])) else lives$name

# ~ . is every column that the left side does not use.
without_dot <- function(side, columns, used) {
  if (!"." %in% all.vars(side)) return(side)
  others <- setdiff(names(columns), used)
  if (!length(others)) stop_input("the formula: '.' stands for the other columns, and data has none")
  sum <- Reduce(function(a, b) call("+", a, b), lapply(others, as.name))
  do.call(substitute, list(side, list(. = sum)))
}

# `dead`: a life of 0 is a part that is dead on arrival.
life_columns <- function(lives, weights, columns, dead = FALSE) {
  study <- lives$columns
  row <- paste0(table_name(columns), ", row ")
  for (name in c("life", "entry", "lower", "upper")) {
    values <- study[[name]]$values
    if (name %in% c("life", "entry") && anyNA(values)) stop_input(row, which(is.na(values))[1], ": the ", name, " is missing")
    if (any(is.infinite(values))) stop_input(row, which(is.infinite(values))[1], ": the ", name, " is ", values[is.infinite(values)][1])
    low <- if (dead) values < 0 else values <= 0
    if (name == "life" && any(low)) {
      stop_input(row, which(low)[1], ": the life is ", number_text(values[low][1]), "; lives are above 0",
                 if (values[low][1] == 0) "; with share_dead_on_arrival = TRUE a life of 0 is a part that is dead on arrival")
    }
  }
  if (!is.null(weights)) {
    each <- find_column(columns, one_text(weights, "count"), "count")
    counts <- numbers_for(each, "count")
    if (anyNA(counts)) stop_input(place_of_row(each, which(is.na(counts))[1]), ": a value is missing; a count is a whole number from 1")
    study$count <- study_column(counts, "", each$heading)
  }
  study
}

# Conditions at which lives are predicted: the reference, and what the caller states.
lives_given <- function(given, conditions, by) {
  names <- c(vapply(conditions, `[[`, "", "source"), by$source)
  unknown <- setdiff(names(given), names)
  if (length(given) && is.null(names(given))) stop_input("given has no names; it is like list(temperature = \"50 degC\")")
  if (length(unknown)) {
    stop_input("given: ", unknown[1], " is no condition of the formula (", if (length(names)) paste0("conditions: ", words(names)) else "it has none", ")")
  }
  all <- list()
  for (condition in c(unname(conditions), if (!is.null(by)) list(utils::modifyList(by, list(label = TRUE, reference = by$levels[1]))))) {
    value <- given[[condition$source]]
    if (is.null(value)) value <- if (is.null(condition$mildest)) condition$reference else condition$mildest
    if (condition$label && !as.character(value) %in% condition$levels) {
      stop_input("given: ", condition$source, " has no level '", value, "' (levels: ", words(condition$levels), ")")
    }
    all[[condition$name]] <- if (condition$label) as.character(value) else in_unit(value, condition$unit)
  }
  all
}

reference_notes <- function(conditions, location, parameters, by) {
  if (!length(conditions)) return(if (!is.null(by)) paste0(location, " of each ", by$source, "; lives of ", by$levels[1]))
  places <- function(key) words(vapply(conditions, function(each) {
    value <- if (is.null(each[[key]])) each$reference else each[[key]]
    paste(each$source, "=", if (each$label) value else trimws(paste(number_text(value), each$unit)))
  }, ""))
  given <- " (given = list(...) states other conditions of the lives)"
  if (places("reference") == places("mildest")) return(paste0(location, " and the lives are those at ", places("reference"), given))
  paste0(location, " is that at ", places("reference"), ", the lives are those at ", places("mildest"), given)
}

# The study's columns of stresses.
stress_columns <- function(effects, stress) vapply(names(stress), function(name) effects$conditions[[name]]$name, "", USE.NAMES = FALSE)

# ---- What all one-line models share.

# The options of ww_fit(); others are misspelt arguments.
require_options <- function(name, ..., own) {
  given <- names(list(...))
  known <- setdiff(names(formals(ww_fit)), c("study", "data", "units"))
  if (any(given == "") || (length(list(...)) && is.null(given))) stop_input(name, "(): arguments behind the second have names")
  unknown <- setdiff(given, known)
  if (!length(unknown)) return()
  all <- c(own, known)
  near <- all[order(utils::adist(unknown[1], all))[1]]
  stop_input(name, "() has no argument '", unknown[1], "'", if (utils::adist(unknown[1], near) <= 3) paste0("; did you mean '", near, "'?"),
             " (arguments: ", words(all), ")")
}

predict_of <- function(own, proposed) {
  if (!is.null(own) && (!is.list(own) || is.null(names(own)))) stop_input("predict is ", kind_of(own), "; it is a list with the keys of [predict]")
  # Another name of credible_level, whose default steps back.
  if ("level" %in% names(own) && identical(proposed$credible_level, 0.9)) proposed$credible_level <- NULL
  for (key in names(own)) proposed[[key]] <- own[[key]]
  proposed
}

# A prior of no knowledge of the parameter of a default: of its unit, above 0 where the default is.
flat_of <- function(default) {
  if (default$distribution == "uniform") return(default)
  size <- c(default$median, default$scale, default$mean)[[1]]
  unit <- if (is.character(size)) sub("^[^ ]+ ", "", size) else "1"
  ww_flat(unit, lower = if (default$distribution != "normal") if (unit == "1") 0 else paste("0", unit))
}

checked_priors <- function(own, known) {
  if (length(own) && (!is.list(own) || is.null(names(own)))) stop_input("priors is ", kind_of(own), "; it is a list like list(slope = ww_lognormal(2, log_sd = 0.5)), or \"flat\"")
  for (name in names(own)) {
    if (!is.list(own[[name]])) stop_input("priors: ", name, " is ", kind_of(own[[name]]), "; ww_lognormal(...) and its like make one")
    base <- sub("[[].*", "", name)
    if (!is.null(known) && !base %in% known) {
      now <- intersect(called_before[[base]], known)
      if (length(now)) stop_input("priors: '", name, "' is called '", now[1], "'")
      stop_input("priors: the model has no parameter '", name, "' (parameters: ", words(known), ")")
    }
  }
  own
}

# A study file of a formula model. `columns`: study_column() by name. The data frame has the same names.
study_text <- function(title, columns, constants, likelihood, priors, own_priors, random, predict, formula = NULL, modes = NULL, populations = NULL) {
  if (identical(own_priors, "flat")) own_priors <- lapply(priors, flat_of)
  own_priors <- checked_priors(own_priors, names(priors))
  proposed <- priors[setdiff(names(priors), names(own_priors))]
  data <- list(file = "data")
  if (length(random$labels) > 1) data$rows_of <- finest(random)
  parts <- c(toml_table("", list(title = title, model = "formula")), toml_table("data", data), columns_table(columns),
             if (length(constants)) toml_table("constants", constants), if (length(formula)) toml_table("formula", formula))
  if (length(modes)) parts <- c(parts, toml_table("failure_modes", modes))
  if (length(populations)) parts <- c(parts, toml_table("subpopulations", populations))
  for (measured in names(likelihood)) parts <- c(parts, toml_table(paste0("likelihood.", measured), likelihood[[measured]]))
  parts <- c(parts, toml_table("prior", c(proposed, own_priors), stats::setNames(rep("default", length(proposed)), names(proposed))))
  for (label in names(random$entries)) parts <- c(parts, toml_table(paste0("random_effects.", toml_key(label)), random$entries[[label]]))
  if (length(predict)) parts <- c(parts, toml_table("predict", predict))
  list(text = paste(parts, collapse = "\n"), proposed = names(proposed))
}

finest <- function(random) names(random$columns)[which.max(vapply(random$columns, function(each) length(unique(each$values)), 0L))]

# `entries`: what is said of single columns instead, by name.
columns_table <- function(columns, entries = list()) {
  toml_table("data.columns", Map(function(each, name) {
    if (!is.null(entries[[name]])) entries[[name]] else if (each$unit == "") name else list(column = name, unit = each$unit)
  }, columns, names(columns)))
}

# The fit of a study's text with a frame, or the study. `values`: by argument what the caller wrote, for messages; `arguments`: by key of
# the study, where the two have other names.
one_line <- function(text, columns, proposed, notes, fit, call, ..., tables = NULL, replicates = NULL, reader = NULL, values = list(),
                     arguments = character()) {
  if (is.null(tables)) {
    tables <- list(data = list(data = lapply(columns, `[[`, "values"), units = NULL, only = NULL))
  }
  refused <- function(error) {
    message <- in_words_of_caller(conditionMessage(error), values)
    for (key in names(arguments)) message <- sub(paste0("^", key, "(?=[.:])"), arguments[[key]], message, perl = TRUE)
    stop_input(with_headings(message, columns))
  }
  study <- tryCatch(new_study(text, "study", tables), wearwell_input_error = refused)
  study$proposed <- if (is.null(proposed)) character() else proposed
  study$notes <- notes
  study$replicates <- replicates
  study$reader <- reader
  if (!one_truth(fit, "fit")) {
    study$columns <- columns
    return(study)
  }
  found <- tryCatch(ww_fit(study, ...), wearwell_input_error = refused)
  with_call(found, call)
}

# Columns by their headings in the frame: the study calls them by what they are, as status or alternating_stress.
with_headings <- function(message, columns) {
  lacks <- regmatches(message, regexec("^column ([A-Za-z_]+): needs a unit: .* unit = \"([^\"]*)\" \\}", message))[[1]]
  if (length(lacks)) {
    heading <- columns[[lacks[2]]]$heading
    if (is.null(heading)) heading <- lacks[2]
    return(paste0("column '", heading, "' needs a unit: units = c(", heading, " = \"", lacks[3], "\"), or '", heading, " [", lacks[3], "]' as the heading in data"))
  }
  message <- sub("^column status: (?=[^:]*, row )", "", message, perl = TRUE)
  of_unit <- regmatches(message, regexec("^column ([A-Za-z_]+)[.]unit: (.*)$", message))[[1]]
  if (length(of_unit)) message <- paste0("column '", of_unit[2], "': ", of_unit[3])
  named <- gregexpr("(column '|rows, and ')[A-Za-z_]+'", message)
  regmatches(message, named) <- lapply(regmatches(message, named), function(found) {
    parts <- regmatches(found, regexec("^(.*')([A-Za-z_]+)'$", found))
    vapply(parts, function(part) paste0(part[2], if (is.null(columns[[part[3]]]$heading)) part[3] else columns[[part[3]]]$heading, "'"), "")
  })
  message
}

with_call <- function(fit, call) {
  if (!inherits(fit, "ww_fit")) return(fit)
  fields <- unclass(fit)
  fields$call <- call
  structure(fields, class = "ww_fit")
}

# Messages of the study file that the caller never wrote.
# `values`: by argument or key, what the caller wrote; it stands behind the name.
in_words_of_caller <- function(message, values = list()) {
  message <- words_of_caller(message)
  match <- regmatches(message, regexec("^([A-Za-z_]+)([.][A-Za-z_0-9]+)?: (entry ([0-9]+): )?", message))[[1]]
  value <- if (length(match)) values[[match[2]]]
  if (is.list(value) && match[3] != "") value <- value[[substring(match[3], 2)]]
  if (length(match) && match[5] != "" && length(value)) value <- value[[as.integer(match[5])]]
  if (length(value) != 1 || is.list(value)) return(message)
  rest <- substring(message, nchar(match[1]) + 1)
  paste0(match[2], ": ", if (!grepl(paste0("'", value), rest, fixed = TRUE)) paste0(shown_value(value), ": "), rest)
}

words_of_caller <- function(message) {
  message <- gsub("(^|\n)study(:[0-9]+)*: ", "\\1", message)
  message <- sub("\n +[^\n]* = [^\n]*\n *\\^ *(\n +right: [^\n]*)?$", "", message)
  message <- sub("\n +\\[[^]\n]*\\]\n *\\^ *$", "", message)
  message <- sub("^random_effects[.][^:]*: ", "", message)
  message <- sub("([0-9]) 1 must be ", "\\1 must be ", message)  # the unit of a plain number
  message <- sub("; or define your own word in the study: .*$", "; or make a column of truths of it, like data$failed <- data$end == \"broke\"", message)
  message <- sub("; write status = \\{ column = \"[^\"]*\", failure = 0 \\} or failure = 1, or use words", "; write words alone, or make a column of truths of it", message)
  message <- sub("state data.end = \"last failure\"", "state end = \"last failure\"", message, fixed = TRUE)
  message <- gsub("give the study a status column", "state the event, Surv(..., EVENT)", message, fixed = TRUE)
  message <- gsub("write \\[failure_modes\\] runout = (\"[^\"]*\")", "write mode = list(column = ..., runout = \\1)", message)
  message <- sub("^(data, column '[^']*' has no unit: name it '([^'\\[\\]]*) \\[([^'\\]]*)\\]')$", "\\1, or write units = c(\\2 = \"\\3\")", message, perl = TRUE)
  message <- sub("^([a-z]+)(, column '[^']*' has no unit: name it '([^'\\[\\]]*) \\[([^'\\]]*)\\]')$", "\\1\\2, or write units = list(\\1 = c(\\3 = \"\\4\"))", message, perl = TRUE)
  message <- gsub("must be a text in quotes", "must be a text", message, fixed = TRUE)
  message <- sub("^[0-9]+ keys are missing; with values of yours: ", "these are missing, here with values of an example: ", message)
  message <- gsub("\\b(lives_of|units) = \\[\"([^\"]*)\"\\]", "predict = list(\\1 = \"\\2\")", message, perl = TRUE)
  message <- gsub("\\b(lives_of|units) = \\[\\]", "predict = list(\\1 = list())", message, perl = TRUE)
  message <- gsub("\\bdata\\.missing_cycles = ", "missing_cycles = ", message, perl = TRUE)
  message <- gsub("\\bprior\\.([A-Za-z0-9_]+)", "priors: \\1", message, perl = TRUE)
  message <- gsub("^data[.]columns[.]", "column ", message)
  message <- sub("^(likelihood[.]life|constants)[.](threshold|share_[a-z_]+):", "\\2:", message)
  message <- sub("^law[.]mean_stress:", "correction:", message)
  message <- gsub("likelihood.depth_error", "depth_error", message, fixed = TRUE)
  message <- sub("^(law|likelihood)[.](curve|fatigue_limit|scatter|family|depth_error):", "\\2:", message)
  message <- sub("^predict[.]stress[.](.*)[.](alternating_stress|stress_ratio|mean_stress):", "at: '\\1': \\2:", message)
  message <- sub(", or name the column of failure modes: [data.returns] mode", "", message, fixed = TRUE)
  message <- gsub("data.returns.", "", message, fixed = TRUE)
  message <- sub("^subpopulations[.]names:", "subpopulations:", message)
  message <- gsub("needs predict\\.given\\.([A-Za-z0-9_]+)", "needs given = list(\\1 = ...)", message, perl = TRUE)
  message <- gsub("\\bpredict\\.given\\.", "given: ", message, perl = TRUE)
  message <- gsub("\\bpredict\\.next\\b", "ahead", message, perl = TRUE)
  message <- gsub("\\b(needs|and) predict\\.limit\\b", "\\1 limit", message, perl = TRUE)
  message <- gsub("\\b(needs|and) predict\\.([a-z_]+)", "\\1 predict = list(\\2 = ...)", message, perl = TRUE)
  message <- gsub("\\bpredict\\.([a-z_]+)", "\\1", message, perl = TRUE)
  gsub("\\bconditions\\.([a-z_]+)", "\\1", message, perl = TRUE)
}
