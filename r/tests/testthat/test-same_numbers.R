# An example of each model, fitted here and by the program with the same seed: byte for byte the same files.

files_below <- function(folder) {
  names <- list.files(folder, recursive = TRUE)
  stats::setNames(lapply(file.path(folder, names), function(file) readBin(file, "raw", file.size(file))), names)
}

# A copy of the clutch's study with nine pairs of exponents and few repetitions: the whole search takes many seconds.
with_few_exponents <- function(study, folder) {
  dir.create(folder)
  file.copy(list.files(dirname(study), full.names = TRUE), folder)
  few <- c(lowest = "0.4", highest = "1.2", step = "0.4", replicates = "5")
  copy <- file.path(folder, basename(study))
  text <- readLines(copy)
  for (key in names(few)) {
    line <- grep(paste0("^", key, " = "), text)
    stopifnot(length(line) == 1)
    text[line] <- paste(key, "=", few[[key]])
  }
  writeLines(text, copy)
  copy
}

# Further kinds of files are those of the same reader, in Python's tests of the same name.
studies <- paste0(c("bearing/study", "clutch/study", "fatigue/study", "joint/study", "life/study", "messy/german_excel", "staircase/study"), ".toml")

test_that("package and program are of one version", {
  expect_match(program("--version")$out, as.character(utils::packageVersion("wearwell")), fixed = TRUE)
})

test_that("files of examples are those of the program", {
  for (name in studies) {
    study <- example(name)
    if (dirname(name) == "clutch") study <- with_few_exponents(study, tempfile("clutch"))
    seed <- if (dirname(name) == "clutch") NULL else 7  # a campaign has its seeds in its file
    there <- tempfile("there")
    here <- tempfile("here")
    done <- program("fit", study, if (!is.null(seed)) c("--seed", seed, "--draws", 200, "--warmup", 200), "--quiet", "--no-report", "-o", there)
    expect_lte(done$code, 1)
    few <- if (!is.null(seed)) 200
    fit <- quiet(ww_fit(study, seed = seed, draws = few, warmup = few, report = FALSE))
    ww_write(fit, here)
    expect_identical(fit$trusted, done$code == 0, info = name)
    expect_identical(files_below(here), files_below(there), info = name)
    unlink(c(here, there), recursive = TRUE)
    if (dirname(name) == "clutch") {  # a campaign has tables and no posterior
      refused(fit$parameters, "no parameters")
      refused(ww_netcdf(fit, tempfile()), "no posterior")
      refused(ww_loo(fit), "ww_loo(): a study of the model clutch-wear has no posterior")
      expect_match(capture.output(print(summary(fit)))[2], "rusted|RUSTED")
    }
  }
})

test_that("another method and its report", {
  study <- example("joint", "study.toml")
  there <- tempfile()
  here <- tempfile()
  done <- program("fit", study, "--method", "metropolis", "--chains", 3, "--draws", 500, "--warmup", 200, "--seed", 11, "-o", there)
  fit <- quiet(ww_fit(study, seed = 11, method = "metropolis", chains = 3, draws = 500, warmup = 200))
  ww_write(fit, here)
  one <- files_below(here)
  other <- files_below(there)
  expect_identical(names(one), names(other))
  timed <- c("report.html", "report.json", "results.sha1")  # the page tells the seconds that it took; the list has its sum
  expect_identical(one[setdiff(names(one), timed)], other[setdiff(names(other), timed)])
  expect_true(startsWith(wearwell:::in_arguments(done$out), fit$text))  # arguments in place of options
  page <- tempfile(fileext = ".html")
  ww_report(fit, page)
  expect_identical(readBin(page, "raw", file.size(page)), one[["report.html"]])
})

test_that("draws are those of the files, in posterior's layout", {
  fit <- ww_fit(example("joint", "study.toml"), seed = 5, report = FALSE)
  folder <- tempfile()
  ww_write(fit, folder)
  for (chain in 1:4) {
    written <- read.csv(file.path(folder, paste0("draws_", chain, ".csv")), comment.char = "#", colClasses = "character")
    expect_identical(exactly(written$k), as.vector(unclass(fit$draws)[, chain, "k"]))
    expect_identical(exactly(written$sigma), as.vector(unclass(fit$draws)[, chain, "sigma"]))
    stats <- fit$sample_stats[fit$sample_stats$chain == chain, ]
    expect_identical(exactly(written$energy__), stats$energy)
    expect_identical(written$divergent__ == "1", stats$divergent)
  }
})

test_that("the number of threads changes nothing", {
  one <- ww_fit(example("joint", "study.toml"), seed = 2, threads = 1, report = FALSE)
  all <- ww_fit(example("joint", "study.toml"), seed = 2, report = FALSE)
  expect_identical(one$summary, all$summary)
  expect_identical(one$draws, all$draws)
})
