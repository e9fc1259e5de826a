# The generics of stats, and those of broom and posterior where these are installed. Each meaning is in the page ww_methods.

require_posterior <- function(fit, what) {
  if (!is_posterior(fit$summary)) stop_input(what, ": a study of the model ", fit$summary$model, " has no posterior; fit$summary and fit$tables hold what it found")
}

coef.ww_fit <- function(object, ...) {
  require_posterior(object, "coef()")
  stats::setNames(object$parameters$mean, rownames(object$parameters))
}

require_draws <- function(fit, what) {
  require_posterior(fit, what)
  if (is.null(unclass(fit)$draws)) stop_input(what, ": this fit has no draws, because its posterior is improper: ", verdict_of(fit))
}

draws_matrix <- function(fit) {
  draws <- unclass(fit$draws)
  names <- dimnames(draws)$variable
  matrix(draws, ncol = length(names), dimnames = list(NULL, names))
}

vcov.ww_fit <- function(object, ...) {
  require_draws(object, "vcov()")
  draws <- draws_matrix(object)
  names <- colnames(draws)
  correlation <- suppressWarnings(stats::cor(draws))
  correlation[is.na(correlation)] <- 0
  diag(correlation) <- 1
  sd <- stats::setNames(object$parameters$sd, rownames(object$parameters))[names]
  structure(correlation * outer(sd, sd), dimnames = list(names, names))
}

require_level <- function(level) {
  fine <- is.numeric(level) && !is.object(level) && length(level) == 1
  if (!fine || !isTRUE(level > 0 && level < 1)) stop_input("level is ", shown_value(level), "; it lies between 0 and 1, like 0.95")
}

confint.ww_fit <- function(object, parm, level = 0.95, ...) {
  require_level(level)
  require_draws(object, "confint()")
  draws <- draws_matrix(object)
  known <- colnames(draws)
  if (missing(parm)) parm <- known
  if (is.numeric(parm)) parm <- known[parm]
  unknown <- setdiff(parm, known)
  if (length(unknown)) stop_input("parm: the fit has no parameter '", unknown[1], "' (parameters: ", words(known), ")")
  ends <- c((1 - level) / 2, (1 + level) / 2)
  found <- t(apply(draws[, parm, drop = FALSE], 2, stats::quantile, probs = ends, names = FALSE))
  if (isTRUE(all.equal(level, 0.9))) found[] <- as.matrix(object$parameters[parm, c("q05", "q95")])
  dimnames(found) <- list(parm, paste(format(100 * ends, trim = TRUE, digits = 3), "%"))
  found
}

mode_of <- function(fit, what) {
  require_posterior(fit, what)
  mode <- fit$summary$mode
  if (is.null(mode)) stop_input(what, ": this study has no mode")
  if (!is.null(mode$problem)) stop_input(what, ": the posterior has no mode: ", mode$problem)
  mode
}

logLik.ww_fit <- function(object, ...) {
  mode <- mode_of(object, "logLik()")
  structure(mode$log_likelihood, df = length(mode$parameters), nobs = mode$observations, class = "logLik")
}

# Leave-one-out of the fit's own check, in the form of the package loo.
ww_loo <- function(fit) {
  require_posterior(fit, "ww_loo()")
  found <- fit$summary$loo
  if (is.null(found$pointwise)) stop_input("ww_loo(): this study has no leave-one-out: ", if (is.null(found)) "its model has no likelihood by observations" else "it is not by observation")
  number <- function(key) column(found$pointwise, key)
  elpd <- number("elpd")
  p <- number("lpd") - elpd
  pointwise <- cbind(elpd_loo = elpd, p_loo = p, looic = -2 * elpd, influence_pareto_k = number("khat"))
  estimates <- cbind(Estimate = c(found$elpd, found$p_loo, -2 * found$elpd), SE = c(found$se, stats::sd(p) * sqrt(length(p)), 2 * found$se))
  rownames(estimates) <- c("elpd_loo", "p_loo", "looic")
  draws <- unclass(fit)$draws
  structure(list(estimates = estimates, pointwise = pointwise, diagnostics = list(pareto_k = pointwise[, "influence_pareto_k"])),
            dims = c(if (is.null(draws)) 0L else prod(dim(draws)[1:2]), length(elpd)), class = c("ww_loo", "loo"), observation = found$observation,
            threshold = found$khat_threshold, refitted = sum(column(found$pointwise, "refitted", FALSE)), density_unit = found$density_unit)
}

loo.ww_fit <- function(x, ...) ww_loo(x)

print.ww_loo <- function(x, digits = 1, ...) {
  cat("Leave-one-out over ", nrow(x$pointwise), " observations (", attr(x, "observation"), ")\n\n", sep = "")
  print(round(x$estimates, digits))
  k <- x$diagnostics$pareto_k
  cat("\nPareto k at most ", format(max(k, -Inf, na.rm = TRUE), digits = 2), " (reliable up to ", format(attr(x, "threshold"), digits = 2), "); ",
      attr(x, "refitted"), " refitted without their observation\n", sep = "")
  invisible(x)
}

nobs.ww_fit <- function(object, ...) {
  mode <- object$summary$mode
  if (is.null(mode$observations)) object$summary$data$rows else mode$observations
}

