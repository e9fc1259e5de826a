# Data from the field in one line: units that are repaired, and warranty returns. And lives of two fits against each other.

ww_repairable <- function(data, age, unit, event = NULL, start = NULL, count = NULL, grouped = FALSE, process = c("power_law", "renewal", "phases"),
                          end = NULL, rounding = NULL, phase_ends = NULL, reference_age = NULL, mode = NULL, fixes = NULL, at = NULL, ahead = NULL,
                          units = NULL, priors = NULL, classical = FALSE, predict = NULL, unused = NULL, title = NULL, fit = TRUE, ...) {
  call <- preset_call(match.call(), "ww_repairable")
  require_options("ww_repairable", ..., own = names(formals(ww_repairable)))
  if (missing(process)) process <- process[1]
  kinds <- eval(formals(ww_repairable)$process)
  if (!is_path(process) || !process %in% kinds) stop_input("process is ", shown_value(process), "; it is one of ", words(kinds))
  if (one_truth(grouped, "grouped") && is.null(count)) stop_input("grouped needs count: the column of the number of failures since the row before")
  if (is.null(event) && !grouped) stop_input("event is missing: the column that says \"failure\" or \"end\"")
  columns <- frame_columns(data, units)
  study <- preset_study(columns, list(unit = unit, age = age, start = start, count = count, mode = mode))
  for (role in c("mode", "unit")) {
    if (!is.null(study[[role]])) study[[role]]$values <- label_texts(study[[role]]$values, paste0("data, column '", study[[role]]$heading, "'"))
  }
  if (!is.null(event) && !is.list(event)) event <- list(column = event)
  unknown <- setdiff(c(names(event), if (is.null(names(event))) ""), c("column", "failure", "end"))
  if (is.null(event)) unknown <- character()
  if (length(unknown) || (!is.null(event) && is.null(event$column))) {
    stop_input("event is ", shown_value(event), "; it is the name of a column, or like list(column = \"event\", failure = \"repaired\")")
  }
  if (!is.null(event)) study$event <- event_column(event, columns)
  look_at_unused(columns, c(age, unit, event$column, start, count, mode), TRUE, unused, "", counts = if (is.null(count)) "count = \"%s\"")
  text <- c(toml_table("", list(title = if (is.null(title)) paste("Failures along", age) else one_text(title, "title"), model = "repairable",
                                process = process)),
            toml_table("data", c(list(file = "data"), given_arguments(end = if (!is.null(end)) one_text(end, "end"),
                                                                      rounding = if (!is.null(rounding)) quantity(rounding, "rounding"),
                                                                      grouped = if (grouped) TRUE))),
            columns_table(study, list(event = if (length(event) > 1) c(list(column = "event"), lapply(event[setdiff(names(event), "column")], as.character)))))
  constants <- given_arguments(reference_age = if (!is.null(reference_age)) quantity(reference_age, "reference_age"),
                               phase_ends = if (!is.null(phase_ends)) as.list(phase_ends))
  if (length(constants)) text <- c(text, toml_table("conditions", constants))
  text <- c(text, fix_tables(mode, fixes))
  if (length(priors)) text <- c(text, toml_table("prior", checked_priors(priors, NULL)))
  asked <- predict_of(predict, given_arguments(age = if (!is.null(at)) as.list(at), `next` = if (!is.null(ahead)) as.list(ahead),
                                               classical = if (one_truth(classical, "classical")) TRUE))
  if (length(asked)) text <- c(text, toml_table("predict", asked))
  one_line(paste(text, collapse = "\n"), study, NULL, NULL, fit, call, ...)
}

