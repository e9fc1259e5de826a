# Classical estimates of lives of which a share can fail, and of two subpopulations, by optim and numDeriv: estimates, standard errors, normal and
# likelihood-ratio bounds (90 %, two-sided) on the scale of each normal approximation. Of examples/life/circuits.csv (Meeker 1987) and
# examples/life/controllers.csv. A profile solves for one parameter in closed form. Writes classical_mixtures.csv.
# Rscript tests/golden/classical_mixtures.R
z <- qnorm(0.95)
out <- "tests/golden/classical_mixtures.csv"
cat("case,what,estimate,error,normal_lower,normal_upper,ratio_lower,ratio_upper\n", file = out)
climb <- function(start, f) {
  r <- list(par = start)
  for (i in 1:8) r <- optim(r$par, f, method = if (i %% 2) "Nelder-Mead" else "BFGS", control = list(reltol = 1e-16, maxit = 20000))
  r
}
# `loss` of x; `quantity(x)`; `with(x, q)`: x with its element `solved` such that the quantity is q.
put <- function(case, what, best, loss, quantity, with, solved) {
  v <- solve(numDeriv::hessian(loss, best$par))
  g <- numDeriv::grad(quantity, best$par)
  at <- quantity(best$par); se <- sqrt(drop(g %*% v %*% g))
  fall <- function(q, from) {
    loss_at <- function(others) {
      x <- with(append(others, NA, solved - 1), q)
      if (anyNA(x)) return(1e10)
      value <- loss(x)
      if (is.finite(value)) value else 1e10
    }
    # A profile can have several branches: the highest of some searches counts.
    starts <- c(list(from), lapply(c(-1, 1), function(by) best$par + by * sqrt(diag(v)) * rep_len(c(1, -1, 1), length(best$par))))
    searches <- lapply(starts, function(start) climb(start[-solved], loss_at))
    r <- searches[[which.min(sapply(searches, `[[`, "value"))]]
    list(root = sqrt(2 * max(0, r$value - best$value)), x = append(r$par, 0, solved - 1))
  }
  end <- function(side) {  # outward in steps, then by bisection of secants
    low <- at; from <- best$par; step <- side * se * z / 2
    repeat {
      high <- low + step
      f <- fall(high, from)
      if (f$root > z) break
      from <- f$x; low <- high
      if (abs(high - at) > 40 * se) return(NA)
    }
    uniroot(function(q) fall(q, from)$root - z, sort(c(low, high)), tol = 1e-9 * abs(step))$root
  }
  cat(sprintf("%s,%s,%s\n", case, what, paste(sprintf("%.10g", c(at, se, at - z * se, at + z * se, end(-1), end(1))), collapse = ",")), file = out, append = TRUE)
}
parameter <- function(i) list(quantity = function(x) x[i], with = function(x, q) replace(x, i, q), solved = i)

# ln eta, ln beta, logit p
circuits <- read.csv("examples/life/circuits.csv", comment.char = "#")
limited <- function(x) {
  p <- plogis(x[3])
  with(circuits, -sum(count * ifelse(status == "failure", log(p) + dweibull(hours, exp(x[2]), exp(x[1]), log = TRUE),
                                     log1p(-p * pweibull(hours, exp(x[2]), exp(x[1]))))))
}
best <- climb(c(log(30), log(0.5), -5), limited)
for (i in 1:3) do.call(put, c(list("circuits", c("eta", "beta", "p")[i], best, limited), parameter(i)))
failed <- function(x, t) plogis(x[3]) * pweibull(t, exp(x[2]), exp(x[1]))
share_of <- function(x, t, failed) { p <- failed / pweibull(t, exp(x[2]), exp(x[1])); replace(x, 3, if (p > 0 && p < 1) qlogis(p) else NA) }
put("circuits", "log B0.5", best, limited, function(x) log(qweibull(0.005 / plogis(x[3]), exp(x[2]), exp(x[1]))),
    function(x, q) share_of(x, exp(q), 0.005), 3)
put("circuits", "survival to 100", best, limited, function(x) log(-log1p(-failed(x, 100))), function(x, q) share_of(x, 100, -expm1(-exp(q))), 3)

# logit w, ln eta_1, ln beta_1, ln eta_2, ln beta_2
table <- read.csv("examples/life/controllers.csv")
t <- table$hours; ended <- table$status == "failure"
# The order of the median lives, as a factor (life.md): 20 is its sharpness.
order_of <- function(x) -log1p(exp(20 * (x[2] - x[4] + log(log(2)) * (exp(-x[3]) - exp(-x[5])))))
mixture <- function(x) {
  w <- plogis(x[1])
  f <- w * dweibull(t, exp(x[3]), exp(x[2])) + (1 - w) * dweibull(t, exp(x[5]), exp(x[4]))
  s <- w * pweibull(t, exp(x[3]), exp(x[2]), lower.tail = FALSE) + (1 - w) * pweibull(t, exp(x[5]), exp(x[4]), lower.tail = FALSE)
  -sum(log(ifelse(ended, f, s))) - order_of(x)
}
best <- climb(c(-2.2, log(670), log(0.7), log(24000), log(3.3)), mixture)
names <- c("w", "eta[early]", "beta[early]", "eta[late]", "beta[late]")
for (i in 1:5) do.call(put, c(list("controllers", names[i], best, mixture), parameter(i)))
share <- function(x, t) plogis(x[1]) * pweibull(t, exp(x[3]), exp(x[2])) + plogis(-x[1]) * pweibull(t, exp(x[5]), exp(x[4]))
weight_of <- function(x, t, failed) {
  early <- pweibull(t, exp(x[3]), exp(x[2])); late <- pweibull(t, exp(x[5]), exp(x[4]))
  w <- (failed - late) / (early - late)
  replace(x, 1, if (is.finite(w) && w > 0 && w < 1) qlogis(w) else NA)
}
put("controllers", "log B10", best, mixture, function(x) uniroot(function(l) share(x, exp(l)) - 0.1, log(c(1, 1e6)), tol = 1e-13)$root,
    function(x, q) weight_of(x, exp(q), 0.1), 1)
put("controllers", "survival to 10000", best, mixture, function(x) log(-log1p(-share(x, 10000))), function(x, q) weight_of(x, 10000, -expm1(-exp(q))), 1)
