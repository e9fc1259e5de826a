# Makes examples/warranty/modes.csv: 18 months of sales, lives in months of two independent modes, seal: Weibull with shape
# 0.9 and scale 300, bearing: Weibull with shape 2.2 and scale 60; sold at any time of their month. Then maximum likelihood
# estimates by R's own functions, and the forecast at them, for tests/models/formula_model.
set.seed(20261127)
n <- 18
months <- format(seq(as.Date("2024-07-01"), by = "month", length.out = n), "%Y-%m")
sold <- round(400 + runif(n, -60, 60))
rows <- list()
for (i in 1:n) {
  seal <- rweibull(sold[i], 0.9, 300); bearing <- rweibull(sold[i], 2.2, 60)
  back <- floor(i - 1 + runif(sold[i]) + pmin(seal, bearing)) + 1
  for (mode in c("seal", "bearing")) {
    hit <- back[(seal < bearing) == (mode == "seal") & back <= n]
    cells <- as.list(tabulate(hit, n)); cells[seq_len(n) < i] <- NA
    names(cells) <- months
    rows[[length(rows) + 1]] <- data.frame(sold = months[i], mode = mode, shipped = sold[i], cells, check.names = FALSE)
  }
}
table <- do.call(rbind, rows)
write.csv(table, "examples/warranty/modes.csv", row.names = FALSE, quote = FALSE, na = "")

# Multinomial: a unit sold in the middle of month i comes back k months later by mode m with the integral of m's density and the
# other's survival over the ages of that month, or not at all.
counts <- sapply(c("seal", "bearing"), function(m) {
  cells <- as.matrix(table[table$mode == m, -(1:3)])
  sapply(0:(n - 1), function(after) sum(cells[cbind(seq_len(n - after), seq_len(n - after) + after)]))
})
left <- sold - sapply(1:n, function(i) sum(table[table$sold == months[i], -(1:3)], na.rm = TRUE))
ends <- c(0, 0:(n - 1) + 0.5)
cell <- function(from, to, own, other)
  integrate(function(t) dweibull(t, own[1], own[2]) * pweibull(t, other[1], other[2], FALSE), from, to, rel.tol = 1e-11)$value
minus <- function(p) {
  seal <- exp(p[1:2]); bearing <- exp(p[3:4]); sum <- 0
  for (a in 1:n) sum <- sum + counts[a, 1] * log(cell(ends[a], ends[a + 1], seal, bearing)) +
    counts[a, 2] * log(cell(ends[a], ends[a + 1], bearing, seal))
  age <- n - 1:n + 0.5
  -(sum + sum(left * (pweibull(age, seal[1], seal[2], FALSE, TRUE) + pweibull(age, bearing[1], bearing[2], FALSE, TRUE))))
}
r <- optim(log(c(0.9, 300, 2.2, 60)), minus, control = list(reltol = 1e-15, maxit = 9999))
r <- optim(r$par, minus, control = list(reltol = 1e-15, maxit = 9999))
options(digits = 9)
seal <- exp(r$par[1:2]); bearing <- exp(r$par[3:4])
print(c(seal, bearing, loglik = -r$value))
# Expected returns of the units in use in the next month and in the next six.
for (ahead in c(1, 6)) print(sapply(1:2, function(m) {
  own <- if (m == 1) seal else bearing; other <- if (m == 1) bearing else seal
  sum(sapply(1:n, function(i) {
    now <- n - i + 0.5
    left[i] * cell(now, now + ahead, own, other) /
      (pweibull(now, own[1], own[2], FALSE) * pweibull(now, other[1], other[2], FALSE))
  }))
}))
