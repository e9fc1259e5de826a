# The spring study of Heo et al. (2011), Tables 6 and 7: an independent computation. Base R, no package.
#   Rscript tests/golden/spring_blives.R > tests/golden/spring_blives.csv
# Given b, S_ut and sigma the likelihood is normal in log10_a, which is integrated by hand; the other three lie on a grid that
# fills the box of their uniform priors, midpoint rule. Lives are in cycles (multiples of 1e5), stresses in MPa.
#   parameter rows: mean, sd, 5 %, 50 %, 95 %
#   life rows: B1, B10, B50 of the posterior predictive, then the lives that B1 and B10 of a type exceed with 90 % probability

data <- read.csv("examples/spring/spring_life.csv")
y_all <- log10(data$life_normalized * 1e5)

centres <- function(from, to, n) from + (seq_len(n) - 0.5) * (to - from) / n
b <- centres(-0.1, -0.06, 60)
log10_S <- centres(3.1, 5.2, 210)
sigma <- centres(0.01, 0.6, 118)

root <- function(f, p, from, to) uniroot(function(t) f(t) - p, c(from, to), tol = 1e-7)$root

cat("case,what,name,v1,v2,v3,v4,v5\n")
for (case in 1:2) {
  rows <- if (case == 1) which(data$type != "G") else seq_len(nrow(data))
  y <- y_all[rows]
  n <- length(y)
  # x[i, j] = log10 of the fully reversed stress of test i with the j-th strength.
  reversed <- function(rows) outer(rows, log10_S, function(i, s) log10(data$alternating_stress_MPa[i] / (1 - data$mean_stress_MPa[i] / 10^s)))
  x <- suppressWarnings(reversed(rows))
  cells <- expand.grid(j = seq_along(log10_S), k = seq_along(sigma))
  s <- sigma[cells$k]
  parts <- lapply(b, function(bb) {
    # Residuals y - (x - A)/b: the best A is the mean of x - b y, the rest of the sum of squares does not depend on A.
    A <- colMeans(x - bb * y)
    ss <- colSums((t(t(x - bb * y) - A) / bb)^2)
    sd_A <- abs(bb) * s / sqrt(n)
    inside <- pnorm(4, A[cells$j], sd_A) - pnorm(2, A[cells$j], sd_A)
    list(A = A, log_weight = -(n - 1) * log(s) - ss[cells$j] / (2 * s^2) + log(abs(bb)) + log(inside))
  })
  highest <- max(sapply(parts, function(part) max(part$log_weight, na.rm = TRUE)))
  W <- sapply(parts, function(part) { w <- exp(part$log_weight - highest); w[is.na(w)] <- 0; w })
  W <- W / sum(W)
  A <- sapply(parts, function(part) part$A)[cells$j, ]
  sd_A <- outer(s, abs(b)) / sqrt(n)

  marginal <- function(name, value, weight) {
    h <- diff(value[1:2])
    q <- approx(c(0, cumsum(weight)), c(value - h / 2, tail(value, 1) + h / 2), c(0.05, 0.5, 0.95), ties = "ordered")$y
    m <- sum(weight * value)
    cat(sprintf("%d,parameter,%s,%.8g,%.8g,%.8g,%.8g,%.8g\n", case, name, m, sqrt(sum(weight * (value - m)^2)), q[1], q[2], q[3]))
  }
  keep <- which(W > 1e-7 * max(W))
  w <- W[keep] / sum(W[keep])
  a <- A[keep]
  sa <- sd_A[keep]
  m <- sum(w * a)
  qa <- sapply(c(0.05, 0.5, 0.95), function(p) root(function(t) sum(w * pnorm(t, a, sa)), p, 2, 4))
  cat(sprintf("%d,parameter,log10_a,%.8g,%.8g,%.8g,%.8g,%.8g\n", case, m, sqrt(sum(w * ((a - m)^2 + sa^2))), qa[1], qa[2], qa[3]))
  marginal("b", b, colSums(W))
  marginal("log10_Sut", log10_S, as.vector(tapply(rowSums(W), cells$j, sum)))
  marginal("sigma", sigma, as.vector(tapply(rowSums(W), cells$k, sum)))

  cell <- (keep - 1) %% nrow(cells) + 1
  bb <- b[(keep - 1) %/% nrow(cells) + 1]
  ss <- s[cell]
  for (i in rows[!duplicated(data$type[rows])]) {
    centre <- (suppressWarnings(reversed(i))[1, cells$j[cell]] - a) / bb
    # A is normal about a: so is the centre, with standard deviation sigma/sqrt(n), and the next life with that and sigma.
    predictive <- function(t) sum(w * pnorm(t, centre, ss * sqrt(1 + 1 / n)))
    B <- sapply(c(0.01, 0.1, 0.5), function(p) root(predictive, p, 0, 12))
    bound <- sapply(c(0.01, 0.1), function(q) root(function(t) sum(w * pnorm(t, centre + ss * qnorm(q), ss / sqrt(n))), 0.1, 0, 12))
    cat(sprintf("%d,life,%s,%.8g,%.8g,%.8g,%.8g,%.8g\n", case, data$type[i], 10^B[1], 10^B[2], 10^B[3], 10^bound[1], 10^bound[2]))
  }
}
