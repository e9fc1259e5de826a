# Units that are repaired, warranty returns, and lives of two fits against each other.

test_that("repairs in one line are those of the study file", {
  seats <- read.csv(example("repairable", "valve_seats.csv"), check.names = FALSE)
  with_event <- function(event) {
    seats$event <- event
    seats
  }
  repairs <- function(frame, event = "event", ...) {
    quiet(ww_repairable(frame, age = "age", unit = "engine", event = event, units = c(age = "day"), rounding = "1 day", at = "600 day",
                                   ahead = "100 day", ..., seed = 1, method = "exact", draws = 50, chains = 2, report = FALSE))
  }
  fit <- repairs(seats)
  file <- quiet(ww_fit(example("repairable", "study.toml"), seed = 1, method = "exact", draws = 50, chains = 2, report = FALSE))
  expect_equal(fit$parameters[c("q05", "q50", "q95")], file$parameters[c("q05", "q50", "q95")], tolerance = 1e-12)
  expect_identical(repairs(with_event(seats$event == "failure"))$parameters, fit$parameters)
  expect_identical(repairs(with_event(as.integer(seats$event == "failure")))$parameters, fit$parameters)
  words <- with_event(ifelse(seats$event == "failure", "cambio", "hoy"))
  expect_identical(repairs(words, list(column = "event", failure = "cambio", end = "hoy"))$parameters, fit$parameters)
  refused(ww_repairable(seats, "age", "engin", "event"), "no column 'engin'")
  refused(ww_repairable(seats, "age", "engine", list(column = "event", runout = 0)), "event is")
  refused(ww_repairable(seats, "age", "engine", "event", process = "power"), "process is")
  refused(ww_repairable(with_event(ifelse(seats$event == "failure", 1, 2)), "age", "engine", "event", units = c(age = "day")), "two ways")
  refused(ww_repairable(seats, "age", "engine", "event", agead = "3 day"), "did you mean 'ahead'")
})

test_that("delayed fixes in one line are those of the study file", {
  frame <- read.csv(example("repairable", "delayed_fixes.csv"), check.names = FALSE)
  delayed <- c(0.67, 0.72, 0.77, 0.77, 0.87, 0.92, 0.50, 0.85, 0.89, 0.74, 0.70, 0.63, 0.64, 0.72, 0.69, 0.46)
  fixes <- c(list(A = "none"), setNames(as.list(rep("during", 12)), paste0("BC", 17:28)), setNames(as.list(delayed), paste0("BD", 1:16)))
  flat <- list(distribution = "flat")
  projected <- function(fixes, mode = "mode") {
    quiet(ww_repairable(frame, age = "test time", unit = "system", event = "event", mode = mode, fixes = fixes, priors = list(beta = flat, M_T = flat),
                        predict = list(level = 0.9, sides = "both", classical = TRUE), seed = 1, method = "exact", draws = 50, chains = 2,
                        report = FALSE))$summary$repairable$projection
  }
  file <- quiet(ww_fit(example("repairable", "delayed_fixes.toml"), seed = 1, method = "exact", draws = 50, chains = 2, report = FALSE))
  expect_identical(projected(fixes), file$summary$repairable$projection)
  refused(projected(replace(fixes, "BD1", 1.4)), "1.4")
  refused(projected(replace(fixes, "BD1", "later")), "BD1 is \"later\"")
  refused(projected(fixes[names(fixes) != "BD3"]), "does not name mode 'BD3'")
  refused(projected(unname(fixes)), "list by mode")
  refused(projected(NULL), "mode needs fixes")
  refused(projected(fixes, NULL), "mode needs fixes")
})

