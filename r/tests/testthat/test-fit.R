# What a fit is: verdict, frames, conditions, Ctrl-C, progress, copies, forks.

joint <- function(...) ww_fit(example("joint", "study.toml"), ...)
delayedAssign("kept", joint(seed = 3))  # for what only reads a fit
delayedAssign("bare", joint(seed = 3, report = FALSE))

test_that("parameters are the summary's, by quadrature", {
  fit <- kept
  k <- fit$summary$parameters$k
  expect_identical(fit$parameters["k", "mean"], k$mean)
  expect_identical(fit$parameters["k", "unit"], "mm^3/(N m)")
  # Table 5 of An et al. (2011): 7.76e-4 +- 0.92e-4, sigma 5.63.
  expect_lt(abs(fit$parameters["k", "mean"] - 7.76e-4), 0.005e-4)
  expect_lt(abs(fit$parameters["sigma", "mean"] - 5.63), 0.005)
  expect_identical(fit$predictions$pi95[1], fit$summary$predictions[[1]]$pi95)
  expect_identical(fit$lives$b10[1], fit$summary$life$b10)
  expect_identical(fit$life, fit$lives)
  expect_identical(dim(fit$draws), c(1000L, 4L, 2L))
  expect_identical(nrow(fit$tables$parameters), 2L)
  expect_lt(abs(mean(fit$draws[, , "k"]) - k$mean), 5 * k$draws$mcse)
  expect_error(fit$trustd, "has no 'trustd'", class = "wearwell_input_error")
})

test_that("draws are what posterior takes, and it finds the same diagnostics", {
  skip_if_not_installed("posterior")
  fit <- bare
  expect_true(posterior::is_draws_array(fit$draws))
  expect_identical(posterior::as_draws_array(fit$draws), fit$draws)
  expect_identical(posterior::variables(fit$draws), c("k", "sigma"))
  found <- posterior::summarise_draws(fit$draws, "rhat", "ess_bulk", "ess_tail", "mcse_mean")
  expect_equal(as.double(found$rhat), fit$parameters$rhat, tolerance = 1e-8)
  expect_equal(as.double(found$ess_bulk), fit$parameters$ess_bulk, tolerance = 1e-6)
  expect_equal(as.double(found$ess_tail), fit$parameters$ess_tail, tolerance = 1e-6)
  expect_equal(nrow(posterior::as_draws_df(fit$draws)), 4000)
})

test_that("the verdict comes first, in print, summary and plot", {
  fit <- bare
  expect_match(capture.output(print(fit))[1], "^trusted")
  expect_match(capture.output(print(summary(fit)))[2], "^trusted")
  expect_identical(ww_require_trusted(fit), fit)
  improper <- NULL
  warned <- character()
  withCallingHandlers(improper <- ww_fit(example("joint", "improper_normal.toml"), seed = 1, report = FALSE),
                      wearwell_check_warning = function(w) {
                        warned <<- c(warned, conditionMessage(w))
                        invokeRestart("muffleWarning")
                      })
  expect_match(warned, "^proper-posterior fails", all = FALSE)
  expect_false(improper$trusted)
  expect_match(capture.output(print(improper))[1], "^NOT TRUSTED: .*proper-posterior")
  expect_error(ww_require_trusted(improper), "proper-posterior", class = "wearwell_not_trusted")
  file <- tempfile(fileext = ".pdf")
  grDevices::pdf(file)
  expect_identical(plot(fit), fit)
  refused(plot(fit, which = "kay"), "no parameter 'kay'")
  grDevices::dev.off()
  expect_gt(file.size(file), 3000)
})

