# New readings of the rows of a fit of ww_degradation(), of new units, under one draw of the posterior: an independent reading of the same
# formula, in R.

new_readings_at <- function(draw, known) {
  level <- as.integer(factor(known$item))
  of_unit <- function(scatter) draw[[scatter]] * stats::rnorm(max(level))[level]
  log_rate <- log(draw[["rate"]])
  for (each in known$effects) log_rate <- log_rate + draw[[each$parameter]] * each$value
  if (known$differs) log_rate <- log_rate + of_unit("rate_scatter")
  grown <- if (known$path == "power") known$power_of * (known$along / known$power_of)^draw[["power"]] else known$along
  mean <- (if (known$falls) -1 else 1) * exp(log_rate) * grown
  if (known$start) mean <- mean + draw[["start"]] + if (known$start_differs) of_unit("start_scatter") else 0
  switch(known$family,
    normal = mean + draw[["sigma"]] * stats::rnorm(known$rows),
    lognormal = mean * exp(draw[["sigma"]] * stats::rnorm(known$rows)),
    process_readings(known$family, mean, draw[["step_ratio"]], known))
}

# Sums of independent increments of each unit, from 0 on. Their variance is `ratio` times their mean.
process_readings <- function(family, mean, ratio, known) {
  found <- numeric(known$rows)
  for (rows in split(seq_len(known$rows), known$item)) {
    rows <- rows[order(known$along[rows])]
    found[rows] <- cumsum(increments(family, pmax(diff(c(0, mean[rows])), 0), ratio))
  }
  found
}

increments <- function(family, mean, ratio) {
  count <- length(mean)
  drawn <- switch(family,
    `wiener-process` = mean + sqrt(ratio * mean) * stats::rnorm(count),
    `gamma-process` = stats::rgamma(count, shape = mean / ratio, scale = ratio),
    `inverse-gaussian-process` = random_life("inverse-gaussian", stats::runif(count), mean, list(sqrt(ratio / mean))))
  ifelse(mean > 0, drawn, 0)
}
