# Makes regress.csv (two data sets of R) and regress_expected.csv: what R 4.2.2's lm says of them
# (Debian 12: apt-get install r-base-core). Run in this folder: Rscript regress.R
#
# longley: Longley (1967), a test of collinearity, not weighted. mtcars: a quadratic in weight and
# power, the rows weighted by the number of cylinders.
cases <- list(
  longley = list(
    columns = cbind(1, as.matrix(longley[, 1:6])), response = longley$Employed,
    weights = rep(1, nrow(longley))),
  mtcars = list(
    columns = with(mtcars, cbind(1, wt, hp, wt^2, wt * hp, hp^2)), response = mtcars$mpg,
    weights = mtcars$cyl))

data <- expected <- NULL
number <- function(x) sprintf("%.17g", x)
for (name in names(cases)) {
  case <- cases[[name]]
  # One row per value: case, row, column (0 response, -1 weight), value.
  block <- function(column, values) {
    data.frame(case = name, row = seq_along(values), column = column, value = number(values))
  }
  data <- rbind(data, block(0, case$response), block(-1, case$weights))
  for (j in seq_len(ncol(case$columns))) data <- rbind(data, block(j, case$columns[, j]))

  x <- case$columns
  w <- case$weights
  y <- case$response
  fit <- lm(y ~ 0 + x, weights = w)
  # The same column space with R's own intercept, for its R2 about the mean.
  centred <- lm(y ~ x[, -1], weights = w)
  stopifnot(all.equal(deviance(fit), deviance(centred), tolerance = 1e-8))
  loo <- residuals(fit) / (1 - hatvalues(fit))
  # Leave one out for once literally, to check the formula.
  literal <- sapply(seq_along(y), function(i) y[i] - sum(x[i, ] * coef(lm(y[-i] ~ 0 + x[-i, ], weights = w[-i]))))
  stopifnot(all.equal(unname(loo), literal, tolerance = 1e-6))
  n <- length(y)
  k <- ncol(x)
  press <- sum(w * loo^2)
  tss <- sum(w * (y - weighted.mean(y, w))^2)
  statistics <- list(
    coefficient = coef(fit), standard_error = sqrt(diag(vcov(fit))), leverage = hatvalues(fit),
    loo_residual = loo, rss = deviance(fit), press = press, sigma = sigma(fit),
    r2 = summary(centred)$r.squared, r2p = 1 - press / tss,
    adjusted_r2 = summary(centred)$adj.r.squared, aic = AIC(fit),
    aicc = AIC(fit) + 2 * (k + 1) * (k + 2) / (n - k - 2), bic = BIC(fit))
  for (statistic in names(statistics)) {
    value <- statistics[[statistic]]
    expected <- rbind(expected, data.frame(
      case = name, statistic = statistic, index = seq_along(value), value = number(value)))
  }
}
write.csv(data, "regress.csv", row.names = FALSE, quote = FALSE)
write.csv(expected, "regress_expected.csv", row.names = FALSE, quote = FALSE)
