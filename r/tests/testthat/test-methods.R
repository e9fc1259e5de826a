# The generics: each number has the meaning that its page states.

pumps <- data.frame(hours = c(150, 340, 560, 800, 1150, 2470, 100, 900, 300, 700), event = c(1, 1, 1, 1, 0, 1, 1, 1, 1, 0))
fit <- quiet(ww_life(Surv(hours, event) ~ 1, data = pumps, units = c(hours = "h"), seed = 1, method = "exact"))
draws <- wearwell:::draws_matrix(fit)

test_that("estimates are the posterior's", {
  expect_identical(coef(fit), stats::setNames(fit$parameters$mean, c("characteristic", "slope")))
  expect_equal(sqrt(diag(vcov(fit))), stats::setNames(fit$parameters$sd, c("characteristic", "slope")))
  expect_equal(stats::cov2cor(vcov(fit)), stats::cor(draws))
  expect_identical(unname(confint(fit, level = 0.9)), unname(as.matrix(fit$parameters[c("q05", "q95")])))
  expect_equal(unname(confint(fit, "slope", level = 0.5)[1, ]), unname(stats::quantile(draws[, "slope"], c(0.25, 0.75))))
  expect_identical(colnames(confint(fit)), c("2.5 %", "97.5 %"))
  refused(confint(fit, "eta"), "parm: the fit has no parameter 'eta' (parameters: characteristic, slope)")
  refused(confint(fit, level = 95), "level is 95; it lies between 0 and 1")
})

test_that("the log-likelihood is that at the mode", {
  mode <- vapply(fit$summary$mode$parameters, `[[`, 0, "value")
  ended <- pumps$event == 1
  own <- sum(stats::dweibull(pumps$hours[ended], mode["slope"], mode["characteristic"], log = TRUE)) +
    sum(stats::pweibull(pumps$hours[!ended], mode["slope"], mode["characteristic"], lower.tail = FALSE, log.p = TRUE))
  expect_equal(as.numeric(logLik(fit)), own, tolerance = 1e-8)
  expect_identical(attr(logLik(fit), "df"), 2L)
  expect_equal(AIC(fit), fit$summary$mode$aic)
  expect_equal(BIC(fit), fit$summary$mode$bic)
  expect_equal(nobs(fit), 10)
})

test_that("residuals are quantile residuals at 400 draws", {
  kept <- draws[(0:399) * 10 + 1, ]
  ended <- pumps$event == 1
  below <- outer(seq_len(400), seq_len(10), function(s, i) stats::pweibull(pumps$hours[i], kept[s, "slope"], kept[s, "characteristic"]))
  below[, !ended] <- (below[, !ended] + 1) / 2
  expect_equal(as.vector(residuals(fit)), apply(stats::qnorm(below), 2, stats::median), tolerance = 1e-6)
  expect_identical(attr(residuals(fit), "censored"), !ended)
  expect_equal(as.vector(residuals(fit, "cox-snell")), -log1p(-stats::pnorm(as.vector(residuals(fit)))), tolerance = 1e-10)
  refused(residuals(fit, "deviance"), "type is \"deviance\"; it is 'score' or 'cox-snell'")
})

test_that("simulations have the predictive distribution, and one seed the same bits", {
  set.seed(5)
  before <- .Random.seed
  lives <- unlist(simulate(fit, nsim = 2000, seed = 3))
  expect_identical(.Random.seed, before)
  b <- ww_life(fit, b = c(10, 50))
  row <- b[b$name == "life", ]
  # Ten lives of one draw are alike: the standard error is that of 2000 draws at most.
  expect_lt(abs(mean(lives < row$b10) - 0.1), 4 * sqrt(0.09 / 2000))
  expect_lt(abs(mean(lives < row$b50) - 0.5), 4 * sqrt(0.25 / 2000))
  expect_identical(simulate(fit, 2, seed = 3), simulate(fit, 2, seed = 3))
  refused(simulate(fit, 0), "nsim is 0")
})

