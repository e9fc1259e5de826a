# Plans of tests and inspections to come.

# An argument as JSON has it. What has names is an object, what has one element is itself; list(x) and I(x) are arrays always.
json_value <- function(item, what) {
  if (is.factor(item)) item <- as.character(item)
  if (inherits(item, "units")) item <- vapply(seq_along(item), function(i) as.character(quantity(item[i], what)), "")
  names <- names(item)
  if (!is.null(names) && (is.list(item) || is.atomic(item))) {
    inside <- vapply(names, function(key) paste0(json_text(key), ": ", json_value(item[[key]], what)), "")
    return(paste0("{", paste(inside, collapse = ", "), "}"))
  }
  known <- is.list(item) || is.character(item) || is.logical(item) || is.numeric(item)
  if (!known || (is.object(item) && !inherits(item, "AsIs")))
    stop_input(what, " is ", kind_of(item), "; it is a text, a number, or several of them")
  if (is.list(item)) {
    each <- vapply(item, json_value, "", what)
  } else {
    always <- inherits(item, "AsIs")
    item <- unclass(item)
    if (anyNA(item) || (is.numeric(item) && any(is.infinite(item)))) stop_input(what, " is ", shown_value(item), "; a number is finite")
    each <- if (is.character(item)) json_text(item) else if (is.logical(item)) ifelse(item, "true", "false") else number_text(item)
    if (length(item) == 1 && !always) return(each)
  }
  paste0("[", paste(each, collapse = ", "), "]")
}

json_text <- function(x) core(C_written, enc2utf8(as.character(x)))

# Arguments as a JSON object, without those that are NULL.
json_arguments <- function(arguments) {
  arguments <- arguments[!vapply(arguments, is.null, NA)]
  inside <- vapply(names(arguments), function(name) paste0(json_text(name), ": ", json_value(arguments[[name]], name)), "")
  paste0("{", paste(inside, collapse = ", "), "}")
}

# The tables that an argument holds: one, or a list of them.
plan_tables <- function(data, name) {
  if (is.null(data)) return(list())
  several <- is.list(data) && !is.data.frame(data) && is.null(names(data))
  tables <- lapply(if (several) data else list(data), table_of, name)
  stats::setNames(tables, rep(name, length(tables)))
}

# What the library answers. `run`, `study`, `path`: what the question is about, `other`: a second fit. `tables`: by argument. `file`: name of its JSON file.
answer_of <- function(kind, file, arguments, run = NULL, other = NULL, study = NULL, path = "", tables = list(), threads = 0, progress = FALSE) {
  text <- json_arguments(arguments)
  threads <- whole(threads, "threads", 0, 1024)
  found <- with_progress(progress, function(report) core(C_answer, kind, text, run, other, study, path, tables, threads, report))
  found$name <- file
  found$text <- in_arguments(found$text)
  found$csv <- found$tables
  found$tables <- lapply(found$csv, exact_csv)
  found
}

plan_of <- function(kind, arguments, ...) {
  found <- answer_of(kind, switch(kind, decide = "decisions", life = "life", "plan"), arguments, ...)
  if (!found$trusted) warn("the fit that this plan rests on is not trusted: see its checks")
  structure(class = c("ww_plan", "ww_answer"), found)
}

# A table of the program, numbers to their last bit: R's own reader may be off by one.
exact_csv <- function(text) {
  if (!nzchar(trimws(text))) return(data.frame())
  frame <- read.csv(text = text, check.names = FALSE, colClasses = "character", na.strings = character())
  frame[] <- lapply(frame, function(texts) core(C_column_of, texts))
  frame
}

# A fit or the folder of a result.
fit_or_folder <- function(fit) {
  if (inherits(fit, "ww_fit")) return(list(run = run_again(fit), path = ""))
  if (!is_path(fit)) stop_input("fit is ", kind_of(fit), "; it is a fit, or the folder of a result")
  list(run = NULL, path = path_of(fit, "fit"))
}

ww_plan_demonstrate <- function(goal, confidence = 0.9, failures = 0, specimens = NULL, time = NULL, distribution = "weibull",
                                shape = NULL, sigma = NULL, truth = NULL, sudden_death = NULL) {
  plan_of("demonstrate", list(goal = goal, confidence = confidence, failures = failures, specimens = specimens, time = time,
                              distribution = distribution, shape = shape, sigma = sigma, truth = truth, sudden_death = sudden_death))
}

ww_plan_inspect <- function(lives, at = NULL, risk = NULL, total_risk = NULL, warning = NULL, until = NULL, step = NULL, unit = NULL, new = FALSE,
                            inspection_cost = NULL, failure_cost = NULL, replacement_cost = NULL, downtime_cost = NULL,
                            visit_cost = NULL, given = NULL, in_service = NULL, threads = 0, progress = FALSE) {
  arguments <- list(at = at, risk = risk, total_risk = total_risk, warning = warning, until = until, step = step, unit = unit, new = new,
                    inspection_cost = inspection_cost, failure_cost = failure_cost, replacement_cost = replacement_cost,
                    downtime_cost = downtime_cost, visit_cost = visit_cost, given = given)
  plan_of_lives("inspect", arguments, lives, in_service, threads, progress)
}

