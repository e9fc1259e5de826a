# Golden values of tests/math/normality_test.cpp, by base R 4.2.2: Rscript normality.R, in this folder.
# normality.csv holds the samples, normality_expected.csv what R says of them.
set.seed(20)
samples <- list(
  normal5 = rnorm(5), normal20 = rnorm(20), normal101 = rnorm(101), normal400 = rnorm(400),
  shifted20 = rnorm(20, 0.6), wide101 = rnorm(101, 0, 1.4), heavy50 = rt(50, 2), skewed50 = rexp(50) - 1,
  far20 = rnorm(20, 2.5))
data <- do.call(rbind, lapply(names(samples), function(name) data.frame(sample = name, value = samples[[name]])))
data$value <- round(data$value, 6)
write.csv(data, "normality.csv", row.names = FALSE, quote = FALSE)

distance <- function(x) {
  p <- pnorm(sort((x - mean(x)) / sd(x)))
  n <- length(x)
  max(p - (seq_len(n) - 1) / n, seq_len(n) / n - p)
}
runs <- 200000
rows <- list()
for (name in names(samples)) {
  x <- data$value[data$sample == name]
  ks <- ks.test(x, "pnorm", exact = TRUE)
  d <- distance(x)
  n <- length(x)
  # The p value of Lilliefors (1967) by simulation; its standard error is at most 0.0012.
  p <- mean(replicate(runs, distance(rnorm(n))) > d)
  rows[[name]] <- data.frame(sample = name, ks_distance = sprintf("%.12g", ks$statistic), ks_p = sprintf("%.12g", ks$p.value),
                             lilliefors_distance = sprintf("%.12g", d), lilliefors_p = sprintf("%.6f", p))
}
write.csv(do.call(rbind, rows), "normality_expected.csv", row.names = FALSE, quote = FALSE)
