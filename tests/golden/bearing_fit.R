# The likelihood and posterior of the bearing study's example, by other means than wearwell's: base R, the inverse
# geometry by uniroot on the paper's formula, each bearing's integral over its own k by R's integrate, the posterior
# on a plain grid. Run from the project's root:  Rscript tests/golden/bearing_fit.R > tests/golden/bearing_fit.csv
data <- read.csv("examples/bearing/inspections.csv")
r <- 10e-3; L <- 20e-3
area <- function(s, d) {
  a <- acos((2*s - 2*s*d - d^2) / (2*(s + d)))
  b <- acos((2*s + 2*s^2 + 2*s*d + d^2) / (2*(1 + s)*(s + d)))
  2*a - sin(2*a) - (1 + s)^2 * (2*b - sin(2*b))
}
depth <- function(s, w) uniroot(function(d) area(s, d)/(8*pi) - w, c(1e-6, 0.5), tol = 1e-13)$root * r
loading <- data$force_N / (2*r*L) * data$revolutions
sigma <- data$clearance_um * 1e-6 / r
measured <- data$depth_um * 1e-6
# Depths by ln k on a fine grid, splined: R's splines are another interpolation than wearwell's.
grid <- seq(log(2e-16), log(2e-14), length.out = 1500)
curves <- lapply(seq_len(nrow(data)), function(i)
  splinefun(grid, vapply(grid, function(x) depth(sigma[i], exp(x) * loading[i]), 0)))
groups <- split(seq_len(nrow(data)), data$bearing)
log_bearing <- function(rows, log_k, sd, scatter) {
  f <- function(u) vapply(u, function(x)
    sum(dnorm(measured[rows], vapply(rows, function(i) curves[[i]](x), 0), sd, log = TRUE)), 0) +
    dnorm(u, log_k, scatter, log = TRUE)
  u <- seq(log_k - 40*scatter, log_k + 40*scatter, length.out = 20001)
  u <- u[u > grid[1] & u < grid[length(grid)]]
  top <- max(f(u)); keep <- u[f(u) > top - 40]
  ends <- range(keep)
  top + log(integrate(function(x) exp(f(x) - top), ends[1], ends[2], rel.tol = 1e-11, subdivisions = 5000)$value)
}
log_likelihood <- function(k, sd, scatter)
  sum(vapply(groups, function(rows) log_bearing(rows, log(k), sd, scatter), 0))
cat("what,k,sigma,k_scatter,value\n")
for (p in list(c(2e-15, 2e-6, 0.3), c(2e-15, 2e-6, 0.05), c(1.5e-15, 4e-6, 0.6), c(3e-15, 1e-6, 1.2), c(1e-15, 10e-6, 0.2)))
  cat(sprintf("log_likelihood,%.17g,%.17g,%.17g,%.13g\n", p[1], p[2], p[3], log_likelihood(p[1], p[2], p[3])))
# The posterior of the example: sigma known, k lognormal, k_scatter half-normal. The integrals over a bearing's own k
# here by Simpson's rule on u = ln k_b, the same nodes for all parameters.
u <- seq(log(2.2e-16), log(1.8e-14), length.out = 4001)
weights <- rep(c(2, 4), length.out = 4001); weights[c(1, 4001)] <- 1; weights <- weights * (u[2] - u[1]) / 3
known <- 2e-6
bells <- lapply(groups, function(rows)
  exp(Reduce(`+`, lapply(rows, function(i) dnorm(measured[i], curves[[i]](u), known, log = TRUE) + log(known)))))
log_k <- seq(log(2e-16), log(2e-14), length.out = 401); scatter <- seq(0.105, 4, by = 0.01)
log_posterior <- outer(log_k, scatter, Vectorize(function(m, s) {
  prior <- dnorm(u, m, s) * weights
  sum(log(vapply(bells, function(b) sum(b * prior), 0))) + dnorm(m, log(1e-15), 2.5, log = TRUE) + dnorm(s, 0, 1, log = TRUE)
}))
p <- exp(log_posterior - max(log_posterior)); p <- p / sum(p)
quantile_of <- function(x, w, q) { f <- cumsum(w) - 0.5*w; approx(f, x, q)$y }
report <- function(name, x, w) {
  m <- sum(x*w)
  cat(sprintf("%s_%s,,,,%.9g\n", name, c("mean", "sd", "q05", "q50", "q95"),
              c(m, sqrt(sum(w*(x - m)^2)), quantile_of(x, w, c(0.05, 0.5, 0.95)))), sep = "")
}
report("k", exp(log_k), rowSums(p))
report("k_scatter", scatter, colSums(p))
# k of a bearing not yet seen
cdf <- function(x) sum(p * pnorm(x, matrix(log_k, nrow(p), ncol(p)), matrix(scatter, nrow(p), ncol(p), byrow = TRUE)))
for (q in c(0.05, 0.1, 0.5, 0.95)) cat(sprintf("new_k_%g,,,,%.9g\n", q, exp(uniroot(function(x) cdf(x) - q, c(-40, -28), tol = 1e-12)$root)))