# The tables [fixes] and [fixes.effectiveness] of a list by mode.
fix_tables <- function(mode, fixes) {
  if (is.null(mode) && is.null(fixes)) return(NULL)
  if (is.null(mode) || is.null(fixes)) {
    stop_input("mode needs fixes, and fixes needs mode: the column of the failure modes, and the fix of each")
  }
  fixes <- as.list(fixes)
  if (!length(fixes) || is.null(names(fixes)) || any(names(fixes) == "") || anyDuplicated(names(fixes))) {
    stop_input("fixes is ", shown_value(fixes), "; it is a list by mode, each once, like list(A = \"none\", BC1 = \"during\", BD1 = 0.7)")
  }
  kind <- vapply(names(fixes), function(each) {
    fix <- fixes[[each]]
    if (is.list(fix) || (is.numeric(fix) && length(fix) == 1)) return("after")
    if (is_path(fix) && fix %in% c("none", "during")) return(fix)
    stop_input("fixes: ", each, " is ", shown_value(fix), "; it is \"none\", \"during\", or the share of the failure intensity that the fix removes, ",
               "a number from 0 to 1 or a distribution")
  }, "")
  modes <- function(of) if (any(kind == of)) as.list(names(fixes)[kind == of])
  c(toml_table("fixes", given_arguments(none = modes("none"), during = modes("during"))),
    if (any(kind == "after")) toml_table("fixes.effectiveness", fixes[kind == "after"]))
}

# Labels as texts: numbers without a point.
label_texts <- function(values, where) {
  values <- column_values(values, where)
  if (is.double(values)) ifelse(is.na(values), NA, number_text(values)) else values
}

# A column of failures and ends of observation: truths and 0 and 1 by failures_of(), words as they are.
event_column <- function(event, columns) {
  each <- find_column(columns, one_text(event$column, "event"), "event")
  if (length(event) > 1) {
    values <- column_values(each$values, paste0("data, column '", each$heading, "'"))
    return(list(heading = "event", values = if (is.double(values)) number_text(values) else values, unit = ""))
  }
  failures <- tryCatch(failures_of(each, "event"), wearwell_input_error = function(error) {
    stop_input(gsub("Surv[(]..., ([^)]*)[)]", paste0("data$failed <- data$\\1, event = \"failed\""), conditionMessage(error)))
  })
  found <- study_column(if (is.logical(failures)) ifelse(failures, "failure", "end") else failures, "")
  found$heading <- "event"
  found
}

# Months and days as texts.
with_text_dates <- function(data) {
  if (!is.data.frame(data)) return(data)
  data[] <- lapply(data, function(column) if (inherits(column, c("Date", "POSIXt"))) format(column, "%Y-%m-%d") else column)
  data
}

# How many months a table of single units covers.
months_of <- function(data, headings, until) {
  texts <- unique(c(unlist(lapply(headings, function(each) as.character(data[[each]]))), until))
  texts <- texts[!is.na(texts) & texts != ""]
  read <- function(text) {
    for (form in c("%Y-%m-%d", "%d.%m.%Y")) if (!is.na(day <- as.Date(text, form))) return(as.double(day))
    for (form in c("%Y-%m-%d", "%d/%m/%Y", "%d %b %Y")) {
      if (!is.na(day <- as.Date(if (form == "%Y-%m-%d") paste0(text, "-01") else paste0("01", if (form == "%d/%m/%Y") "/" else " ", text), form))) {
        return(as.double(day))
      }
    }
    NA
  }
  days <- vapply(texts, read, 0)
  if (all(is.na(days))) {
    stop_input("priors: no default can be proposed, since the dates of sale are of a form that is not known here; state priors = list(...), ",
               "or write the dates as 2024-01-31")
  }
  max(1, diff(range(days, na.rm = TRUE)) / 30.4)
}

# A fixed time, a distribution, or a table of delays and shares; `tables` takes the table.
delay_of <- function(value, name) {
  if (is.null(value)) return(NULL)
  if (is.data.frame(value)) {
    if (length(value) != 2) {
      stop_input(name, ": the table has ", length(value), " columns; it has two, delays with their unit and the shares of units that have them")
    }
    return(list(file = name, delay = names(value)[1], share = names(value)[2]))
  }
  if (is.list(value)) value else quantity(value, name)
}

