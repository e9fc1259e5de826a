# Maximum likelihood and 90 % profile intervals of Weibull and lognormal lives that are known to an interval, by optim and
# uniroot in logarithms: the numbers of tests/models/formula_model/formula_edges_test.cpp. Times in hours, `n` lives alike.
few <- list(lower = c(0, 10, 20, 30, 40), upper = c(10, 20, 30, 40, Inf), n = c(1, 3, 2, 1, 1))
# Cracked tubes of heat exchangers, of three plants: Meeker and Escobar (1998), example 1.5.
tubes <- list(lower = c(0, 1, 2, 3), upper = c(1, 2, 3, Inf), n = c(5, 7, 9, 279))
cdfs <- list(weibull = function(x, a, b) pweibull(x, b, a), lognormal = function(x, a, b) plnorm(x, log(a), b))
fit <- function(data, cdf) {
  value <- function(p) {
    share <- cdf(data$upper, exp(p[1]), exp(p[2])) - cdf(data$lower, exp(p[1]), exp(p[2]))
    if (any(!is.finite(share) | share <= 0)) return(-1e10)
    sum(data$n * log(share))
  }
  best <- optim(c(3, 0.3), function(p) -value(p), control = list(reltol = 1e-15, maxit = 10000))
  best <- optim(best$par, function(p) -value(p), control = list(reltol = 1e-15, maxit = 10000))
  drop <- qchisq(0.9, 1) / 2
  end <- function(i, way) {
    excess <- function(at) {
      other <- optimize(function(q) value(if (i == 1) c(at, q) else c(q, at)), best$par[3 - i] + c(-6, 6), maximum = TRUE, tol = 1e-10)
      -best$value - other$objective - drop
    }
    exp(uniroot(excess, sort(c(best$par[i] + way * 1e-6, best$par[i] + way * 4)), tol = 1e-10)$root)
  }
  c(a = exp(best$par[1]), b = exp(best$par[2]), log_likelihood = -best$value,
    a_low = end(1, -1), a_high = end(1, 1), b_low = end(2, -1), b_high = end(2, 1))
}
for (law in names(cdfs)) for (data in c("few", "tubes")) {
  cat(law, data, "\n")
  print(signif(fit(get(data), cdfs[[formula]]), 7))
}
