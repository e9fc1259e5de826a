# Fits, and what they found.

methods <- c("nuts", "metropolis", "exact")

ww_fit <- function(study, data = NULL, units = NULL, seed = NULL, method = NULL, chains = NULL, warmup = NULL, draws = NULL,
                   threads = 0, report = TRUE, progress = interactive()) {
  if (!is.null(method) && !(is_path(method) && method %in% methods)) {
    stop_input("method is ", shown_value(method), "; it is 'nuts', 'metropolis' or 'exact'")
  }
  choice <- list(method = method, chains = whole(chains, "chains", 1, 1000), warmup = whole(warmup, "warmup", 0, 1e7),
                 draws = whole(draws, "draws", 10, 1e7), seed = seed_text(seed))
  threads <- whole(threads, "threads", 0, 1024)
  report <- one_truth(report, "report")
  study <- as_study(study, data, units)
  run <- with_progress(progress, function(report_progress) run_of(study, choice, threads, report, report_progress))
  with_call(fit_of(study, run, choice, report), match.call())
}

one_truth <- function(x, what) {
  if (!is.logical(x) || length(x) != 1 || is.na(x)) stop_input(what, " is ", shown_value(x), "; it is TRUE or FALSE")
  x
}

run_of <- function(study, choice, threads, report, progress) {
  method <- if (is.null(choice$method)) "" else choice$method
  core(C_run, study_address(study), method, choice$chains, choice$warmup, choice$draws, choice$seed, threads, report, progress)
}

# progress: TRUE for a bar on standard error, or a function of what, done, total and seconds.
with_progress <- function(progress, work) {
  if (is.function(progress)) return(work(function(...) progress(...)))
  if (!one_truth(progress, "progress, where it is not a function,")) return(work(NULL))
  shown <- FALSE
  on.exit(if (shown) cat("\r", strrep(" ", 79), "\r", sep = "", file = stderr()))
  work(function(what, done, total, seconds) {
    shown <<- TRUE
    filled <- if (total > 0) floor(30 * min(1, done / total)) else 0
    # The part of the work, or its steps where they are counted; as wide as what it replaces.
    text <- if (total > 0) sprintf("%.0f of %.0f %s, %.0f s", done, total, what, seconds) else
      if (done > 0) sprintf("%.0f %s, %.0f s", done, what, seconds) else what
    cat(sprintf("\r[%s%s] %-46s", strrep("#", filled), strrep(".", 30 - filled), text), file = stderr())
  })
}

fit_of <- function(study, run, choice, report) {
  summary <- core(C_summary, run)
  fit <- list(study = study, summary = summary, trusted = summary$trusted, checks = checks_of(summary),
              seed = summary$seed, text = in_arguments(core(C_terminal, run)), choice = choice, report = report, live = living(run))
  if (is_posterior(summary)) {
    fit$parameters <- parameters_of(summary)
    fit$predictions <- predictions_of(summary)
    fit$quantities <- quantities_of(summary)
    fit$lives <- lives_of(summary)
    array <- core(C_draws, run)
    if (!is.null(array)) {
      fit$draws <- draws_array(array, names(summary$parameters))
      fit$sample_stats <- stats_of(core(C_sample_stats, run), dim(array))
    }
  }
  fit <- structure(class = "ww_fit", fit)
  warn_of(fit$checks)
  fit
}

is_posterior <- function(summary) !is.null(summary$sampler)

draws_array <- function(array, names) {
  dimnames(array) <- list(iteration = as.character(seq_len(dim(array)[1])), chain = as.character(seq_len(dim(array)[2])),
                          variable = names)
  structure(array, class = c("draws_array", "draws", "array"))
}

stats_of <- function(stats, size) {
  frame <- data.frame(chain = rep(seq_len(size[2]), each = size[1]), iteration = rep(seq_len(size[1]), size[2]))
  for (name in names(stats)) frame[[name]] <- stats[[name]]
  if (!is.null(frame$divergent)) frame$divergent <- frame$divergent != 0
  frame
}

# ---- Frames of summary.json.

life <- function(value) if (is.na(value)) Inf else value  # null of a life: never

column <- function(rows, key, type = NA_real_) {
  vapply(rows, function(row) if (is.null(row[[key]])) type else as.vector(row[[key]], typeof(type)), type, USE.NAMES = FALSE)
}

checks_of <- function(summary) {
  data.frame(name = column(summary$checks, "name", ""), verdict = column(summary$checks, "verdict", ""),
             detail = in_arguments(column(summary$checks, "detail", "")), advice = in_arguments(column(summary$checks, "advice", "")))
}

numbers_of <- function(rows, keys, missing = NA_real_) {
  found <- lapply(stats::setNames(keys, keys), function(key) column(rows, key))
  as.data.frame(found)
}

parameters_of <- function(summary) {
  rows <- summary$parameters
  prior <- lapply(rows, function(row) row$prior)
  cbind(data.frame(unit = column(rows, "unit", ""), row.names = names(rows)),
        numbers_of(rows, c("mean", "sd", "q05", "q50", "q95")),
        numbers_of(lapply(rows, function(row) row$draws), c("mcse", "ess_bulk", "ess_tail", "rhat")),
        data.frame(exact = column(rows, "by", "") == "quadrature", prior = column(prior, "words", ""),
                   default_prior = column(prior, "default", FALSE)))
}