ww_returns <- function(data, sold = NULL, quantity = NULL, returned = NULL, until = NULL, period = NULL, ages = "middle", warranty = NULL,
                       delay_to_use = NULL, delay_of_report = NULL, hold_out = NULL, family = "weibull", ahead = "12 month", cost_per_return = NULL,
                       planned_sales = NULL, survival_to = NULL, priors = NULL, b = c(1, 10, 50), predict = NULL, title = NULL, fit = TRUE, ...) {
  call <- preset_call(match.call(), "ww_returns")
  require_options("ww_returns", ..., own = names(formals(ww_returns)))
  families <- setdiff(names(life_families), "log-location-scale")  # each under its own name, without a further argument
  if (!is_path(family) || !family %in% families) stop_input("family is ", shown_value(family), "; it is one of ", words(families))
  refuse_path(data, "data")
  require_columns(data, "data")
  if (!length(data)) stop_input("data has no columns")
  data <- with_text_dates(as.data.frame(data, check.names = FALSE, stringsAsFactors = FALSE))
  for (name in c("sold", "quantity", "returned")) {
    heading <- get(name)
    if (is.null(heading)) next
    if (!one_text(heading, name) %in% names(data)) no_column(name, "data", heading, names(data))
    column_values(data[[heading]], paste0("data, column '", heading, "'"))
  }
  if (!is.null(returned) && is.null(sold)) stop_input("sold is missing: the column of the date of sale of each unit")
  time <- function(value, name) if (!is.null(value)) quantity(value, name)
  columns <- given_arguments(sold = sold, quantity = quantity, returned = returned, until = until, period = period, ages = one_text(ages, "ages"),
                             delay_to_use = delay_of(delay_to_use, "delay_to_use"), delay_of_report = delay_of(delay_of_report, "delay_of_report"),
                             warranty = time(warranty, "warranty"), hold_out = time(hold_out, "hold_out"))
  parameters <- parameters_of_family(family)
  length <- if (is.null(returned) || !is.null(priors[[parameters[1]]])) max(1, ncol(data) - 2) else months_of(data, c(sold, returned), until)
  unit <- if (is.null(period)) "month" else period
  proposed <- life_priors(family, 10 * length, unit)
  if (family == "weibull") proposed$slope <- ww_lognormal(1.2, log_sd = 0.5)
  own <- checked_priors(priors, parameters)
  shown <- proposed[setdiff(names(proposed), names(own))]
  proposed[names(own)] <- own
  asked <- predict_of(predict, given_arguments(`next` = ahead, cost_per_return = cost_per_return, b_lives = as.list(b),
                                               survival_to = if (!is.null(survival_to)) as.list(survival_to),
                                               planned_sales = if (!is.null(planned_sales)) list(file = "planned_sales")))
  frames <- c(list(data = data), Filter(is.data.frame, list(delay_to_use = delay_to_use, delay_of_report = delay_of_report)),
              if (!is.null(planned_sales)) list(planned_sales = with_text_dates(planned_sales)))
  tables <- lapply(frames, function(frame) list(data = frame, units = NULL, only = NULL))
  text <- c(toml_table("", list(title = if (is.null(title)) "Warranty returns" else one_text(title, "title"), model = "formula")), toml_table("data", list(file = "data")),
            toml_table("data.returns", columns),
            toml_table("likelihood.life", life_slots(family, parameters[1])),
            toml_table("prior", proposed), toml_table("predict", asked))
  one_line(paste(text, collapse = "\n"), NULL, shown, NULL, fit, call, ..., tables = tables, arguments = c(b_lives = "b"))
}

ww_against <- function(fit, other, horizon = NULL, confidence = 0.9, at = NULL) {
  about <- fit_or_folder(fit)
  if (!inherits(other, "ww_fit") && !is_path(other)) stop_input("other is ", kind_of(other), "; it is a fit, or the folder of a result")
  against <- fit_or_folder(other)
  found <- answer_of("against", "against", list(other = if (nzchar(against$path)) against$path, at = at, horizon = horizon, confidence = confidence),
                     run = about$run, other = against$run, path = about$path)
  if (!found$trusted) warn("a fit that this rests on is not trusted: see its checks")
  keys <- c("at_least", "q05", "q50", "q95", "mean", "better")
  rows <- c(found$summary$ratios, list(found$summary$outlives), if (!is.null(found$summary$survival_difference)) list(found$summary$survival_difference))
  differences <- numbers_of(rows, keys)
  differences[] <- lapply(differences, endless)
  rownames(differences) <- c(sprintf("B%g ratio", column(found$summary$ratios, "percent")), "outlives",
                             if (!is.null(found$summary$survival_difference)) "survival difference")
  found$differences <- differences
  structure(class = c("ww_against", "ww_answer"), found)
}
