# Densities and quantiles of truncated laws, from base R 4.2.2. Run in this folder:
#   Rscript laws.R > laws.csv
# Each law has three parameters a, b, c (0 where unused) and is truncated to [lower, upper]; log_density is at x,
# quantile at p. All in logarithms, by whichever tail does not cancel.
inverse_gamma <- list(  # 1/X is gamma
  d = function(x, a, b, c) dgamma(1 / x, a, rate = b, log = TRUE) - 2 * log(x),
  p = function(x, a, b, c, tail) pgamma(1 / x, a, rate = b, lower.tail = tail, log.p = TRUE),
  q = function(p, a, b, c, tail) 1 / qgamma(p, a, rate = b, lower.tail = tail, log.p = TRUE))
families <- list(
  normal = list(
    d = function(x, a, b, c) dnorm(x, a, b, log = TRUE),
    p = function(x, a, b, c, tail) pnorm(x, a, b, !tail, TRUE),
    q = function(p, a, b, c, tail) qnorm(p, a, b, !tail, TRUE)),
  lognormal = list(
    d = function(x, a, b, c) dlnorm(x, a, b, log = TRUE),
    p = function(x, a, b, c, tail) plnorm(x, a, b, !tail, TRUE),
    q = function(p, a, b, c, tail) qlnorm(p, a, b, !tail, TRUE)),
  gamma = list(
    d = function(x, a, b, c) dgamma(x, a, scale = b, log = TRUE),
    p = function(x, a, b, c, tail) pgamma(x, a, scale = b, lower.tail = !tail, log.p = TRUE),
    q = function(p, a, b, c, tail) qgamma(p, a, scale = b, lower.tail = !tail, log.p = TRUE)),
  "inverse-gamma" = inverse_gamma,
  "student-t" = list(
    d = function(x, a, b, c) dt((x - b) / c, a, log = TRUE) - log(c),
    p = function(x, a, b, c, tail) pt((x - b) / c, a, lower.tail = !tail, log.p = TRUE),
    q = function(p, a, b, c, tail) b + c * qt(p, a, lower.tail = !tail, log.p = TRUE)),
  beta = list(
    d = function(x, a, b, c) dbeta(x, a, b, log = TRUE),
    p = function(x, a, b, c, tail) pbeta(x, a, b, lower.tail = !tail, log.p = TRUE),
    q = function(p, a, b, c, tail) qbeta(p, a, b, lower.tail = !tail, log.p = TRUE)))

log_sum <- function(u, v) { m <- max(u, v); if (m == -Inf) m else m + log(exp(u - m) + exp(v - m)) }

cat("family,a,b,c,lower,upper,x,log_density,p,quantile\n")
case <- function(name, a, b, c, lower, upper, xs, ps = c(0.01, 0.5, 0.99)) {
  f <- families[[name]]
  tail <- f$p(lower, a, b, c, FALSE) > log(0.5)
  nearer <- f$p(if (tail) lower else upper, a, b, c, tail)  # the larger of the two
  farther <- f$p(if (tail) upper else lower, a, b, c, tail)
  log_mass <- nearer + log1p(-exp(farther - nearer))
  for (i in seq_along(xs)) {
    p <- ps[(i - 1) %% length(ps) + 1]
    at_lower <- f$p(lower, a, b, c, tail) + log1p(-p)
    at_upper <- f$p(upper, a, b, c, tail) + log(p)
    q <- f$q(log_sum(at_lower, at_upper), a, b, c, tail)
    cat(sprintf("%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", name, a, b, c, lower, upper,
                xs[i], f$d(xs[i], a, b, c) - log_mass, p, q))
  }
}
case("normal", 2, 3, 0, -Inf, Inf, c(-40, 2, 9))
case("normal", 0, 1, 0, 0, Inf, c(1e-9, 0.7, 12))
case("normal", 0, 1, 0, 30, 40, c(30.001, 31, 39))         # far in the upper tail
case("normal", 0, 1, 0, -37, -30, c(-30.001, -31, -36))    # and in the lower
case("normal", 5.05e-13, 0.74e-13, 0, 0, Inf, c(1e-14, 5e-13, 9e-13))  # wear coefficients in SI
case("normal", 5.05e-13, 0.74e-13, 0, 27e-13, 28e-13, c(2.71e-12, 2.75e-12, 2.79e-12))
case("lognormal", -28, 0.3, 0, 0, Inf, c(1e-13, 7e-13, 3e-12))
case("lognormal", 1, 2, 0, 1e-3, 1e4, c(2e-3, 1, 9e3))
case("lognormal", 0, 0.5, 0, 50, 60, c(50.1, 52, 59))
case("gamma", 1, 2e-13, 0, 0, Inf, c(1e-16, 2e-13, 4e-12))
case("gamma", 0.3, 5, 0, 0, Inf, c(1e-6, 1, 80))
case("gamma", 700, 0.1, 0, 60, 65, c(60.5, 63, 64.9))
case("gamma", 3, 2e-9, 0, 4e-7, Inf, c(4.001e-7, 4.1e-7, 5e-7))
case("inverse-gamma", 3, 2e-9, 0, 0, Inf, c(1e-10, 1e-9, 1e-6))
case("inverse-gamma", 0.5, 4, 0, 1, 1e6, c(1.5, 30, 9e5))
case("inverse-gamma", 3, 2, 0, 0, 0.02, c(0.01, 0.015, 0.0199))
case("student-t", 1, 0, 1.5e-9, 0, Inf, c(1e-12, 2e-9, 1e-6))  # half-Cauchy
case("student-t", 4.5, 2, 0.5, -Inf, Inf, c(-100, 2, 3))
case("student-t", 4.5, 2, 0.5, 1e3, 2e3, c(1001, 1200, 1999))
case("student-t", 1e6, 0, 1, -1, 4, c(-0.9, 0, 3.9))
case("beta", 2, 5, 0, 0, 1, c(1e-4, 0.3, 0.99))
case("beta", 0.5, 0.5, 0, 0.1, 0.2, c(0.11, 0.15, 0.19))
case("beta", 900, 700, 0, 0, 1, c(0.5, 0.5625, 0.6))
case("beta", 3, 40, 0, 0.6, 1, c(0.61, 0.65, 0.9))
