# Columns of every kind, in every argument that names one: an answer, or a refusal that names the argument or the column.

hours <- c(120, 340, 560, 230, 450, 610, 80, 150)
event <- c(1, 1, 1, 1, 0, 1, 1, 0)
site <- rep(c("a", "b"), 4)
temperature <- rep(c(300, 320), 4)

# name: a column made from the values of a good one
kinds <- list(
  `as it is` = identity,
  integer = function(v) if (is.numeric(v)) as.integer(v) else v,
  factor = factor,
  ordered = function(v) factor(v, ordered = TRUE),
  texts = as.character,
  `as is` = I,
  logical = function(v) rep(c(TRUE, FALSE), 4),
  `NA` = function(v) replace(v, 3, NA),
  `NaN` = function(v) if (is.numeric(v)) replace(v, 3, NaN) else v,
  infinite = function(v) if (is.numeric(v)) replace(v, 3, Inf) else v,
  `minus infinity` = function(v) if (is.numeric(v)) replace(v, 3, -Inf) else v,
  `all NA` = function(v) rep(NA, 8),
  negative = function(v) if (is.numeric(v)) replace(v, 3, -7) else v,
  zero = function(v) rep(0, 8),
  alike = function(v) rep(v[1], 8),
  complex = function(v) complex(8, 1),
  raw = function(v) as.raw(1:8),
  date = function(v) as.Date("2020-01-01") + 1:8,
  POSIXct = function(v) as.POSIXct("2020-01-01", tz = "UTC") + 1:8,
  POSIXlt = function(v) as.POSIXlt(as.POSIXct("2020-01-01", tz = "UTC") + 1:8),
  difftime = function(v) as.difftime(1:8, units = "hours"),
  integer64 = function(v) structure(as.double(1:8), class = "integer64"),
  list = function(v) I(as.list(v)),
  ragged = function(v) I(c(list(1:2), as.list(v[-1]))),
  `list of NULL` = function(v) I(rep(list(NULL), 8)),
  frames = function(v) I(rep(list(data.frame(a = 1)), 8)),
  functions = function(v) I(rep(list(mean), 8)),
  matrix = function(v) matrix(v, 8, 2),
  `one column` = function(v) matrix(v, 8, 1),
  frame = function(v) data.frame(a = v, b = v),
  unknown = function(v) structure(as.list(v), class = "rcrd"),
  mixed = function(v) c(as.character(v)[1:3], "seven", as.character(v)[5:8]),
  blanks = function(v) rep(" ", 8),
  huge = function(v) if (is.numeric(v)) rep(1e300, 8) else v,
  tiny = function(v) if (is.numeric(v)) rep(1e-300, 8) else v,
  `signs and lines` = function(v) rep("\"];\n#", 8),
  latin1 = function(v) rep("caf\xe9", 8),
  bytes = function(v) {
    text <- rep("\xff", 8)
    Encoding(text) <- "UTF-8"
    text
  })

frame_with <- function(column, values, frame = list(hours = hours, event = event, site = site, temperature = temperature)) {
  frame[[column]] <- values
  structure(frame, class = "data.frame", row.names = 1:8)
}

forms <- list(
  conditions = function(frame) ww_life(Surv(hours, event) ~ site, data = frame, stress = c(temperature = "arrhenius"), units = c(temperature = "K"), fit = FALSE),
  effects = function(frame) ww_life(Surv(hours, event) ~ temperature + (1 | site), data = frame, fit = FALSE),
  modes = function(frame) ww_life(Surv(hours, event) ~ temperature, data = frame, mode = "site", fit = FALSE),
  path = function(frame) ww_degradation(hours ~ temperature | site, data = frame, unused = "event", fit = FALSE))

