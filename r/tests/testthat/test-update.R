# New rows, single units, backtests and code: what the program does with the same numbers to the bit.

few <- list(seed = 7, method = "exact", draws = 100, report = FALSE)

fitted_joint <- function() quiet(do.call(ww_fit, c(list(example("joint", "study.toml")), few)))

of_machines <- local({
  kept <- NULL
  function() {
    if (is.null(kept)) {
      wear <- data.frame(machine = rep(c("A", "B", "C"), each = 3), km = c(100, 200, 300), wear = c(11, 19, 31, 14, 31, 44, 8, 18, 25))
      study <- ww_study(formula = "worn = rate*km; wear = worn", data = wear, units = c(km = "km", wear = "um"), unit = "machine", scatter = "error",
                        constants = list(error = "1 um"), priors = list(rate = ww_lognormal("0.1 um/km", log_sd = 1)),
                        predict = list(along = "km", limit = list(worn = "100 um")))
      kept <<- quiet(do.call(ww_fit, c(list(study), few)))
    }
    kept
  }
})

test_that("an update is what the program writes, and can be updated again", {
  fit <- fitted_joint()
  folder <- tempfile("results")
  there <- tempfile("there")
  file <- file.path(tempfile("rows"), "june.csv")
  dir.create(dirname(file))
  june <- data.frame(cycles = c(15000, 18000), volume_mm3 = c(69, 83.5))
  write.csv(june, file, row.names = FALSE)
  ww_write(fit, folder)
  expect_lte(program("update", folder, file, "-o", there, "--no-report", "--quiet")$code, 1)
  later <- quiet(ww_update(fit, file, report = FALSE))
  here <- tempfile("here")
  ww_write(later, here)
  names <- list.files(there, recursive = TRUE)
  expect_setequal(list.files(here, recursive = TRUE), names)
  expect_identical(unname(tools::md5sum(file.path(here, names))), unname(tools::md5sum(file.path(there, names))))
  expect_identical(quiet(ww_update(folder, june, report = FALSE))$draws, later$draws)
  again <- quiet(ww_update(later, list(cycles = 20000, volume_mm3 = 92), report = FALSE))
  expect_identical(again$summary$update$rows_before, 14)
  expect_true(ww_ask(again, list(cycles = list(30000)))$predictions[[1]]$pi95 > 0)
  file <- tempfile(fileext = ".rds")
  saveRDS(later, file)
  kept <- readRDS(file)
  expect_identical(ww_ask(kept, list(cycles = list(30000))), ww_ask(later, list(cycles = list(30000))))
  refused(ww_update(fit, june, repeated = "twice"), "repeated is \"twice\"; it is 'once' or 'another'")
  refused(ww_update(fit, list(cycles = 1000)), "data has no column")
})

test_that("a unit is followed by its readings", {
  fit <- of_machines()
  tracker <- ww_track(fit, "M7", new = TRUE)
  expect_identical(update(tracker, data.frame(machine = "M7", km = c(100, 100, 200), wear = c(12, 12, 21))), tracker)
  expect_identical(tracker$outcomes$repeated, c(FALSE, TRUE, FALSE))
  expect_identical(attr(tracker$rul, "unit"), "km")
  expect_true(all(diff(tracker$rul) > 0) && tracker$is_new && is.null(tracker$doubt))
  expect_identical(tracker$summary$at, 200)
  expect_identical(names(tracker$path), c("km", "q05", "q50", "q95"))
  expect_lt(ww_risk(tracker, "100 km"), ww_risk(tracker, 900))
  expect_output(print(tracker), "New machine 'M7', 2 readings")
  expect_lt(ww_track(fit, "B")$rul[["q50"]], ww_track(fit, "C")$rul[["q50"]])
  refused(ww_track(fit, "D"), "unit: the study has no machine 'D'")
  refused(update(tracker, list(km = 300)), "no column 'wear'")
  refused(update(tracker, list(machine = "M8", km = 300, wear = 30)), "row 1, column 'machine': it is a reading of machine 'M8'")
  expect_warning(update(tracker, list(km = 210, wear = 0.04)), "row 1 contradicts", class = "wearwell_check_warning")
  expect_error(tracker$life, "a tracker has no 'life'")
})

test_that("a backtest and an export are the program's", {
  fit <- of_machines()
  folder <- tempfile("results")
  ww_write(fit, folder)
  readings <- data.frame(machine = "D", "km [km]" = c(100, 200, 300), "wear [um]" = c(12, 21, 33), check.names = FALSE)
  lives <- data.frame(machine = "D", "life [km]" = 850, check.names = FALSE)
  files <- file.path(tempdir(), c("readings.csv", "lives.csv", "forecasts.csv"))
  write.csv(readings, files[1], row.names = FALSE)
  write.csv(lives, files[2], row.names = FALSE)
  there <- program("backtest", folder, files[1:2], "-o", files[3])
  test <- ww_backtest(fit, stats::setNames(readings, c("machine", "km", "wear")), stats::setNames(lives, c("machine", "life")))
  expect_true(startsWith(there$out, test$text))
  written <- readLines(files[3])[-1]
  expect_identical(test$forecasts[["q50 [km]"]], exactly(vapply(strsplit(written, ","), `[[`, "", 6)))
  expect_identical(test$coverage$forecasts[test$coverage$readings == "all"], 3)
  sql <- program("export", "sql", folder, "--dialect", "duckdb", "--table", "fleet.cars", "--columns", "km=odometer:km", "--draws", "20")
  expect_identical(ww_export_sql(fit, "duckdb", "fleet.cars", columns = c(km = "odometer:km"), draws = 20), sql$out)
  here <- tempfile("c")
  expect_match(ww_export_c(fit, here, name = "car", lines = 64), "nodes on [0-9]+ lines")
  expect_setequal(grep("car", list.files(here), value = TRUE), c("car_unit.h", "car_unit.c", "car_test.c"))
  refused(ww_export_c(fit, here, lines = 3), "lines is 3; it is a whole number from 16 to 20000")
  refused(ww_export_sql(fitted_joint(), "duckdb", "fleet.cars"), "SQL export needs a study of model")
})

