# Plans: the numbers and tables of the program to the last digit; frames in, frames out; errors name arguments.

texts_below <- function(folder) {
  names <- list.files(folder, recursive = TRUE)
  stats::setNames(vapply(file.path(folder, names), function(file) readChar(file, file.size(file), useBytes = TRUE), ""), names)
}

# The plan's folder is what the program writes for these arguments, but for the page, which names arguments.
same <- function(plan, ..., but_title = FALSE, command = "plan", file = "plan.json") {
  here <- tempfile("here")
  there <- tempfile("there")
  done <- program(command, ..., "-o", there)
  expect_lte(done$code, 1)
  expect_s3_class(plan, "ww_plan")
  ww_write(plan, here)
  one <- texts_below(here)
  other <- texts_below(there)
  expect_identical(names(one), names(other))
  names_equal <- setdiff(names(one), c("report.html", "results.sha1"))
  if (but_title) {
    line <- '"title": "[^\n]*"'
    one[file] <- sub(line, "", one[file])
    other[file] <- sub(line, "", other[file])
  }
  expect_identical(one[names_equal], other[names_equal])
  unlink(c(here, there), recursive = TRUE)
}

test_that("demonstrations are the program's", {
  goal <- "B10 >= 1e6 cycles"
  same(ww_plan_demonstrate(goal, failures = "0 to 3"), "demonstrate", goal, "--failures", "0 to 3")
  same(ww_plan_demonstrate(goal, shape = 2, specimens = 10), "demonstrate", goal, "--shape", 2, "--specimens", 10)
  same(ww_plan_demonstrate(goal, shape = "1.5 to 3", time = "2e6 cycles", confidence = 0.95), "demonstrate", goal, "--shape", "1.5 to 3",
       "--time", "2e6 cycles", "--confidence", 0.95)
  same(ww_plan_demonstrate(goal, distribution = "lognormal", sigma = 0.5, specimens = 4L, truth = c("B10 = 2e6 cycles", "B10 = 3e6 cycles")),
       "demonstrate", goal, "--distribution", "lognormal", "--sigma", 0.5, "--specimens", 4, "--true", "B10 = 2e6 cycles", "--true",
       "B10 = 3e6 cycles")
  same(ww_plan_demonstrate(goal, shape = 1.5, sudden_death = 6), "demonstrate", goal, "--shape", 1.5, "--sudden-death", 6)
})

test_that("a plan has numbers, frames, a text and a page", {
  plan <- ww_plan_demonstrate("B10 >= 1e6 cycles", time = "2e6 cycles")
  expect_identical(plan$summary$plans[[1]]$specimens, 22)  # ln(1 - 0.9)/ln(0.9) = 21.85
  expect_s3_class(plan$tables$plans, "data.frame")
  expect_identical(nrow(plan$tables$plans), 1L)
  expect_true(plan$trusted)
  shown <- capture.output(print(plan))
  expect_true(any(grepl("Without shape", shown)))  # the program says --shape
  expect_false(any(grepl("--[a-z]", shown)))
  page <- tempfile(fileext = ".html")
  ww_report(plan, page)
  expect_gt(file.size(page), 10000)
})

test_that("errors name the argument", {
  goal <- "B10 >= 1e6 cycles"
  refused(ww_plan_demonstrate("B10"), "goal: 'B10' states no goal")
  refused(ww_plan_demonstrate(goal, confidence = 1.5), "confidence: '1.5' must lie above 0 %")
  refused(ww_plan_demonstrate(goal, confidence = c(0.9, 0.95)), "confidence is a list; it is a text or a number")
  refused(ww_plan_demonstrate(goal, confidence = NA), "confidence is NA")
  refused(ww_plan_demonstrate(goal, sigma = 1), "sigma: a Weibull distribution has a shape")
  refused(ww_plan_demonstrate(goal, specimens = 2.5), "specimens is 2.5; it is a whole number")
  refused(ww_plan_demonstrate(goal, specimens = Sys.Date()), "specimens is Date")
  refused(ww_plan_demonstrate(goal, shape = 2, time = "1 m"), "time: '1 m'")
})

