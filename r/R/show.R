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
  invisible(x)
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

plot.ww_fit <- function(x, which = NULL, breaks = 40, ...) {
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
  colour <- if (!x$trusted) "#cf222e" else if (any(x$checks$verdict == "warn")) "#9a6700" else "#1a7f37"
  mtext(verdict_of(x), outer = TRUE, line = 1.4, col = colour, font = 2)
  mtext(x$summary$title, outer = TRUE, line = 0.2, cex = 0.8)
  invisible(x)
}
