# Lives as R writes them: Surv(time, event) and its kind, read from the call, so that the package survival need not be there;
# objects that survival made are read too.

# What headings say: of a failure, or of a test that was stopped.
of_events <- "event|fail|broke|dead|death|died|ausfall|bruch|defekt"
of_censoring <- "cens|runout|run[._ -]*out|suspen|surviv|zensier|durchlauf"
of_endings <- paste0(of_events, "|", of_censoring, "|^status$|^delta$|^ended$")

says_failure <- function(heading) grepl(of_events, heading, ignore.case = TRUE)
says_stopped <- function(heading) grepl(of_censoring, heading, ignore.case = TRUE)

surv_types <- c("right", "left", "interval", "counting", "interval2")

refuse_path <- function(data, name) {
  if (is_path(data)) stop_input(name, " is \"", data, "\"; it is a data frame or a named list of columns (read.csv() reads a file)")
}

# The columns of a frame by the names that a formula may use: the heading, or, of "F [N]", F. Each is a list of values, heading, unit.
frame_columns <- function(data, units, name = "data") {
  refuse_path(data, name)
  require_columns(data, name)
  if (!length(data)) stop_input(name, " has no columns")
  units <- unit_texts(units, "units")
  headings <- names(data)
  parts <- regmatches(headings, regexec("^\\s*(.*[^ ])\\s*[[(]([^])]*)[])]\\s*$", headings))
  has_unit <- lengths(parts) > 0
  short <- headings
  short[has_unit] <- vapply(parts[has_unit], `[`, "", 2)
  twice <- short[duplicated(short)]
  if (length(twice)) stop_input(name, ": two columns are called '", twice[1], "'")
  unknown <- setdiff(names(units), c(headings, short))
  if (length(unknown)) no_column("units", name, unknown[1], headings)
  columns <- lapply(seq_along(headings), function(i) {
    values <- .subset2(data, i)
    unit <- if (has_unit[i]) parts[[i]][3] else ""
    given <- units[names(units) %in% c(headings[i], short[i])]
    if (length(given)) unit <- given[[1]] else if (inherits(values, "units")) unit <- units_of(values)
    list(values = values, heading = headings[i], unit = if (unit == "1") "" else unit, of = name)
  })
  stats::setNames(columns, short)
}

# What messages call a column, and the table of several: the caller's argument.
place_of <- function(each) paste0(if (is.null(each$of)) "data" else each$of, ", column '", each$heading, "'")
place_of_row <- function(each, row) paste0(if (is.null(each$of)) "data" else each$of, ", row ", row, ", column '", each$heading, "'")
table_name <- function(columns) if (length(columns)) columns[[1]]$of else "data"

# The frame of a formula without data: its variables where it was written.
data_of_formula <- function(formula) {
  names <- setdiff(all.vars(formula), ".")
  found <- lapply(stats::setNames(names, names), function(name) get0(name, envir = environment(formula)))
  missing <- names[vapply(found, is.null, NA)]
  if (length(missing)) stop_input("data is missing, and there is no variable '", missing[1], "' where the formula was written")
  as.data.frame(found, check.names = FALSE, stringsAsFactors = FALSE)
}

find_column <- function(columns, name, what) {
  if (name %in% names(columns)) return(columns[[name]])
  by_heading <- vapply(columns, function(each) each$heading == name, NA)
  if (any(by_heading)) return(columns[[which(by_heading)[1]]])
  no_column(what, table_name(columns), name, names(columns))
}

no_column <- function(what, table, name, names) {
  stop_input(what, ": ", table, " has no column '", name, "' (columns: ", words(names), ")", did_you_mean(name, names))
}

did_you_mean <- function(name, names) {
  near <- names[order(utils::adist(name, names, ignore.case = TRUE))[1]]
  if (length(near) && !is.na(near) && utils::adist(name, near, ignore.case = TRUE) <= 2) paste0("; did you mean '", near, "'?")
}

plain_values <- function(each) if (inherits(each$values, "units")) as.double(each$values) else each$values

