# Lives of subpopulations by brute force. Rscript tests/golden/subpopulations.R
# 1. subpopulations.csv: log likelihoods of the rows of subpopulations_rows.csv, P(T > t) = (1 - d)(1 - p F(t)) (Meeker 1987), F that of a
#    Weibull and a lognormal subpopulation; probabilities are integrals of the density by stats::integrate in the logarithm of life.
# 2. examples/life/controllers.csv: simulated lives of 80 controllers, a sixth from an early subpopulation; run-outs at 30 000 h.
# 3. subpopulations_fit.csv: maximum likelihood by optim: of the Weibull mixture for these, of one Weibull, and of the limited failure
#    population of examples/life/circuits.csv (Meeker 1987).
rows <- read.csv("tests/golden/subpopulations_rows.csv")
points <- list(c(eta = 40, beta = 0.8, m = 300, s = 0.3, w = 0.3, p = 0.6, d = 0.1),
               c(eta = 150, beta = 2.5, m = 90, s = 1.2, w = 0.8, p = 0.05, d = 0.02))
density_at <- function(t, x) x["w"] * dweibull(t, x["beta"], x["eta"]) + (1 - x["w"]) * dlnorm(t, log(x["m"]), x["s"])
within <- function(a, b, x) {
  low <- if (a > 0) log(a) else log(b) - 60
  cuts <- seq(low, log(b), length.out = ceiling((log(b) - low) / 0.1) + 1)
  sum(mapply(function(u, v) integrate(function(y) density_at(exp(y), x) * exp(y), u, v, rel.tol = 1e-12)$value, head(cuts, -1), tail(cuts, -1)))
}
lasting <- function(t, x) (1 - x["d"]) * (1 - x["p"] * if (t > 0) within(0, t, x) else 0)
one <- function(r, x) {
  value <- switch(r$status,
    failure = if (r$life == 0) log(x["d"]) else log((1 - x["d"]) * x["p"] * density_at(r$life, x)),
    runout = log(lasting(r$life, x)),
    left = log(1 - lasting(r$life, x)),
    interval = log((1 - x["d"]) * x["p"] * within(r$lower, r$upper, x)))
  unname(value - if (is.na(r$entry)) 0 else log(lasting(r$entry, x)))
}
out <- do.call(rbind, lapply(seq_along(points), function(k) data.frame(point = k, row = seq_len(nrow(rows)),
  log_likelihood = sprintf("%.12f", sapply(seq_len(nrow(rows)), function(i) one(rows[i, ], points[[k]]))))))
write.csv(out, "tests/golden/subpopulations.csv", row.names = FALSE, quote = FALSE)

set.seed(20261126)
n <- 80
weak <- runif(n) < 1 / 6
life <- ifelse(weak, rweibull(n, 0.9, 900), rweibull(n, 3.5, 24000))
ran_out <- life > 30000
table <- data.frame(hours = ifelse(ran_out, 30000, signif(life, 4)), status = ifelse(ran_out, "runout", "failure"))
write.csv(table[order(table$hours), ], "examples/life/controllers.csv", row.names = FALSE, quote = FALSE)

climb <- function(start, f) {
  r <- list(par = start)
  for (i in 1:4) r <- optim(r$par, f, method = if (i %% 2) "Nelder-Mead" else "BFGS", control = list(reltol = 1e-15, maxit = 20000))
  r
}
t <- table$hours; failed <- table$status == "failure"
mixture <- function(x) {
  w <- plogis(x[1])
  f <- w * dweibull(t, exp(x[3]), exp(x[2])) + (1 - w) * dweibull(t, exp(x[5]), exp(x[4]))
  s <- w * pweibull(t, exp(x[3]), exp(x[2]), lower.tail = FALSE) + (1 - w) * pweibull(t, exp(x[5]), exp(x[4]), lower.tail = FALSE)
  -sum(log(ifelse(failed, f, s)))
}
single <- function(x) -sum(ifelse(failed, dweibull(t, exp(x[2]), exp(x[1]), log = TRUE),
                                  pweibull(t, exp(x[2]), exp(x[1]), lower.tail = FALSE, log.p = TRUE)))
circuits <- read.csv("examples/life/circuits.csv", comment.char = "#")
limited <- function(x) {
  p <- plogis(x[1])
  with(circuits, -sum(count * ifelse(status == "failure", log(p) + dweibull(hours, exp(x[3]), exp(x[2]), log = TRUE),
                                     log(1 - p * pweibull(hours, exp(x[3]), exp(x[2]))))))
}
a <- climb(c(-1.6, log(900), 0, log(24000), 1), mixture)
b <- climb(c(log(20000), 0), single)
c <- climb(c(-5, log(30), log(0.5)), limited)
fit <- rbind(data.frame(fit = "mixture", name = c("share", "eta_1", "beta_1", "eta_2", "beta_2", "log_likelihood"),
                        value = c(plogis(a$par[1]), exp(a$par[-1]), -a$value)),
             data.frame(fit = "single", name = c("eta", "beta", "log_likelihood"), value = c(exp(b$par), -b$value)),
             data.frame(fit = "limited", name = c("p", "eta", "beta", "log_likelihood"), value = c(plogis(c$par[1]), exp(c$par[-1]), -c$value)))
fit$value <- sprintf("%.9g", fit$value)
write.csv(fit, "tests/golden/subpopulations_fit.csv", row.names = FALSE, quote = FALSE)
