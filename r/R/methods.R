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
  lives <- object$study$lives
  if (is.null(lives)) {
    stop_input("simulate() needs a fit of ww_life(): for other models ww_ask(fit, predict) has predictive intervals, and fit$draws the posterior")
  }
  text <- seed_text(if (is.null(seed)) object$seed else seed)
  old <- get0(".Random.seed", globalenv(), inherits = FALSE)
  on.exit(if (is.null(old)) rm(".Random.seed", envir = globalenv()) else assign(".Random.seed", old, globalenv()))
  set.seed(as.integer(as.double(text) %% .Machine$integer.max), kind = "Mersenne-Twister", normal.kind = "Inversion", sample.kind = "Rejection")
  require_units_of(object, lives)
  draws <- draws_matrix(object)
  frame <- as.data.frame(lapply(seq_len(nsim), function(i) new_lives_at(draws[sample.int(nrow(draws), 1), ], lives)))
  names(frame) <- paste0("sim_", seq_len(nsim))
  attr(frame, "seed") <- text
  attr(frame, "unit") <- lives$unit
  frame
}

# The simulation computes in the units that ww_life() gave.
require_units_of <- function(fit, lives) {
  location <- lives$parameters[[1]]
  rows <- grep(paste0("^", location, "([[].*)?$"), rownames(fit$parameters))
  found <- setdiff(fit$parameters$unit[rows], c(lives$unit, if (lives$unit == "") "1"))
  if (length(found)) stop_input("simulate(): the prior gives ", location, " in ", found[1], ", and the lives are in ", lives$unit, ": state the prior in ", lives$unit)
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