# An expression of columns, evaluated: its values, and unit and heading if it is one column.
evaluated <- function(expression, columns, env, what) {
  if (is.symbol(expression)) {
    found <- find_column(columns, as.character(expression), what)
    return(list(values = plain_values(found), unit = found$unit, heading = found$heading, name = as.character(expression), of = found$of))
  }
  for (name in all.vars(expression)) find_column(columns, name, what)
  values <- tryCatch(eval(expression, lapply(columns, plain_values), env), error = function(error) {
    stop_input(what, ": ", shown_value(expression), ": ", conditionMessage(error))
  })
  # A sum or a difference has the unit of its columns; of others nothing is known.
  in_units <- unique(vapply(all.vars(expression), function(name) find_column(columns, name, what)$unit, ""))
  linear <- length(in_units) == 1 && all(setdiff(all.names(expression), all.vars(expression)) %in% c("+", "-", "("))
  list(values = values, unit = if (linear) in_units else "", heading = paste(deparse(expression), collapse = " "), name = "life", of = table_name(columns))
}

numbers_for <- function(each, what) {
  values <- column_values(each$values, place_of(each))
  require_no_truths(each, what)
  if (!is.double(values)) stop_input(what, ": column '", each$heading, "' holds texts; it is a number")
  values
}

# A column of NA alone is logical in R, and of no truths.
require_no_truths <- function(each, what) {
  if (is.logical(each$values) && !all(is.na(each$values))) {
    stop_input(what, ": column '", each$heading, "' holds TRUE and FALSE; it is a number in each row (as.double() makes 1 and 0)")
  }
}

# TRUE: failure. `codes`: the column's own.
failures_of <- function(each, what) {
  values <- each$values
  if (inherits(values, "AsIs")) oldClass(values) <- setdiff(oldClass(values), "AsIs")
  heading <- each$heading
  if (length(dim(values)) > 1 || is.character(values)) column_values(values, place_of(each))
  if (is.factor(values)) values <- as.character(values)
  if (is.character(values)) {
    empty <- which(is.na(values) | grepl("^[ \t]*$", values, useBytes = TRUE))
    if (length(empty)) stop_input(place_of_row(each, empty[1]), ": no value; state how this test ended")
    if (!all(are_codes(values))) return(values)
    values <- codes_of(values)
  }
  if (is.numeric(values) && !is.object(values) || is.logical(values)) {
    if (anyNA(values)) stop_input(place_of_row(each, which(is.na(values))[1]), ": a value is missing; ", what, " needs one")
    if (says_stopped(heading) && !says_failure(heading) && is_name(heading)) {
      stop_input(what, ": column '", heading, "' can be read in two ways: ", heading, " = 1 is a part that was stopped unbroken (as its ",
                 "name says), or a failure (as Surv() reads it): write Surv(..., ", heading, " == 0) for the first, Surv(..., ",
                 heading, " == 1) for the second")
    }
    kinds <- sort(unique(as.double(values)))
    if (all(kinds %in% c(0, 1))) return(values == 1)
    if (all(kinds %in% c(1, 2))) {
      stop_input(what, ": column '", heading, "' holds ", words(kinds), ", which can be read in two ways: 2 is a failure and 1 was stopped ",
                 "(as survival reads it), or 1 is a failure and 2 was stopped: write Surv(..., ", heading, " == 2) for the first, ",
                 "Surv(..., ", heading, " == 1) for the second")
    }
    stop_input(what, ": column '", heading, "' holds ", words(utils::head(kinds, 6)), if (length(kinds) > 6) ", ...",
               "; an event is TRUE or 1 of a failure and FALSE or 0 of a part that was stopped; write a condition, like Surv(..., ",
               heading, " == ", kinds[1], "), or, where the numbers are failure modes, mode = list(column = \"", heading, "\", runout = 0) without an event")
  }
  column_values(values, place_of(each))
  stop_input(what, ": column '", heading, "' is ", kind_of(values), "; it holds truths, 0 and 1, or words")
}