residuals.ww_fit <- function(object, type = "score", ...) {
  if (!isTRUE(type %in% c("score", "cox-snell"))) stop_input("type is ", shown_value(type), "; it is 'score' or 'cox-snell'")
  require_posterior(object, "residuals()")
  found <- core(C_residuals, run_again(object))
  score <- found$score
  if (type == "cox-snell") score <- -stats::pnorm(score, lower.tail = FALSE, log.p = TRUE)
  structure(stats::setNames(score, seq_along(score)), censored = found$censored == 1)
}

simulate.ww_fit <- function(object, nsim = 1, seed = NULL, ...) {
  nsim <- whole(nsim, "nsim", 1, 1e6)
  require_draws(object, "simulate()")
  known <- object$study$replicates
  if (is.null(known)) {
    stop_input("simulate() needs a fit of ww_life() or ww_degradation(): for other models ww_ask(fit, predict) has predictive intervals, and fit$draws the posterior")
  }
  text <- seed_text(if (is.null(seed)) object$seed else seed)
  old <- get0(".Random.seed", globalenv(), inherits = FALSE)
  on.exit(if (is.null(old)) rm(".Random.seed", envir = globalenv()) else assign(".Random.seed", old, globalenv()))
  set.seed(as.integer(as.double(text) %% .Machine$integer.max), kind = "Mersenne-Twister", normal.kind = "Inversion", sample.kind = "Rejection")
  require_units_of(object, known)
  draws <- draws_matrix(object)
  replicate_at <- if (is.null(known$path)) new_lives_at else new_readings_at
  frame <- as.data.frame(lapply(seq_len(nsim), function(i) replicate_at(draws[sample.int(nrow(draws), 1), ], known)))
  names(frame) <- paste0("sim_", seq_len(nsim))
  attr(frame, "seed") <- text
  attr(frame, "unit") <- known$unit
  frame
}

# The simulation computes in the units of the data: `known$units`, by parameter.
require_units_of <- function(fit, known) {
  for (name in names(known$units)) {
    rows <- grep(paste0("^", name, "([[].*)?$"), rownames(fit$parameters))
    unit <- known$units[[name]]
    found <- setdiff(fit$parameters$unit[rows], c(unit, if (unit == "") "1"))
    if (length(found)) stop_input("simulate(): the prior gives ", name, " in ", found[1], ", and the data have it in ", unit, ": state the prior in ", unit)
  }
}

update.ww_fit <- function(object, formula. = NULL, ..., evaluate = TRUE) {
  call <- unclass(object)$call
  if (is.null(call)) stop_input("update(): this fit does not know its call")
  if (!is.null(formula.)) {
    if (!inherits(formula., "formula") || is.null(call$x)) {
      stop_input("update(): only fits of a formula (ww_life, ww_degradation) take another one; name the arguments to change")
    }
    call$x <- stats::update.formula(stats::formula(eval(call$x, parent.frame())), formula.)
  }
  changes <- match.call(expand.dots = FALSE)$...
  if (length(changes) && (is.null(names(changes)) || any(names(changes) == ""))) stop_input("update(): arguments have names, like family = \"lognormal\"")
  for (name in names(changes)) call[[name]] <- changes[[name]]
  if (evaluate) eval(call, parent.frame()) else call
}

# ---- broom, posterior: registered when these packages are loaded.

tidy.ww_fit <- function(x, conf.int = FALSE, conf.level = 0.95, ...) {
  require_posterior(x, "tidy()")
  frame <- data.frame(term = rownames(x$parameters), estimate = x$parameters$mean, std.error = x$parameters$sd, unit = x$parameters$unit)
  if (one_truth(conf.int, "conf.int")) {
    ends <- confint(x, level = conf.level)[frame$term, , drop = FALSE]
    frame$conf.low <- unname(ends[, 1])
    frame$conf.high <- unname(ends[, 2])
  }
  frame
}

glance.ww_fit <- function(x, ...) {
  require_posterior(x, "glance()")
  mode <- x$summary$mode
  number <- function(value) if (is.null(value)) NA_real_ else value
  data.frame(model = x$summary$model, trusted = x$trusted, logLik = number(mode$log_likelihood), AIC = number(mode$aic), BIC = number(mode$bic),
             elpd_loo = number(x$summary$loo$elpd), p_loo = number(x$summary$loo$p_loo), nobs = nobs(x))
}

augment.ww_fit <- function(x, data = NULL, ...) {
  if (is.null(data)) {
    given <- x$study$given
    if (length(given) != 1 || is_path(given[[1]]$data)) stop_input("augment(): data is missing: the frame of the fit's rows")
    data <- as.data.frame(given[[1]]$data, check.names = FALSE, optional = TRUE)
  }
  found <- residuals(x)
  if (length(found) != NROW(data)) {
    stop_input("augment(): data has ", NROW(data), " rows, and the fit has ", length(found), " residuals: rows stand for several tests, or others are measured")
  }
  data$.resid <- as.vector(found)
  data$.censored <- attr(found, "censored")
  data
}

as_draws.ww_fit <- function(x, ...) {
  require_draws(x, "as_draws()")
  x$draws
}
