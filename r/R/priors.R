# Priors, as [prior] of a study file has them. Their parameters are checked when the study is read.

prior <- function(distribution, ..., unit = NULL) {
  keys <- list(...)
  keys <- keys[!vapply(keys, is.null, NA)]
  keys <- Map(quantity, keys, names(keys))
  c(list(distribution = distribution), if (!is.null(unit)) list(unit = one_text(unit, "unit")), keys)
}

stop_without_unit <- function(name) {
  stop_input("unit is missing: ", name, "(unit = \"h\"), that of the parameter, or ", name, "(unit = \"1\") of a plain number")
}

ww_flat <- function(unit, lower = NULL, upper = NULL) {
  if (missing(unit)) stop_without_unit("ww_flat")
  prior("flat", lower = lower, upper = upper, unit = unit)
}

ww_uniform <- function(lower, upper) prior("uniform", lower = lower, upper = upper)

ww_normal <- function(mean, sd, lower = NULL, upper = NULL) prior("normal", mean = mean, sd = sd, lower = lower, upper = upper)

ww_lognormal <- function(median = NULL, log_sd = NULL, mean = NULL, sd = NULL, lower = NULL, upper = NULL) {
  prior("lognormal", median = median, log_sd = log_sd, mean = mean, sd = sd, lower = lower, upper = upper)
}

ww_half_normal <- function(scale, lower = NULL, upper = NULL) prior("half-normal", scale = scale, lower = lower, upper = upper)

ww_half_cauchy <- function(scale, lower = NULL, upper = NULL) prior("half-cauchy", scale = scale, lower = lower, upper = upper)

ww_exponential <- function(mean, lower = NULL, upper = NULL) prior("exponential", mean = mean, lower = lower, upper = upper)

ww_gamma <- function(shape, scale, lower = NULL, upper = NULL) {
  prior("gamma", shape = shape, scale = scale, lower = lower, upper = upper)
}

ww_inverse_gamma <- function(shape, scale, lower = NULL, upper = NULL) {
  prior("inverse-gamma", shape = shape, scale = scale, lower = lower, upper = upper)
}

ww_student_t <- function(df, location, scale, lower = NULL, upper = NULL) {
  prior("student-t", df = df, location = location, scale = scale, lower = lower, upper = upper)
}

ww_beta <- function(alpha, beta, lower = NULL, upper = NULL) prior("beta", alpha = alpha, beta = beta, lower = lower, upper = upper)

ww_jeffreys <- function(unit, lower = NULL, upper = NULL) {
  if (missing(unit)) stop_without_unit("ww_jeffreys")
  prior("jeffreys", lower = lower, upper = upper, unit = unit)
}

ww_prior <- function(distribution, ..., lower = NULL, upper = NULL, unit = NULL) prior(distribution, ..., lower = lower, upper = upper, unit = unit)

ww_default <- function() list(distribution = "default")
