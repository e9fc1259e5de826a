# The best model of every size by the residual sum of squares, by leaps on the data of bench_select: 34 terms of a cubic in
# four inputs beside the constant, which is in every model (Debian: r-cran-leaps). Leave-one-out is beyond leaps.
suppressMessages(library(leaps))
folder <- dirname(sub("--file=", "", grep("--file=", commandArgs(FALSE), value = TRUE)))
data <- read.csv(file.path(folder, "select.csv"))
columns <- NULL
for (degree in 1:3) {
  factors <- expand.grid(rep(list(1:4), degree))
  factors <- factors[apply(factors, 1, function(f) !is.unsorted(f)), , drop = FALSE]
  for (i in seq_len(nrow(factors))) {
    x <- Reduce(`*`, lapply(unlist(factors[i, ]), function(j) data[[j]]))
    columns <- cbind(columns, (x - min(x)) / diff(range(x)))
  }
}
for (repetition in 1:3) {
  seconds <- system.time(found <- regsubsets(columns, data$y, nvmax = ncol(columns), really.big = TRUE))[["elapsed"]]
  cat(sprintf("leaps %s  every size of %d terms: %.3f s\n", packageVersion("leaps"), ncol(columns) + 1, seconds))
}
