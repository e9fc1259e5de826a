# Rscript tests/golden/projection.R (R 4.2, base). Crow's projection of delayed fixes for his example (Crow 2004; published by
# ReliaSoft: beta-bar 0.7472, h(T) 0.0299/h; test-find-test: demonstrated MTBF 9.52 h, projected 0.0661/h and 15.13 h, growth
# potential 22.45 h; test-fix-find-test: beta-bar 0.9103, demonstrated 0.1274/h), and quantiles of the posterior of
# src/wearwell/models/recurrence/projection.h by simulation, written into tests/models/recurrence/projection_test.cpp. The last
# part simulates tests with modes whose rates are points of a stable process and counts how often the 90 % interval holds
# the intensity after the fixes.
d <- read.csv("examples/repairable/delayed_fixes.csv", check.names = FALSE)
end <- 400; d <- d[d$event == "failure", ]; age <- d[["test time [h]"]]
f <- c(.67, .72, .77, .77, .87, .92, .50, .85, .89, .74, .70, .63, .64, .72, .69, .46); names(f) <- paste0("BD", 1:16)
bd <- age[grepl("^BD", d$mode)]; of <- d$mode[grepl("^BD", d$mode)]; bc <- age[grepl("^BC", d$mode)]; a <- age[d$mode == "A"]
n <- table(factor(of, names(f))); first <- sapply(names(f), function(k) min(bd[of == k])); m <- length(f)
logs <- sum(log(end / first)); bar <- (m - 1) / logs; h <- m * bar / end
report <- function(name, demonstrated) {
  potential <- demonstrated - length(bd) / end + sum((1 - f) * n) / end; projected <- potential + mean(f) * h
  cat(sprintf("%s: demonstrated %.7f (%.5f h), projected %.7f (%.5f h), potential %.7f (%.5f h)\n", name,
              demonstrated, 1 / demonstrated, projected, 1 / projected, potential, 1 / potential))
}
cat(sprintf("beta-bar %.7f, h %.8f, mean factor %.5f\n", bar, h, mean(f)))
report("test-find-test", (length(a) + length(bd)) / end)
all <- c(a, bd, bc); report("test-fix-find-test", length(all) * (length(all) - 1) / sum(log(end / all)) / end)

posterior <- function(size, n, f, logs, end, unfixed, during = 0, during_logs = 1) {
  m <- length(n)
  beta <- qgamma(runif(size) * pgamma(1, m, logs), m, logs)
  seen <- 0; left <- 0
  for (i in seq_len(m)) { r <- rgamma(size, n[i] - beta); seen <- seen + r; left <- left + (1 - f[i]) * r }
  unseen <- rgamma(size, m * beta)
  others <- (if (unfixed > 0) rgamma(size, unfixed + 0.5) else 0) +
    (if (during > 0) rgamma(size, during) / during_logs * rgamma(size, during) else 0)
  cbind(demonstrated = others + seen + unseen, projected = others + left + unseen,
        potential = others + left + (1 - mean(f)) * unseen) / end
}
set.seed(1)
show <- function(name, p) for (k in colnames(p))
  cat(sprintf("%s %s: mean %.6f, MTBF %s\n", name, k, mean(p[, k]), paste(sprintf("%.4f", quantile(1 / p[, k], c(.05, .5, .95))), collapse = " ")))
show("test-find-test", posterior(4e6, n, f, logs, end, length(a)))
show("test-fix-find-test", posterior(4e6, n, f, logs, end, length(a), length(bc), sum(log(end / bc))))

# Modes occur first at the times of a power law with the mean M (t/T)^beta; the rate of one that occurs first at t has a gamma
# distribution with the shape 1 - beta and the rate t. The sum of the rates of later modes is tempered stable (Brix 1999).
stable <- function(b) { u <- pi * runif(1); e <- rexp(1); sin(b * u) / sin(u)^(1 / b) * (sin((1 - b) * u) / e)^((1 - b) / b) }
unseen <- function(b, M) { k <- ceiling(M); s <- 0
  for (i in seq_len(k)) repeat { x <- (M / k)^(1 / b) * stable(b); if (runif(1) < exp(-x)) { s <- s + x; break } }; s }
coverage <- function(b, M, A, tests = 2000) {
  inside <- 0; used <- 0
  for (i in seq_len(tests)) {
    m <- rpois(1, M); if (m < 2) next
    t <- runif(m)^(1 / b); rate <- rgamma(m, 1 - b, t); n <- 1 + rpois(m, rate * (1 - t)); f <- runif(m, .5, .95)
    truth <- A + sum((1 - f) * rate) + unseen(b, M)
    q <- quantile(posterior(4000, n, f, sum(log(1 / t)), 1, rpois(1, A))[, "projected"], c(.05, .95))
    used <- used + 1; inside <- inside + (q[1] <= truth && truth <= q[2])
  }
  cat(sprintf("beta %.2f, M %g, A %g: %d of %d tests inside\n", b, M, A, inside, used))
}
for (b in c(.4, .6, .8)) for (M in c(8, 20)) coverage(b, M, 10)
