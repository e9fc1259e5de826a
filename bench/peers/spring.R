# Effective draws per second by rstan on case 2 of examples/spring, of the parameter with the fewest: 4 chains of 1000 draws after 1000
# of warm-up; adapt_delta as wearwell's. Debian: r-cran-rstan, r-cran-bh. The C++ side is bench/sampling_bench.cpp.
suppressMessages(library(rstan))
rstan_options(boost_lib = "/usr/include")
folder <- dirname(sub("--file=", "", grep("--file=", commandArgs(FALSE), value = TRUE)))
lives <- read.csv(file.path(folder, "..", "..", "examples", "spring", "spring_life.csv"))
compile <- system.time(model <- stan_model(file.path(folder, "spring.stan")))[["elapsed"]]
data <- list(n = nrow(lives), mean_stress = lives$mean_stress_MPa, alternating_stress = lives$alternating_stress_MPa,
             log10_life = log10(lives$life_normalized))
names <- c("log10_a", "b", "log10_Sut", "sigma")
cat(sprintf("rstan %s: %.0f s to compile the model\n", packageVersion("rstan"), compile))
for (delta in c(0.8, 0.9, 0.99)) for (seed in 1:3) {
  fit <- suppressWarnings(sampling(model, data, chains = 4, iter = 2000, warmup = 1000, seed = seed, refresh = 0, cores = 1,
                                   control = list(adapt_delta = delta)))
  draws <- as.array(fit)
  effective <- min(sapply(names, function(name) ess_bulk(draws[, , name])))
  seconds <- get_elapsed_time(fit)
  cat(sprintf("rstan       adapt_delta %.2f: %6.0f effective draws, %.3f s sampling, %.3f s with warm-up: %8.0f per second of sampling; %d divergent, mean log10_Sut %.3f\n",
              delta, effective, sum(seconds[, "sample"]), sum(seconds), effective / sum(seconds[, "sample"]),
              get_num_divergent(fit), mean(draws[, , "log10_Sut"])))
}
