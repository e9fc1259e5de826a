# New rows for a fit, single units followed by their readings, forecasts against known ends, code.

# Tables or paths: one of them, or a list without names.
several_rows <- function(data, name, fit = NULL) {
  several <- if (is.list(data) && !is.data.frame(data) && is.null(names(data))) data else list(data)
  lapply(several, function(each) if (is_path(each)) path_of(each, name) else rows_for(fit, each, name))
}

# New rows as the formula of ww_life() reads them, with the columns of the fit's study and their units; others by the
# names of these columns. `name`: the argument that holds them.
rows_for <- function(fit, data, name) {
  reader <- if (inherits(fit, "ww_fit")) fit$study$reader
  if (is.null(reader) || !is.data.frame(data) || !read_by_formula(reader, data, name)) return(table_of(data, name))
  if (!nrow(data)) stop_input(name, " has no rows")
  known <- names(reader$units) %in% c(names(data), names(frame_columns(data, NULL, name)))
  columns <- read_lives(reader, frame_columns(data, reader$units[known], name), fitted = TRUE)$columns
  table_of(lapply(columns, `[[`, "values"), name, Filter(nzchar, vapply(columns, `[[`, "", "unit")))
}

# Whether rows have the columns that the formula reads, and not those that it made for the study.
read_by_formula <- function(reader, data, name) {
  there <- c(names(data), names(frame_columns(data, NULL, name)))
  by_formula <- all(reader$used %in% there)
  by_name <- all(reader$made %in% there)
  others <- setdiff(reader$made, reader$used)
  if (by_formula && by_name && length(others)) {
    stop_input(name, " can be read in two ways: by the formula of the fit, with the columns ", words(reader$used), ", or as the columns of its study, ",
               words(reader$made), "; leave out ", words(others), ", or ", words(setdiff(reader$used, reader$made)))
  }
  by_formula || !any(c("life", "lower", "upper") %in% there)
}

ww_update <- function(fit, data, repeated = NULL, threads = 0, report = TRUE, progress = interactive()) {
  if (!is.null(repeated) && !(is_path(repeated) && repeated %in% c("once", "another"))) {
    stop_input("repeated is ", shown_value(repeated), "; it is 'once' or 'another'")
  }
  threads <- whole(threads, "threads", 0, 1024)
  report <- one_truth(report, "report")
  rows <- several_rows(data, "data", fit)
  about <- fit_or_folder(fit)
  run <- with_progress(progress, function(report_progress) {
    core(C_update, about$run, about$path, rows, if (is.null(repeated)) "" else repeated, threads, report, report_progress)
  })
  study <- study_of_state(core(C_state, run), if (inherits(fit, "ww_fit")) fit$study$shown else about$path)
  if (inherits(fit, "ww_fit")) study$reader <- fit$study$reader
  used <- core(C_summary, run)$sampler
  choice <- list(method = used$method, chains = whole(used$chains, "chains", 1, 1000),
                 warmup = if (!identical(used$method, "exact")) whole(used$warmup, "warmup", 0, 1e9),
                 draws = whole(used$draws, "draws", 1, 1e9), seed = if (is.null(used)) "" else seed_text(used$seed))
  with_call(fit_of(study, run, choice, report), match.call())
}

# A study kept as the state that its fit saves, in hexadecimal digits.
study_of_state <- function(state, shown) {
  study <- structure(class = "ww_study", list(text = "", path = shown, shown = shown, given = list(), state = state, live = living(NULL)))
  study$text <- core(C_study_text, study_address(study))
  study
}

ww_track <- function(fit, unit = NULL, new = FALSE) {
  new <- one_truth(new, "new")
  if (!is.null(unit)) unit <- one_text(unit, "unit")
  population <- population_of(fit)
  followed <- core(C_followed_unit, population, if (is.null(unit)) "" else unit, new)
  tracker <- new.env(parent = emptyenv())
  tracker$followed <- followed
  tracker$outcomes <- list()
  structure(class = "ww_tracker", list(state = tracker))
}

population_of <- function(fit) {
  about <- fit_or_folder(fit)
  population <- core(C_population_of, about$run, about$path)
  warn_unless(core(C_is_trusted, population))
  population
}

warn_unless <- function(trusted) if (!trusted) warn("the fit that this rests on is not trusted: see its checks")

state_of_tracker <- function(tracker) {
  state <- .subset2(tracker, "state")
  if (!core(C_is_there, state$followed)) stop_input("this tracker was kept beyond its session; track the unit again and give it its readings")
  state
}

update.ww_tracker <- function(object, rows, ...) {
  state <- state_of_tracker(object)
  outcomes <- core(C_take_readings, state$followed, table_of(rows, "rows"))
  found <- core(C_forecast, state$followed)
  for (row in seq_along(outcomes)) {
    each <- outcomes[[row]]
    if (!each$counted && !each$repeated) {
      warn(paste0("row ", row, " does not count: ", each$problem))
    } else if (each$contradicts) {
      warn(paste0("row ", row, " contradicts the earlier readings of ", found$noun, " '", found$unit, "' (predictive p-value ",
                  signif(each$p_value, 1), "); it counts"))
    }
  }
  state$outcomes <- c(state$outcomes, outcomes)
  invisible(object)
}

forecast_of <- function(tracker) core(C_forecast, state_of_tracker(tracker)$followed)

