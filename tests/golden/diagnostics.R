# Makes diagnostics.csv, chains of many kinds, and diagnostics_expected.csv, what the R package
# posterior 1.4.0 says of them (Debian 12: apt-get install r-cran-posterior). Run in this folder:
#   Rscript diagnostics.R
suppressMessages(library(posterior))
stopifnot(packageVersion("posterior") == "1.4.0")
set.seed(20240607, kind = "Mersenne-Twister", normal.kind = "Inversion", sample.kind = "Rejection")

# Chains in the columns. AR(1) with unit variance, started in its stationary distribution.
ar1 <- function(draws, chains, rho) {
  replicate(chains, {
    x <- numeric(draws)
    x[1] <- rnorm(1)
    for (i in seq_len(draws)[-1]) x[i] <- rho * x[i - 1] + sqrt(1 - rho^2) * rnorm(1)
    x
  })
}
normal <- function(draws, chains) matrix(rnorm(draws * chains), draws)

metropolis <- function(draws) {
  x <- numeric(draws)
  for (i in seq_len(draws)[-1]) {
    y <- x[i - 1] + runif(1, -5, 5)
    x[i] <- if (log(runif(1)) < (x[i - 1]^2 - y^2) / 2) y else x[i - 1]
  }
  x
}

cases <- list(
  independent = normal(200, 4),
  one_chain = normal(200, 1),
  ar_050 = ar1(200, 4, 0.5),
  ar_095 = ar1(500, 4, 0.95),
  ar_minus_030 = ar1(200, 4, -0.3),
  ar_minus_090 = ar1(200, 4, -0.9),
  random_walk = apply(normal(150, 4), 2, cumsum),
  cauchy = matrix(rcauchy(800), 200),
  lognormal_ar = exp(3 * ar1(151, 3, 0.7)),
  shifted = sweep(normal(150, 4), 2, c(0, 0, 0, 1), "+"),
  wider = sweep(normal(150, 4), 2, c(1, 1, 1, 3), "*"),
  one_chain_stuck = {
    x <- normal(100, 4)
    x[, 3] <- 0.5
    x
  },
  metropolis = replicate(4, metropolis(200)),
  poisson = matrix(rpois(400, 3), 100),
  two_values = matrix(rep(c(-1, 1), 100), 50),
  two_values_unequal = matrix(rbinom(400, 1, 0.3), 100),
  constant = matrix(2.5, 20, 4),
  far_from_zero = 293.15 + 1e-3 * ar1(150, 4, 0.5),
  large = 1e12 * ar1(100, 2, 0.5),
  odd = ar1(101, 3, 0.3),
  draws_4 = normal(4, 4),
  draws_5 = normal(5, 4),
  draws_6 = normal(6, 4),
  draws_7 = normal(7, 4),
  draws_11 = normal(11, 4),
  draws_12 = normal(12, 4),
  draws_13 = normal(13, 4),
  draws_25 = normal(25, 2)
)

written <- function(x) formatC(x, digits = 9, format = "g", width = 1)
full <- function(x) ifelse(is.na(x), "nan", formatC(x, digits = 17, format = "g", width = 1))

draws <- expected <- character()
for (name in names(cases)) {
  text <- apply(cases[[name]], 2, written)
  draws <- c(draws, apply(text, 2, function(chain) paste(c(name, chain), collapse = ",")))
  # What a reader of the file sees, to the last bit.
  x <- matrix(as.numeric(text), nrow(text))
  numbers <- suppressWarnings(c(
    rhat = rhat(x), ess_bulk = ess_bulk(x), ess_tail = ess_tail(x),
    ess_mean = ess_mean(x), ess_sd = ess_sd(x),
    ess_q10 = unname(ess_quantile(x, 0.1)),
    mcse_mean = mcse_mean(x), mcse_sd = mcse_sd(x),
    setNames(mcse_quantile(x, c(0.05, 0.5, 0.95)), c("mcse_q05", "mcse_q50", "mcse_q95"))
  ))
  if (!length(expected)) expected <- paste(c("case", names(numbers)), collapse = ",")
  expected <- c(expected, paste(c(name, full(numbers)), collapse = ","))
}
writeLines(draws, "diagnostics.csv")  # one chain a line: case, then its draws
writeLines(expected, "diagnostics_expected.csv")
