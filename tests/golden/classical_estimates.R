# Classical estimates of lives by R's survival package: maximum likelihood with normal and likelihood-ratio bounds, median rank regression,
# Kaplan and Meier's survival with log-log bounds. Of the 23 ball bearings (Lieblein and Zelen 1956) and the 38 shock absorbers (O'Connor 1985,
# in Meeker and Escobar 1998), both modes together; of lives with left, interval and right censoring and of counts.
# Writes classical_estimates.csv and survival_bands.csv. Rscript tests/golden/classical_estimates.R
suppressMessages(library(survival))
level <- 0.9
z <- qnorm((1 + level) / 2)

# A profile over mu + h sigma = value, h the standard quantile: survreg with the offset and sigma free; the fall from the maximum is its root.
loglik <- function(y, w, dist, mu, sigma) {
  d <- switch(dist, weibull = list(F = function(u) 1 - exp(-exp(u)), S = function(u) exp(-exp(u)), f = function(u) exp(u - exp(u))),
              lognormal = list(F = pnorm, S = function(u) pnorm(-u), f = dnorm))
  at <- function(t) (log(t) - mu) / sigma
  term <- ifelse(y$kind == "exact", log(d$f(at(y$a))) - log(sigma) - log(y$a),
          ifelse(y$kind == "right", log(d$S(at(y$a))),
          ifelse(y$kind == "left", log(d$F(at(y$b))), log(d$F(at(y$b)) - d$F(at(y$a))))))
  sum(w * term)
}
estimates <- function(case, y, w, dist, survive) {
  surv <- Surv(ifelse(y$kind == "left", NA, y$a), ifelse(y$kind == "right", NA, ifelse(y$kind == "exact", y$a, y$b)), type = "interval2")
  fit <- survreg(surv ~ 1, weights = w, dist = dist, control = survreg.control(rel.tolerance = 1e-14, maxiter = 100))
  mu <- unname(coef(fit)); sigma <- fit$scale
  v <- fit$var  # of mu and log sigma
  most <- loglik(y, w, dist, mu, sigma)
  # bounds of mu + h sigma
  quantile_bounds <- function(h) {
    se <- sqrt(c(1, h * sigma) %*% v %*% c(1, h * sigma))[1]
    at <- mu + h * sigma
    best <- function(q) -optimize(function(ls) -loglik(y, w, dist, q - h * exp(ls), exp(ls)), log(sigma) + c(-3, 3), tol = 1e-12)$objective
    root <- function(to) uniroot(function(q) 2 * (most - best(q)) - z^2, c(at, to), tol = 1e-12)$root
    c(at, se, at - z * se, at + z * se, root(at - 6 * se), root(at + 6 * se))
  }
  sigma_bounds <- function() {
    se <- sqrt(v[2, 2])
    best <- function(ls) -optimize(function(m) -loglik(y, w, dist, m, exp(ls)), mu + c(-6, 6) * sqrt(v[1, 1]), tol = 1e-12)$objective
    root <- function(to) uniroot(function(ls) 2 * (most - best(ls)) - z^2, c(log(sigma), to), tol = 1e-12)$root
    c(log(sigma), se, log(sigma) - z * se, log(sigma) + z * se, root(log(sigma) - 5 * se), root(log(sigma) + 6 * se))
  }
  # survival to t: bounds of (log t - mu)/sigma
  survival_bounds <- function(t) {
    u <- (log(t) - mu) / sigma
    g <- c(-1 / sigma, -u)
    se <- sqrt(g %*% v %*% g)[1]
    best <- function(u) -optimize(function(ls) -loglik(y, w, dist, log(t) - u * exp(ls), exp(ls)), log(sigma) + c(-3, 3), tol = 1e-12)$objective
    root <- function(to) uniroot(function(u) 2 * (most - best(u)) - z^2, c(u, to), tol = 1e-12)$root
    c(u, se, u - z * se, u + z * se, root(u - 6 * se), root(u + 6 * se))
  }
  put <- function(what, b) cat(sprintf("%s,%s,%s\n", case, what, paste(sprintf("%.10g", b), collapse = ",")), file = out, append = TRUE)
  q <- if (dist == "weibull") function(p) log(-log(1 - p)) else qnorm
  put("loglik", c(most, 0, 0, 0, 0, 0))
  put("location", quantile_bounds(0))
  put("log scale", sigma_bounds())
  put("log B10", quantile_bounds(q(0.1)))
  put("survival deviate", survival_bounds(survive))
}
out <- "tests/golden/classical_estimates.csv"
cat("case,what,estimate,error,normal_lower,normal_upper,ratio_lower,ratio_upper\n", file = out)
exact <- function(t) data.frame(kind = "exact", a = t, b = t)
bearings <- read.csv("examples/life/bearings.csv")$million_revolutions
estimates("bearings weibull", exact(bearings), rep(1, 23), "weibull", 20)
estimates("bearings lognormal", exact(bearings), rep(1, 23), "lognormal", 20)
shocks <- read.csv("examples/life/shock_absorbers.csv", check.names = FALSE)
failed <- shocks[["failure mode"]] != "censored"
estimates("shocks weibull", data.frame(kind = ifelse(failed, "exact", "right"), a = shocks$km, b = shocks$km), rep(1, 38), "weibull", 10000)
mixed <- data.frame(kind = c("left", "interval", "interval", "exact", "right", "right"), a = c(NA, 100, 200, 260, 300, 500), b = c(100, 200, 300, 260, NA, NA))
estimates("mixed weibull", mixed, c(2, 3, 4, 1, 5, 3), "weibull", 150)

bands <- "tests/golden/survival_bands.csv"
cat("case,at,at_risk,failed,survival,error,lower,upper\n", file = bands)
put_bands <- function(case, fit) {
  for (i in which(fit$n.event > 0 & fit$surv > 0))
    cat(sprintf("%s,%.17g,%.17g,%.17g,%.12g,%.12g,%.12g,%.12g\n", case, fit$time[i], fit$n.risk[i], fit$n.event[i], fit$surv[i],
                fit$surv[i] * fit$std.err[i], fit$lower[i], fit$upper[i]), file = bands, append = TRUE)
}
t <- c(2, 3, 3, 5, 6, 6, 8, 11, 12, 15); s <- c(1, 1, 0, 1, 0, 1, 1, 0, 1, 0); n <- c(1, 2, 1, 1, 3, 1, 1, 4, 1, 2)
long <- rep(seq_along(t), n)
put_bands("runouts", survfit(Surv(t[long], s[long]) ~ 1, conf.int = level, conf.type = "log-log"))
entry <- c(0, 0, 1, 2, 0, 4, 5, 0, 7, 3)
put_bands("entries", survfit(Surv(entry[long], t[long], s[long]) ~ 1, conf.int = level, conf.type = "log-log"))
put_bands("shocks", survfit(Surv(shocks$km, failed) ~ 1, conf.int = level, conf.type = "log-log"))
