# Lives beyond one distribution that begins at 0: thresholds, shares of parts that can fail or are dead on arrival, subpopulations.

names_of_populations <- list(c("early", "late"), c("early", "middle", "late"), c("first", "second", "third", "fourth"))

# Their names in the order of their median lives; none where there is one population.
population_names <- function(subpopulations) {
  if (is.null(subpopulations)) return(NULL)
  if (is.character(subpopulations) && length(subpopulations) %in% 2:4 && !anyNA(subpopulations)) return(subpopulations)
  if (is.numeric(subpopulations) && length(subpopulations) == 1 && subpopulations %in% 2:4) return(names_of_populations[[subpopulations - 1]])
  stop_input("subpopulations is ", shown_value(subpopulations), "; it is 2, 3 or 4, or as many names in the order of their median lives, like c(\"early\", \"wear-out\")")
}

# Whether a share is asked for: TRUE, or a known number.
is_asked <- function(value, name) {
  if (isTRUE(value) || is.null(value) || isFALSE(value)) return(isTRUE(value))
  if (is.numeric(value) && length(value) == 1 && isTRUE(value >= 0 && value <= 1)) return(TRUE)
  stop_input(name, " is ", shown_value(value), "; it is TRUE, for a share with a prior, or a known share from 0 to 1")
}

refuse_beside <- function(shares, populations, by, modes, random) {
  units <- length(random$labels) > 0
  if (length(populations)) {
    if (!is.null(by)) stop_input("by and subpopulations: each group has its own scale, and a subpopulation is not known of a part; leave one out")
    if (!is.null(modes)) stop_input("mode and subpopulations: a failure mode is known of a part, a subpopulation is not; leave one out")
    if (units) stop_input("subpopulations have no random effects; leave out (1 | ...), or subpopulations")
  }
  asked <- names(shares)[vapply(names(shares), function(name) is_asked(shares[[name]], name), NA)]
  if (!length(asked)) return()
  if (!is.null(modes)) stop_input("mode and ", asked[1], ": failure modes have no such share; leave one out")
  if (units) stop_input(asked[1], ": lives with random effects have no such share; leave out (1 | ...), or ", asked[1])
}

# What these add to a study: keys of [likelihood], priors, constants, [subpopulations]. `study`: the columns, of which lives have `unit`.
further_of_lives <- function(threshold, shares, populations, study, unit) {
  found <- list(slots = list(), priors = list(), constants = list(), names = populations)
  if (isTRUE(threshold)) {
    values <- unlist(lapply(study[intersect(names(study), c("life", "lower", "upper"))], `[[`, "values"), use.names = FALSE)
    smallest <- min(values[is.finite(values) & values > 0])
    found$priors$threshold <- ww_half_normal(quantity_text(rounded_up(smallest), unit))
  } else if (!is.null(threshold) && !isFALSE(threshold)) {
    found$constants$threshold <- quantity(threshold, "threshold")
    if (is.numeric(found$constants$threshold)) found$constants$threshold <- quantity_text(found$constants$threshold, unit)
    found$known_threshold <- number_in(found$constants$threshold, unit)
  }
  if (length(c(found$priors, found$constants))) found$slots$threshold <- "threshold"
  for (name in names(shares)) {
    if (!is_asked(shares[[name]], name)) next
    found$slots[[name]] <- if (isTRUE(shares[[name]])) name else shares[[name]]
    if (isTRUE(shares[[name]])) found$priors[[name]] <- ww_uniform(0, 1)
  }
  if (!length(populations)) return(found)
  first <- populations[-length(populations)]  # the last has the rest
  names <- paste0("share_", gsub("[^A-Za-z0-9]", "_", first))
  if (anyDuplicated(names)) {
    stop_input("subpopulations: the names give the share ", names[anyDuplicated(names)], " twice; choose names that differ in letters or digits")
  }
  for (name in names) found$priors[[name]] <- ww_uniform(0, 1)
  found$shares <- names
  found$table <- list(names = I(populations), share = stats::setNames(as.list(names), first))
  found
}

# The number of "500 h" in the unit "h"; NA in another unit.
number_in <- function(text, unit) {
  if (is.numeric(text)) return(text)
  parts <- regmatches(text, regexec("^([^ ]+) +(.*)$", text))[[1]]
  if (length(parts) && parts[3] == unit) as.double(parts[2]) else NA_real_
}

# New lives: `drawn(label)` are those of one distribution, of the subpopulation of each row where there are some.
of_populations <- function(draw, rows, further, drawn) {
  value <- function(key) {
    own <- further$slots[[key]]
    if (!is.character(own)) own else if (own %in% names(draw)) draw[[own]] else further$known_threshold
  }
  label <- NULL
  if (length(further$names)) {
    shares <- vapply(further$shares, function(name) draw[[name]], 0)
    label <- further$names[1 + findInterval(stats::runif(rows), cumsum(shares))]
  }
  lives <- drawn(label)
  threshold <- value("threshold")
  if (anyNA(threshold)) stop_input("simulate(): threshold is ", further$constants$threshold, "; state it in the unit of the lives")
  if (!is.null(threshold)) lives <- lives + threshold
  defective <- value("share_defective")
  if (!is.null(defective)) lives[stats::runif(rows) >= defective] <- Inf
  dead <- value("share_dead_on_arrival")
  if (!is.null(dead)) lives[stats::runif(rows) < dead] <- 0
  lives
}
