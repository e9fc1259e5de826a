# Damage, design curves and load spectra: the program's numbers to the last digit, tables of any kind, errors of arguments.

curve <- local({
  found <- NULL
  function() {
    if (is.null(found)) {
      fit <- quiet(ww_fit(example("spectrum", "study.toml"), seed = 1, method = "exact", draws = 100, report = FALSE))
      folder <- tempfile("curve")
      ww_write(fit, folder)
      found <<- list(fit = fit, folder = folder)
    }
    found
  }
})

texts_of_folder <- function(folder) {
  names <- grep("[.](json|csv)$", list.files(folder, recursive = TRUE), value = TRUE)
  stats::setNames(vapply(file.path(folder, names), function(file) readChar(file, file.size(file), useBytes = TRUE), ""), names)
}

# JSON and tables are what the program writes for these arguments, apart from the lines of `keys`.
same_answer <- function(answer, ..., keys = character()) {
  there <- tempfile("there")
  here <- tempfile("here")
  done <- program("fatigue", ..., "-o", there)
  expect_identical(done$code, 0L)
  expect_s3_class(answer, "ww_answer")
  ww_write(answer, here)
  one <- texts_of_folder(here)
  other <- texts_of_folder(there)
  for (key in keys) {
    line <- sprintf("\"%s\": \"[^\n]*\"", key)
    one <- sub(line, "", one)
    other <- sub(line, "", other)
  }
  expect_identical(one, other)
  unlink(c(here, there), recursive = TRUE)
  done$out
}

loads <- function() example("spectrum", "loads.csv")

test_that("damage is the program's", {  # a sum over 30 000 points of the posterior takes seconds: one of them
  cycles <- data.frame(range = c(900, 480), mean = c(0, 50), count = c(2, 2000))
  file <- tempfile(fileext = ".csv")
  write.csv(cycles, file, row.names = FALSE)
  expect_warning(found <- ww_damage(curve()$fit, cycles, units = "MPa", block = "100 h", b = c(1, 5), confidence = 0.95), "extrapolation warns",
                 class = "wearwell_check_warning")
  same_answer(found, "life", curve()$folder, file, "--unit", "MPa", "--block", "100 h", "--b-lives", 1, 5, "--confidence", 95, keys = "history")
  expect_identical(found$lives$percent, c(1, 5))
  expect_identical(unique(found$lives$unit), "h")
  expect_true(all(found$lives$bound < found$lives$q50) && all(diff(found$life) > 0) && all(diff(found$damage) > 0))
  expect_equal(sum(found$sources$share), 1, tolerance = 0.01)
})

test_that("design curves and spectra are the program's", {
  found <- quiet(ww_design(curve()$folder, stress = c("300 MPa", "500 MPa"), stress_ratio = -1, reliability = 0.99, confidence = 0.95))
  same_answer(found, "design", curve()$folder, "--stress", "300 MPa", "--stress", "500 MPa", "--stress-ratio", -1, "--reliability", 99,
              "--confidence", 95)
  expect_identical(found$curves$stress, c(500, 300))
  one <- quiet(ww_design(steel = curve()$fit, stress = "400 MPa", stress_ratio = -1))
  expect_identical(one$models$study, "steel")
  expect_identical(one$curves$curve, c("90/90", "B-basis", "A-basis", "97.7/90"))
  counted <- ww_spectrum(loads(), column = "stress", bins = 12)
  same_answer(counted, "rainflow", loads(), "--column", "stress", "--bins", 12)
  stress <- read.csv(loads(), check.names = FALSE)[["stress [MPa]"]]
  expect_identical(ww_spectrum(stress, units = "MPa", bins = 12)$tables$cycles, counted$tables$cycles)
  expect_setequal(names(counted$tables), c("cycles", "matrix", "spectrum", "levels"))
  expect_output(print(counted), "531 cycles, 519 of them closed")
})

test_that("errors name argument or cell", {
  fit <- curve()$fit
  signal <- data.frame("stress [MPa]" = c(0, 900, 100, 800), check.names = FALSE)
  refused(ww_damage(fit, c(0, 900, 100)), "loads, column 'load' has no unit")
  refused(ww_damage(fit, c(0, NA, 100), units = "MPa"), "loads, row 2, column 'load': no value")
  refused(ww_damage(fit, signal, rule = "haibch"), "did you mean 'haibach'?")
  refused(ww_damage(fit, signal, knee = 150), "knee: '150' may be a life or a stress")
  refused(ww_damage(fit, signal, confidence = 90), "confidence: 90 is not a share")
  refused(ww_damage(fit, signal, b = 0), "b: 0 is not a percentage")
  refused(ww_damage(fit, Sys.Date()), "loads")
  refused(ww_design(fit, stress = "400 MPa", stress_ratio = -1, mean_stress = "0 MPa"), "say the same in two ways")
  refused(ww_design(fit, fit, names = c("x", "x")), "names: 'x' is given twice")
  refused(ww_design(), "at least")
  refused(ww_design(3), "design takes fits or folders of results, not double")
  refused(ww_spectrum(c(1, 2, 1), bins = 0), "bins is 0; it is a whole number from 1 to 1024")
})