# Texts and levels of factors that are codes: 0 and 1, true and false.
are_codes <- function(texts) grepl("^[ \t]*([+-]?[0-9]+([.][0-9]*)?|true|false)[ \t]*$", texts, ignore.case = TRUE, useBytes = TRUE)
codes_of <- function(texts) {
  texts <- tolower(trimws(texts))
  as.double(ifelse(texts == "true", "1", ifelse(texts == "false", "0", texts)))
}

is_name <- function(text) grepl("^[A-Za-z.][A-Za-z0-9._]*$", text)

ended <- function(failures, otherwise) if (is.character(failures)) failures else ifelse(failures, "failure", otherwise)

is_surv_call <- function(side) {
  is.call(side) && (identical(side[[1]], quote(Surv)) || identical(side[[1]], quote(survival::Surv)))
}

# A column of the study: values, unit, and the heading that messages name where the frame has another.
study_column <- function(values, unit, heading = NULL) list(values = values, unit = unit, heading = heading)

# `ending`: the event of a Surv(), `otherwise`: what its FALSE means.
ending_column <- function(ending, otherwise) study_column(ended(failures_of(ending, "Surv()"), otherwise), "", ending$heading)

# The lives of a formula's left side: the columns that the study has of them, by the names that the library gives them, the name of the
# life, the columns of data that they use, and whether endings are stated.
lives_of_side <- function(side, columns, env) {
  if (is_surv_call(side)) return(lives_of_call(side, columns, env))
  found <- evaluated(side, columns, env, "the formula's left side")
  if (inherits(found$values, "Surv")) return(lives_of_surv(found$values, found$unit, all.vars(side)))
  lives <- numbers_for(found, "the formula's left side")
  new_lives(list(life = study_column(lives, found$unit, found$heading)), found, all.vars(side), known = FALSE)
}

new_lives <- function(columns, found, used, known = TRUE) {
  list(columns = columns, name = found$name, unit = found$unit, used = used, known = known)
}

lives_of_call <- function(side, columns, env) {
  shape <- function(time, time2, event, type, origin) NULL
  call <- tryCatch(match.call(shape, side), error = function(error) stop_input(shown_value(side), ": ", conditionMessage(error)))
  if (is.null(call$time)) stop_input("Surv() has no time")
  if (!is.null(call$origin)) stop_input("Surv(origin = ...) is not read: subtract it from the times in the data")
  type <- if (is.null(call$type)) NULL else eval(call$type, env)
  if (!is.null(type) && !(is_path(type) && type %in% surv_types)) {
    stop_input("Surv(): type is ", shown_value(type), "; it is one of ", words(surv_types), if (identical(type, "mstate"))
      " (failure modes: Surv(time, event) with mode = \"column of the modes\")")
  }
  # As survival has it: of two unnamed arguments the second is the event, of three the first two are times.
  if (is.null(type)) type <- if (!is.null(call$time2) && !is.null(call$event)) "counting" else "right"
  if (type %in% c("right", "left") && is.null(call$event)) {
    call$event <- call$time2
    call$time2 <- NULL
  }
  used <- all.vars(side)
  time <- evaluated(call$time, columns, env, "Surv()")
  times <- numbers_for(time, "Surv()")
  second <- if (!is.null(call$time2)) evaluated(call$time2, columns, env, "Surv()")
  needs <- function(is, what) if (!is) stop_input("Surv(type = \"", type, "\") needs ", what)
  event <- function() {
    found <- evaluated(call$event, columns, env, "Surv()")
    if (length(found$values) != length(times)) stop_input("Surv(): the event has ", length(found$values), " values, the time ", length(times))
    found
  }
  if (type %in% c("right", "left")) {
    needs(is.null(second), "a time and an event; two times are of type counting, interval or interval2")
    life <- list(life = study_column(times, time$unit, time$heading))
    if (is.null(call$event)) return(new_lives(life, time, used, known = FALSE))
    life$status <- ending_column(event(), if (type == "right") "runout" else "left")
    return(new_lives(life, time, used))
  }
  needs(!is.null(second), "two times")
  to <- numbers_for(second, "Surv()")
  if (time$unit == "") time$unit <- second$unit
  if (second$unit == "") second$unit <- time$unit
  if (type == "counting") {
    needs(!is.null(call$event), "a start, a stop and an event")
    late <- which(to <= times)
    if (length(late)) stop_input("Surv(): row ", late[1], " stops at ", to[late[1]], ", not after its start, ", times[late[1]])
    return(new_lives(list(life = study_column(to, second$unit, second$heading), entry = study_column(times, time$unit, time$heading),
                          status = ending_column(event(), "runout")), second, used))
  }
  if (type == "interval") {
    needs(!is.null(call$event), "an event: 0 stopped, 1 failure, 2 failed before, 3 failed between")
    codes <- event()
    if (!is.numeric(codes$values) || anyNA(codes$values) || !all(codes$values %in% 0:3)) {
      stop_input("Surv(): column '", codes$heading, "' holds other than the codes of an interval: 0 stopped, 1 failure, 2 failed before, ",
                 "3 failed between the two times")
    }
    return(between_ends(times, to, codes$values, time, second$unit, used))
  }
  if (!is.null(call$event)) stop_input("Surv(type = \"interval2\") has no event: two times, NA of an open end")
  times[is.infinite(times)] <- NA
  to[is.infinite(to)] <- NA
  bounds_of(times, to, time, second$unit, used)
}

