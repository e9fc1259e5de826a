# Makes examples/warranty/returns.csv: 24 months of sales, lives in months Weibull with shape 1.6 and scale 80, sold at any time of
# their month. Then maximum likelihood estimates of two triangles with R's own functions, for tests/models/formula_model.
set.seed(20261127)
months <- format(seq(as.Date("2024-01-01"), by = "month", length.out = 24), "%Y-%m")
sold <- round(300 + 18 * (0:23) + runif(24, -40, 40))
cells <- matrix(0, 24, 24)
for (i in 1:24) {
  back <- floor(i - 1 + runif(sold[i]) + rweibull(sold[i], 1.6, 80)) + 1
  for (j in back[back <= 24]) cells[i, j] <- cells[i, j] + 1
}
cells[lower.tri(cells)] <- NA
table <- data.frame(sold = months, shipped = sold, cells)
names(table)[-(1:2)] <- months
write.csv(table, "examples/warranty/returns.csv", row.names = FALSE, quote = FALSE, na = "")

# start: when in its month a unit begins; whole: ages are whole numbers of months.
estimate <- function(sold, cells, start, whole = FALSE) {
  n <- nrow(cells); last <- ncol(cells)
  minus <- function(p) {
    b <- exp(p[1]); e <- exp(p[2]); sum <- 0
    for (i in 1:n) for (j in 1:last) {
      after <- j - i + attr(cells, "shift")
      if (after < 0 || is.na(cells[i, j]) || cells[i, j] == 0) next
      f <- if (whole) dweibull(after, b, e)
           else pweibull(after + 1 - start, b, e) - pweibull(max(0, after - start), b, e)
      sum <- sum + cells[i, j] * log(f)
    }
    for (i in 1:n) {
      age <- last - i + attr(cells, "shift") + if (whole) 0 else 1 - start
      sum <- sum + (sold[i] - sum(cells[i, ], na.rm = TRUE)) * pweibull(age, b, e, FALSE, TRUE)
    }
    -sum
  }
  r <- optim(c(0.4, 4), minus, control = list(reltol = 1e-15, maxit = 9999))
  r <- optim(r$par, minus, control = list(reltol = 1e-15, maxit = 9999))
  c(shape = exp(r$par[1]), scale = exp(r$par[2]), loglik = -r$value)
}
attr(cells, "shift") <- 0
options(digits = 9)
for (start in c(0, 0.5)) print(estimate(sold, cells, start))
# ReliaSoft's example of the Nevada format: sold in June to August, back in July to September.
nevada <- rbind(c(3, 3, 5), c(0, 2, 4), c(0, 0, 4))
attr(nevada, "shift") <- 1
whole <- estimate(c(100, 140, 150), nevada, 1, TRUE)
print(whole)
survival <- function(t) pweibull(t, whole["shape"], whole["scale"], FALSE)
print(unname(c(89, 134, 146) * (1 - survival(4:2) / survival(3:1))))  # in October
