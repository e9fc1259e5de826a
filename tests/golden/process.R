# Paths with random increments: maximum likelihood of gamma, inverse Gaussian and Wiener processes of the fifteen lasers
# (examples/degradation/laser.csv), and quantiles of first passages, by other ways than wearwell's: increments by dgamma and the
# density of the inverse Gaussian law, the Wiener process with noise by the dense covariance of each unit, first passages by
# uniroot.
#   Rscript tests/golden/process.R
d <- read.csv("examples/degradation/laser.csv")
units <- split(d, d$laser)
fit <- function(minus_log, start) {
  best <- optim(start, minus_log, control = list(maxit = 20000, reltol = 1e-15))
  for (i in 1:20) best <- optim(best$par, minus_log, control = list(maxit = 20000, reltol = 1e-16))
  best
}
steps <- do.call(rbind, lapply(units, function(u) data.frame(dt = diff(c(0, u$hours)), dy = diff(c(0, u$increase_percent)))))
gamma <- fit(function(p) -sum(dgamma(steps$dy, shape = exp(p[1] - p[2]) * steps$dt, scale = exp(p[2]), log = TRUE)), log(c(0.002, 0.05)))
dig <- function(x, m, lambda) 0.5 * log(lambda / (2 * pi * x^3)) - lambda * (x - m)^2 / (2 * m^2 * x)
ig <- fit(function(p) { m <- exp(p[1]) * steps$dt; -sum(dig(steps$dy, m, m^2 / exp(p[2]))) }, log(c(0.002, 0.05)))
wiener <- function(rate, scale, noise) {
  sum(sapply(units, function(u) {
    v <- rate * scale * outer(u$hours, u$hours, pmin) + diag(noise^2, nrow(u))
    l <- chol(v)
    z <- backsolve(l, u$increase_percent - rate * u$hours, transpose = TRUE)
    -sum(log(diag(l))) - 0.5 * sum(z^2) - 0.5 * nrow(u) * log(2 * pi)
  }))
}
cat("per cent and hours; log-likelihoods of readings in per cent\n")
cat(sprintf("gamma   rate %.8g scale %.8g logL %.6f\n", exp(gamma$par[1]), exp(gamma$par[2]), -gamma$value))
cat(sprintf("ig      rate %.8g scale %.8g logL %.6f\n", exp(ig$par[1]), exp(ig$par[2]), -ig$value))
cat(sprintf("wiener  rate 0.002 scale 0.05 noise 0.1 logL %.8f, without noise %.8f\n", wiener(0.002, 0.05, 0.1), wiener(0.002, 0.05, 0)))
# First passage of distance d with scale u: the mean path by then. Increasing processes are beyond d by then; of the Wiener process
# the first passage is an inverse Gaussian.
for (case in list(c(10, 0.05), c(2, 1.5), c(0.3, 2))) {
  d0 <- case[1]; u <- case[2]
  for (p in c(0.05, 0.5, 0.95)) {
    root <- function(f) uniroot(function(x) f(exp(x)) - p, log(d0) + c(-7, 5), tol = 1e-14)$root
    pig <- function(x, m, lambda) {
      pnorm(sqrt(lambda / x) * (x / m - 1)) + exp(2 * lambda / m + pnorm(-sqrt(lambda / x) * (x / m + 1), log.p = TRUE))
    }
    w <- root(function(m) pig(m, d0, d0^2 / u))
    g <- root(function(m) pgamma(d0, m / u, scale = u, lower.tail = FALSE))
    i <- root(function(m) 1 - pig(d0, m, m^2 / u))
    cat(sprintf("{%g, %g, %g, %.8g, %.8g, %.8g},\n", d0, u, p, exp(w), exp(g), exp(i)))
  }
}
