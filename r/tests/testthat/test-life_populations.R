# ww_life beyond one distribution that begins at 0: thresholds, shares of parts, subpopulations.

pumps <- data.frame(hours = c(312, 480, 510, 640, 700, 700, 150, 260, 420), failed = c(1, 1, 1, 1, 0, 0, 1, 1, 1))
study_of <- function(...) ww_life(..., fit = FALSE)
quick <- function(...) quiet(ww_life(..., seed = 1, method = "exact", draws = 100, report = FALSE))
of_hours <- function(...) study_of(Surv(hours, failed) ~ 1, pumps, units = c(hours = "h"), ...)
keys_of <- function(study) wearwell:::core(wearwell:::C_keys, study$text)

same_numbers <- function(fit, text, table) {
  file <- tempfile(fileext = ".toml")
  writeLines(text, file)
  utils::write.csv(table, file.path(dirname(file), "d.csv"), row.names = FALSE)
  own <- quiet(ww_fit(file, seed = 1, method = "exact", draws = 100, report = FALSE))
  columns <- c("mean", "sd", "q05", "q50", "q95")
  expect_identical(as.matrix(fit$parameters[columns]), as.matrix(own$parameters[rownames(fit$parameters), columns]))
}

test_that("a share that can fail is that of the study", {
  circuits <- read.csv(example("life", "circuits.csv"), comment.char = "#")
  fit <- quick(Surv(hours, status) ~ 1, circuits, count = "count", units = c(hours = "h"), share_defective = TRUE, classical = TRUE, predict = list(b_lives = 0.5))
  same_numbers(fit, 'model = "formula"
[data]
file = "d.csv"
[data.columns]
life = { column = "hours", unit = "h" }
status = "status"
count = "count"
[likelihood.life]
family = "weibull"
scale = "characteristic"
shape = "slope"
share_defective = "share_defective"
[prior]
characteristic = { distribution = "lognormal", median = "50000 h", log_sd = 7 }
slope = { distribution = "lognormal", median = 1.5, log_sd = 0.7 }
share_defective = { distribution = "uniform", lower = 0, upper = 1 }
[predict]
b_lives = 0.5
', circuits)
  estimates <- fit$summary$classical$maximum_likelihood$parameters
  values <- stats::setNames(vapply(estimates, `[[`, 0, "value"), vapply(estimates, `[[`, "", "name"))
  expect_equal(values[["share_defective"]], 0.00674, tolerance = 1e-3)  # Meeker and Escobar 1998
  lives <- unlist(simulate(fit, nsim = 20, seed = 2))
  expect_gt(mean(is.infinite(lives)), 0.95)  # of the rows, with counts one each
})

test_that("a threshold is that of the study, and shifts simulated lives", {
  fit <- quick(Surv(hours, failed) ~ 1, pumps, units = c(hours = "h"), threshold = TRUE)
  same_numbers(fit, 'model = "formula"
[data]
file = "d.csv"
[data.columns]
life = { column = "hours", unit = "h" }
status = { column = "failed", failure = 1 }
[likelihood.life]
family = "weibull"
scale = "characteristic"
shape = "slope"
threshold = "threshold"
[prior]
characteristic = { distribution = "lognormal", median = "1000 h", log_sd = 2 }
slope = { distribution = "lognormal", median = 1.5, log_sd = 0.7 }
threshold = { distribution = "half-normal", scale = "200 h" }
[predict]
b_lives = [1, 10, 50]
', pumps)
  known <- quick(Surv(hours, failed) ~ 1, pumps, units = c(hours = "h"), threshold = "100 h")
  expect_gt(min(unlist(simulate(known, nsim = 100, seed = 1))), 100)
  expect_identical(keys_of(of_hours(threshold = 100))$constants, keys_of(of_hours(threshold = "100 h"))$constants)
  expect_error(simulate(quick(Surv(hours, failed) ~ 1, pumps, units = c(hours = "h"), threshold = "6000 min")), "in the unit of the lives")
})

test_that("subpopulations and shares are the keys of the study", {
  keys <- keys_of(of_hours(subpopulations = c("early", "wear-out")))
  expect_identical(unlist(keys$subpopulations$names), c("early", "wear-out"))
  expect_identical(keys$subpopulations$share, list(early = "share_early"))
  expect_identical(keys$likelihood$life$scale, "characteristic[subpopulation]")
  expect_identical(keys$likelihood$life$shape, "slope[subpopulation]")
  expect_identical(keys_of(of_hours(subpopulations = 3))$subpopulations$share, list(early = "share_early", middle = "share_middle"))
  expect_identical(keys_of(of_hours(subpopulations = 2, shape = "shared"))$likelihood$life$shape, "slope")
  expect_match(ww_description(of_hours(subpopulations = 2)), "in the order of their median lives", fixed = TRUE)
  dead <- study_of(Surv(hours, failed) ~ 1, rbind(pumps, data.frame(hours = 0, failed = 1)), share_dead_on_arrival = TRUE, priors = "flat")
  expect_match(dead$text, "share_dead_on_arrival = { distribution = \"uniform\", lower = 0, upper = 1 }", fixed = TRUE)
})

test_that("simulated lives of subpopulations have their shares and distributions", {
  further <- list(names = c("a", "b"), shares = "share_a", slots = list(share_dead_on_arrival = 0.1))
  set.seed(1)
  lives <- wearwell:::of_populations(c(share_a = 0.3), 1e5, further, function(label) ifelse(label == "a", 1, 2))
  expect_equal(mean(lives == 0), 0.1, tolerance = 0.03)
  expect_equal(mean(lives == 1), 0.27, tolerance = 0.03)
})

test_that("what is refused is refused in the words of arguments", {
  sites <- transform(pumps, site = rep(c("A", "B", "C"), 3))
  of_sites <- function(formula = Surv(hours, failed) ~ 1, ...) study_of(formula, sites, ...)
  refused(of_hours(family = "log-location-scale"), "standard is NULL; the distribution of the standardized logarithm is one of smallest extreme value, normal")
  refused(of_hours(standard = "normal"), "standard is of family = \"log-location-scale\"")
  refused(of_hours(subpopulations = 1), "subpopulations is 1; it is 2, 3 or 4, or as many names")
  refused(of_hours(subpopulations = c("a b", "a-b", "c")), "share_a_b twice")
  refused(of_sites(subpopulations = 2, by = "site"), "by and subpopulations: each group has its own scale")
  refused(of_sites(subpopulations = 2, mode = "site"), "mode and subpopulations")
  refused(of_sites(Surv(hours, failed) ~ 1 + (1 | site), subpopulations = 2), "subpopulations have no random effects")
  refused(of_sites(Surv(hours, failed) ~ 1 + (1 | site), share_defective = TRUE), "share_defective: lives with random effects have no such share")
  refused(of_hours(share_defective = 1.5), "share_defective is 1.5; it is TRUE, for a share with a prior, or a known share from 0 to 1")
  refused(of_hours(threshold = "3 kg"), "threshold")
  refused(of_hours(shape = "separate"), "shape = 'separate' needs by or mode: the column of the groups or failure modes that differ; or subpopulations")
})
