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

# Weak priors from the size of the data: `size`, of the location, and how wide it is.
life_priors <- function(family, size, unit, log_sd = 2) {
  own <- life_families[[family]]
  c(stats::setNames(list(ww_lognormal(quantity_text(rounded_up(size), unit), log_sd = log_sd)), own$location), own$shapes)
}

# Where that prior is centred and how wide it is, as life_size.h of the library has it: the characteristic life by the time on test and the
# number of failures alone, with a slope of 1.5; at least the largest life, and wider the further it lies beyond.
life_size <- function(study, runouts = NULL) {
  of <- function(name, otherwise) if (is.null(study[[name]])) otherwise else study[[name]]$values
  words <- of("status", NULL)
  mode <- if (is.null(words)) of("mode", NULL)
  runs <- function(word) {
    word <- iconv(as.character(word), "UTF-8", "UTF-8", sub = "?")  # what is not UTF-8 is refused where it is read
    is.na(word) | !nzchar(word) | word %in% runouts | tolower(word) %in% c("runout", "right", "censored", "suspended")
  }
  if (is.null(study$life)) {
    upper <- of("upper", NA_real_)
    open <- is.na(upper)
    lower <- of("lower", rep(0, length(upper)))
    seen <- ifelse(open, lower, (ifelse(is.na(lower), 0, lower) + upper) / 2)
  } else {
    seen <- of("life", NULL)
    open <- rep(FALSE, length(seen))
  }
  open <- open | if (!is.null(words)) runs(words) else if (!is.null(mode)) runs(mode) else FALSE
  count <- rep_len(of("count", 1), length(seen))
  entry <- rep_len(of("entry", 0), length(seen))
  largest <- max(unlist(lapply(study[intersect(names(study), c("life", "lower", "upper"))], `[[`, "values")), na.rm = TRUE)
  modes <- of("mode", NULL)
  each <- max(1, length(unique(modes[!runs(modes)])))
  failed <- max(1, sum(count[!open], na.rm = TRUE) / each)
  estimate <- (sum(count * pmax(0, seen^1.5 - entry^1.5), na.rm = TRUE) / failed)^(1 / 1.5)
  beyond <- max(0, log(estimate / max(seen, na.rm = TRUE)))
  if (!is.finite(beyond)) return(list(median = largest, log_sd = 2))
  list(median = if (beyond > 0) max(largest, estimate) else largest, log_sd = floor(4 * sqrt(1 + beyond^2) + 0.5) / 2)
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