test_that("errors have the words of the program", {
  folder <- tempfile()
  dir.create(folder)
  wrong <- file.path(folder, "wrong.toml")
  writeLines(sub("[likelihood]", "[likelyhood]", readLines(example("joint", "study.toml")), fixed = TRUE), wrong)
  for (study in c(wrong, file.path(folder, "none.toml"))) {
    said <- program("fit", study)
    error <- tryCatch(ww_fit(study), error = identity)
    expect_s3_class(error, c("wearwell_input_error", "wearwell_error", "error", "condition"), exact = TRUE)
    expect_identical(paste0("wearwell: ", conditionMessage(error), "\n"), said$error)
  }
  fit <- bare
  refused(ww_report(fit, tempfile()), "report = FALSE")
  expect_error(ww_netcdf(fit, "/dev/full"), class = "wearwell_machine_error")
})

test_that("options are checked", {
  refused(joint(seed = -1), "seed is -1")
  refused(joint(seed = 1.5), "seed is 1.5")
  refused(joint(seed = 2^60), "beyond 2^53 as a text")
  refused(joint(seed = "18446744073709551616"), "seed is")
  refused(joint(chains = 0), "chains is 0")
  refused(joint(draws = 5), "draws is 5")
  refused(joint(draws = NA), "draws is NA")
  refused(joint(method = "gibbs"), "method is \"gibbs\"")
  refused(joint(threads = -1), "threads is -1")
  refused(joint(report = NA), "report is NA")
  refused(joint(progress = 3), "is 3; it is TRUE or FALSE")
  largest <- quiet(joint(seed = "18446744073709551615", draws = 10, report = FALSE, method = "exact"))
  expect_identical(quiet(joint(seed = "018446744073709551615", draws = 10, report = FALSE, method = "exact"))$draws, largest$draws)
  expect_false(identical(quiet(joint(seed = 2^53, draws = 10, report = FALSE, method = "exact"))$draws, largest$draws))
})

test_that("progress is reported, and what it throws stops the fit", {
  reported <- list()
  joint(seed = 1, draws = 15000, report = FALSE, progress = function(...) reported[[length(reported) + 1]] <<- list(...))
  expect_gt(length(reported), 0)
  # A part that ends within a tenth of a second may not be seen.
  parts <- unique(vapply(reported, function(step) step[[1]], ""))
  expect_true("iterations" %in% parts)
  expect_true(all(parts %in% c("evaluations of the density", "iterations", "curves", "leave-one-out", "predictions and checks", "data sets")))
  expect_true(all(vapply(reported, function(step) step[[3]] == 0 || step[[2]] <= step[[3]], NA)))
  expect_error(joint(seed = 1, draws = 5e6, report = FALSE, progress = function(...) stop("enough")), "enough")
  # A fit within a fit, whose error unwinds both.
  inner <- function(...) ww_fit(example("joint", "study.toml"), seed = 1, draws = 5e6, report = FALSE, progress = function(...) stop("within"))
  expect_error(joint(seed = 1, draws = 5e6, report = FALSE, progress = inner), "within")
  expect_true(joint(seed = 3, report = FALSE)$trusted)  # the next one is as any
})

test_that("Ctrl-C stops a fit and leaves nothing", {
  folder <- tempfile()
  dir.create(folder)
  script <- file.path(folder, "script.R")
  writeLines(c(
    sprintf("study <- %s", deparse(example("joint", "study.toml"))),
    "library(wearwell)",
    "system(sprintf('(sleep 2; kill -INT %d) &', Sys.getpid()))",
    "tryCatch(ww_write(ww_fit(study, seed = 1, draws = 9000000, report = FALSE), 'results'),",
    "  interrupt = function(...) cat('stopped', length(list.dirs(recursive = FALSE)), '\\n'))",
    "cat(ww_fit(study, seed = 3, report = FALSE)$trusted, '\\n')"), script)
  old <- setwd(folder)
  on.exit(setwd(old))
  said <- system2(file.path(R.home("bin"), "Rscript"), c("--vanilla", shQuote(script)), stdout = TRUE, stderr = FALSE)
  expect_identical(trimws(said), c("stopped 0", "TRUE"))
})