# The codes of Surv(type = "interval").
between_ends <- function(times, to, codes, time, unit, used) {
  bounds_of(ifelse(codes == 2, NA, times), ifelse(codes == 0, NA, ifelse(codes == 3, to, times)), time, unit, used)
}

bounds_of <- function(lower, upper, time, unit, used) {
  row <- which(is.na(lower) & is.na(upper))
  if (length(row)) stop_input("Surv(): row ", row[1], " has neither a lower nor an upper time")
  row <- which(lower > upper)
  if (length(row)) stop_input("Surv(): row ", row[1], " ends at ", upper[row[1]], ", before its start, ", lower[row[1]])
  time$name <- "life"
  new_lives(list(lower = study_column(lower, time$unit), upper = study_column(upper, unit)), time, used)
}

# What survival made.
lives_of_surv <- function(surv, unit, used) {
  type <- attr(surv, "type")
  m <- unclass(surv)
  found <- list(name = "life", unit = unit)
  if (anyNA(m[, "status"])) stop_input("Surv: row ", which(is.na(m[, "status"]))[1], ": a value is missing")
  if (type %in% c("right", "left")) {
    return(new_lives(list(life = study_column(as.double(m[, "time"]), unit),
                          status = study_column(ended(m[, "status"] == 1, if (type == "right") "runout" else "left"), "")), found, used))
  }
  if (type == "counting") {
    return(new_lives(list(life = study_column(as.double(m[, "stop"]), unit), entry = study_column(as.double(m[, "start"]), unit),
                          status = study_column(ended(m[, "status"] == 1, "runout"), "")), found, used))
  }
  if (type == "interval") return(between_ends(as.double(m[, "time1"]), as.double(m[, "time2"]), m[, "status"], found, unit, used))
  stop_input("Surv of type ", type, " is not read; it is one of ", words(surv_types), " (failure modes: mode = \"column of the modes\")")
}

# Long words alone: a short one, such as S, can be a mode.
of_runouts <- "^(runout|run-out|suspended|suspension|censored|running|survived)$"

# Failure modes with a word for what did not fail.
looks_like_modes <- function(each) {
  values <- if (is.factor(each$values)) as.character(each$values) else each$values
  is.character(values) && any(grepl(of_runouts, values, ignore.case = TRUE)) && length(unique(values)) <= 6
}

# ---- Unused columns that look like endings, weights or units.

looks_like_ending <- function(each) {
  values <- each$values
  if (is.factor(values)) values <- as.character(values)
  named <- grepl(of_endings, each$heading, ignore.case = TRUE)
  if (is.logical(values)) return(TRUE)
  if (is.numeric(values) && !is.object(values)) return(named && length(unique(values)) <= 4)
  word <- "^(failure|failed|fail|f|broken|runout|run-out|right|s|suspended|suspension|censored|running|survived|dead|alive)$"
  is.character(values) && (named && length(unique(values)) <= 6 || all(grepl(word, values[!is.na(values)], ignore.case = TRUE)) && !all(is.na(values)))
}