test_that("leave-one-out has the form of the package loo", {
  found <- ww_loo(fit)
  expect_s3_class(found, c("ww_loo", "loo"), exact = TRUE)
  said <- fit$summary$loo
  expect_identical(found$estimates["elpd_loo", ], c(Estimate = said$elpd, SE = said$se))
  # Standard errors are those of sums of as many independent terms (Vehtari, Gelman and Gabry 2017, eq. 23).
  for (name in rownames(found$estimates)) {
    expect_equal(unname(found$estimates[name, ]), c(sum(found$pointwise[, name]), sqrt(10) * stats::sd(found$pointwise[, name])), tolerance = 1e-8)
  }
  expect_identical(dim(found$pointwise), c(10L, 4L))
  expect_identical(attr(found, "dims"), c(4000, 10))
  expect_match(capture.output(print(found)), "elpd_loo", all = FALSE)
  # The registered method is found where loo is installed.
  skip_if_not_installed("loo")
  expect_identical(loo::loo(fit), found)
})

test_that("readings of degradation are simulated, of new units", {
  wear <- data.frame(machine = rep(c("A", "B"), each = 2), km = c(10, 20, 10, 20), wear = c(11, 19, 14, 31))
  known <- list(rate = ww_lognormal("1.2 um/km", log_sd = 0.3), sigma = ww_lognormal("1 um", log_sd = 0.5), rate_scatter = ww_lognormal(0.4, log_sd = 0.3))
  paths <- quiet(ww_degradation(wear ~ km | machine, data = wear, units = c(wear = "um", km = "km"), priors = known, seed = 1, draws = 500, warmup = 200,
                                chains = 1, report = FALSE))
  expect_identical(attr(simulate(paths, 1), "unit"), "um")
  expect_identical(simulate(paths, 2, seed = 4), simulate(paths, 2, seed = 4))
  rows <- as.matrix(simulate(paths, 2000, seed = 2))
  scale <- paths$parameters["rate", "q50"]
  expect_equal(stats::median(rows[1, ]), 10 * scale, tolerance = 0.1)  # of the median unit
  expect_gt(stats::cor(rows[1, ], rows[2, ]), stats::cor(rows[1, ], rows[3, ]) + 0.3)  # one unit has one rate
  refused(wearwell:::require_units_of(paths, list(units = list(rate = "mm/km"))), "the prior gives rate in um/km, and the data have it in mm/km")
  refused(simulate(quiet(ww_fit(of_a_formula(), seed = 1, method = "exact", draws = 10, report = FALSE))), "simulate() needs a fit of ww_life() or ww_degradation()")
})

test_that("increments of processes have their mean and a variance in proportion", {
  set.seed(1)
  for (family in c("wiener-process", "gamma-process", "inverse-gaussian-process")) {
    drawn <- wearwell:::increments(family, rep(c(0, 3), each = 1e5), 0.5)
    expect_identical(unique(drawn[1:1e5]), 0, info = family)
    expect_equal(mean(drawn[-(1:1e5)]), 3, tolerance = 0.01, info = family)
    expect_equal(stats::var(drawn[-(1:1e5)]), 0.5 * 3, tolerance = 0.03, info = family)
  }
})

test_that("each family simulates its own quantiles", {
  u <- c(0.1, 0.5, 0.9)
  of <- function(family, ...) wearwell:::random_life(family, u, 100, c(...))
  expect_equal(of("weibull", 2), stats::qweibull(u, 2, 100))
  expect_equal(of("lognormal", 0.5), stats::qlnorm(u, log(100), 0.5))
  expect_equal(of("loglogistic", 3), 100 * exp(stats::qlogis(u) / 3))
  expect_equal(of("frechet", 2), 1e4 / stats::qweibull(1 - u, 2, 100))  # the reciprocal of a Weibull life
  expect_equal(of("exponential"), stats::qexp(u, 1 / 100))
  expect_equal(of("gamma", 2), stats::qgamma(u, 2, scale = 50))  # mean 100
  expect_equal(of("generalized-gamma", 0.5, 1), stats::qweibull(u, 2, 100))  # lambda 1
  expect_equal(of("generalized-gamma", 0.5, 0), stats::qlnorm(u, log(100), 0.5))  # lambda 0
  x <- of("birnbaum-saunders", 0.7)
  expect_equal(stats::pnorm((sqrt(x / 100) - sqrt(100 / x)) / 0.7), u)
  set.seed(1)
  wald <- wearwell:::random_life("inverse-gaussian", stats::runif(1e5), 100, sqrt(1 / 3))
  expect_equal(mean(wald), 100, tolerance = 0.01)  # mean m, variance (m variation)^2
  expect_equal(stats::var(wald), 100^3 / 300, tolerance = 0.03)
})