test_that("new rows of a fit by Surv() are read as its call reads them", {
  pumps <- data.frame(hours = c(150, 340, 560, 800, 1150, 2470, 100, 900, 300, 700), failed = c(1, 1, 1, 1, 0, 1, 1, 1, 1, 0))
  new <- data.frame(hours = c(420, 900.5), failed = c(1, 0))
  fit <- quiet(ww_life(Surv(hours, failed) ~ 1, data = pumps, units = c(hours = "h"), seed = 1, method = "exact", draws = 100, report = FALSE))
  later <- quiet(ww_update(fit, new, report = FALSE))
  expect_identical(later$summary$update[c("rows_before", "counted")], list(rows_before = 10, counted = 2))
  in_words <- data.frame("life [h]" = new$hours, status = c("failure", "runout"), check.names = FALSE)
  expect_identical(later$parameters, quiet(ww_update(fit, in_words, report = FALSE))$parameters)
  again <- quiet(ww_update(later, data.frame(hours = 610, failed = 1), report = FALSE))  # of a fit that was updated
  expect_identical(again$summary$update$rows_before, 12)
  refused(ww_update(fit, data.frame(hours = 3)), "Surv(): data has no column 'failed'")
  refused(ww_update(fit, new[0, ]), "data has no rows")
  refused(ww_update(fit, cbind(new, in_words)), "data can be read in two ways: by the formula of the fit, with the columns hours, failed, or as the columns of its study, life, status")
  two <- quiet(ww_update(fit, list(new[1, ], new[2, ]), report = FALSE))  # several tables, each as the formula reads it
  expect_identical(two$parameters, later$parameters)
  pumps$speed <- rep(c(10, 20), 5)
  pumps$site <- rep(c("a", "b"), c(4, 6))
  varied <- quiet(ww_life(Surv(hours, failed) ~ speed + site, data = pumps, units = c(hours = "h"), seed = 1, method = "exact", draws = 100,
                          report = FALSE))
  one <- quiet(ww_update(varied, data.frame(hours = 420, failed = 1, speed = 15, site = "b"), report = FALSE))  # one row does not vary
  expect_identical(one$summary$update$counted, 1)
  expect_error(ww_life(Surv(hours, failed) ~ speed, data = pumps[1, ]), "in all rows")
  expect_identical(ww_life(fit, b = 10, survived = 100), ww_life(fit, b = 10, survived = "100 h"))
})

test_that("new rows are read as the fit was made, whatever its columns are called", {
  pumps <- data.frame(hours = c(150, 340, 560, 800, 1150, 2470, 100, 900, 300, 700), failed = c(1, 1, 1, 1, 0, 1, 1, 1, 1, 0))
  fit_of <- function(...) quiet(ww_life(..., seed = 1, method = "exact", draws = 100, report = FALSE))
  expected <- quiet(ww_update(fit_of(Surv(hours, failed) ~ 1, data = pumps, units = c(hours = "h")), data.frame(hours = 420, failed = 0), report = FALSE))
  # The columns of the data have the names of those of the study: 0 was stopped, as Surv() reads it.
  renamed <- stats::setNames(pumps, c("life", "ended"))
  own <- fit_of(Surv(life, ended) ~ 1, data = renamed, units = c(life = "h"))
  expect_identical(quiet(ww_update(own, data.frame(life = 420, ended = 0), report = FALSE))$parameters, expected$parameters)
  by_names <- fit_of(pumps, "hours", event = "failed", units = c(hours = "h"))
  expect_identical(quiet(ww_update(by_names, data.frame(hours = 420, failed = 0), report = FALSE))$parameters, expected$parameters)
  formula <- Surv(hours, failed) ~ 1  # a formula that is kept under a name
  kept <- fit_of(formula, data = pumps, units = c(hours = "h"))
  rm(formula)
  expect_identical(quiet(ww_update(kept, data.frame(hours = 420, failed = 0), report = FALSE))$parameters, expected$parameters)
  refused(ww_plan_next(kept, goal = "B10", candidates = data.frame(count = 1), tests = data.frame(hours = c(3, NA), failed = 1)),
          "tests, row 2: the life is missing")
  refused(ww_plan_next(kept, goal = "B10", candidates = data.frame(count = 1), tests = data.frame(hours = 3)), "tests has no column 'failed'")
})