# The words of both are those of the Python package (python/wearwell/_impl/idle_columns.py).
of_counts <- "^(counts?|weights?|n|quantity|qty|freq|frequency|number)$"
of_units <- "^(units?|machines?|serial|id|(unit|machine|serial)[ ._-]?(id|no|nr|number))$"

# The heading without its unit.
bare_heading <- function(each) trimws(sub("[[(][^])]*[])]\\s*$", "", each$heading))

# Whole positive numbers, neither all 1, which changes nothing, nor those of the rows: 1, 2, 3, ...
looks_like_counts <- function(each) {
  values <- each$values
  grepl(of_counts, each$heading, ignore.case = TRUE) && each$unit == "" && is.numeric(values) && !is.object(values) && length(values) > 0 &&
    all(is.finite(values)) && all(values > 0 & values == round(values)) && any(values != 1) && !isTRUE(all(values == seq_along(values)))
}

# Several labels, one of which stands in several rows.
looks_like_units <- function(each, noun = NULL) {
  values <- if (is.factor(each$values)) as.character(each$values) else each$values
  called <- c(of_units, if (!is.null(noun)) paste0("^", noun, "s?([ ._-]?(id|no|nr|number))?$"))
  if (!any(vapply(called, grepl, NA, bare_heading(each), ignore.case = TRUE)) || !is.atomic(values)) return(FALSE)
  values <- values[!is.na(values) & values != ""]
  length(unique(values)) > 1 && anyDuplicated(values) > 0
}

# `counts` and `units`: what to write for a column of them, such as "weights = \"%s\""; none where the model has no such argument, or has
# one in use. `noun`: what units are called here, such as "bearing"; `count_as`: what rows are without their units.
look_at_unused <- function(columns, used, known, unused, call, counts = NULL, units = NULL, noun = NULL, count_as = "independent") {
  unknown <- setdiff(unused, c(names(columns), vapply(columns, `[[`, "", "heading")))
  if (length(unknown)) stop_input("unused: ", table_name(columns), " has no column '", unknown[1], "' (columns: ", words(names(columns)), ")")
  left <- columns[!names(columns) %in% c(used, unused)]
  left <- left[!vapply(left, function(each) each$heading %in% c(used, unused), NA)]
  ends <- names(left)[vapply(left, function(each) looks_like_ending(each) || looks_like_modes(each), NA)]
  if (length(ends) && !known) {
    stop_input("column '", ends[1], "' looks like how each life ended, and the formula does not use it, so that all lives would be ",
               "failures: write ", call, ", ", if (looks_like_modes(left[[ends[1]]]) && grepl("^Surv", call)) paste0("or mode = \"", ends[1], "\" of failure modes, "),
               "or unused = \"", ends[1], "\" if it says something else")
  }
  for (name in ends) warn_of_column(name, "looks like how a life ended")
  if (!is.null(counts)) {
    for (name in names(left)[vapply(left, looks_like_counts, NA)]) warn_of_column(name, "looks like a number of equal rows", counts)
  }
  if (!is.null(units)) {
    for (name in names(left)[vapply(left, looks_like_units, NA, noun = noun)]) {
      warn_of_column(name, "looks like a label of units with several rows each", units, paste0(", so all rows count as ", count_as))
    }
  }
}

# `cure`: what to write, with %s for the name.
warn_of_column <- function(name, why, cure = NULL, so = "") {
  otherwise <- if (is.null(cure)) paste0("; unused = \"", name, "\" confirms that") else
    paste0(so, ": write ", gsub("%s", name, cure, fixed = TRUE), ", or unused = \"", name, "\" if ", if (so == "") "it says something else" else "that is so")
  warning(condition(paste0("column '", name, "' ", why, " and is not used", otherwise), "wearwell_column_warning", "warning"))
}
