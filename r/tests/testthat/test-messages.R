# Messages, advice and reports name arguments and functions of R, not options and commands.

test_that("options become arguments", {
  texts <- c(
    "Draw more (--draws, --warmup), or use --method exact." = "Draw more (draws, warmup), or use method = \"exact\".",
    "target_accept, or use --method\n    exact." = "target_accept, or use\n    method = \"exact\".",
    "--scar-width: '--depth' must be positive" = "scar_width: '--depth' must be positive",
    "add --repeated once or --repeated another" = "add repeated = \"once\" or repeated = \"another\"",
    "fitted with --no-report; fit it again" = "fitted with report = FALSE; fit it again",
    "fit them first: wearwell update springs TESTS -o NEW" = "fit them first: ww_update(fit, tests)",
    "see wearwell plan inspect and wearwell decide --inspect-after" = "see ww_plan_inspect and ww_decide(inspect_after = ...)",
    "is not possible with `wearwell plan next`: more" = "is not possible with ww_plan_next: more",
    "are for the command line (wearwell plan inspect, wearwell decide)" = "are for the command line (wearwell plan inspect, wearwell decide)",
    "  with --rows here, or in tables/coverage.csv" = "  in tables/coverage.csv",
    "44 more rows: -o writes all to tables/inspections.csv" = "44 more rows: tables[[\"inspections\"]] has all",
    "columns '--draws', a--draws and --draws=3 stay" = "columns '--draws', a--draws and --draws=3 stay")
  expect_identical(wearwell:::in_arguments(names(texts)), unname(texts))
  expect_identical(wearwell:::in_arguments(unname(texts)), unname(texts))
})

test_that("refusals name arguments", {
  expect_error(ww_bearing_life("", radius = "1 mm"), "^contact is missing", class = "wearwell_input_error")
  expect_error(ww_select(example("formula", "wear.csv"), "h_um"), "^inputs [(]with degree[)] or terms is missing", class = "wearwell_input_error")
  expect_error(ww_fit(example("clutch", "study.toml"), method = "nuts"), "^method, chains, draws, warmup and seed are for", class = "wearwell_input_error")
})

test_that("advice names arguments", {
  warned <- character()
  fit <- withCallingHandlers(
    ww_fit(example("joint", "study.toml"), seed = 1, method = "nuts", draws = 10, warmup = 10, chains = 2, report = FALSE, progress = FALSE),
    wearwell_check_warning = function(w) {
      warned <<- c(warned, conditionMessage(w))
      invokeRestart("muffleWarning")
    })
  expect_true("Draw more (draws, warmup), or use method = \"exact\"." %in% fit$checks$advice)
  expect_true(any(grepl("method = \"exact\"", warned, fixed = TRUE)))
  expect_false(any(grepl("--[a-z]", c(warned, fit$text, fit$checks$advice))))
})
