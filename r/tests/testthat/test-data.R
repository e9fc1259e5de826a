# What may be data, and what is refused with which words.

small <- function(study, ...) quiet(ww_fit(study, ..., seed = 1, method = "exact", draws = 10, report = FALSE))
same <- function(a, b) expect_identical(small(a)$summary$parameters, small(b)$summary$parameters)

test_that("columns of every kind are the same numbers", {
  plain <- joints()
  other <- plain
  other$F <- as.integer(other$F)
  other$joint <- factor(other$joint)
  same(of_a_formula(other), of_a_formula(plain))
  same(of_a_formula(as.list(plain)), of_a_formula(plain))
  named <- plain
  names(named) <- c("joint", "F [N]", "s [m]", "V [mm^3]")
  same(of_a_formula(named, units = NULL), of_a_formula(plain))
  with_units <- plain
  with_units$V <- structure(plain$V, units = structure(list(numerator = rep("mm", 3), denominator = character()), class = "symbolic_units"),
                            class = "units")
  same(of_a_formula(with_units, units = c(F = "N", s = "m")), of_a_formula(plain))
  file <- tempfile(fileext = ".csv")
  write.csv(data.frame(lapply(plain, function(x) if (is.double(x)) sprintf("%.17g", x) else x)), file, row.names = FALSE, quote = FALSE)
  same(of_a_formula(file), of_a_formula(plain))
})

test_that("what is missing is named with row and column", {
  frame <- joints()
  frame$F[4] <- NA
  refused(of_a_formula(frame), "row 4, column 'F'")
  frame$F[4] <- NaN
  refused(of_a_formula(frame), "row 4, column 'F'")
  frame$F[4] <- Inf
  refused(of_a_formula(frame), "row 4, column 'F'")
  frame <- joints()
  frame$F <- as.integer(frame$F)
  frame$F[2] <- NA
  refused(of_a_formula(frame), "row 2, column 'F'")
  frame <- joints()
  frame$joint[3] <- NA
  refused(of_a_formula(frame, unit = "joint"), "row 3, column 'joint'")
})

test_that("wrong columns are refused by name", {
  with <- function(column) {
    frame <- joints()
    frame$F <- column
    of_a_formula(frame)
  }
  refused(with(as.Date("2024-01-01") + 1:18), "column 'F' holds dates or times (Date)")
  refused(with(as.POSIXct("2024-01-01", tz = "UTC") + 1:18), "column 'F' holds dates or times (POSIXct)")
  refused(with(as.difftime(1:18, units = "hours")), "column 'F' holds durations (difftime); as.double(..., units = \"hours\") makes numbers of them")
  refused(with(structure(as.double(1:18), class = "integer64")), "column 'F' is of class integer64")
  refused(with(complex(18, 1)), "column 'F' holds complex numbers")
  refused(with(as.raw(1:18)), "column 'F' is raw")
  refused(with(I(as.list(1:18))), "column 'F' is a list")
  refused(with(I(c(list(1:2), as.list(2:18)))), "row 1 has 2 elements")
  refused(with(matrix(1, 18, 2)), "column 'F' has 2 dimensions")
  refused(with("100 N"), "column 'F'")
  wrong <- "caf\xe9"
  Encoding(wrong) <- "UTF-8"
  frame <- joints()
  frame$joint[5] <- wrong
  refused(of_a_formula(frame, unit = "joint"), "row 5, column 'joint': the text is not Unicode")
})

test_that("wrong tables are refused", {
  frame <- joints()
  twice <- cbind(frame, F = frame$F)
  refused(of_a_formula(twice), "data: two columns are called 'F'")
  refused(of_a_formula(cbind(frame, `F [N]` = frame$F)), "have one name, F")
  refused(of_a_formula(frame[0, ]), "has no rows")
  refused(of_a_formula(as.matrix(frame)), "is a matrix")
  refused(of_a_formula(1:3), "data is integer")
  refused(of_a_formula(list(1, 2)), "the columns have no names")
  refused(of_a_formula(list(F = 1:3, s = 1:3, V = 1:2)), "column 'V' has 2 rows, and 'F' has 3")
  refused(of_a_formula(frame["F"], units = c(F = "N")), "no left side of the formula is a column of data")
  refused(of_a_formula(frame, units = c(G = "N")), "units: data has no column 'G'")
  refused(of_a_formula(frame, units = "N"), "units has no names")
  refused(of_a_formula(frame, unit = "pair"), "unit: data has no column 'pair'")
  refused(of_a_formula(tempfile(fileext = ".csv")), ".csv")
})

test_that("formulas and priors that are none are refused", {
  refused(ww_study("k*F*s", joints(), priors = list()), "is not an equation")
  refused(ww_study("", joints(), priors = list()), "the formula is empty")
  refused(ww_study(3, joints(), priors = list()), "the formula is double")
  refused(ww_study("V = k*F*s", joints()), "priors is missing")
  refused(ww_study("V = k*F*s", joints(), priors = list(k = 3)), "priors: k is double")
  refused(ww_lognormal(median = NA), "median is NA")
  refused(ww_fit(list(formula = "V = k*F*s", data = joints(), prior = list())), "study has no 'prior'")
  refused(ww_fit(3), "study is double")
  refused(ww_fit("none.toml"), "none.toml")
})

test_that("a study is its text: lists, vectors, numbers to the last bit", {
  value <- wearwell:::toml_value
  expect_identical(value(list(a = 1, "b c" = "x\"y", d = c(1, 2.5), e = TRUE, f = list("u")), ""),
                   "{ a = 1, \"b c\" = \"x\\\"y\", d = [1, 2.5], e = true, f = [\"u\"] }")
  expect_identical(value(I(1), ""), "[1]")
  expect_identical(value(c(NA, Inf, -Inf, 1e-7), ""), "[nan, inf, -inf, 1e-07]")
  numbers <- c(pi, 1 / 3, 1e300 / 3, -2^-1074, 2^53 + 2)
  expect_identical(exactly(wearwell:::number_text(numbers)), numbers)
  refused(value(sum, "predict.at"), "predict.at is builtin")
})

test_that("a table in memory stands for the file of a study", {
  study <- example("formula", "study.toml")
  wear <- read.csv(example("formula", "wear.csv"))
  from_file <- small(study)
  in_memory <- small(study, data = wear)
  expect_equal(in_memory$parameters, from_file$parameters, tolerance = 1e-9)  # read.csv may be off by the last bit
  by_name <- ww_study_toml(readLines(study), list(wear.csv = wear))
  expect_identical(small(by_name)$parameters, in_memory$parameters)
})
