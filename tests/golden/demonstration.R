# Rscript tests/golden/demonstration.R > tests/golden/demonstration.csv (R 4.2, base).
# Demonstration tests: fewest specimens with 0 to 3 failures from pbinom (Clopper and Pearson 1934), times by uniroot on pbinom,
# exposures from qchisq, sudden death from pgamma, and a lognormal prior of the Weibull shape by integrate().
options(digits = 17)
cat("what,reliability,confidence,failures,specimens,spread,time,value\n")
row <- function(what, r, c, f, n, s, m, value) cat(sprintf("%s,%g,%g,%d,%d,%.17g,%.17g,%.15g\n", what, r, c, f, n, s, m, value))
fewest <- function(p, c, f) { n <- f + 1; while (pbinom(f, n, p) > (1 - c) * (1 + 1e-12)) n <- n + 1; n }
for (r in c(0.8, 0.85, 0.9, 0.95, 0.975, 0.99, 0.995, 0.999)) for (c in c(0.5, 0.8, 0.9, 0.95, 0.99)) for (f in 0:3)
  row("specimens", r, c, f, 0, 0, 1, fewest(1 - r, c, f))
for (shape in c(0.8, 1, 1.5, 2, 3, 4)) for (f in 0:2) for (n in c(3, 5, 10, 30)) {
  g <- function(x) pbinom(f, n, 1 - 0.9^(exp(x)^shape), log.p = TRUE) - log(0.1)
  row("time", 0.9, 0.9, f, n, shape, 0, exp(uniroot(g, c(-12, 12), tol = 1e-13)$root))
}
for (shape in c(1.5, 3)) for (m in c(0.5, 2)) for (f in 0:2)
  row("weibull", 0.9, 0.95, f, 0, shape, m, fewest(1 - 0.9^(m^shape), 0.95, f))
for (sigma in c(0.3, 0.8)) for (m in c(0.7, 1.5)) for (f in 0:2)
  row("lognormal", 0.9, 0.9, f, 0, sigma, m, fewest(pnorm(qnorm(0.1) + log(m) / sigma), 0.9, f))
for (f in 0:5) for (c in c(0.8, 0.9, 0.95)) row("exposure", 0.95, c, f, 0, 0, 0, qchisq(c, 2 * f + 2) / 2 / -log(0.95))
for (groups in c(2, 6)) for (life in c(1, 2, 4))
  row("sudden", 0.9, 0.9, 0, groups, 1.7, life, pgamma(qchisq(0.9, 2 * groups) / 2, groups, rate = life^-1.7, lower.tail = FALSE))
# The confidence averaged over log shape ~ N(log sqrt(1.5 * 3), log(2) / (2 * 1.645)): the 90 % interval 1.5 to 3.
middle <- mean(log(c(1.5, 3))); spread <- diff(log(c(1.5, 3))) / (2 * qnorm(0.95))
for (m in c(0.5, 1, 2)) for (f in 0:1) for (n in c(5, 20)) {
  risk <- integrate(function(z) dnorm(z) * pbinom(f, n, -expm1(log(0.9) * m^exp(middle + spread * z))), -9, 9, rel.tol = 1e-12)$value
  row("averaged", 0.9, 0, f, n, 0, m, 1 - risk)
}
for (m in c(0.5, 2)) {
  e <- function(z) 10 * m^exp(middle + spread * z)
  a <- integrate(function(z) dnorm(z) / e(z), -9, 9, rel.tol = 1e-12)$value
  b <- integrate(function(z) dnorm(z) / e(z) * -expm1(log(0.9) * e(z)), -9, 9, rel.tol = 1e-12)$value
  row("posterior", 0.9, 0, 0, 10, 0, m, b / a)
}
