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
                             shapes = list(sigma = of_spread(), lambda = list(distribution = "normal", mean = 0, sd = 1.5))),
  `exponentiated-weibull` = list(location = "scale", slots = list(scale = "{}", shape = "slope", exponent = "exponent"),
                                 shapes = list(slope = list(distribution = "lognormal", median = 1.5, log_sd = 0.7),
                                               exponent = list(distribution = "lognormal", median = 1, log_sd = 0.7))),
  `log10-normal` = list(location = "median_life", slots = list(median = "{}", log10_sd = "log10_sd"),
                        shapes = list(log10_sd = of_spread(spread / 2.302585))),
  `log-location-scale` = list(location = "scale", slots = list(scale = "{}", sigma = "sigma"), shapes = list(sigma = of_spread())))

# Distributions of the standardized logarithm of a log-location-scale family.
standards <- c("smallest extreme value", "normal", "logistic", "largest extreme value")

require_family <- function(family, standard) {
  if (!is_path(family) || !family %in% names(life_families)) {
    stop_input("family is ", shown_value(family), "; it is one of ", words(names(life_families)))
  }
  if (family != "log-location-scale" && !is.null(standard)) {
    stop_input("standard is ", shown_value(standard), " and family is ", shown_value(family), "; standard is of family = \"log-location-scale\"")
  }
  if (family == "log-location-scale" && !isTRUE(standard %in% standards)) {
    stop_input("standard is ", shown_value(standard), "; the distribution of the standardized logarithm is one of ", words(standards))
  }
}

# Earlier names of parameters.
called_before <- list(eta = c("characteristic", "life_ref"), characteristic = "life_ref", median_life = "life_ref", mean_life = "life_ref", shape = c("slope", "alpha"), median = c("median_life", "life_ref"), mean = c("mean_life", "life_ref"), exponent = "power",
                      scale = "step_ratio")

# Under stresses the location is that at the harshest.
parameters_of_family <- function(family, stress = NULL) {
  c(if (length(stress)) "life_ref" else life_families[[family]]$location, names(life_families[[family]]$shapes))
}

# Weak priors from the size of the data: `size`, of the location, and how wide it is.
life_priors <- function(family, size, unit, log_sd = 2, location = life_families[[family]]$location) {
  c(stats::setNames(list(ww_lognormal(quantity_text(rounded_up(size), unit), log_sd = log_sd)), location), life_families[[family]]$shapes)
}

# Where that prior is centred and how wide it is, as the library proposes it (study/life_size.h): at least the largest life, or with stresses, whose
# scale is that of the harshest, the middle one.
life_size <- function(study, modes = NULL, stresses = character()) {
  lives <- study[intersect(names(study), c("life", "lower", "upper"))]
  each <- sort(unlist(lapply(lives, function(column) column$values[is.finite(column$values)]), use.names = FALSE))
  least <- if (!length(each)) 1 else if (length(stresses)) each[length(each) %/% 2 + 1] else each[length(each)]
  of <- function(name) if (study[[name]]$unit == "") name else list(column = name, unit = study[[name]]$unit)
  said <- lapply(stats::setNames(nm = intersect(c("life", "lower", "upper", "status", "count", "entry"), names(study))), of)
  if (!is.null(modes)) said$mode <- modes$name
  table <- table_of(lapply(study[unique(c(names(said)[names(said) != "mode"], modes$name, stresses))], `[[`, "values"))
  core(C_life_size, table, toml_table("", said), as.character(modes$table$runout), least, stresses)
}

# [likelihood] of a family: `middle` is an expression of its location, `index` "[group]" if shapes differ.
life_slots <- function(family, middle, index = "", standard = NULL) {
  own <- life_families[[family]]
  slots <- lapply(own$slots, function(text) {
    for (name in names(own$shapes)) text <- sub(paste0("\\b", name, "\\b"), paste0(name, index), text)
    sub("{}", middle, text, fixed = TRUE)
  })
  c(list(family = family), if (!is.null(standard)) list(standard = standard), slots)
}
