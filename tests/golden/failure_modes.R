# Log likelihoods of competing failure modes by brute force: the density of a failure by one mode is its density times the
# survival of the others (Meeker and Escobar 1998, sec. 15.4), integrated over intervals by stats::integrate in the logarithm of life.
# Writes failure_modes.csv. Rscript tests/golden/failure_modes.R
modes <- list(
  a = list(d = function(t, p) dweibull(t, p[2], p[1], log = TRUE), s = function(t, p) pweibull(t, p[2], p[1], lower.tail = FALSE, log.p = TRUE)),
  b = list(d = function(t, p) dlnorm(t, log(p[1]), p[2], log = TRUE), s = function(t, p) plnorm(t, log(p[1]), p[2], lower.tail = FALSE, log.p = TRUE)),
  c = list(d = function(t, p) dweibull(t, p[2], p[1], log = TRUE), s = function(t, p) pweibull(t, p[2], p[1], lower.tail = FALSE, log.p = TRUE)))
points <- list(list(a = c(180, 0.7), b = c(150, 0.4), c = c(160, 8)), list(a = c(400, 1.6), b = c(90, 1.1), c = c(110, 12)))
rows <- read.csv("tests/golden/failure_modes_rows.csv", colClasses = c(mode = "character"))

survival <- function(t, p) if (t <= 0) 0 else sum(sapply(names(modes), function(m) modes[[m]]$s(t, p[[m]])))
density <- function(m, p) function(t) exp(Reduce(`+`, lapply(setdiff(names(modes), m), function(k) modes[[k]]$s(t, p[[k]])), modes[[m]]$d(t, p[[m]])))
within <- function(m, p, from, until) {
  low <- if (from > 0) log(from) else log(until) - 60  # what lies below is less than 1e-18
  cuts <- seq(low, log(until), length.out = max(2, ceiling((log(until) - low) / 0.05) + 1))
  f <- density(m, p)
  sum(mapply(function(a, b) integrate(function(v) f(exp(v)) * exp(v), a, b, rel.tol = 1e-12, subdivisions = 1000)$value,
             head(cuts, -1), tail(cuts, -1)))
}
one <- function(r, p) {
  names_of <- if (is.na(r$mode) || r$mode == "") names(modes) else strsplit(r$mode, "|", fixed = TRUE)[[1]]
  entered <- if (is.na(r$entry)) 0 else survival(r$entry, p)
  value <- switch(r$status,
    runout = survival(r$life, p),
    failure = log(sum(sapply(names_of, function(m) density(m, p)(r$life)))),
    left = log(sum(sapply(names_of, within, p, 0, r$life))),
    interval = log(sum(sapply(names_of, within, p, r$lower, r$upper))))
  value - entered
}
out <- do.call(rbind, lapply(seq_along(points), function(k) data.frame(point = k, row = seq_len(nrow(rows)),
  value = sapply(seq_len(nrow(rows)), function(i) one(rows[i, ], points[[k]])))))
out$value <- sprintf("%.13g", out$value)
write.csv(out, "tests/golden/failure_modes.csv", row.names = FALSE, quote = FALSE)

# Maximum likelihood by mode, failures by others as run-outs: printed, for comparison with failure_modes_test.cpp.
fit <- function(t, failed) {
  nll <- function(p) -sum(ifelse(failed, dweibull(t, exp(p[2]), exp(p[1]), log = TRUE), pweibull(t, exp(p[2]), exp(p[1]), lower.tail = FALSE, log.p = TRUE)))
  o <- optim(optim(c(log(mean(t)), 0), nll)$par, nll, method = "BFGS", control = list(reltol = 1e-15, maxit = 1000))
  c(scale = exp(o$par[1]), shape = exp(o$par[2]), mu = o$par[1], sigma = exp(-o$par[2]), log_likelihood = -o$value)
}
shocks <- read.csv("examples/life/shock_absorbers.csv")
device <- read.csv("tests/golden/device_g.csv")
print(rbind(mode_1 = fit(shocks$km, shocks$failure.mode == "mode 1"), mode_2 = fit(shocks$km, shocks$failure.mode == "mode 2"),
            surge = fit(device$kilocycles, device$cause == "S"), wear = fit(device$kilocycles, device$cause == "W")), digits = 9)
