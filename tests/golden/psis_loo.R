# Pareto-smoothed importance sampling by the R package loo (2.5.1, Debian: r-cran-loo), on draws and likelihoods that have a formula:
# draw s of S is the normal quantile at (s - 1/2)/S times `spread`, observation y has the density of N(draw, 1).
# Run from the project's root:  Rscript tests/golden/psis_loo.R > tests/golden/psis_loo.csv
suppressMessages(library(loo))
cat("draws,spread,y,elpd,lpd,khat\n")
for (S in c(100, 1000, 4000)) for (spread in c(0.3, 0.9, 2)) {
  mu <- spread * qnorm((seq_len(S) - 0.5) / S)
  y <- c(0, 0.5, 1, 2, 4)
  ll <- sapply(y, function(each) dnorm(each, mu, 1, log = TRUE))
  fit <- suppressWarnings(loo(ll, r_eff = rep(1, length(y))))
  for (i in seq_along(y)) cat(sprintf("%d,%.1f,%.1f,%.12g,%.12g,%.12g\n", S, spread, y[i], fit$pointwise[i, "elpd_loo"],
    log(mean(exp(ll[, i]))), fit$diagnostics$pareto_k[i]))
}
