# The verdict first, whatever is shown.

verdict_of <- function(fit) {
  checks <- fit$checks
  named <- function(verdict) words(checks$name[checks$verdict == verdict])
  if (!fit$trusted) return(paste0("NOT TRUSTED: ", named("fail")))
  if (any(checks$verdict == "warn")) return(paste0("trusted, with warnings: ", named("warn")))
  paste0("trusted: all ", nrow(checks), " checks pass")
}

cat_verdict <- function(fit) {
  cat(verdict_of(fit), "\n", sep = "")
  for (i in which(fit$checks$verdict != "pass")) cat(strwrap(reason(fit$checks[i, ]), indent = 2, exdent = 4), sep = "\n")
}

print.ww_fit <- function(x, ...) {
  cat_verdict(x)
  cat("\n", x$text, sep = "")
  cat_proposed(x)
  invisible(x)
}

# What a one-line model chose by itself.
cat_proposed <- function(x) {
  study <- x$study
  own <- if (is_posterior(x$summary)) rownames(x$parameters)[rownames(x$parameters) %in% study$proposed | x$parameters$default_prior]
  if (is.null(study$proposed)) return(invisible())
  if (length(own)) {
    cat("\nDefault priors, weak ones from the size of the data; priors = list(...) states what you know\n")
    cat(paste0("  ", format(own), "  ", x$parameters[own, "prior"], "\n"), sep = "")
  }
  for (note in study$notes) cat(strwrap(note, exdent = 2), sep = "\n")
}

summary.ww_fit <- function(object, ...) {
  keep <- intersect(c("trusted", "checks", "parameters", "predictions", "lives"), names(unclass(object)))
  structure(class = "summary.ww_fit", c(list(title = object$summary$title), unclass(object)[keep]))
}

print.summary.ww_fit <- function(x, digits = 4, ...) {
  cat(x$title, "\n", sep = "")
  cat_verdict(x)
  if (!is.null(x$parameters)) {
    cat("\nParameters\n")
    print(x$parameters[c("unit", "mean", "sd", "q05", "q50", "q95", "rhat", "ess_bulk")], digits = digits)
  }
  if (NROW(x$predictions)) {
    cat("\nPredictions\n")
    print(x$predictions, digits = digits, row.names = FALSE)
  }
  if (NROW(x$lives)) {
    cat("\nLives\n")
    print(x$lives[c("name", "of", "at", "unit", "b1", "b10", "b50", "q05", "q95")], digits = digits, row.names = FALSE)
  }
  invisible(x)
}

# Histograms of draws, where there is no report.
plot_draws <- function(x, which, breaks, ...) {
  draws <- x$draws
  known <- dimnames(draws)$variable
  if (is.null(which)) which <- head(known, 9)
  unknown <- setdiff(which, known)
  if (length(unknown)) stop_input("which: the fit has no parameter '", unknown[1], "' (parameters: ", words(known), ")")
  across <- ceiling(sqrt(length(which)))
  old <- par(mfrow = c(ceiling(length(which) / across), across), oma = c(0, 0, 3, 0), mar = c(4, 2, 1, 1))
  on.exit(par(old))
  for (name in which) {
    row <- x$parameters[name, ]
    unit <- if (row$unit %in% c("", "1")) "" else paste0(" [", row$unit, "]")
    hist(as.vector(unclass(draws)[, , name]), breaks = breaks, freq = FALSE, border = NA, col = hcl(240, 35, 75), main = "",
         ylab = "", yaxt = "n", xlab = paste0(name, unit), ...)
    abline(v = c(row$q05, row$q95), lty = 2)
    abline(v = row$mean)
  }
  mtext(verdict_of(x), outer = TRUE, line = 1.4, col = verdict_colour(x), font = 2)
  mtext(x$summary$title, outer = TRUE, line = 0.2, cex = 0.8)
  invisible(x)
}
