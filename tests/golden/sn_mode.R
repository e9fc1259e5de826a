# Maximum likelihood of an S-N regression with run-outs (log10 N = (log10 S - log10 a)/b, a linear model in log10 S), by other means
# than wearwell's: Newton's method with derivatives written out for the normal law of log10 life, optim for the Weibull law.
# The lives were simulated once with R's generator. Run from the project's root:
#   Rscript tests/golden/sn_mode.R > tests/golden/sn_mode.csv
set.seed(7)
stress <- rep(c(500, 440, 380, 340, 300, 270), each = 4) * 1e6
center <- (log10(stress) - 9.3) / -0.11
life <- signif(10^(center + 0.25 * rnorm(length(stress))), 4)
broke <- life < 2e7
life[!broke] <- 2e7
cat("kind,stress,life,broke\n")
for (i in seq_along(stress)) cat(sprintf("test,%.0f,%.4g,%d\n", stress[i], life[i], broke[i]))
x <- log10(stress); y <- log10(life); m <- mean(x)
design <- cbind(1, x - m)
# Normal: parameters beta1, beta2, s = log sigma.
newton <- function(p) {
  for (i in 1:100) {
    s <- exp(p[3]); z <- drop(y - design %*% p[1:2]) / s
    h <- exp(dnorm(z, log = TRUE) - pnorm(z, lower.tail = FALSE, log.p = TRUE))  # hazard
    d1 <- ifelse(broke, -z, -h)                # derivatives of the log density or survival by z
    d2 <- ifelse(broke, -1, -h * (h - z))
    zb <- -design / s; zs <- -z                # dz/dbeta, dz/ds
    g <- c(colSums(d1 * zb), sum(d1 * zs - broke))
    H <- matrix(0, 3, 3)
    H[1:2, 1:2] <- t(zb) %*% (d2 * zb)
    H[1:2, 3] <- H[3, 1:2] <- colSums((d2 * zs - d1) * zb)
    H[3, 3] <- sum(d2 * zs^2 + d1 * z)
    step <- solve(-H, g)
    p <- p + step
    if (max(abs(step)) < 1e-14) break
  }
  list(p = p, H = H)
}
report <- function(kind, p, H, value) {
  # To log10 a (in Pa), b, sigma: x = log10 a + b y, so b = 1/beta2 and log10 a = m - beta1/beta2.
  J <- rbind(c(-1 / p[2], p[1] / p[2]^2, 0), c(0, -1 / p[2]^2, 0), c(0, 0, exp(p[3])))
  se <- sqrt(diag(J %*% solve(-H) %*% t(J)))
  cat(sprintf("%s,%.12g,%.12g,%.12g,%.8g,%.8g,%.8g,%.12g\n", kind, m - p[1] / p[2], 1 / p[2], exp(p[3]), se[1], se[2], se[3], value))
}
cat("kind,log10_a,b,sigma,se_log10_a,se_b,se_sigma,log_likelihood\n")
start <- c(coef(lm(y ~ I(x - m))), log(0.25))
fit <- newton(start)
log_normal <- function(p) {
  z <- drop(y - design %*% p[1:2]) / exp(p[3])
  sum(ifelse(broke, dnorm(z, log = TRUE) - p[3] - log(life * log(10)), pnorm(z, lower.tail = FALSE, log.p = TRUE)))
}
report("normal", fit$p, fit$H, log_normal(fit$p))
weibull <- function(p) {
  z <- drop(y - design %*% p[1:2]) / exp(p[3])
  sum(ifelse(broke, z - exp(z) - p[3] - log(life * log(10)), -exp(z)))
}
best <- start
for (i in 1:20) best <- optim(best, weibull, method = "BFGS", control = list(fnscale = -1, reltol = 1e-16, maxit = 1000, ndeps = rep(1e-6, 3)))$par
report("weibull", best, optimHess(best, weibull, control = list(fnscale = -1, ndeps = rep(1e-4, 3))), weibull(best))