test_that("nothing is printed by a fit, and a bar goes to standard error", {
  # Only the study's own warning is given, as a warning.
  expect_silent(suppressWarnings(fit <- joint(seed = 3, report = FALSE)))
  expect_identical(capture.output(joint(seed = 1, draws = 15000, report = FALSE, progress = TRUE)$trusted), "[1] TRUE")
})

test_that("a fit that was kept answers as before", {
  fit <- kept
  file <- tempfile(fileext = ".rds")
  saveRDS(fit, file)
  again <- readRDS(file)
  expect_identical(again$summary, fit$summary)
  expect_identical(again$draws, fit$draws)
  expect_identical(capture.output(print(again)), capture.output(print(fit)))
  expect_identical(ww_ask(again, list(cycles = list(30000))), ww_ask(fit, list(cycles = list(30000))))
  formula <- quiet(ww_fit(of_a_formula(), seed = 1, method = "exact", report = FALSE))
  saveRDS(formula, file)
  expect_identical(predict(readRDS(file), list(F = 150, s = 5e4)), predict(formula, list(F = 150, s = 5e4)))
})

test_that("a kept fit of data that changed is refused", {
  folder <- tempfile()
  dir.create(folder)
  file.copy(example("joint", c("study.toml", "joint_wear.csv")), folder)
  fit <- ww_fit(file.path(folder, "study.toml"), seed = 1, report = FALSE)
  file <- tempfile(fileext = ".rds")
  saveRDS(fit, file)
  table <- file.path(folder, "joint_wear.csv")
  writeLines(sub("44.41", "45.41", readLines(table), fixed = TRUE), table)
  again <- readRDS(file)
  expect_identical(again$parameters, fit$parameters)
  refused(ww_netcdf(again, tempfile()), "have changed since this fit")
})

test_that("forked children fit too, to the same bits", {
  here <- joint(seed = 4, report = FALSE)$summary  # starts threads, of which a forked child has none
  there <- parallel::mclapply(1:2, function(i) joint(seed = 4, report = FALSE)$summary, mc.cores = 2)
  expect_identical(there, list(here, here))
})

test_that("workers of parallel and future fit too, to the same bits", {
  study <- example("joint", "study.toml")
  cluster <- parallel::makePSOCKcluster(1)
  on.exit(parallel::stopCluster(cluster))
  there <- parallel::clusterCall(cluster, function(study) suppressWarnings(wearwell::ww_fit(study, seed = 3, report = FALSE))$parameters, study)[[1]]
  expect_identical(there, bare$parameters)
  skip_if_not_installed("future")
  future::plan("multisession", workers = 2)
  expect_identical(future::value(future::future(wearwell::ww_fit(study, seed = 3, report = FALSE)$parameters)), bare$parameters)
})

test_that("NetCDF is that of the program", {
  there <- tempfile(fileext = ".nc")
  program("fit", example("joint", "study.toml"), "--seed", 3, "--quiet", "--no-report", "--netcdf", there, "-o", tempfile())
  here <- tempfile(fileext = ".nc")
  ww_netcdf(bare, here)
  expect_equal(file.size(here), file.size(there), tolerance = 0.01)
  expect_identical(readBin(here, "raw", 4), as.raw(c(0x89, 0x48, 0x44, 0x46)))
})

test_that("memory does not grow with fits", {
  resident <- function() as.double(strsplit(grep("VmRSS", readLines("/proc/self/status"), value = TRUE), "[^0-9]+")[[1]][2])
  study <- ww_study(formula = "hours = mean_life", family = "exponential", data = data.frame(hours = c(120, 340, 560, 230)),
                    priors = list(mean_life = ww_lognormal(300, log_sd = 1)))
  fit <- function() quiet(ww_fit(study, seed = 1, method = "exact", draws = 10, chains = 1, report = FALSE))
  for (i in 1:20) fit()
  gc()
  before <- resident()
  for (i in 1:30) fit()
  gc()
  expect_lt(resident() - before, 20 * 1024)  # after 240 fits it was 10 MB more than after 40
})
