# Pages with R: every block, in its order, in one place, where the examples are.

run_blocks <- function(...) {
  text <- readLines(file.path(source_of_project(), "docs", ...), encoding = "UTF-8")
  starts <- which(text == "```r")
  expect_gte(length(starts), 8)
  folder <- tempfile()
  dir.create(folder)
  file.symlink(example(), file.path(folder, "examples"))
  old <- setwd(folder)
  on.exit(setwd(old))
  grDevices::pdf(NULL)
  space <- new.env(parent = globalenv())
  capture.output(quiet(for (start in starts) {
    end <- start + which(text[-(1:start)] == "```")[1]
    eval(parse(text = text[(start + 1):(end - 1)]), space)
  }))
  grDevices::dev.off()
  space$files <- list.files(recursive = TRUE)
  space
}

test_that("every block of the reference runs", {
  space <- run_blocks("reference", "r.md")
  expect_true(all(file.path("joint-results", c("draws_1.csv", "report.html", "summary.json")) %in% space$files))
  expect_identical(space$left$of, "joint J5")
  expect_true("fit.nc" %in% space$files)
})

test_that("the page for users of survival compares both", {  # in its blocks
  skip_if_not_installed("survival")
  space <- run_blocks("how-to", "coming-from-survival.md")
  expect_match(space$study$text, "characteristic = { distribution = \"lognormal\", log_sd = \"characteristic_scatter\" }", fixed = TRUE)
})

test_that("the page for users of brms agrees with a published fit of brms", {  # in its blocks
  skip_if_not_installed("survival")
  space <- run_blocks("how-to", "coming-from-brms.md")
  expect_match(space$between$text, "lower", fixed = TRUE)
  expect_match(space$late$text, "entry", fixed = TRUE)
  expect_match(space$study$text, "slope = { distribution = \"gamma\", shape = 4, scale = 0.5 }", fixed = TRUE)
})

test_that("the page for users of WeibullR compares with survival", {
  skip_if_not_installed("survival")
  space <- run_blocks("how-to", "coming-from-weibullr.md")
  expect_false(space$fit$trusted)
  expect_match(space$cracks$text, "count = ", fixed = TRUE)
})
