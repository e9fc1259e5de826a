# The joint study of An et al. (2011) on a dense grid: an independent computation of Tables 6 and 7. Base R, no package.
#   Rscript tests/golden/joint_grid.R > tests/golden/joint_grid.csv
# k in 1e-4 mm^3/(N m), volumes and sigma in mm^3; ci and pi are 5 % and 95 % at `at` cycles; midpoint rule.
cycles <- c(1, 100, 1000, 5000, 10000, 20585)
volume <- c(4.44, 5.105, 8.825, 24.175, 45.31, 92.73)
work <- cycles * 5.966

log_likelihood <- list(
  normal = function(v, mu, sd) dnorm(v, mu, sd, log = TRUE),
  lognormal = function(v, mu, sd) {
    zeta <- sqrt(log1p((sd / mu)^2))
    dlnorm(v, log(mu) - zeta^2 / 2, zeta, log = TRUE)
  })
predictive <- list(
  normal = function(y, mu, sd) pnorm(y, mu, sd),
  lognormal = function(y, mu, sd) {
    zeta <- sqrt(log1p((sd / mu)^2))
    plnorm(y, log(mu) - zeta^2 / 2, zeta)
  })
# k ~ flat on k > 0 or N(5.05, 0.74); sigma ~ U(0, upper). The evidence of the flat prior has no meaning and is not given.
log_prior <- list(flat = function(k) 0 * k, tribometer = function(k) dnorm(k, 5.05, 0.74, log = TRUE))
upper <- c(normal = 15, lognormal = 7)

weighted_quantile <- function(x, density, p) approx(c(0, cumsum(density)) / sum(density), c(x - diff(x[1:2]) / 2, tail(x, 1) + diff(x[1:2]) / 2), p, ties = "ordered")$y

cat("family,prior,rows,at,k_mean,k_sd,sigma_mean,sigma_sd,ci05,ci95,pi05,pi95\n")
for (family in names(upper)) for (prior in names(log_prior)) for (n in 3:6) {
  # Wide enough for the least certain case: 15 mm^3 of scatter about 1000 cycles.
  widest <- if (prior == "tribometer") 12 else c(NA, NA, 180, 50, 25, 18)[n]
  k <- (seq_len(3000) - 0.5) * widest / 3000
  sigma <- (seq_len(900) - 0.5) * upper[[family]] / 900
  grid <- matrix(log_prior[[prior]](k), length(k), length(sigma))
  s <- rep(sigma, each = length(k))
  for (i in seq_len(n)) grid <- grid + log_likelihood[[family]](volume[i], 1e-4 * k * work[i], s)
  p <- exp(grid - max(grid))
  p <- p / sum(p)
  pk <- rowSums(p)
  ps <- colSums(p)
  mean_sd <- function(x, w) { m <- sum(x * w); c(m, sqrt(sum((x - m)^2 * w))) }
  for (at in if (n == 5) 5:6 else n) {
    ci <- weighted_quantile(k, pk, c(0.05, 0.95)) * 1e-4 * work[at]
    keep <- which(p > 1e-12)
    mu <- 1e-4 * k[(keep - 1) %% length(k) + 1] * work[at]
    sd <- sigma[(keep - 1) %/% length(k) + 1]
    cdf <- function(y) sum(p[keep] * predictive[[family]](y, mu, sd))
    pi <- sapply(c(0.05, 0.95), function(q) uniroot(function(y) cdf(y) - q, c(-60, 250), tol = 1e-6)$root)
    cat(sprintf("%s,%s,%d,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", family, prior, n, cycles[at],
                mean_sd(k, pk)[1], mean_sd(k, pk)[2], mean_sd(sigma, ps)[1], mean_sd(sigma, ps)[2],
                ci[1], ci[2], pi[1], pi[2]))
  }
}
