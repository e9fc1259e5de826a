# Rscript tests/golden/crow.R (R 4.2, base). Crow's estimates and his Cramer-von Mises statistic for the three systems and for
# the 40 failures of MIL-HDBK-189, written into tests/models/recurrence/trend_tests_test.cpp; the published numbers are
# beta 0.615, lambda 0.461 and beta 0.490, lambda 0.761.
statistic <- function(z) {
  z <- sort(z); m <- length(z); b <- (m - 1) / sum(log(1 / z))
  1 / (12 * m) + sum((z^b - (2 * seq_len(m) - 1) / (2 * m))^2)
}
three <- list(
  c(4.3, 4.4, 10.2, 23.5, 23.8, 26.4, 74.0, 77.1, 92.1, 197.2),
  c(0.1, 5.6, 18.6, 19.5, 24.2, 26.7, 45.1, 45.8, 75.7, 79.7, 98.6, 120.1, 161.8, 180.6, 190.8),
  c(8.4, 32.5, 44.7, 48.4, 50.6, 73.6, 98.7, 112.2, 129.8, 136.0, 195.8))
x <- unlist(three); b <- length(x) / sum(log(200 / x))
cat(sprintf("three systems: beta %.7f, lambda %.7f, statistic %.8f\n", b, length(x) / 3 / 200^b, statistic(x / 200)))
y <- c(0.7, 3.7, 13.2, 17.6, 54.5, 99.2, 112.2, 120.9, 151.0, 163.0, 174.5, 191.6, 282.8, 355.2, 486.3, 490.5, 513.3,
       558.4, 678.1, 688.0, 785.9, 887.0, 1010.7, 1029.1, 1034.4, 1136.1, 1178.9, 1259.7, 1297.9, 1419.7, 1571.7,
       1629.8, 1702.4, 1928.9, 2072.3, 2525.2, 2928.5, 3016.4, 3181.0, 3256.3)
end <- max(y); b <- length(y) / sum(log(end / y))
cat(sprintf("40 failures: beta %.7f, lambda %.7f, statistic %.8f\n", b, length(y) / end^b, statistic(y[y < end] / end)))
