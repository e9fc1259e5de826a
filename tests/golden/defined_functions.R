# Values of tests/formula/expression_test.cpp, by base R 4.2.2: Rscript defined_functions.R
show <- function(family, parameters, x, cdf, survival, pdf)
  cat(sprintf('    {"%s", "%s", %.17g, %.15g, %.15g, %.15g},\n', family, parameters, x, cdf, survival, pdf), sep = "")
of <- function(family, parameters, xs, p, d) for (x in xs) show(family, parameters, x, p(x, TRUE), p(x, FALSE), d(x))
of("normal", "1.5, 2", c(-9, 0.5, 4), function(x, l) pnorm(x, 1.5, 2, l), function(x) dnorm(x, 1.5, 2))
of("lognormal", "3, 0.7", c(0.05, 2, 60), function(x, l) plnorm(x, log(3), 0.7, l), function(x) dlnorm(x, log(3), 0.7))
of("weibull", "3, 1.8", c(1e-4, 2, 9), function(x, l) pweibull(x, 1.8, 3, l), function(x) dweibull(x, 1.8, 3))
of("exponential", "3", c(1e-4, 2, 60), function(x, l) pexp(x, 1 / 3, l), function(x) dexp(x, 1 / 3))
of("loglogistic", "3, 1.8", c(1e-4, 2, 60), function(x, l) plogis(log(x), log(3), 1 / 1.8, l),
   function(x) dlogis(log(x), log(3), 1 / 1.8) / x)
sev <- function(x, l) pexp(exp((x - 1.5) / 2), 1, l)
of("smallest_extreme_value", "1.5, 2", c(-20, 1, 6), sev, function(x) { z <- (x - 1.5) / 2; exp(z - exp(z)) / 2 })
of("largest_extreme_value", "1.5, 2", c(-4, 1, 20), function(x, l) pexp(exp(-(x - 1.5) / 2), 1, !l),
   function(x) { z <- -(x - 1.5) / 2; exp(z - exp(z)) / 2 })
of("log10_normal", "3, 0.3", c(0.05, 2, 60), function(x, l) pnorm(log10(x / 3) / 0.3, lower.tail = l),
   function(x) dlnorm(x, log(3), 0.3 * log(10)))
bs <- function(x) (sqrt(x / 3) - sqrt(3 / x)) / 0.7
of("birnbaum_saunders", "3, 0.7", c(0.3, 2, 40), function(x, l) pnorm(bs(x), lower.tail = l),
   function(x) dnorm(bs(x)) * (sqrt(x / 3) + sqrt(3 / x)) / (1.4 * x))
of("frechet", "3, 1.8", c(0.5, 2, 900), function(x, l) pexp((x / 3)^-1.8, 1, !l),
   function(x) 1.8 / x * (x / 3)^-1.8 * exp(-(x / 3)^-1.8))
ew <- function(x, l) { p <- 1.4 * pweibull(x, 1.8, 3, log.p = TRUE); if (l) exp(p) else -expm1(p) }
of("exponentiated_weibull", "3, 1.8, 1.4", c(0.01, 2, 9), ew,
   function(x) 1.4 * dweibull(x, 1.8, 3) * pweibull(x, 1.8, 3)^0.4)
of("gamma", "2.3, 3", c(0.01, 2, 90), function(x, l) pgamma(x, 2.3, scale = 3, lower.tail = l), function(x) dgamma(x, 2.3, scale = 3))
ig <- function(x, l) {
  a <- sqrt(7 / x) * (x / 3 - 1); b <- exp(2 * 7 / 3 + pnorm(-sqrt(7 / x) * (x / 3 + 1), log.p = TRUE))
  if (l) pnorm(a) + b else pnorm(a, lower.tail = FALSE) - b
}
of("inverse_gaussian", "3, 7", c(0.4, 2, 15), ig, function(x) sqrt(7 / (2 * pi * x^3)) * exp(-7 * (x - 3)^2 / (2 * 9 * x)))
gg <- function(lambda) list(
  p = function(x, l) pgamma(exp(lambda * log(x / 3) / 0.7) / lambda^2, 1 / lambda^2, lower.tail = l == (lambda > 0)),
  d = function(x) { u <- exp(lambda * log(x / 3) / 0.7) / lambda^2; dgamma(u, 1 / lambda^2) * u * abs(lambda) / (0.7 * x) })
for (lambda in c(0.6, -0.4, 2)) of("generalized_gamma", sprintf("3, 0.7, %g", lambda), c(0.4, 2, 30), gg(lambda)$p, gg(lambda)$d)
of("generalized_gamma", "3, 0.7, 0", c(0.4, 2, 30), function(x, l) plnorm(x, log(3), 0.7, l), function(x) dlnorm(x, log(3), 0.7))
of("student_t", "3.5, 1.5, 2", c(-90, 1, 40), function(x, l) pt((x - 1.5) / 2, 3.5, lower.tail = l), function(x) dt((x - 1.5) / 2, 3.5) / 2)
# Relations between life and stress (k: Boltzmann's constant in eV/K).
k <- 8.617333262e-5
heat <- function(temperature, reference, energy) exp(energy / k * (1 / temperature - 1 / reference))
relations <- c(
  "arrhenius(313.15 [K], 353.15 [K], 0.7 [eV])" = heat(313.15, 353.15, 0.7),
  "eyring(313.15 [K], 353.15 [K], 0.7 [eV])" = 353.15 / 313.15 * heat(313.15, 353.15, 0.7),
  "inverse_power(24 [kV], 30000 [V], 15.5)" = (24 / 30)^-15.5,
  "voltage_temperature(12 [V], 24 [V], 3, 313.15 [K], 353.15 [K], 0.7 [eV])" = 8 * heat(313.15, 353.15, 0.7),
  "peck(40 [%], 0.85, 2.66, 303.15 [K], 358.15 [K], 0.79 [eV])" = (40 / 85)^-2.66 * heat(303.15, 358.15, 0.79),
  "coffin_manson(35 [K], 140 [K], 2)" = 16,
  "norris_landzberg(35 [K], 100 [K], 1.9, 2 [1/day], 48 [1/day], 1/3, 333.15 [K], 373.15 [K], 0.122 [eV])" =
    (35 / 100)^-1.9 * (2 / 48)^(1 / 3) * heat(333.15, 373.15, 0.122))
for (i in seq_along(relations)) cat(sprintf('    {"%s", %.15g},\n', names(relations)[i], relations[[i]]))
