# Lives of a fit under conditions, held against the draws of its posterior, against one another, and against the program.

few <- data.frame(hours = c(150, 340, 560, 800, 1150, 2470, 100, 900, 300, 700), event = c(1, 1, 1, 1, 0, 1, 1, 1, 1, 0), site = rep(c("A", "B"), 5))
fit <- quiet(ww_life(Surv(hours, event) ~ 1, data = few, units = c(hours = "h"), seed = 1, method = "exact", draws = 1000, report = FALSE))
draws <- as.data.frame(wearwell:::draws_matrix(fit))

# Quantiles of a value over the draws have this standard error, at most, of its distribution function: 4 of them.
near <- function(found, values) {
  share <- mean(values < found$q50)
  expect_lt(abs(share - 0.5), 4 * 0.5 / sqrt(length(values)))
  expect_lt(abs(mean(values < found$q05) - 0.05), 4 * 0.22 / sqrt(length(values)))
}

test_that("survival, hazard and percentiles are those of the posterior", {
  near(ww_percentile(fit, 10), draws$characteristic * (-log(0.9))^(1 / draws$slope))
  near(ww_survival_function(fit, 300), exp(-(300 / draws$characteristic)^draws$slope))
  near(ww_hazard(fit, "300 h"), draws$slope / draws$characteristic * (300 / draws$characteristic)^(draws$slope - 1))
  both <- ww_percentile(fit, c(1, 10), confidence = 0.95)
  expect_identical(both$p, c(1, 10))
  expect_identical(attr(both, "unit"), "h")
  of_life <- ww_life(fit, b = c(1, 10), confidence = 0.95)
  expect_equal(both$bound, of_life$bound[match(c("B1 life", "B10 life"), of_life$name)])
  mean <- predict(quiet(ww_life(Surv(hours, event) ~ site, few, seed = 1, method = "exact", draws = 100, report = FALSE)), data.frame(site = c("A", "B")))
  expect_identical(names(mean), c("mean", "lower", "upper"))
  expect_true(all(mean$lower < mean$mean & mean$mean < mean$upper))
})

test_that("what remains is the survival function from there on", {
  rest <- ww_conditional(fit, survived = 300, b = 50)
  expect_identical(rest$quantity, c("survival to 300 h", "mean remaining useful life", "B50 remaining useful life"))
  median <- rest$predictive[3]
  at <- ww_survival_function(fit, c(300, 300 + median))$predictive
  expect_equal(at[2] / at[1], 0.5, tolerance = 1e-6)
})

test_that("groups are rows, and conditions can be asked for", {
  by <- quiet(ww_life(Surv(hours, event) ~ 1, data = few, by = "site", seed = 1, method = "exact", draws = 100, report = FALSE))
  found <- ww_percentile(by, 10)
  expect_setequal(found$site, c("A", "B"))
  expect_equal(ww_percentile(by, 10, given = list(site = "B"))$q50, found$q50[found$site == "B"])
  expect_equal(ww_percentile(by, 10, data.frame(site = c("B", "B")))$q50, rep(found$q50[found$site == "B"], 2))
  refused(ww_percentile(by, 10, given = list(site = "C")), "given: site has no 'C' (")
  refused(ww_percentile(by, 10, given = list(load = 1)), "given: the study has no condition 'load' (conditions: site)")
  refused(predict(by, data.frame(site = "C")), "newdata: site has no 'C'")
})

test_that("errors name the argument", {
  refused(ww_percentile(fit, 0.1), "p holds 0.1, which may be a percentage")
  refused(ww_percentile(fit, 110), "p is 110")
  refused(ww_percentile(fit, NA_real_), "p is NA")
  refused(ww_survival_function(fit, -1), "times is -1; lives of this study are 0 or more")
  refused(ww_survival_function(fit, c(1, NA)), "times holds a missing value")
  refused(ww_survival_function(fit, "5 kg"), "times")
  refused(ww_hazard(fit, list()), "times is")
  refused(ww_conditional(fit, c(1, 2)), "survived is")
  refused(ww_conditional(fit, 1e9), "survived: a new item survives to 1e+09 with a probability of")
  refused(ww_percentile(quiet(ww_fit(of_a_formula(), seed = 1, method = "exact", draws = 50, report = FALSE)), 10), "this study measures V")
  refused(ww_study_toml(fit), "fit$toml")
})

test_that("the life of a unit is the program's", {
  folder <- tempfile("results")
  quiet(ww_write(fit, folder))
  found <- ww_unit_life(fit, survived = "300 h", horizon = "100 h", level = "95 %")
  run <- program("life", folder, "--survived", "300 h", "--horizon", "100 h", "--level", "95 %", "--json")
  expect_identical(run$code, 0L)
  expect_identical(paste0(sub("\n$", "", found$json), "\n"), run$out)
  expect_identical(ww_unit_life(folder, survived = "300 h")$summary$name, "remaining useful life")
  refused(ww_unit_life(fit, survived = "3 kg"), "survived: ")
  refused(ww_unit_life(3), "fit is double")
})

test_that("the default prior of a life is that of `wearwell new`, also with few failures", {
  lives <- data.frame(hours = c(310, 420, 1000, 1000, 1000, 1000, 1000, 1000), status = c("failed", "failed", rep("censored", 6)))
  folder <- tempfile("lives")
  dir.create(folder)
  utils::write.csv(stats::setNames(lives, c("hours [h]", "status")), file.path(folder, "lives.csv"), row.names = FALSE)
  run <- program("new", "life", file.path(folder, "study"), "--from", file.path(folder, "lives.csv"))
  keys <- wearwell:::core(wearwell:::C_keys, paste(readLines(file.path(folder, "study", "study.toml")), collapse = "\n"))
  own <- ww_life(Surv(hours, status) ~ 1, data = lives, units = c(hours = "h"), fit = FALSE)
  proposed <- wearwell:::core(wearwell:::C_keys, own$text)$prior$characteristic
  expect_identical(proposed[c("median", "log_sd")], keys$prior$characteristic[c("median", "log_sd")])
  expect_identical(proposed$log_sd, 2.5)
})
