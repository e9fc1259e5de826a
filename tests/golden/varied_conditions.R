# Survival of units whose conditions of use differ, each with its own for life: integrals over the conditions by stats::integrate.
# Rscript tests/golden/varied_conditions.R
# Weibull lives, Arrhenius with inverse power: scale = 2e4 h exp(E/k (1/T - 1/313.15 K)) (V/400)^-n, E = 0.7 eV, n = 4.
boltzmann <- 8.617333262e-5
scale_at <- function(temperature, voltage) 2e4 * exp(0.7 / boltzmann * (1 / temperature - 1 / 313.15)) * (voltage / 400)^-4
lasting <- function(t, temperature, voltage, shape) exp(-(t / scale_at(temperature, voltage))^shape)
over <- function(f, low, high) {
  cuts <- seq(low, high, length.out = 61)
  sum(mapply(function(a, b) integrate(f, a, b, rel.tol = 1e-12)$value, head(cuts, -1), tail(cuts, -1)))
}
normal <- function(t, shape) over(function(z) dnorm(z) * lasting(t, 313.15 + 5 * z, 400, shape), -9, 9)
bounded <- function(t, shape) {
  mass <- pnorm(3) - pnorm(-2)
  over(function(z) dnorm(z) / mass * lasting(t, 313.15 + 5 * z, 400, shape), -2, 3)
}
uniform <- function(t, shape) over(function(x) lasting(t, x, 400, shape) / 20, 303.15, 323.15)
lognormal <- function(t, shape) over(function(z) dnorm(z) * lasting(t, 313.15, 400 * exp(0.2 * z), shape), -9, 9)
both <- function(t, shape)
  over(function(z) dnorm(z) * sapply(z, function(one)
    over(function(y) dnorm(y) * lasting(t, 313.15 + 5 * one, 400 * exp(0.2 * y), shape), -8, 8)), -8, 8)
rows <- NULL
for (name in c("normal", "bounded", "uniform", "lognormal", "both")) for (shape in c(1.5, 8)) for (t in c(2000, 15000, 40000))
  rows <- rbind(rows, data.frame(case = name, shape = shape, hours = t, survival = sprintf("%.12g", get(name)(t, shape))))
write.csv(rows, "tests/golden/varied_conditions.csv", row.names = FALSE, quote = FALSE)