test_that("inspections are the program's, of tables, folders and fits", {
  table <- example("decide", "lives.csv")
  same(ww_plan_inspect(table, risk = 0.1, until = "1000 h"), "inspect", table, "--risk", 0.1, "--until", "1000 h")
  frame <- read.csv(table, check.names = FALSE)
  expect_identical(ww_plan_inspect(frame, risk = 0.1)$tables, ww_plan_inspect(table, risk = 0.1)$tables)
  fit <- quiet(ww_fit(example("formula", "study.toml"), seed = 1, report = FALSE))
  folder <- tempfile("results")
  ww_write(fit, folder)
  same(ww_plan_inspect(folder, risk = 0.05), "inspect", folder, "--risk", 0.05)
  same(ww_plan_inspect(fit, unit = "1", given = list(force = "20 N")), "inspect", folder, "--unit", 1, "--given", "force = 20 N",
       but_title = TRUE)
})

test_that("decisions are the program's, and units in service a frame or a file", {
  lives <- example("decide", "lives.csv")
  same(ww_decide(lives, "12000 EUR", "900 EUR", month = "300 h", months = 3, claims = "2 %"), lives, "--failure-cost", "12000 EUR",
       "--replacement-cost", "900 EUR", "--month", "300 h", "--months", 3, "--claims", "2 %", command = "decide", file = "decisions.json")
  fit <- quiet(ww_life(life ~ 1, data.frame(life = c(1200, 1500, 1900, 2300, 2600, 3100, 3600)), units = list(life = "h"), seed = 1,
                       method = "exact", draws = 100))
  folder <- tempfile("results")
  ww_write(fit, folder)
  ages <- data.frame(unit = c("P1", "P2"), "age [h]" = c(500, 2000), check.names = FALSE)
  file <- tempfile("ages", fileext = ".csv")
  write.csv(ages, file, row.names = FALSE, quote = FALSE)
  same(ww_decide(fit, 10, 1, in_service = ages), folder, "--failure-cost", 10, "--replacement-cost", 1, "--in-service", file,
       command = "decide", file = "decisions.json", but_title = TRUE)
  refused(ww_decide(fit, 10, 0), "replacement_cost: must be above 0")
  refused(ww_decide(lives, 10, 1, in_service = ages), "in_service: a table of lives has its running units")
})

test_that("errors of inspections name the argument", {
  table <- example("decide", "lives.csv")
  refused(ww_plan_inspect(table, total_risk = 0.01), "total_risk: needs warning")
  refused(ww_plan_inspect(table, new = 1), "new is a number; it is true or false")
  refused(ww_plan_inspect(table, unit = "P22"), "did you mean")
  refused(ww_plan_inspect(3), "lives is double")
  refused(ww_plan_next(list(a = 1), "B10"), "fit is list; it is a fit, or the folder of a result")
})

test_that("accelerated tests are the program's", {
  given <- list(use = "50 degC", highest = "120 degC", until = "183 d", specimens = 300, failing_at_use = "0.1 %")
  flags <- c("accelerate", "--use", "50 degC", "--highest", "120 degC", "--until", "183 d", "--specimens", 300, "--failing-at-use", "0.1 %")
  same(do.call(ww_plan_accelerate, c(given, sigma = 0.6, failing_at_highest = 0.9)), flags, "--sigma", 0.6, "--failing-at-highest", 0.9)
  same(do.call(ww_plan_accelerate, c(given, sigma = 0.6, failing_at_highest = 0.9, stop = list(c("366 d", "183 d", "92 d")))), flags,
       "--sigma", 0.6, "--failing-at-highest", 0.9, "--stop", "366 d, 183 d, 92 d")
  refused(do.call(ww_plan_accelerate, given), "shape, sigma: give one of them")
  refused(do.call(ww_plan_accelerate, c(given, sigma = 0.6, activation_energy = "0.7 eV", exponent = 4)),
          "exponent: belongs to relation inverse-power, not arrhenius")
})

