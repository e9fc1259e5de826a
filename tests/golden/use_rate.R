# Ages T = U / R of units with a life U in use and a rate of use R: P(T > t), density of T, and the share that fails
# before both an age and a use of 40, by R's integrate over the rate. Run from the project's root:
# Rscript tests/golden/use_rate.R > tests/golden/use_rate.csv
options(digits = 15)
lives <- list(
  weibull = list(S = function(u) pweibull(u, 1.6, 60, lower.tail = FALSE), f = function(u) dweibull(u, 1.6, 60)),
  lognormal = list(S = function(u) plnorm(u, log(50), 0.5, lower.tail = FALSE), f = function(u) dlnorm(u, log(50), 0.5)),
  gamma = list(S = function(u) pgamma(u, 2.5, scale = 20, lower.tail = FALSE), f = function(u) dgamma(u, 2.5, scale = 20)))
rates <- list(
  lognormal = function(r) dlnorm(r, log(1.2), 0.7),
  weibull = function(r) dweibull(r, 1.8, 1.5),
  gamma = function(r) dgamma(r, 3, scale = 0.5))
over_rates <- function(integrand, low, high) {
  # Piece by piece in log r, so that no peak is missed.
  cuts <- seq(log(low), log(high), length.out = 41)
  sum(sapply(1:40, function(i) integrate(function(w) integrand(exp(w)) * exp(w), cuts[i], cuts[i + 1],
                                         rel.tol = 1e-11, subdivisions = 1000,
                                         stop.on.error = FALSE)$value))
}
cat("life,rate,age,survival,density,within\n")
for (life in names(lives)) for (rate in names(rates)) {
  S <- lives[[life]]$S; f <- lives[[life]]$f; g <- rates[[rate]]
  for (t in c(2, 36, 300)) {
    survival <- over_rates(function(r) S(r * t) * g(r), 1e-14, 1e4)
    density <- over_rates(function(r) r * f(r * t) * g(r), 1e-14, 1e4)
    within <- over_rates(function(r) (1 - S(pmin(40, r * t))) * g(r), 1e-14, 40 / t) +
      (1 - S(40)) * over_rates(g, 40 / t, 1e5)
    cat(sprintf("%s,%s,%g,%.15g,%.15g,%.15g\n", life, rate, t, survival, density, within))
  }
}