predictions_of <- function(summary) {
  rows <- summary$predictions
  at <- lapply(rows, function(row) row[[1]])  # "cycles": the first key is what it is at
  numeric <- all(vapply(at, is.numeric, NA))
  cbind(data.frame(at_name = vapply(rows, function(row) names(row)[1], ""),
                   at = if (numeric) vapply(at, as.double, 0) else vapply(at, as.character, ""),
                   quantity = column(rows, "quantity", ""), unit = column(rows, "unit", "")),
        numbers_of(rows, c("mean", "ci05", "ci95", "pi05", "pi95")), numbers_of(rows, "measured"))
}

quantiles <- c("q05", "q50", "q95", "b1", "b10", "b50")

quantities_of <- function(summary) {
  rows <- summary$quantities
  is_life <- vapply(rows, function(row) !is.null(row$b10), NA)
  upper <- if (any(vapply(rows, function(row) !is.null(row$upper_bound), NA))) "upper_bound"  # with predict$sides
  frame <- cbind(data.frame(name = column(rows, "name", ""), of = column(rows, "of", ""), at = column(rows, "at", ""),
                            unit = column(rows, "unit", ""), is_life = is_life),
                 numbers_of(rows, c(quantiles, "predictive", "bound", upper, "credible_level", "mean")))
  for (key in quantiles) {
    never <- is_life & vapply(rows, function(row) !is.null(row[[key]]) && is.na(row[[key]]) && !isTRUE(row$undetermined), NA)
    frame[[key]][never] <- Inf
  }
  frame
}

lives_of <- function(summary) {
  frame <- quantities_of(summary)
  frame <- frame[frame$is_life, setdiff(names(frame), c("is_life", "mean", "upper_bound"))]
  if (!is.null(summary$life)) {
    entry <- summary$life
    if (is.null(entry$q50)) entry$q50 <- entry$b50
    at <- paste("to", format(entry$limit, digits = 6), entry$limit_unit)
    first <- data.frame(name = "life", of = if (is.null(entry$of)) "" else entry$of, at = at, unit = entry$unit)
    first[quantiles] <- lapply(quantiles, function(key) if (is.null(entry[[key]])) NA_real_ else life(entry[[key]]))
    first[c("predictive", "bound", "credible_level")] <- NA_real_
    frame <- rbind(first, frame)
  }
  rownames(frame) <- NULL
  sometimes <- c("predictive", "bound", "credible_level")
  frame[!names(frame) %in% sometimes | !vapply(frame, function(values) all(is.na(values)), NA)]
}

# ---- What a fit has.

of_posterior <- c("parameters", "predictions", "quantities", "lives", "draws", "sample_stats")

`$.ww_fit` <- function(x, name) {
  fields <- unclass(x)
  if (name == "life") name <- "lives"
  if (name %in% names(fields)) return(fields[[name]])
  if (name == "tables") return(tables_of(x))
  if (name == "toml") return(fields$study$text)
  if (name %in% of_posterior) {
    stop_input("a study of the model ", fields$summary$model, " has no ", name, "; fit$summary and fit$tables hold what it found")
  }
  stop_input("a fit has no '", name, "' (it has: ", words(c(setdiff(names(fields), c("choice", "report", "live")), "tables", "toml")), ")")
}

# The run; of a fit that was kept beyond its session it is done again, to the bit.
run_again <- function(fit) {
  live <- fit$live
  if (!core(C_is_there, live$address)) {
    choice <- fit$choice
    choice$seed <- seed_text(if (nzchar(choice$seed)) choice$seed else fit$seed)
    run <- run_of(fit$study, choice, 0L, fit$report, NULL)
    if (core(C_summary, run)$data$fingerprint != fit$summary$data$fingerprint) {
      stop_input("the data of '", fit$study$shown, "' have changed since this fit")
    }
    live$address <- run
  }
  live$address
}

files_of <- function(fit) core(C_files, run_again(fit))

page_of <- function(files) {
  if (is.na(files["report.json"])) stop_input("this fit was made with report = FALSE; fit it again with a report")
  core(C_page_of, files[["summary.json"]], files[["report.json"]])
}

tables_of <- function(fit) {
  files <- files_of(fit)
  files <- files[grepl("^tables/.*[.]csv$", names(files))]
  found <- lapply(files, function(text) if (nzchar(trimws(text))) read.csv(text = text, check.names = FALSE) else data.frame())
  stats::setNames(found, sub("^tables/(.*)[.]csv$", "\\1", names(files)))
}

ww_require_trusted <- function(fit) {
  failed <- fit$checks[fit$checks$verdict == "fail", ]
  if (!fit$trusted) {
    why <- vapply(seq_len(nrow(failed)), function(i) reason(failed[i, ]), "")
    stop(condition(paste(why, collapse = "; "), "wearwell_not_trusted", "wearwell_error", "error"))
  }
  invisible(fit)
}

# ---- Files.

ww_write <- function(fit, folder) {
  if (inherits(fit, "ww_answer")) {
    files <- c(stats::setNames(fit$json, paste0(fit$name, ".json")), stats::setNames(fit$csv, sprintf("tables/%s.csv", names(fit$csv))), report.html = fit$page)
  } else {
    files <- files_of(fit)
    if (!is.na(files["report.json"])) files <- c(files, report.html = page_of(files))
  }
  core(C_write_folder, path_of(folder, "folder"), files)
  invisible(folder)
}

ww_report <- function(fit, path) {
  if (inherits(fit, c("ww_selection", "ww_comparison", "ww_answer"))) {
    page <- fit$page
    if (!nzchar(page)) stop_input("there is no page: select again with report = TRUE")
  } else {
    page <- page_of(files_of(fit))
  }
  core(C_write_page, path_of(path), page)
  invisible(path)
}

ww_netcdf <- function(fit, path) {
  core(C_write_netcdf, run_again(fit), path_of(path))
  invisible(path)
}