# The life of a new unit, or the remaining useful life of one of the data.
ww_unit_life <- function(fit, unit = NULL, survived = NULL, horizon = NULL, risk = NULL, level = NULL, sides = NULL) {
  about <- fit_or_folder(fit)
  plan_of("life", list(unit = unit, survived = survived, horizon = horizon, risk = risk, level = level, sides = sides), run = about$run, path = about$path)
}

ww_decide <- function(lives, failure_cost, replacement_cost, at = NULL, in_service = NULL, inspection_cost = NULL, downtime_cost = NULL,
                      month = NULL, months = 12, service_level = 0.95, claims = NULL, unit = NULL, inspect_after = NULL, given = NULL,
                      progress = FALSE) {
  arguments <- list(at = at, failure_cost = failure_cost, replacement_cost = replacement_cost, inspection_cost = inspection_cost,
                    downtime_cost = downtime_cost, month = month, months = months, service_level = service_level, claims = claims,
                    unit = unit, inspect_after = inspect_after, given = given)
  plan_of_lives("decide", arguments, lives, in_service, 0, progress)
}

# `lives`: a fit, a folder, or a table of lives.
plan_of_lives <- function(kind, arguments, lives, in_service, threads, progress) {
  running <- plan_tables(in_service, "in_service")
  if (inherits(lives, "ww_fit") || is_path(lives)) {
    about <- fit_or_folder(lives)
    return(plan_of(kind, arguments, run = about$run, path = about$path, tables = running, threads = threads, progress = progress))
  }
  plan_of(kind, arguments, tables = c(plan_tables(lives, "lives"), running), threads = threads, progress = progress)
}

ww_plan_next <- function(fit, goal, candidates = NULL, grid = NULL, specimens = NULL, cost = NULL, specimen_cost = NULL, use_cost = NULL,
                         measure = NULL, by = "variance", value = NULL, budget = NULL, batch = 1, until = NULL, tests = NULL,
                         samples = 256, nodes = 800, seed = 1, failure_cost = NULL, replacement_cost = NULL, fleet_use = NULL,
                         threads = 0, progress = FALSE) {
  about <- fit_or_folder(fit)
  several <- if (is.list(tests) && !is.data.frame(tests) && is.null(names(tests))) tests else if (!is.null(tests)) list(tests)
  files <- vapply(several, is_path, NA)
  done <- lapply(several[!files], function(each) rows_for(fit, each, "tests"))
  plan_of("next", list(goal = goal, grid = grid, specimens = specimens, cost = cost, specimen_cost = specimen_cost, use_cost = use_cost,
                       measure = measure, by = by, value = value, budget = budget, batch = batch, until = until, samples = samples,
                       nodes = nodes, seed = seed_text(seed), failure_cost = failure_cost, replacement_cost = replacement_cost,
                       fleet_use = fleet_use,
                       tests = if (any(files)) I(vapply(several[files], path_of, "", "tests"))),
          run = about$run, path = about$path, tables = c(plan_tables(candidates, "candidates"), stats::setNames(done, rep("tests", length(done)))),
          threads = threads, progress = progress)
}

ww_plan_accelerate <- function(use, highest, until, specimens, stop = NULL, goal = "B10", relation = "arrhenius", family = "weibull", shape = NULL,
                               sigma = NULL, failing_at_use = NULL, failing_at_highest = NULL, life_at_highest = NULL,
                               activation_energy = NULL, exponent = NULL, slope = NULL, lowest = NULL, low = NULL, middle_share = 0.2,
                               least_failures = 4) {
  plan_of("accelerate", list(use = use, highest = highest, until = until, specimens = specimens, stop = stop, goal = goal, relation = relation,
                             family = family, shape = shape, sigma = sigma, failing_at_use = failing_at_use,
                             failing_at_highest = failing_at_highest, life_at_highest = life_at_highest,
                             activation_energy = activation_energy, exponent = exponent, slope = slope, lowest = lowest, low = low,
                             middle_share = middle_share, least_failures = least_failures))
}

ww_plan_size <- function(study, goal, width, tests, assurance = 0.8, level = 0.9, measure = NULL, most = 1000, simulations = 200, seed = 1,
                         threads = 0, progress = FALSE) {
  of_file <- is_path(study)
  if (!of_file && !inherits(study, "ww_study")) stop_input("study is ", kind_of(study), "; it is a study, or the path of a study file")
  plan_of("size", list(goal = goal, width = width, assurance = assurance, level = level, measure = measure, most = most,
                       simulations = simulations, seed = seed_text(seed)),
          study = if (!of_file) study_address(study), path = if (of_file) path_of(study, "study") else "",
          tables = plan_tables(tests, "tests"), threads = threads, progress = progress)
}

print.ww_answer <- function(x, ...) {
  cat(x$text)
  invisible(x)
}
