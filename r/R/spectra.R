# Damage and life under load histories, design curves, load spectra: what `wearwell fatigue` does.

# Arguments and tables of a load history. `units`: of the load, or of columns by heading.
load_history <- function(loads, units) {
  by_column <- !is.null(names(units))
  given <- list(units = if (!is.null(units) && !by_column) one_text(units, "units"))
  if (is_path(loads) && !by_column) return(list(given = c(given, list(loads = path_of(loads, "loads"))), tables = list()))
  if (is.atomic(loads) && is.null(dim(loads)) && !is_path(loads)) loads <- list(load = loads)
  list(given = given, tables = list(loads = table_of(loads, "loads", if (by_column) units)))
}

fatigue_answer <- function(class, found) {
  if (!found$trusted) warn("the fit that this rests on is not trusted: see its checks")
  for (each in found$summary$checks) {
    if (each$verdict == "warn") warn(paste0(each$name, " warns: ", each$detail))
  }
  structure(class = c(class, "ww_answer"), found)
}

# JSON has no infinity: a life without end is null.
endless <- function(values) ifelse(is.na(values), Inf, values)

ww_damage <- function(fit, loads, column = NULL, units = NULL, method = "four-point", residual = "half", time = NULL, scale = NULL,
                      rule = NULL, knee = NULL, damage_sum = "1 x/ 1.34", block = NULL, b = c(1, 10, 50), confidence = 0.9,
                      progress = FALSE) {
  history <- load_history(loads, units)
  arguments <- c(history$given, list(column = column, method = method, residual = residual, time = time, scale = scale, rule = rule,
                                     knee = knee, damage_sum = damage_sum, block = block, b = b, confidence = confidence))
  about <- fit_or_folder(fit)
  found <- answer_of("damage", "life", arguments, run = about$run, path = about$path, tables = history$tables, progress = progress)
  keys <- c("q05", "q50", "q95", "bound", "predictive")
  lives <- numbers_of(found$summary$lives, c("percent", keys))
  lives[keys] <- lapply(lives[keys], endless)
  found$lives <- cbind(lives["percent"], unit = found$summary$unit, lives[keys])
  found$life <- structure(endless(unlist(found$summary[["next"]])), unit = found$summary$unit)
  found$damage <- unlist(found$summary$damage)
  found$sources <- data.frame(of = column(found$summary$contributions, "of", ""), share = column(found$summary$contributions, "share"))
  fatigue_answer("ww_damage", found)
}

ww_design <- function(..., names = NULL, stress = NULL, mean_stress = NULL, stress_ratio = NULL, reliability = NULL, confidence = NULL,
                      progress = FALSE) {
  found <- with_folders(list(...), names, "design", function(folders) {
    if (length(folders) == 0) stop_input("design takes a fit of an S-N curve at least")
    twice <- names(folders)[duplicated(names(folders))]
    if (length(twice)) stop_input("names: '", twice[1], "' is given twice")
    answer_of("design", "design", list(results = as.list(folders), stress = stress, mean_stress = mean_stress, stress_ratio = stress_ratio,
                                       reliability = reliability, confidence = confidence), progress = progress)
  })
  found$curves <- do.call(rbind, lapply(found$summary$curves, function(curve) {
    points <- numbers_of(curve$points, c("stress", "mean_stress", "life", "most_cautious"))
    points[c("life", "most_cautious")] <- lapply(points[c("life", "most_cautious")], endless)
    cbind(curve = curve$name, reliability = curve$reliability, confidence = curve$confidence, points)
  }))
  models <- found$summary$models
  found$models <- data.frame(study = column(models, "study", ""), equation = column(models, "equation", ""), weight = column(models, "weight"),
                             trusted = column(models, "trusted", NA))
  fatigue_answer("ww_design", found)
}

ww_spectrum <- function(loads, column = NULL, units = NULL, method = "four-point", residual = "half", time = NULL, bins = 32,
                        bin_width = NULL) {
  history <- load_history(loads, units)
  arguments <- c(history$given, list(column = column, method = method, residual = residual, time = time, bins = bins, bin_width = bin_width))
  fatigue_answer("ww_spectrum", answer_of("spectrum", "rainflow", arguments, tables = history$tables))
}
