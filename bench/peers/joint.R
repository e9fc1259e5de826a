# Effective draws of k per second by rstan on the joint study: 4 chains of 1000 draws after 1000 of warm-up.
# Debian: r-cran-rstan, r-cran-bh. Prints name, effective draws, seconds of sampling (summed over chains), seconds in all.
suppressMessages(library(rstan))
rstan_options(boost_lib = "/usr/include")
folder <- dirname(sub("--file=", "", grep("--file=", commandArgs(FALSE), value = TRUE)))
compile <- system.time(model <- stan_model(file.path(folder, "joint.stan")))[["elapsed"]]
data <- list(n = 5, work = c(1, 100, 1000, 5000, 10000) * 5.966,
             volume = c(4.44, 5.105, 8.825, 24.175, 45.31))
cat(sprintf("rstan %s: %.0f s to compile the model\n", packageVersion("rstan"), compile))
for (repetition in 1:5) {
  fit <- sampling(model, data, chains = 4, iter = 2000, warmup = 1000, seed = repetition, refresh = 0, cores = 1)
  k <- as.array(fit)[, , "k"]
  seconds <- get_elapsed_time(fit)
  cat(sprintf("rstan       %6.0f effective draws of k, %.4f s sampling, %.4f s with warm-up: %8.0f per second of sampling\n",
              ess_bulk(k), sum(seconds[, "sample"]), sum(seconds), ess_bulk(k) / sum(seconds[, "sample"])))
}