for (form in names(forms)) {
  test_that(paste("a column of each kind is read, or refused by name:", form), {
    for (column in c("hours", "event", "site", "temperature")) {
      for (kind in names(kinds)) {
        frame <- frame_with(column, kinds[[kind]](get(column)))
        found <- tryCatch(suppressWarnings(ww_description(forms[[form]](frame))), error = identity)
        about <- paste(form, column, kind)
        if (!inherits(found, "condition")) {
          expect_match(found, "Will be fitted", info = about)
        } else {
          expect_s3_class(found, "wearwell_input_error")
          expect_match(conditionMessage(found), paste0("\\b(", column, "|Surv|stress|by|mode|life|readings|formula|contradict)\\b"), info = paste(about, conditionMessage(found)))
        }
      }
    }
  })
}

test_that("frames of every kind are read or refused", {
  good <- frame_with("hours", hours)
  tibble <- structure(good, class = c("tbl_df", "tbl", "data.frame"))
  expect_identical(forms$effects(tibble)$text, forms$effects(good)$text)
  refused(forms$effects(good[0, ]), "data has no rows")
  refused(forms$effects(good["hours"]), "data has no column 'event'")
  twice <- good
  names(twice)[4] <- "hours"
  refused(forms$effects(twice), "two columns are called 'hours'")
  names(twice)[4] <- NA
  refused(forms$effects(twice), "column 4 has no name")
  refused(forms$effects(as.matrix(good)), "matrix")
  refused(forms$effects(unclass(good)$hours), "data is double")
  refused(forms$effects(mean), "data is closure")
  refused(forms$effects(list(1, 2)), "the columns have no names")
})

presets <- list(
  ww_sn = list(
    study = function(frame) ww_sn(frame, "S", "N", event = "end", stress_ratio = "R", label = "batch", count = "tests", units = c(N = "cycles", S = "MPa"), fit = FALSE),
    frame = list(N = c(1:7, 7) * 1e5, S = c(400, 380, 360, 340, 320, 310, 300, 290), end = rep(c(1, 1, 1, 0), 2), R = rep(-1, 8), batch = site, tests = rep(1, 8))),
  ww_staircase = list(
    study = function(frame) ww_staircase(frame, "S", "end", count = "tests", units = c(S = "MPa"), fit = FALSE),
    frame = list(S = c(300, 310, 320, 310, 300, 310, 320, 310), end = rep(0:1, 4), tests = rep(1, 8))),
  ww_joint = list(
    study = function(frame) ww_joint(frame, "V", "n", work = "w", predict = list(work_per_cycle = "6.2 N m"), limit = "200 mm^3", units = c(V = "mm^3", n = "cycles", w = "N m"), fit = FALSE),
    frame = list(V = c(20, 35, 60, 80, 95, 120, 140, 155), n = 1:8 * 1000, w = rep(6.2, 8))),
  ww_bearing = list(
    study = function(frame) ww_bearing(frame, "d", revolutions = "turns", contact = "journal", radius = "10 mm", clearance = "20 um", pressure = "p", unit = "place",
                                       units = c(d = "um", p = "MPa"), fit = FALSE),
    frame = list(d = c(5, 9, 14, 20, 24, 31, 33, 41), turns = 1:8 * 1e5, p = rep(1.5, 8), place = site)),
  ww_repairable = list(
    study = function(frame) ww_repairable(frame, "age", unit = "part", event = "what", units = c(age = "h"), fit = FALSE),
    frame = list(age = c(100, 250, 400, 90, 300, 500, 40, 420), part = rep(c("A", "B", "C"), c(3, 3, 2)), what = c("failure", "failure", "end")[c(1, 2, 3, 1, 2, 3, 1, 3)])),
  ww_returns = list(
    study = function(frame) ww_returns(frame, sold = "sold", returned = "back", until = "2024-12", fit = FALSE),
    frame = list(sold = rep(c("2024-01", "2024-02", "2024-03", "2024-04"), 2), back = rep(c("2024-05", "", "2024-08", ""), 2))))

