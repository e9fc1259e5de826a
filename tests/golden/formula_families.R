# Posteriors of lives by brute force, on grids: the 23 ball bearings (examples/life/bearings.csv, millions of revolutions) of which the
# last five are taken for run-outs at 100, and 101 coupons (coupons.csv, thousands of cycles) with run-outs at 160. Of the parameters and of
# the life by which 10 % of all fail.
#   Rscript tests/golden/formula_families.R > tests/golden/formula_families.csv
bearings <- read.csv("examples/life/bearings.csv")[[1]]
coupons <- read.csv("tests/golden/coupons.csv")[[1]]
lives <- function(t, limit) list(t = pmin(t, limit), failed = t <= limit)
# Trapezoids on a grid of logarithms or, of lambda, of the parameter; d and s are log density and log survival.
posterior <- function(name, data, axes, logarithms, log_prior, d, s, quantile) {
  grid <- as.matrix(expand.grid(axes))
  natural <- sapply(seq_along(axes), function(i) if (logarithms[i]) exp(grid[, i]) else grid[, i])
  ll <- log_prior(natural)
  for (i in seq_along(axes)) if (logarithms[i]) ll <- ll + grid[, i]
  for (i in seq_along(data$t)) ll <- ll + (if (data$failed[i]) d(data$t[i], natural) else s(data$t[i], natural))
  w <- exp(ll - max(ll)); w <- w / sum(w)
  put <- function(what, x) {
    m <- sum(w * x); o <- order(x)
    cat(sprintf("%s,%s,%.8g,%.8g,%.8g\n", name, what, m, sqrt(sum(w * (x - m)^2)), approx(cumsum(w[o]), x[o], 0.5, ties = "ordered")$y))
  }
  for (i in seq_along(axes)) put(names(axes)[i], natural[, i])
  put("b10", quantile(0.1, natural))
}
cat("family,what,mean,sd,median\n")
n <- 81
posterior("generalized-gamma", lives(bearings, 100),
  list(eta = seq(log(25), log(220), length.out = n), sigma = seq(log(0.12), log(2.2), length.out = n), lambda = seq(-3.5, 3.52, length.out = n)),
  c(TRUE, TRUE, FALSE),
  function(p) dlnorm(p[, 1], log(70), 1, log = TRUE) + dlnorm(p[, 2], log(0.5), 0.7, log = TRUE) + dnorm(p[, 3], 0, 1, log = TRUE),
  function(y, p) { x <- (y / p[, 1])^(p[, 3] / p[, 2]) / p[, 3]^2; dgamma(x, 1 / p[, 3]^2, log = TRUE) + log(x * abs(p[, 3]) / (p[, 2] * y)) },
  function(y, p) { x <- (y / p[, 1])^(p[, 3] / p[, 2]) / p[, 3]^2
    ifelse(p[, 3] > 0, pgamma(x, 1 / p[, 3]^2, lower.tail = FALSE, log.p = TRUE), pgamma(x, 1 / p[, 3]^2, log.p = TRUE)) },
  function(q, p) p[, 1] * (qgamma(ifelse(p[, 3] > 0, q, 1 - q), 1 / p[, 3]^2) * p[, 3]^2)^(p[, 2] / p[, 3]))
posterior("exponentiated-weibull", lives(bearings, 100),
  list(eta = seq(log(0.3), log(300), length.out = n), beta = seq(log(0.2), log(9), length.out = n), power = seq(log(0.08), log(150), length.out = n)),
  c(TRUE, TRUE, TRUE),
  function(p) dlnorm(p[, 1], log(50), 0.7, log = TRUE) + dlnorm(p[, 2], log(1.5), 0.4, log = TRUE) + dlnorm(p[, 3], log(2), 1, log = TRUE),
  function(y, p) log(p[, 3]) + (p[, 3] - 1) * pweibull(y, p[, 2], p[, 1], log.p = TRUE) + dweibull(y, p[, 2], p[, 1], log = TRUE),
  function(y, p) log(-expm1(p[, 3] * pweibull(y, p[, 2], p[, 1], log.p = TRUE))),
  function(q, p) qweibull(q^(1 / p[, 3]), p[, 2], p[, 1]))
posterior("birnbaum-saunders", lives(coupons, 160),
  list(median = seq(log(115), log(155), length.out = 301), alpha = seq(log(0.1), log(0.35), length.out = 301)), c(TRUE, TRUE),
  function(p) dlnorm(p[, 1], log(130), 1, log = TRUE) + dlnorm(p[, 2], log(0.2), 0.7, log = TRUE),
  function(y, p) { r <- sqrt(y / p[, 1]); dnorm((r - 1 / r) / p[, 2], log = TRUE) + log((r + 1 / r) / (2 * p[, 2] * y)) },
  function(y, p) { r <- sqrt(y / p[, 1]); pnorm((r - 1 / r) / p[, 2], lower.tail = FALSE, log.p = TRUE) },
  function(q, p) { w <- p[, 2] * qnorm(q) / 2; p[, 1] * (w + sqrt(w^2 + 1))^2 })
