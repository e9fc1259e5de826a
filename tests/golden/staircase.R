# Rscript tests/golden/staircase.R > tests/golden/staircase.csv (R 4.2, base), from the root of the project.
# The posterior of examples/staircase by the rectangle rule on a fine grid, in log10(MPa); and Dixon and Mood's estimate as their paper has it.
d <- read.csv("examples/staircase/tests.csv", check.names = FALSE)
s <- d[[1]]; failed <- d$status == "failure"
m <- seq(2.35, 2.60, length.out = 2501); t <- seq(1e-5, 0.30, length.out = 3000)
g <- expand.grid(m = m, t = t)
lp <- dnorm(g$m, 2.5, 0.2, log = TRUE) + dnorm(g$t, 0, 0.05, log = TRUE)
for (i in seq_along(s)) lp <- lp + pnorm((log10(s[i]) - g$m) / g$t, lower.tail = failed[i], log.p = TRUE)
w <- exp(lp - max(lp)); w <- w / sum(w)
mean_of <- function(y) sum(w * y); sd_of <- function(y) sqrt(sum(w * (y - mean_of(y))^2))
b10 <- g$m + g$t * qnorm(0.1)
o <- order(b10); cw <- cumsum(w[o])
cat("what,value\n")
cat(sprintf("mean_limit,%.8f\nsd_limit,%.8f\nmean_sigma,%.8f\nsd_sigma,%.8f\nlimit90_q10,%.6f\n",
            mean_of(g$m), sd_of(g$m), mean_of(g$t), sd_of(g$t), 10^b10[o][which(cw >= 0.1)[1]]))
rare <- if (sum(failed) <= sum(!failed)) failed else !failed
step <- 15; i <- (s[rare] - min(s[rare])) / step
n <- length(i); a <- sum(i); b <- sum(i^2); v <- (n * b - a^2) / n^2
cat(sprintf("dm_mean,%.8f\ndm_sd,%.8f\n", min(s[rare]) + step * (a / n + ifelse(all(rare == failed), -0.5, 0.5)),
            ifelse(v > 0.3, 1.62 * step * (v + 0.029), 0.53 * step)))
