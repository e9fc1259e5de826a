# Maximum likelihood estimates of R's survival package, which lifelines' fitters maximize too, of the tables of these tests:
#   Rscript python/tests/peers/peers.R > python/tests/peers/peers.csv
library(survival)
here <- dirname(sub("--file=", "", grep("--file=", commandArgs(), value = TRUE)))
pumps <- read.csv(file.path(here, "pumps.csv"))
bearings <- read.csv(file.path(here, "../../../examples/life/bearings.csv"))
devices <- read.csv(file.path(here, "../../../examples/accelerated/device_a.csv"))
cat("task,parameter,value\n")
say <- function(task, ...) for (name in names(list(...))) cat(sprintf("%s,%s,%.8g\n", task, name, list(...)[[name]]))
tight <- survreg.control(rel.tolerance = 1e-12, maxiter = 200)
weibull <- function(task, fit, more = list())
  do.call(say, c(list(task, characteristic = exp(unname(coef(fit)[1])), slope = 1 / fit$scale), more))

weibull("complete", survreg(Surv(million_revolutions) ~ 1, bearings, dist = "weibull", control = tight))
censored <- Surv(pumps$hours, pumps$failed)
weibull("censored", survreg(censored ~ 1, dist = "weibull", control = tight))
fit <- survreg(censored ~ 1, dist = "lognormal", control = tight)
say("lognormal", median_life = exp(unname(coef(fit))), sigma = fit$scale)
fit <- survreg(censored ~ 1, dist = "loglogistic", control = tight)
say("loglogistic", median_life = exp(unname(coef(fit))), shape = 1 / fit$scale)
fit <- survreg(censored ~ 1, dist = "exponential", control = tight)
say("exponential", mean_life = exp(unname(coef(fit))))
weibull("interval", survreg(Surv(last_ok, first_failed, type = "interval2") ~ 1, pumps, dist = "weibull", control = tight))
# survreg takes no late entry: the likelihood of a Weibull life, given survival to the entry.
loss <- function(p) {
  z <- function(t) (t / exp(p[1]))^exp(p[2])
  -sum(pumps$failed * (p[2] - p[1] + (exp(p[2]) - 1) * (log(pumps$hours) - p[1])) - z(pumps$hours) + z(pumps$since))
}
p <- optim(c(6.5, 0.5), loss, control = list(reltol = 1e-15, maxit = 5000))$par
say("entry", characteristic = exp(p[1]), slope = exp(p[2]))
counts <- data.frame(hours = c(300, 500, 700), failed = c(1, 1, 0), count = c(4, 6, 20))
weibull("counts", survreg(Surv(hours, failed) ~ 1, counts, weights = count, dist = "weibull", control = tight))
groups <- survreg(Surv(hours, failed) ~ 0 + supplier, pumps, dist = "weibull", control = tight)
do.call(say, c(list("groups"), setNames(as.list(c(exp(coef(groups)), 1 / groups$scale)), c("characteristic[A]", "characteristic[B]", "slope"))))
boltzmann <- 8.617333262e-5
devices$x <- 1 / (boltzmann * (devices$temperature_C + 273.15)) - 1 / (boltzmann * (80 + 273.15))
fit <- survreg(Surv(hours, status == "failure") ~ x, devices, weights = count, dist = "lognormal", control = tight)
say("arrhenius", life_ref = exp(unname(coef(fit)[1])), energy = unname(coef(fit)[2]), sigma = fit$scale)