quantiles_of <- function(found, key, infinite) {
  values <- if (!found$known) rep(NA_real_, 3) else vapply(found[[key]], function(q) if (is.na(q)) infinite else q, 0)
  stats::setNames(values, c("q05", "q50", "q95"))
}

`$.ww_tracker` <- function(x, name) {
  known <- c("unit", "is_new", "rul", "level", "passed", "rate_change", "doubt", "summary", "outcomes", "path")
  if (!name %in% known) stop_input("a tracker has no '", name, "' (it has: ", words(known), ")")
  if (name == "outcomes") return(outcomes_frame(state_of_tracker(x)$outcomes))
  found <- forecast_of(x)
  switch(name,
    unit = found$unit,
    is_new = found$new,
    rul = structure(quantiles_of(found, "remaining", Inf), unit = found$axis_unit),
    level = structure(quantiles_of(found, "level", NA_real_), unit = found$level_unit),
    passed = if (is.na(found$passed)) NaN else found$passed,
    rate_change = if (is.list(found$rate_change)) found$rate_change else NULL,
    doubt = if (is.na(found$doubt)) NULL else found$doubt,
    summary = found,
    path = {
      path <- core(C_forecast_path, state_of_tracker(x)$followed)
      frame <- data.frame(path)
      names(frame)[1] <- found$axis
      structure(frame, unit = found$level_unit, axis_unit = found$axis_unit)
    })
}

names.ww_tracker <- function(x) c("unit", "is_new", "rul", "level", "passed", "rate_change", "doubt", "summary", "outcomes", "path")

outcomes_frame <- function(outcomes) {
  data.frame(counted = column(outcomes, "counted", NA), repeated = column(outcomes, "repeated", NA),
             contradicts = column(outcomes, "contradicts", NA), p_value = column(outcomes, "p_value"), problem = column(outcomes, "problem", ""))
}

ww_risk <- function(tracker, within) {
  if (!inherits(tracker, "ww_tracker")) stop_input("tracker is ", kind_of(tracker), "; ww_track makes one")
  state <- state_of_tracker(tracker)
  if (is.numeric(within) && !is.object(within) && length(within) == 1) within <- paste(number_text(within), forecast_of(tracker)$axis_unit)
  core(C_risk, state$followed, one_text(within, "within"))
}

print.ww_tracker <- function(x, ...) {
  found <- forecast_of(x)
  n <- found$quality$readings
  cat(if (found$new) "New ", found$noun, " '", found$unit, "', ", n, if (!found$new) " new", if (n == 1) " reading" else " readings", "\n", sep = "")
  if (found$known) {
    rul <- signif(quantiles_of(found, "remaining", Inf), 4)
    if (!is.na(found$passed) && found$passed > 0.05) cat("Threshold passed with probability ", round(100 * found$passed), " %; if not:\n", sep = "")
    cat("Remaining useful life ", format(rul[["q50"]]), " ", found$axis_unit, ", ", format(rul[["q05"]]), " to ", format(rul[["q95"]]), " ",
        found$axis_unit, " (90 %)\n", sep = "")
  } else {
    cat("Nothing determines how it continues\n")
  }
  if (is.list(found$rate_change)) cat("Rate changed with probability ", round(100 * found$rate_change$probability), " %\n", sep = "")
  if (!is.na(found$doubt)) cat("In doubt: ", found$doubt, "\n", sep = "")
  invisible(x)
}

ww_backtest <- function(fit, readings, lives) {
  readings <- table_of(readings, "readings")
  lives <- table_of(lives, "lives")
  population <- population_of(fit)
  found <- core(C_backtest, population, readings, lives)
  ages <- found$summary$ages
  held <- column(ages, "held")
  forecasts <- column(ages, "forecasts")
  coverage <- data.frame(readings = column(ages, "readings", ""), units = column(ages, "units"), forecasts = forecasts, covered = held,
                         coverage = held / forecasts, numbers_of(ages, c("low", "high", "width", "error")))
  structure(class = "ww_backtest", list(summary = found$summary, coverage = coverage, forecasts = exact_csv(found$forecasts), text = found$text,
                                        trusted = core(C_is_trusted, population)))
}

print.ww_backtest <- function(x, ...) {
  cat(x$text)
  invisible(x)
}

ww_export_c <- function(fit, folder, name = "unit", unit = NULL, lines = NULL) {
  arguments <- json_arguments(list(name = one_text(name, "name"), unit = unit, lines = lines))
  about <- fit_or_folder(fit)
  found <- core(C_export_c, about$run, about$path, arguments, path_of(folder, "folder"))
  warn_unless(found$trusted)
  found$text
}

ww_export_sql <- function(fit, dialect, table, value = NULL, unit = NULL, columns = NULL, keep = NULL, prefix = "wearwell", draws = 400,
                          part = "all") {
  if (!is.null(names(columns))) columns <- paste0(names(columns), "=", vapply(columns, one_text, "", "columns"))
  arguments <- json_arguments(list(dialect = one_text(dialect, "dialect"), table = one_text(table, "table"), value = value, unit = unit,
                                   columns = columns, keep = keep, prefix = prefix, draws = draws, part = part))
  about <- fit_or_folder(fit)
  found <- core(C_export_sql, about$run, about$path, arguments)
  warn_unless(found$trusted)
  found$text
}
