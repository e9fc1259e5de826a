# docs/reference/r.md: every block of R, in its order, in one place, where the examples are.

test_that("every block runs", {
  text <- readLines(file.path(source_of_project(), "docs", "reference", "r.md"))
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
  expect_true(all(c("draws_1.csv", "report.html", "summary.json") %in% list.files("joint-results")))
  expect_identical(space$left$of, "joint J5")
  expect_true(file.exists("fit.nc"))
})
