# Maximum likelihood of the ramp test of examples/accelerated/ramp.csv by base R 4.2.2: exposure by integrate, Weibull lives.
#   Rscript tests/golden/ramp.R
data <- read.csv("examples/accelerated/ramp.csv")
names(data) <- c("specimen", "hours", "rate", "result")
exposure <- function(t, rate, life, n) integrate(function(u) (((5 + rate * u) / 10)^n) / life, 0, t, rel.tol = 1e-12)$value
log_likelihood <- function(p) {
  life <- exp(p[1]); n <- p[2]; shape <- exp(p[3])
  sum(mapply(function(t, rate, result) {
    w <- exposure(t, rate, life, n)
    if (result == "failed") dweibull(w, shape, log = TRUE) + n * log((5 + rate * t) / 10) - log(life) else -w^shape
  }, data$hours, data$rate, data$result))
}
fit <- optim(c(log(1000), 10, 0), function(p) -log_likelihood(p), method = "BFGS", control = list(reltol = 1e-15, maxit = 1000))
fit <- optim(fit$par, function(p) -log_likelihood(p), method = "Nelder-Mead", control = list(reltol = 1e-15, maxit = 5000))
cat(sprintf("life_10 %.10g h, n %.10g, shape %.10g, log-likelihood %.10g\n", exp(fit$par[1]), fit$par[2], exp(fit$par[3]), -fit$value))
