# Gradients per second by rstan of the two likelihoods of bench/formula_bench.cpp: a Weibull regression of 1000 rows, and 50 machines x 20
# readings, in processor time. Debian: r-cran-rstan, r-cran-bh. The time of a call of R alone is that of the same model with two rows; it is told beside.
suppressMessages(library(rstan))
rstan_options(boost_lib = "/usr/include")
weibull <- "
data { int n; vector[n] t; vector[n] x1; vector[n] x2; }
parameters { real m; real b0; real b1; real b2; }
model { target += weibull_lpdf(t | m, exp(b0 + b1 * x1 + b2 * x2)); }"
hierarchy <- "
data { int n; int machines; int machine[n]; vector[n] y; vector[n] x; }
parameters { real mu; real tau; real sigma; vector[machines] z; }
model {
  vector[machines] k = exp(mu + tau * z);
  target += normal_lpdf(y | k[machine] .* x, sigma);
}"
weibull_data <- function(n) {
  x1 <- runif(n, -1, 1); x2 <- runif(n, -1, 1)
  list(n = n, x1 = x1, x2 = x2, t = rweibull(n, 2, exp(1 + 0.5 * x1 - 0.3 * x2)))
}
hierarchy_data <- function(machines, readings) {
  n <- machines * readings
  machine <- rep(seq_len(machines), each = readings)
  x <- runif(n, 0.1, 1.1)
  list(n = n, machines = machines, machine = machine, x = x, y = exp(0.2 + 0.4 * rnorm(machines))[machine] * x + rnorm(n, 0, 0.1))
}
seconds <- function(model, data, at) {
  fit <- suppressWarnings(sampling(model, data, chains = 1, iter = 2, warmup = 1, refresh = 0, init = list(at), cores = 1))
  instance <- fit@.MISC$stan_fit_instance
  upars <- unlist(at)
  repetitions <- 20000
  best <- Inf
  for (repetition in 1:5)
    best <- min(best, system.time(for (i in seq_len(repetitions)) instance$grad_log_prob(upars, FALSE))[["user.self"]] / repetitions)
  best
}
report <- function(name, code, data, few, at, at_few) {
  compile <- system.time(model <- stan_model(model_code = code))[["elapsed"]]
  whole <- seconds(model, data, at)
  call <- seconds(model, few, at_few)
  cat(sprintf("rstan %s, %s: %.0f s to compile, %.1f us a gradient, of which %.1f us the call: %.0f gradients per second without it\n",
              packageVersion("rstan"), name, compile, 1e6 * whole, 1e6 * call, 1 / (whole - call)))
}
set.seed(1)
report("weibull", weibull, weibull_data(1000), weibull_data(2), list(m = 2, b0 = 1, b1 = 0.5, b2 = -0.3),
       list(m = 2, b0 = 1, b1 = 0.5, b2 = -0.3))
report("hierarchy", hierarchy, hierarchy_data(50, 20), hierarchy_data(50, 1), list(mu = 0.2, tau = 0.4, sigma = 0.1, z = rnorm(50)),
       list(mu = 0.2, tau = 0.4, sigma = 0.1, z = rnorm(50)))
