# Numbers of tests/infer/score_tests_test.cpp and of the Anderson-Darling test in tests/math/normality_test.cpp.
x <- c(2.1, 3.4, 1.9, 5.6, 4.4, 3.8, 9.7, 2.8, 4.1, 3.3)
n <- length(x)
p <- pnorm((sort(x) - mean(x)) / sd(x))
A <- -n - mean((2 * seq_len(n) - 1) * (log(p) + log(1 - rev(p))))
modified <- A * (1 + 0.75 / n + 2.25 / n^2)
print(c(A, exp(1.2937 - 5.709 * modified + 0.0186 * modified^2)), digits = 12)

q <- c(-0.3, 0.4, 1.2, -1.1, 0.7, 0.1, 1.9, -0.6, 0.2, 1.4)
w <- c(1, 2, 3, 4, 5, 6, 7, 8, 9, 11)
level <- factor(c(1, 1, 2, 2, 3, 3, 2, 1, 3, 2))
print(qnorm(pf(summary(aov(q ~ level))[[1]][1, 4], 2, 7, lower.tail = FALSE)), digits = 12)
line <- summary(lm(q ~ w))$coefficients
print(qnorm(pt(line[2, 3], 8)), digits = 12)  # slope
print(qnorm(pt(line[1, 3], 8)), digits = 12)  # intercept

# Shapiro and Wilk's test (Royston 1995, as base R has it): W and p of samples of 5, 10, 11, 12, 30 and 400 values.
set.seed(31)
for (sample in list(c(2.5, 3.1, 0.4, 7.7, 4.0), x, c(x, 6.2), c(x, 6.2, 0.3), round(rexp(30), 4), (1:400)^1.2)) {
  test <- shapiro.test(sample)
  cat(sprintf("{%.15g, %.15g, {%s}},\n", test$statistic, test$p.value, if (length(sample) > 40) "" else paste(sample, collapse = ", ")))
}