test_that("update changes the call", {
  other <- quiet(update(fit, family = "exponential", report = FALSE, draws = 100))
  expect_identical(names(coef(other)), "mean_life")
  call <- update(fit, . ~ . + load, evaluate = FALSE)
  expect_equal(call$x, Surv(hours, event) ~ load, ignore_formula_env = TRUE)
  refused(update(fit, "family"), "only fits of a formula")
})

test_that("broom's and posterior's generics", {
  skip_if_not_installed("generics")
  tidy <- generics::tidy(fit, conf.int = TRUE, conf.level = 0.9)
  expect_identical(names(tidy), c("term", "estimate", "std.error", "unit", "conf.low", "conf.high"))
  expect_identical(tidy$conf.low, fit$parameters$q05)
  expect_equal(generics::glance(fit)$AIC, AIC(fit))
  expect_identical(generics::augment(fit)$.resid, as.vector(residuals(fit)))
  expect_identical(generics::augment(fit)$.censored, pumps$event == 0)
  skip_if_not_installed("posterior")
  expect_identical(posterior::as_draws(fit), fit$draws)
})

test_that("the report's figures are drawn from their specifications", {
  grDevices::pdf(NULL)
  on.exit(grDevices::dev.off())
  for (kind in c("life", "probability", "posterior", "residuals", "hazard", "trace-characteristic")) expect_identical(plot(fit, kind), fit)
  paper <- wearwell:::drawing_of(wearwell:::chosen_figures(fit, "probability")[[1]])
  points <- Filter(function(layer) layer$type == "point", paper$layers)[[1]]$data
  expect_equal(points$x, sort(pumps$hours[pumps$event == 1]))
  expect_true(paper$x$log)
  expect_true("50" %in% sub("[^0-9.].*", "", paper$y$labels))
  belief <- wearwell:::drawing_of(wearwell:::figures_of(fit)[["belief-characteristic"]])
  expect_true("before the data (prior)" %in% unlist(lapply(belief$layers, `[[`, "label")))
  refused(plot(fit, "curve"), "this fit has no figure of the kind 'curve'; it has")
  refused(plot(fit, "lives"), "it is one of life, probability, curve, posterior, residuals, or a figure of this fit")
  refused(plot(fit, "life", which = "characteristic"), "goes with kind = \"posterior\"")
  bare <- quiet(update(fit, report = FALSE, draws = 100))
  expect_identical(plot(bare), bare)
  refused(plot(bare, "life"), "this fit was made with report = FALSE")
})

test_that("ggplot2 draws the same layers", {
  skip_if_not_installed("ggplot2")
  grDevices::pdf(NULL)
  on.exit(grDevices::dev.off())
  for (kind in c("probability", "hazard", "residuals", "draws-characteristic-slope")) {
    plot <- ggplot2::autoplot(fit, kind)
    built <- ggplot2::ggplot_build(plot)
    drawings <- wearwell:::drawings_of(fit, kind)
    expect_identical(length(built$data), length(drawings[[1]]$layers), info = kind)
  }
  points <- Filter(function(layer) "shape" %in% names(layer), ggplot2::ggplot_build(ggplot2::autoplot(fit, "probability"))$data)[[1]]
  expect_equal(10^points$x, sort(pumps$hours[pumps$event == 1]), tolerance = 1e-5)
  expect_type(ggplot2::autoplot(fit), "list")  # one of each parameter
})
