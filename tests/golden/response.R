# Log densities and log probabilities of families of observations, far in their tails as well, by R's own distribution functions.
#   Rscript tests/golden/response.R > tests/golden/response.csv
cat("family,seen,at,until,s0,s1,s2,value\n")
put <- function(family, seen, at, until, s, value)
  cat(sprintf("%s,%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", family, seen, at, until, s[1], s[2], s[3], value))
# p(q, lower.tail) gives logarithms; d(x) too.
all_ways <- function(family, at, s, d, p) {
  for (y in at) {
    put(family, "exactly", y, 0, s, d(y))
    put(family, "above", y, 0, s, p(y, FALSE))
    put(family, "below", y, 0, s, p(y, TRUE))
  }
  for (i in seq_along(at)[-1]) {
    a <- at[i - 1]; b <- at[i]
    low <- p(b, TRUE) < p(a, FALSE)
    # Only where R loses nothing.
    large <- if (low) p(b, TRUE) else p(a, FALSE)
    small <- if (low) p(a, TRUE) else p(b, FALSE)
    if (is.finite(large) && large - small > 0.5) put(family, "between", a, b, s, large + log1p(-exp(small - large)))
  }
}
m <- 3; sd <- 0.7
all_ways("normal", c(-25, -2, 2.9, 3.4, 6, 40), c(m, sd, 0), function(y) dnorm(y, m, sd, log = TRUE),
         function(q, l) pnorm(q, m, sd, l, TRUE))
all_ways("lognormal", c(1e-8, 0.5, 1.9, 3, 50, 1e9), c(2, 0.6, 0), function(y) dlnorm(y, log(2), 0.6, log = TRUE),
         function(q, l) plnorm(q, log(2), 0.6, l, TRUE))
all_ways("log10-normal", c(1e-8, 0.5, 1.9, 3, 50, 1e9), c(2, 0.3, 0), function(y) dlnorm(y, log(2), 0.3 * log(10), log = TRUE),
         function(q, l) plnorm(q, log(2), 0.3 * log(10), l, TRUE))
all_ways("weibull", c(1e-6, 0.3, 60, 110, 400, 3000), c(82, 2.1, 0), function(y) dweibull(y, 2.1, 82, log = TRUE),
         function(q, l) pweibull(q, 2.1, 82, l, TRUE))
all_ways("weibull", c(15.001, 20, 60, 110, 400), c(82, 2.1, 15), function(y) dweibull(y - 15, 2.1, 82, log = TRUE),
         function(q, l) pweibull(q - 15, 2.1, 82, l, TRUE))
all_ways("exponential", c(1e-9, 0.1, 5, 300, 9000), c(7, 0, 0), function(y) dexp(y, 1 / 7, log = TRUE), function(q, l) pexp(q, 1 / 7, l, TRUE))
all_ways("gamma", c(1e-12, 0.01, 3, 8, 90, 4000), c(2.5, 1.7, 0), function(y) dgamma(y, 2.5, scale = 1.7, log = TRUE),
         function(q, l) pgamma(q, 2.5, scale = 1.7, lower.tail = l, log.p = TRUE))
all_ways("gamma", c(200, 900, 1000, 1100, 3000), c(1000, 1, 0), function(y) dgamma(y, 1000, scale = 1, log = TRUE),
         function(q, l) pgamma(q, 1000, scale = 1, lower.tail = l, log.p = TRUE))
all_ways("student-t", c(-1e8, -40, 0.2, 1.1, 30, 1e12), c(4.5, 1, 0.5), function(y) dt((y - 1) / 0.5, 4.5, log = TRUE) - log(0.5),
         function(q, l) pt((q - 1) / 0.5, 4.5, lower.tail = l, log.p = TRUE))
all_ways("loglogistic", c(1e-9, 0.2, 4, 11, 1e9), c(5, 3, 0),
         function(y) dlogis(3 * log(y / 5), log = TRUE) + log(3 / y), function(q, l) plogis(3 * log(q / 5), lower.tail = l, log.p = TRUE))
# Smallest extreme value: the Weibull law of exp(y). Largest: its mirror.
all_ways("smallest-extreme-value", c(-90, -3, 1, 2, 6), c(1, 1.3, 0), function(y) { z <- (y - 1) / 1.3; z - exp(z) - log(1.3) },
         function(q, l) pweibull(exp((q - 1) / 1.3), 1, 1, l, TRUE))
all_ways("largest-extreme-value", c(-4, 0, 1, 5, 90), c(1, 1.3, 0), function(y) { z <- -(y - 1) / 1.3; z - exp(z) - log(1.3) },
         function(q, l) pweibull(exp(-(q - 1) / 1.3), 1, 1, !l, TRUE))
# Generalized gamma (Meeker and Escobar 1998, eq. 5.19): x = exp(lambda omega)/lambda^2 has the gamma law of shape 1/lambda^2.
generalized_gamma <- function(at, s) {
  x <- function(y) (y / s[1])^(s[3] / s[2]) / s[3]^2
  all_ways("generalized-gamma", at, s,
           function(y) dgamma(x(y), 1 / s[3]^2, log = TRUE) + log(x(y) * abs(s[3]) / (s[2] * y)),
           function(q, l) pgamma(x(q), 1 / s[3]^2, lower.tail = l == (s[3] > 0), log.p = TRUE))
}
for (lambda in c(0.3, 2, -0.7, -3, 0.06, 0.04, -0.04, 0.003)) generalized_gamma(c(0.01, 0.4, 1.9, 3, 8, 40), c(2, 0.6, lambda))
all_ways("birnbaum-saunders", c(0.004, 0.5, 1.9, 3, 50, 900), c(2, 0.6, 0),
         function(y) { r <- sqrt(y / 2); dnorm((r - 1 / r) / 0.6, log = TRUE) + log((r + 1 / r) / (2 * 0.6 * y)) },
         function(q, l) { r <- sqrt(q / 2); pnorm((r - 1 / r) / 0.6, lower.tail = l, log.p = TRUE) })
# Where F is 1 to the last digit, 1 - F^a is a (1 - F).
exponentiated_weibull <- function(at, s) {
  upper <- function(q) pweibull(q, s[2], s[1], FALSE, TRUE)
  all_ways("exponentiated-weibull", at, s,
           function(y) log(s[3]) + (s[3] - 1) * pweibull(y, s[2], s[1], log.p = TRUE) + dweibull(y, s[2], s[1], log = TRUE),
           function(q, l) {
             below <- s[3] * pweibull(q, s[2], s[1], log.p = TRUE)
             if (l) below else if (upper(q) < -40) log(s[3]) + upper(q) else log(-expm1(below))
           })
}
for (a in c(0.3, 4)) exponentiated_weibull(c(1e-6, 0.3, 60, 110, 400, 3000), c(82, 2.1, a))
# The reciprocal is a Weibull life.
all_ways("frechet", c(0.2, 1.9, 3, 8, 90, 9000), c(2, 1.4, 0),
         function(y) dweibull(1 / y, 1.4, 1 / 2, log = TRUE) - 2 * log(y),
         function(q, l) pweibull(1 / q, 1.4, 1 / 2, lower.tail = !l, log.p = TRUE))
for (y in c(0, 1, 7, 400)) put("poisson", "exactly", y, 0, c(5.5, 0, 0), dpois(y, 5.5, log = TRUE))
