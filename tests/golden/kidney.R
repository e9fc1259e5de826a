# Marginal log-likelihood of Weibull lives with a lognormal effect of each patient on the scale (survival::kidney), each patient by
# base R's integrate over the effect.
#   Rscript tests/golden/kidney.R > tests/golden/kidney_expected.csv
data <- read.csv("tests/golden/kidney.csv")
patient <- function(rows, middle, slope, by_sex, scatter) {
  log_scale <- log(middle) + by_sex * (rows$sex - 1.74)
  log_f <- function(z) sapply(z, function(z) {
    w <- slope * (log(rows$time) - log_scale - scatter * z)
    sum(rows$status * (log(slope) - log(rows$time) + w) - exp(w)) + dnorm(z, log = TRUE)
  })
  top <- optimize(log_f, c(-40, 40), maximum = TRUE, tol = 1e-10)
  f <- function(z) exp(log_f(z) - top$objective)
  at <- top$maximum
  ends <- c(-9, -4, -1.5, -0.5, -0.1, 0, 0.1, 0.5, 1.5, 4, 9)
  parts <- sapply(seq_len(length(ends) - 1), function(i) integrate(f, at + ends[i], at + ends[i + 1], rel.tol = 1e-12, abs.tol = 0)$value)
  top$objective + log(sum(parts))
}
points <- rbind(c(120, 1.1, 1.4, 0.6), c(80, 0.8, 0, 0.05), c(300, 2.2, -1, 1.9), c(95, 1, 2.1, 0.9), c(1000, 1.5, 3, 4), c(20, 0.4, 0.5, 0.3))
cat("characteristic,slope,b_sex,characteristic_scatter,log_likelihood\n")
for (i in seq_len(nrow(points))) {
  p <- points[i, ]
  all <- sapply(split(data, data$id), patient, p[1], p[2], p[3], p[4])
  cat(sprintf("%g,%g,%g,%g,%.12g\n", p[1], p[2], p[3], p[4], sum(all)))
}
