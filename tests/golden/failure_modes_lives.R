# Lives of parts with two Weibull failure modes over a posterior on dense grids (logarithms of scales and shapes, equal steps).
# Separate modes: a grid for each; the mean survival of the part is the product of theirs.
# One common shape: a grid over both scales and the shape; shares failed by each mode are in the ratio of the hazards. Masked failures
# (the second, fifth, eighth, eleventh) add the log of the sum of the hazards.
# Priors: scale lognormal(30000, 1) (device: 300, 1.5), shape lognormal(2, 0.5) (device: 1, 1).
# Columns: study, quantity, at, and `next`: the value for the next part, over all uncertainty.
# Writes failure_modes_lives.csv. Rscript tests/golden/failure_modes_lives.R
shocks <- setNames(read.csv("examples/life/shock_absorbers.csv"), c("life", "mode"))
device <- setNames(read.csv("tests/golden/device_g.csv"), c("life", "mode"))
out <- list()
note <- function(study, quantity, at, now)
  out[[length(out) + 1]] <<- data.frame(study, quantity, at, `next` = now, check.names = FALSE)
root <- function(f, low, high) exp(uniroot(function(u) f(exp(u)), log(c(low, high)), tol = 1e-9)$root)
normalized <- function(lp) { w <- exp(lp - max(lp)); w / sum(w) }
log_prior <- function(u, median, sd) -0.5 * ((u - log(median)) / sd)^2

# A mode alone: weights on a grid of (log scale, log shape).
alone <- function(d, mode, prior, n = 501) {
  u <- log(prior[1]) + prior[2] * seq(-5, 7, length.out = n)
  b <- log(prior[3]) + prior[4] * seq(-6, 6, length.out = n)
  failed <- d$life[d$mode == mode]
  logs <- log(d$life)
  grid <- sapply(b, function(v) {
    shape <- exp(v)
    most <- max(logs)
    power <- sum(exp(shape * (logs - most)))  # in units of the longest life
    length(failed) * (v - shape * u) + (shape - 1) * sum(log(failed)) - power * exp(shape * (most - u)) +
      log_prior(u, prior[1], prior[2]) + log_prior(v, prior[3], prior[4])
  })
  grid[is.nan(grid)] <- -Inf
  w <- normalized(grid)
  edge <- sum(w[c(1, n), ]) + sum(w[, c(1, n)])
  stopifnot(edge < 1e-9)
  keep <- as.vector(w) > 1e-13
  list(log_scale = rep(u, n)[keep], shape = exp(rep(b, each = n))[keep], w = as.vector(w)[keep])
}
hazard_to <- function(g, t) exp(g$shape * (log(t) - g$log_scale))
survives <- function(g, t) sum(g$w * exp(-hazard_to(g, t)))
separate <- function(study, d, modes, prior, percents, lives) {
  g <- lapply(modes, function(m) alone(d, m, prior))
  low <- min(d$life) / 1e6; high <- max(d$life) * 1e4
  for (p in percents) {
    now <- root(function(t) 1 - survives(g[[1]], t) * survives(g[[2]], t) - p / 100, low, high)
    note(study, "B", p, now)
    for (k in 1:2) {
      now <- root(function(t) 1 - survives(g[[k]], t) - p / 100, low, high)
      note(study, paste("B", modes[k]), p, now)
    }
  }
  for (t in lives) {
    note(study, "survival", t, survives(g[[1]], t) * survives(g[[2]], t))
    for (k in 1:2) {  # the mean share failed by mode k: f_k(t) S_j(t), both averaged on their own
      density <- function(u) sapply(exp(u), function(x) {
        h <- hazard_to(g[[k]], x); sum(g[[k]]$w * g[[k]]$shape * h * exp(-h)) * survives(g[[3 - k]], x) })
      cuts <- seq(log(t) - 25, log(t), length.out = 26)
      share <- sum(mapply(function(a, b) integrate(density, a, b, rel.tol = 1e-9)$value, head(cuts, -1), tail(cuts, -1)))
      note(study, paste("failed by", modes[k]), t, share)
    }
  }
}
common <- function(study, d, modes, prior, percents, lives, n = 101) {
  masked <- d$mode == paste(modes, collapse = "|")
  u <- seq(log(prior[1]) - 1.5, log(prior[1]) + 5, length.out = 3 * n)
  b <- seq(log(prior[3]) - 2, log(prior[3]) + 2, length.out = n)
  parts <- lapply(b, function(v) {
    shape <- exp(v); power <- sum(exp(shape * (log(d$life) - log(prior[1]))))
    term <- function(m) {
      failed <- d$life[d$mode == m]
      length(failed) * (v - shape * u) + (shape - 1) * sum(log(failed)) - power * exp(shape * (log(prior[1]) - u)) + log_prior(u, prior[1], prior[2])
    }
    lp <- outer(term(modes[1]), term(modes[2]), "+") + log_prior(v, prior[3], prior[4])
    # Of a common shape the sum of the hazards is shape t^(shape - 1) (scale_1^-shape + scale_2^-shape).
    sum_of <- outer(exp(-shape * (u - log(prior[1]))), exp(-shape * (u - log(prior[1]))), "+")
    lp + sum(masked) * (v + log(sum_of) - shape * log(prior[1])) + (shape - 1) * sum(log(d$life[masked]))
  })
  most <- max(sapply(parts, max))
  g <- do.call(rbind, lapply(seq_along(b), function(i) {
    w <- exp(parts[[i]] - most); keep <- which(w > 1e-11, arr.ind = TRUE)
    if (nrow(keep) == 0) return(NULL)
    cbind(u[keep[, 1]], u[keep[, 2]], exp(b[i]), w[keep])
  }))
  w <- g[, 4] / sum(g[, 4]); shape <- g[, 3]
  stopifnot(sum(w[g[, 1] %in% range(u) | g[, 2] %in% range(u)]) < 1e-8)
  first <- 1 / (1 + exp(-shape * (g[, 2] - g[, 1])))  # the share of the hazard that is mode 1's
  log_scale <- g[, 1] + log(first) / shape            # of the part
  for (p in percents) {
    now <- root(function(t) sum(w * -expm1(-exp(shape * (log(t) - log_scale)))) - p / 100, min(d$life) / 1e6, max(d$life) * 1e4)
    note(study, "B", p, now)
  }
  for (t in lives) {
    lasts <- exp(-exp(shape * (log(t) - log_scale)))
    note(study, "survival", t, sum(w * lasts))
    for (k in 1:2) {
      share <- (1 - lasts) * (if (k == 1) first else 1 - first)
      note(study, paste("failed by", modes[k]), t, sum(w * share))
    }
  }
}
masked <- shocks
failures <- which(masked$mode != "censored")
masked$mode[failures[seq_along(failures) %% 3 == 2]] <- "mode 1|mode 2"
separate("shocks", shocks, c("mode 1", "mode 2"), c(30000, 1, 2, 0.5), c(1, 10, 50), c(10000, 25000))
separate("device", device, c("W", "S"), c(300, 1.5, 1, 1), c(1, 10, 50), c(100, 300))
common("common", shocks, c("mode 1", "mode 2"), c(30000, 1, 2, 0.5), c(1, 10), c(10000, 25000))
common("masked", masked, c("mode 1", "mode 2"), c(30000, 1, 2, 0.5), c(1, 10), c(10000, 25000))
all <- do.call(rbind, out)
all$`next` <- sprintf("%.8g", all$`next`)
write.csv(all, "tests/golden/failure_modes_lives.csv", row.names = FALSE, quote = FALSE)