test_that("next tests are the program's, of folders and fits, files and frames", {
  goal <- "B10 at softer spring"
  fit <- quiet(ww_fit(example("spring", "sensible.toml"), seed = 1, report = FALSE))
  folder <- tempfile("results")
  ww_write(fit, folder)
  tests <- data.frame("alternating_stress_MPa" = c(230, 260, 290), "mean_stress_MPa" = 1000, "stop [cycles]" = c(5e5, 3e5, 2e5),
                      "cost [EUR]" = c(900, 500, 300), check.names = FALSE)
  file <- tempfile(fileext = ".csv")
  write.csv(tests, file, row.names = FALSE)
  of_file <- ww_plan_next(folder, goal, candidates = file, cost = "cost")
  same(of_file, "next", folder, "--goal", goal, "--candidates", file, "--cost", "cost")
  of_frame <- ww_plan_next(fit, goal, candidates = tests, cost = "cost")
  expect_identical(of_frame$summary$candidates, of_file$summary$candidates)
  expect_identical(of_frame$tables$candidates, of_file$tables$candidates)
  grid <- list(alternating_stress_MPa = c(230, 250), mean_stress_MPa = 1000, stop = "5e5 cycles")
  same(ww_plan_next(folder, goal, grid = grid, specimens = c(1, 3), batch = 2, samples = 64, nodes = 200, seed = 7),
       "next", folder, "--goal", goal, "--grid", "alternating_stress_MPa = 230, 250; mean_stress_MPa = 1000; stop = 5e5 cycles",
       "--specimens", "1, 3", "--batch", 2, "--samples", 64, "--nodes", 200, "--seed", 7)
  same(ww_plan_next(folder, goal, candidates = file, cost = "cost", by = "loss", failure_cost = "20 EUR", replacement_cost = "1 EUR", nodes = 200),
       "next", folder, "--goal", goal, "--candidates", file, "--cost", "cost", "--by", "loss", "--failure-cost", "20 EUR", "--replacement-cost", "1 EUR",
       "--nodes", 200)
  refused(ww_plan_next(fit, "B10 at hanger", candidates = tests), "goal: the study has no")
  refused(ww_plan_next(fit, goal, candidates = tests, cost = "price"), "cost: candidates has no column 'price'")
  refused(ww_plan_next(fit, goal, candidates = tests, seed = -1), "seed is -1")
})

test_that("tests that were done are read as the Surv() of their fit", {
  lives <- data.frame(hours = c(5200, 3900, 8000, 1300, 2100, 990, 420, 610), failed = c(1, 1, 0, 1, 1, 1, 1, 1),
                      temperature = rep(c(330, 360, 390), c(3, 3, 2)))
  fit <- quiet(ww_life(Surv(hours, failed) ~ 1, data = lives, stress = c(temperature = "arrhenius"), units = c(hours = "h", temperature = "K"),
                       seed = 1, method = "exact", draws = 100, report = FALSE))
  goal <- "life_ref"
  done <- data.frame(hours = c(1500, 400), failed = c(1, 0), temperature = c(360, 390))
  own <- data.frame("life [h]" = done$hours, status = c("failure", "runout"), "temperature [K]" = done$temperature, check.names = FALSE)
  plan <- function(tests) quiet(ww_plan_next(fit, goal, grid = list(temperature = c(340, 380)), tests = tests, samples = 64, nodes = 200))$summary
  expect_identical(plan(done)$candidates, plan(own)$candidates)
  expect_identical(plan(done)$candidates, plan(list(done[1, ], done[2, ]))$candidates)
  expect_false(identical(plan(done)$candidates, plan(NULL)$candidates))
  refused(ww_plan_next(fit, goal, grid = list(temperature = 340), tests = done[c("hours", "temperature")]), "failed")
})

test_that("sizes are the program's", {
  study <- tempfile(fileext = ".toml")
  writeLines(c('title = "Wear of a liner"', 'model = "formula"', "[data]", 'file = "not-measured-yet.csv"', "[data.columns]",
               'wear = { column = "V", unit = "mm^3" }', 'force = { column = "F", unit = "N" }', 'distance = { column = "s", unit = "m" }',
               "[likelihood.wear]", 'family = "normal"', 'mean = "k * force * distance"', 'sd = "sigma"', "[prior]",
               'k = { distribution = "lognormal", median = "1e-7 mm^3/(N m)", log_sd = 1 }',
               'sigma = { distribution = "lognormal", median = "0.1 mm^3", log_sd = 0.3 }'), study)
  tests <- data.frame("F [N]" = c(100, 200), "s [m]" = 4e4, specimens = c(1, 2), check.names = FALSE)
  file <- tempfile(fileext = ".csv")
  write.csv(tests, file, row.names = FALSE)
  plan <- ww_plan_size(study, "k", "factor 1.3", file, simulations = 20, most = 40, seed = 3)
  same(plan, "size", study, "--goal", "k", "--tests", file, "--width", "factor 1.3", "--simulations", 20, "--most", 40, "--seed", 3)
  expect_identical(ww_plan_size(study, "k", "factor 1.3", tests, simulations = 20, most = 40, seed = 3)$summary, plan$summary)
  refused(ww_plan_size(study, "k", "factor 0.5", tests), "width: 'factor 0.5'")
  refused(ww_plan_size(study, "k", "factor 2", tests, simulations = 5), "simulations is 5; it is a whole number from 20 to 100000")
  refused(ww_plan_size(tests, "k", "factor 2", tests), "study is data.frame; it is a study")
})