test_that("failures counted by interval in one line are those of the study file", {
  frame <- read.csv(example("repairable", "grouped.csv"), check.names = FALSE)
  asked <- function(...) {
    quiet(ww_repairable(frame, age = "age", unit = "helicopter", priors = list(M_T = ww_lognormal(50, log_sd = 3)), units = c(age = "h"), ahead = "20 h",
                        predict = list(level = 0.9, sides = "both", classical = TRUE), seed = 1, method = "exact", draws = 50, chains = 2,
                        report = FALSE, ...))
  }
  file <- quiet(ww_fit(example("repairable", "grouped.toml"), seed = 1, method = "exact", draws = 50, chains = 2, report = FALSE))
  expect_equal(asked(count = "count", grouped = TRUE)$summary$classical, file$summary$classical, tolerance = 1e-12)
  refused(asked(count = "count"), "event is missing")
  refused(asked(grouped = TRUE), "grouped needs count")
  refused(asked(count = "count", grouped = NA), "it is TRUE or FALSE")
})

test_that("returns in one line are those of the study file", {
  triangle <- read.csv(example("warranty", "returns.csv"), check.names = FALSE)
  planned <- read.csv(example("warranty", "planned_sales.csv"))
  fit <- quiet(ww_returns(triangle, sold = "sold", quantity = "shipped", warranty = "36 month", cost_per_return = "180 EUR",
                                     planned_sales = planned, survival_to = "36 month", priors = list(characteristic = ww_lognormal("200 month", log_sd = 2)),
                                     seed = 1, method = "exact", draws = 50, chains = 2, report = FALSE))
  file <- quiet(ww_fit(example("warranty", "study.toml"), seed = 1, method = "exact", draws = 50, chains = 2, report = FALSE))
  expect_equal(unname(fit$parameters$q50), unname(file$parameters$q50), tolerance = 1e-12)
  expect_equal(fit$summary$returns$forecast, file$summary$returns$forecast, tolerance = 1e-12)
  units <- head(read.csv(example("warranty", "units.csv"), check.names = FALSE), 2000)
  days <- units
  days[["sale date"]] <- as.Date(days[["sale date"]])
  days[["failure date"]] <- as.Date(ifelse(days[["failure date"]] == "", NA, days[["failure date"]]))
  text <- function(frame) ww_returns(frame, sold = "sale date", returned = "failure date", until = "2025-12", family = "exponential", fit = FALSE)$text
  expect_identical(text(days), text(units))
  expect_match(text(units), "median = \"500 month\"", fixed = TRUE)
  delays <- data.frame("delay [month]" = c(0, 0.5, 2), share = c(0.6, 0.3, 0.1), check.names = FALSE)
  expect_match(ww_returns(triangle, delay_of_report = delays, fit = FALSE)$text, "file = \"delay_of_report\"", fixed = TRUE)
  refused(ww_returns(triangle, sold = "sale"), "no column 'sale'")
  refused(ww_returns(triangle, family = "weibul"), "family is")
  refused(ww_returns(units, returned = "failure date"), "sold is missing")
})

test_that("lives of two fits are compared as the program does", {
  makes <- list(c(312, 480, 510, 640, 700, 820), c(150, 210, 260, 330, 420, 450))
  fits <- lapply(makes, function(hours) {
    quiet(ww_life(data.frame(hours = hours), "hours", units = c(hours = "h"), seed = 1, method = "exact", draws = 50, chains = 2, report = FALSE))
  })
  found <- quiet(ww_against(fits[[1]], fits[[2]], horizon = "300 h", confidence = "95 %"))
  expect_identical(rownames(found$differences), c("B1 ratio", "B10 ratio", "B50 ratio", "outlives", "survival difference"))
  folder <- file.path(tempfile("against"), c("new", "old"))
  dir.create(dirname(folder[1]))
  for (i in 1:2) ww_write(fits[[i]], folder[i])
  printed <- program("life", folder[1], "--against", folder[2], "--horizon", "300 h", "--confidence", "95 %")$out
  table <- function(text) grep("life, as a|outlive|survival to", strsplit(text, "\n")[[1]], value = TRUE)
  expect_identical(table(found$text), table(printed))
  expect_identical(quiet(ww_against(folder[1], folder[2], horizon = "300 h", confidence = 0.95))$differences, found$differences)
  refused(ww_against(fits[[1]], fits[[2]], horizon = "3 kg"), "horizon")
  refused(ww_against(fits[[1]], makes), "other is")
})
