# Selections, comparisons, counting, bearings, clutches: held to the program's answers.

json <- function(text) {
  # The program's JSON as TOML's reader cannot read it: only numbers of one key are compared.
  function(key) as.double(sub(paste0(".*\"", key, "\": *([-+.0-9e]+).*"), "\\1", gsub("\n", " ", text)))
}

test_that("a selection is that of the program", {
  found <- quiet(ww_select(example("select", "wear.csv"), "w", inputs = c("Td", "n", "Mz"), degree = 2))
  expect_s3_class(found, "ww_selection")
  said <- program("select", example("select", "wear.csv"), "--response", "w", "--inputs", "Td,n,Mz", "--degree", 2)
  expect_lte(said$code, 1)
  first <- strsplit(said$out, "\n")[[1]]
  expect_true(all(first %in% strsplit(found$text, "\n")[[1]] | grepl("[0-9] s", first)))
  wear <- read.csv(example("select", "wear.csv"), check.names = FALSE)
  again <- quiet(ww_select(wear, "w", inputs = c("Td", "n", "Mz"), degree = 2))
  expect_identical(again$models$terms, found$models$terms)
  expect_match(capture.output(print(found))[1], "rusted|RUSTED")
  refused(ww_select(wear, "v", inputs = "Td", degree = 1), "v")
  refused(ww_select(wear, "w", inputs = 3, degree = 1), "inputs is double")
})

test_that("fits are compared as the program compares folders", {
  one <- quiet(ww_fit(example("joint", "normal_flat.toml"), seed = 1, report = FALSE))
  other <- quiet(ww_fit(example("joint", "lognormal_flat.toml"), seed = 1, report = FALSE))
  found <- ww_compare(one, other, names = c("normal", "lognormal"))
  folder <- tempfile()
  dir.create(folder)
  ww_write(one, file.path(folder, "normal"))
  ww_write(other, file.path(folder, "lognormal"))
  old <- setwd(folder)
  on.exit(setwd(old))
  said <- program("compare", "normal", "lognormal")
  expect_identical(found$text, said$out)
  expect_identical(ww_compare("normal", lognormal = other)$text, said$out)
  page <- tempfile(fileext = ".html")
  ww_report(found, page)
  expect_gt(file.size(page), 10000)
  refused(ww_compare(one), "two fits at least")
  refused(ww_compare(one, other, names = "a"), "1 names are given for 2 fits")
})

test_that("families are ranked as the program ranks them", {
  pumps <- data.frame(hours = c(312, 480, 510, 640, 700, 700, 150, 260, 420), failed = c(1, 1, 1, 1, 0, 0, 1, 1, 1))
  study <- ww_life(Surv(hours, failed) ~ 1, data = pumps, units = c(hours = "h"), fit = FALSE)
  ranked <- ww_compare(study, families = c("weibull", "lognormal"), progress = FALSE)
  folder <- tempfile()
  dir.create(folder)
  file <- file.path(folder, "study.toml")
  writeLines(sub("file = \"data\"", "file = \"data.csv\"", study$text, fixed = TRUE), file)
  written <- study$columns
  write.csv(as.data.frame(lapply(written, `[[`, "values")), file.path(folder, "data.csv"), row.names = FALSE, quote = FALSE)
  said <- program("compare", file, "--families", "weibull,lognormal")
  expect_identical(ranked$text, said$out)
  expect_identical(ww_compare(file, families = "weibull,lognormal", progress = FALSE)$text, said$out)
  fit <- quiet(ww_fit(study, method = "exact", draws = 100, report = FALSE))
  expect_identical(ww_compare(fit, families = c("weibull", "lognormal"), progress = FALSE)$summary, ranked$summary)
  expect_setequal(ranked$close, c("weibull", "lognormal"))
  of_weibull <- ranked$lives[ranked$lives$family == "weibull", ]
  expect_identical(of_weibull$q50, fit$quantities$q50[match(of_weibull$name, fit$quantities$name)])
  page <- tempfile(fileext = ".html")
  ww_report(ranked, page)
  expect_gt(file.size(page), 10000)
  refused(ww_compare(study, families = "weibull"), "needs two families")
  refused(ww_compare(study, families = c("weibull", "wei")), "'wei' cannot be ranked")
  refused(ww_compare(study, families = 3), "families is 3")
  refused(ww_compare(study, study, families = "all"), "2 are given")
  refused(ww_compare(study, families = "all", names = "a"), "leave names out")
  refused(ww_compare(pumps, families = "all"), "of a data frame: ww_life()")
  refused(ww_compare(example("joint", "study.toml"), families = "all"), "model \"formula\"")
})

test_that("cycles are those of ASTM E1049's example", {
  signal <- c(-2, 1, -3, 5, -1, 3, -4, 4, -2)  # figure 6 of the standard: ranges 3, 4, 4, 8, 9, 8, 6
  found <- ww_rainflow(signal, method = "three-point")
  counts <- tapply(found$count, found$range, sum)
  expect_identical(as.vector(counts[c("3", "4", "6", "8", "9")]), c(0.5, 1.5, 0.5, 1, 0.5))
  expect_identical(found$range, abs(found$to - found$from))
  refused(ww_rainflow(c(1, NA)), "signal, row 2: not a number")
  refused(ww_rainflow("a"), "signal holds no numbers")
  refused(ww_rainflow(signal, method = "five"), "method is")
})

test_that("a bearing is what the program says", {
  options <- list(radius = "10 mm", clearance = "20 um", depth = "50 +- 5 um", rate = "1e-16 m^3/(N m) +- 10 %", pressure = "2 MPa",
                  speed = "60 rpm")
  found <- do.call(ww_bearing_life, c("journal", options))
  flags <- unlist(Map(function(name, value) c(paste0("--", name), value), names(options), options))
  said <- program("bearing", "life", "--contact", "journal", flags, "--json")
  expect_identical(said$code, 0L)
  expect_identical(found$value, json(said$out)("value"))
  refused(ww_bearing_life("journal", "10 mm"), "inputs have names")
  expect_error(ww_bearing_life("wheel", radius = "10 mm"), class = "wearwell_input_error")
})
