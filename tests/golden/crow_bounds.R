# Rscript tests/golden/crow_bounds.R (R 4.2, base). Exact bounds of the power law by other means than the program: sums on a fine
# grid, R's own gamma and chi-square quantiles. The factors of the mean time between failures are those of the tables of
# MIL-HDBK-189 (n = 2: 0.5552 and 72.67 failure truncated, 0.200 and 38.66 time truncated, 90 %). The numbers are written into
# tests/models/recurrence/exact_bounds_test.cpp.
below <- function(n, c) {  # P(Z U <= c), gamma variables with the shapes n - 1 and n
  w <- seq(log(qgamma(1e-15, n - 1)), log(qgamma(1e-15, n - 1, lower.tail = FALSE)), length.out = 20001)
  sum(exp((n - 1) * w - exp(w) - lgamma(n - 1)) * pgamma(c * exp(-w), n)) * (w[2] - w[1])
}
product <- function(n, p) exp(uniroot(function(l) below(n, exp(l)) - p, log(n * n) + c(-15, 5), tol = 1e-12)$root)
failure_ended <- function(n, outside) n^2 / c(product(n, 1 - outside), product(n, outside))
share <- function(n, y) {
  j <- 1:(ceiling(sqrt(y)) * 6 + 200 + n)
  l <- j * log(y) - lgamma(j + 1) - lgamma(j)
  w <- exp(l - max(l)); sum(w[j <= n]) / sum(w)
}
rate <- function(n, p) exp(uniroot(function(l) share(n, exp(l)) - p, c(-12, log(50 * n * n + 200)), tol = 1e-12)$root)
time_ended <- function(n, outside) n^2 / c(rate(n, outside), rate(n - 1, 1 - outside))
for (n in c(2, 3, 10, 22)) for (level in c(0.8, 0.9, 0.95)) {
  cat(sprintf("n %d, level %.2f: failure ended %.6f %.6f, time ended %.6f %.6f\n", n, level,
              failure_ended(n, (1 - level) / 2)[1], failure_ended(n, (1 - level) / 2)[2],
              time_ended(n, (1 - level) / 2)[1], time_ended(n, (1 - level) / 2)[2]))
}
# ReliaWiki, Crow-AMSAA: 22 failures, the last ends the test. Published: beta 0.6142, lambda 0.4239, MTBF 45.883 h.
y <- c(2.7, 10.3, 12.5, 30.6, 57.0, 61.3, 80.0, 109.5, 125.0, 128.6, 143.8, 167.9, 229.2, 296.7, 320.6, 328.2, 366.2, 396.7,
       421.1, 438.2, 501.2, 620.0)
b <- 22 / sum(log(620 / y))
cat(sprintf("beta %.7f, lambda %.7f, MTBF %.6f\n", b, 22 / 620^b, 620 / (22 * b)))
cat("beta, 90 %:", format(b * qchisq(c(0.05, 0.95), 42) / 44, digits = 8), "\n")
cat("MTBF, 90 %:", format(620 / (22 * b) * failure_ended(22, 0.05), digits = 8), "\n")
# NIST/SEMATECH e-Handbook 8.4.5.2, case study 1: r = 10 in 1500 h. Published: MTBF 310.234 h by the corrected estimate.
z <- c(5, 40, 43, 175, 389, 712, 747, 795, 1299, 1478)
bar <- 9 / sum(log(1500 / z))
cat(sprintf("beta-bar %.7f, MTBF %.6f\n", bar, 1500 / (10 * bar)))
cat("MTBF, 80 %:", format(1500 * sum(log(1500 / z)) / 100 * time_ended(10, 0.1), digits = 8), "\n")
