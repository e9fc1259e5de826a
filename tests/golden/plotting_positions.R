# Shares that have failed by R's survival package: Kaplan and Meier's with entries and counts, Turnbull's of intervals. The test has the
# same data.
#   Rscript tests/golden/plotting_positions.R > tests/golden/plotting_positions.csv
suppressMessages(library(survival))
cat("case,at,p\n")
put <- function(case, at, p) cat(sprintf("%s,%.17g,%.17g\n", case, at, p))
half_way <- function(case, fit) {
  steps <- fit$n.event > 0
  before <- c(1, fit$surv)[seq_along(fit$surv)]
  for (i in which(steps)) put(case, fit$time[i], 1 - (before[i] + fit$surv[i]) / 2)
}
t <- c(2, 3, 3, 5, 6, 6, 8, 11, 12, 15); s <- c(1, 1, 0, 1, 0, 1, 1, 0, 1, 0); n <- c(1, 2, 1, 1, 3, 1, 1, 4, 1, 2)
half_way("runouts", survfit(Surv(t, s) ~ 1, weights = n))
entry <- c(0, 0, 1, 2, 0, 4, 5, 0, 7, 3)
half_way("entries", survfit(Surv(entry, t, s) ~ 1, weights = n))
# NA: no end. Left-censored, intervals that overlap, exact, run-outs.
lower <- c(NA, NA, 2, 3, 4, 4, 6, 7, 9, 10, 5); upper <- c(3, 5, 5, 6, 4, 9, 8, NA, 12, NA, 7)
fit <- survfit(Surv(lower, upper, type = "interval2") ~ 1)
for (at in c(3, 4, 5, 6, 7, 8, 9, 12)) {
  here <- summary(fit, times = at, extend = TRUE)$surv
  put("intervals", at, 1 - here)
}
