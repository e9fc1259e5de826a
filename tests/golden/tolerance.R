# Rscript tests/golden/tolerance.R > tests/golden/tolerance.csv (R 4.2, base).
# One-sided tolerance factors by the noncentral t quantile (Owen 1968), and limits of a fitted line by lm(): ISO 12107, Owen, and the
# band of ASTM E739. R's qt with ncp is another algorithm (AS 243) than Boost's.
options(digits = 17)
cat("what,reliability,confidence,leverage,freedom,x,value\n")
for (r in c(0.5, 0.9, 0.977, 0.99)) for (c in c(0.9, 0.95)) for (n in c(3, 8, 15, 30)) {
  k <- qt(c, n - 1, qnorm(r) * sqrt(n)) / sqrt(n)
  cat(sprintf("factor,%g,%g,%.17g,%d,0,%.15g\n", r, c, 1 / n, n - 1, k))
}
x <- c(2.78, 2.78, 2.70, 2.70, 2.63, 2.63, 2.58, 2.58, 2.54)
y <- c(4.31, 4.52, 4.98, 5.21, 5.40, 5.77, 5.93, 6.02, 6.41)
fit <- lm(y ~ x)
s <- summary(fit)$sigma; nu <- fit$df.residual
cat(sprintf("slope,0,0,0,0,0,%.15g\nintercept,0,0,0,0,0,%.15g\nsd,0,0,0,0,0,%.15g\n", coef(fit)[2], coef(fit)[1], s))
for (at in c(2.50, 2.63, 2.80)) {
  p <- predict(fit, data.frame(x = at), se.fit = TRUE)
  h <- (p$se.fit / s)^2
  for (r in c(0.9, 0.99)) for (c in c(0.9, 0.95)) {
    owen <- p$fit - s * sqrt(h) * qt(c, nu, qnorm(r) / sqrt(h))
    iso <- p$fit - s * sqrt(1 + h) * qt(c, nu, qnorm(r) * sqrt(nu + 1)) / sqrt(nu + 1)
    cat(sprintf("owen,%g,%g,%.17g,%d,%g,%.15g\niso,%g,%g,%.17g,%d,%g,%.15g\n", r, c, h, nu, at, owen, r, c, h, nu, at, iso))
  }
  cat(sprintf("band,0.5,0.95,%.17g,%d,%g,%.15g\n", h, nu, at, p$fit - sqrt(2 * qf(0.95, 2, nu)) * p$se.fit))
}
