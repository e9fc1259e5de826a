# New lives of the rows of a fit of ww_life(), under one draw of the posterior: an independent reading of the same formula, in R.

kelvin_of <- function(x, unit) switch(unit, degC = x + 273.15, degF = (x + 459.67) * 5 / 9, x)

# The logarithm that the conditions of each row add to the location. Labels of random effects get new levels.
shift_of <- function(draw, lives) {
  shift <- numeric(lives$rows)
  for (each in lives$effects) shift <- shift + draw[[each$parameter]] * each$value
  for (each in lives$fixed) shift <- shift + each
  for (label in lives$random) {
    z <- matrix(stats::rnorm(label$levels * length(label$entries)), ncol = length(label$entries))
    if (!is.null(label$correlation)) {
      rho <- draw[[label$correlation]]
      z[, 2] <- rho * z[, 1] + sqrt(1 - rho^2) * z[, 2]
    }
    for (i in seq_along(label$entries)) {
      entry <- label$entries[[i]]
      shift <- shift + draw[[entry$scatter]] * z[label$level, i] * entry$value
    }
  }
  shift
}

# "wear" and "seal" of characteristic[wear] and characteristic[seal].
levels_among <- function(names, parameter) {
  own <- names[startsWith(names, paste0(parameter, "["))]
  substr(own, nchar(parameter) + 2, nchar(own) - 1)
}

new_lives_at <- function(draw, lives) {
  parameters <- lives$parameters
  shift <- shift_of(draw, lives)
  # Of a label of every row, such as its group.
  of <- function(parameter, label) {
    if (parameter %in% names(draw)) draw[[parameter]] else unname(draw[paste0(parameter, "[", label, "]")])
  }
  drawn_of <- function(label) {
    random_life(lives$family, stats::runif(lives$rows), of(parameters[[1]], label) * exp(shift), lapply(parameters[-1], of, label))
  }
  modes <- if (isTRUE(lives$modes)) levels_among(names(draw), parameters[[1]])
  # A part fails by the mode whose life ends first.
  drawn <- function() {
    if (!is.null(modes)) return(do.call(pmin, lapply(modes, drawn_of)))
    of_populations(draw, lives$rows, lives$populations, function(label) drawn_of(if (is.null(label)) lives$by else label))
  }
  if (is.null(lives$entry)) return(drawn())
  # Given survival to its entry: redrawn until it is.
  values <- drawn()
  for (i in seq_len(1000)) {
    early <- values <= lives$entry
    if (!any(early)) return(values)
    values[early] <- drawn()[early]
  }
  stop_input("simulate(): hardly any new life outlasts the entries of the data")
}

# The quantile of u at a location, and the family's other parameters.
random_life <- function(family, u, location, other) {
  switch(family,
    weibull = location * (-log1p(-u))^(1 / other[[1]]),
    `exponentiated-weibull` = location * (-log1p(-u^(1 / other[[2]])))^(1 / other[[1]]),
    `smallest extreme value` = location * exp(other[[1]] * log(-log1p(-u))),
    normal = location * exp(other[[1]] * stats::qnorm(u)),
    logistic = location * exp(other[[1]] * stats::qlogis(u)),
    `largest extreme value` = location * exp(-other[[1]] * log(-log(u))),
    `log10-normal` = location * 10^(other[[1]] * stats::qnorm(u)),
    lognormal = location * exp(other[[1]] * stats::qnorm(u)),
    loglogistic = location * (u / (1 - u))^(1 / other[[1]]),
    frechet = location * (-log(u))^(-1 / other[[1]]),
    exponential = -location * log1p(-u),
    gamma = stats::qgamma(u, other[[1]]) / other[[1]] * location,
    `birnbaum-saunders` = {
      w <- other[[1]] * stats::qnorm(u) / 2
      location * (w + sqrt(w^2 + 1))^2
    },
    `inverse-gaussian` = {  # Michael, Schucany and Haas 1976
      y <- stats::qnorm(u)^2
      shape <- location / other[[1]]^2
      x <- location + location^2 * y / (2 * shape) - location / (2 * shape) * sqrt(4 * location * shape * y + location^2 * y^2)
      ifelse(stats::runif(length(u)) <= location / (location + x), x, location^2 / x)
    },
    `generalized-gamma` = {
      sigma <- other[[1]]
      lambda <- rep_len(other[[2]], length(u))
      as_normal <- abs(lambda) < 1e-6
      lambda[as_normal] <- 1
      ifelse(as_normal, location * exp(sigma * stats::qnorm(u)),
             location * exp(sigma / lambda * log(lambda^2 * stats::qgamma(ifelse(lambda > 0, u, 1 - u), lambda^-2))))
    })
}
