# Maximum likelihood of the random fatigue-limit model (Pascual and Meeker 1999, Technometrics 41, 277-290, eqs. 2 to 5) by other
# means than wearwell's: the likelihood as printed, integrated over the limit by R's integrate(), climbed by nlminb.
# The tests are those of the paper's laminate panel, 125 specimens of a carbon eight-harness-satin/epoxy laminate (Shimokawa and
# Hamaguchi 1987), as Meeker, Escobar and Pascual give them with "Statistical Methods for Reliability Data" (second edition, 2022):
# github.com/wqmeeker/SMRD2Data, LaminatePanel.csv. Run from the project's root:
#   Rscript tests/golden/random_limit_mode.R > tests/golden/random_limit_mode.csv
# ln(kilocycles) = beta0 + beta1 ln(S/MPa - gamma) + sigma e, ln(gamma) = mu_gamma + sigma_gamma z; log_likelihood is of kilocycles.
tests <- read.csv("tests/golden/laminate_panel.csv")
x <- log(tests$stress_MPa); y <- log(tests$kilocycles); broke <- tests$status == "failure"
normal <- list(density = dnorm, survival = function(z) pnorm(z, lower.tail = FALSE), from = -12)
sev <- list(density = function(z) exp(z - exp(z)), survival = function(z) exp(-exp(z)), from = -60)

probability <- function(p, i, life, limit) {
  sigma <- exp(p[3]); scale <- exp(p[5])
  top <- (x[i] - p[4]) / scale
  integrand <- function(z) {
    at <- (y[i] - p[1] - p[2] * (x[i] + log1p(-exp(p[4] + scale * z - x[i])))) / sigma
    if (broke[i]) limit$density(z) * life$density(at) / sigma
    else limit$density(z) * life$survival(at)
  }
  # Between breakpoints which are dense where the limit has its mass and where it nears the stress.
  cuts <- c(limit$from, -8:8, top - 2^-(0:12))
  cuts <- sort(unique(c(cuts[cuts > limit$from & cuts < top], limit$from, top)))
  if (top <= limit$from) return(if (broke[i]) 0 else 1)
  parts <- sapply(seq_along(cuts[-1]), function(k)
    integrate(integrand, cuts[k], cuts[k + 1], rel.tol = 1e-10, abs.tol = 1e-300, stop.on.error = FALSE)$value)
  sum(parts) + if (broke[i]) 0 else limit$survival(top)
}
minus_log <- function(p, life, limit)
  -sum(log(pmax(sapply(seq_along(y), probability, p = p, life = life, limit = limit), 1e-300)) - ifelse(broke, y, 0))

cat("life,limit,beta0,beta1,sigma,mu_gamma,sigma_gamma,log_likelihood\n")
for (life in c("normal", "sev")) for (limit in c("normal", "sev")) {
  p <- c(30, -5, log(0.3), 5.36, log(0.04))
  for (again in 1:3)
    p <- nlminb(p, minus_log, life = get(life), limit = get(limit), scale = c(0.1, 1, 10, 10, 10),
                control = list(rel.tol = 1e-13, x.tol = 1e-10, iter.max = 500, eval.max = 1000))$par
  cat(sprintf("%s,%s,%.6g,%.6g,%.6g,%.7g,%.6g,%.9g\n", life, limit, p[1], p[2], exp(p[3]), p[4], exp(p[5]),
              -minus_log(p, get(life), get(limit))))
}