for (preset in names(presets)) {
  test_that(paste("columns of presets are read, or refused by their headings:", preset), {
    study <- presets[[preset]]$study
    good <- presets[[preset]]$frame
    text <- study(good)$text
    for (column in names(good)) {
      for (kind in c("as is", "factor", "NA", "infinite", "minus infinity", "date", "difftime", "integer64", "list", "functions", "matrix", "frame", "bytes")) {
        frame <- frame_with(column, kinds[[kind]](good[[column]]), good)
        found <- tryCatch(ww_description(study(frame)), error = identity)
        about <- paste(preset, column, kind)
        if (kind %in% c("as is", "factor")) {
          expect_identical(study(frame)$text, text, info = about)
        } else if (inherits(found, "condition")) {
          expect_s3_class(found, "wearwell_input_error")
          expect_match(conditionMessage(found), paste0("\\bcolumn '", column, "'"), info = about)
        }
      }
    }
    expect_identical(study(structure(good, class = c("tbl_df", "tbl", "data.frame"), row.names = 1:8))$text, text)
    refused(study(data.frame()), "data has no columns")
    refused(study("tests.csv"), "data is \"tests.csv\"; it is a data frame")
  })
}

campaign <- list(
  design = list(point = 1:8, role = rep("model", 8), `slip_speed [rpm]` = 1:8 * 200, `torque [N m]` = rep(25, 8), `temperature [degC]` = rep(120, 8), `closing_time [s]` = rep(0.9, 8)),
  cycles = list(plate = rep(1, 8), cycle = 1:8, `slip_speed [rpm]` = rep(1200, 8), `torque [N m]` = rep(25, 8), `temperature [degC]` = rep(120, 8), `closing_time [s]` = rep(0.9, 8),
                `energy [J]` = rep(25131, 8)),
  weighings = list(plate = rep(1, 8), cycle = 0:7, block = c("start", rep("run-in", 7)), `mass [g]` = 250 - 0:7 * 0.01))

test_that("columns of a clutch's tables are read, or refused by table and column", {
  study <- function(tables) {
    ww_clutch(tables$design, tables$cycles, tables$weighings, density = "2.2 g/cm^3", depth = "1 mm", area = "100 cm^2", balance_sd = "1 mg", fit = FALSE)
  }
  of_all <- lapply(campaign, function(table) frame_with("x", NULL, table))
  for (table in names(campaign)) {
    for (column in names(campaign[[table]])) {
      for (kind in setdiff(names(kinds), c("as it is", "integer", "factor", "ordered", "texts", "as is", "negative", "zero", "alike", "huge", "tiny"))) {
        tables <- of_all
        tables[[table]] <- frame_with(column, kinds[[kind]](campaign[[table]][[column]]), campaign[[table]])
        found <- tryCatch(study(tables), error = identity)
        if (!inherits(found, "condition")) next
        about <- paste(table, column, kind)
        expect_s3_class(found, "wearwell_input_error")
        expect_match(conditionMessage(found), paste0("^", table, "|^run-in: "), info = paste(about, conditionMessage(found)))
      }
    }
  }
})

test_that("texts of 0 and 1 are read as the codes, and what a preset refuses has the names of its arguments", {
  good <- presets$ww_sn$frame
  values <- function(frame) presets$ww_sn$study(frame)$columns$status$values
  expect_identical(values(replace(good, "end", list(as.character(good$end)))), values(good))
  expect_identical(values(replace(good, "end", list(good$end == 1))), values(good))
  sn <- function(...) ww_sn(good, "S", "N", event = "end", stress_ratio = "R", unused = "batch", count = "tests", units = c(N = "cycles", S = "MPa"), fit = FALSE, ...)
  refused(sn(curve = "bent"), "curve: 'bent' is not allowed")
  refused(sn(correction = "none of them"), "correction: 'none of them' is not allowed")
  refused(sn(family = "cauchy"), "family: 'cauchy' is not allowed")
  refused(sn(at = "300 kg"), "at: '300 kg': alternating_stress: unit 'kg'")
  refused(ww_joint(presets$ww_joint$frame, "V", "n", work_per_cycle = "6.2 N m", at = "soon", units = c(V = "mm^3", n = "cycles"), fit = FALSE), "at: entry 1: 'soon'")
  refused(ww_staircase(presets$ww_staircase$frame, "S", "end", confidence = 2, units = c(S = "MPa"), fit = FALSE), "confidence: must lie between 0 and 1")
})
