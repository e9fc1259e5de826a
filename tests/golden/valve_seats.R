# Rscript tests/golden/valve_seats.R > tests/golden/valve_seats.csv (R 4.2, package survival), from the root of the project.
# The mean cumulative function of examples/repairable with the robust standard error of survfit (infinitesimal jackknife by
# engine, which is Lawless and Nadeau's), and the maximum likelihood estimate of the power law.
suppressMessages(library(survival))
d <- read.csv("examples/repairable/valve_seats.csv", check.names = FALSE)
names(d) <- c("engine", "age", "event")
# Survfit has no intervals of length 0: the second of two failures on one day begins a thousandth of a day earlier.
d$from <- ave(d$age, d$engine, FUN = function(x) c(0, head(x, -1)))
tie <- d$from == d$age
d$from[tie] <- d$age[tie] - 1e-3
before <- which(tie) - 1
d$age[before] <- d$age[before] - 1e-3
f <- survfit(Surv(from, age, event == "failure") ~ 1, data = d, id = engine, robust = TRUE)
cat("age,mean,se\n")
failed <- f$n.event > 0
cat(sprintf("%.10g,%.10g,%.10g\n", f$time[failed], f$cumhaz[failed], f$std.chaz[failed]), sep = "")
x <- d$age[d$event == "failure"]; e <- d$age[d$event == "end"]
x <- round(x); n <- length(x)
score <- function(b) n / b + sum(log(x)) - n * sum(e^b * log(e)) / sum(e^b)
b <- uniroot(score, c(0.5, 3), tol = 1e-12)$root
cat(sprintf("beta,%.10g,\neta,%.10g,\n", b, (sum(e^b) / n)^(1 / b)))
