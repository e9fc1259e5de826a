# Families of lives: parameters, likelihood and default priors, those of `wearwell new`.

# The spread of ln life, pi/sqrt(6)/slope of a Weibull life, under the default prior of its slope.
spread <- 0.86
of_spread <- function(median = spread, log_sd = 0.7) list(distribution = "lognormal", median = round(median, 2), log_sd = log_sd)

# Of a family: the parameter that conditions multiply, what [likelihood] has of it ("{}"), and the parameters of its shape with their default
# priors. Names and priors are those of ww.life in Python.
life_families <- list(
  weibull = list(location = "characteristic", slots = list(scale = "{}", shape = "slope"),
                 shapes = list(slope = list(distribution = "lognormal", median = 1.5, log_sd = 0.7))),
  lognormal = list(location = "median_life", slots = list(median = "{}", log_sd = "sigma"), shapes = list(sigma = of_spread())),
  loglogistic = list(location = "median_life", slots = list(scale = "{}", shape = "shape"), shapes = list(shape = of_spread(1.8138 / spread))),
  frechet = list(location = "characteristic", slots = list(scale = "{}", shape = "slope"), shapes = list(slope = of_spread(1.2825 / spread))),
  exponential = list(location = "mean_life", slots = list(mean = "{}"), shapes = list()),
  gamma = list(location = "mean_life", slots = list(scale = "{}/shape", shape = "shape"), shapes = list(shape = of_spread(1.8, 1.2))),
  `inverse-gaussian` = list(location = "mean_life", slots = list(mean = "{}", shape = "{}/variation^2"), shapes = list(variation = of_spread())),
  `birnbaum-saunders` = list(location = "median_life", slots = list(scale = "{}", shape = "alpha"), shapes = list(alpha = of_spread())),
  `generalized-gamma` = list(location = "scale", slots = list(scale = "{}", sigma = "sigma", lambda = "lambda"),
                             shapes = list(sigma = of_spread(), lambda = list(distribution = "normal", mean = 0, sd = 1.5))))

# Earlier names of parameters.
called_before <- list(eta = "characteristic", shape = c("slope", "alpha"), median = "median_life", mean = "mean_life", exponent = "power",
                      scale = "step_ratio")

parameters_of_family <- function(family) c(life_families[[family]]$location, names(life_families[[family]]$shapes))

# Weak priors from the size of the data: `size`, of the location.
life_priors <- function(family, size, unit) {
  own <- life_families[[family]]
  c(stats::setNames(list(ww_lognormal(quantity_text(rounded_up(size), unit), log_sd = 2)), own$location), own$shapes)
}

# [likelihood] of a family: `middle` is an expression of its location, `index` "[group]" if shapes differ.
life_slots <- function(family, middle, index = "") {
  own <- life_families[[family]]
  slots <- lapply(own$slots, function(text) {
    for (name in names(own$shapes)) text <- sub(paste0("\\b", name, "\\b"), paste0(name, index), text)
    sub("{}", middle, text, fixed = TRUE)
  })
  c(list(family = family), slots)
}
