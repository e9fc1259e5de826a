# The other models in one line: their studies are those that one would write, and their errors name arguments.

test_that("degradation is a formula study with a rate of each unit", {
  wear <- expand.grid(km = c(10, 20, 30), machine = c("A", "B", "C", "D"), stringsAsFactors = FALSE)
  wear$depth <- rep(c(0.9, 1.1, 1.4, 0.7), each = 3) * wear$km + c(0.3, -0.4, 0.2, 0.1, -0.2, 0.4)
  units <- c(depth = "um", km = "km")
  keys <- function(study) wearwell:::core(wearwell:::C_keys, study$text)
  fit <- ww_degradation(depth ~ km | machine, wear, units = units, fit = FALSE)
  own <- ww_study(formula = "depth = rate * km", data = wear, units = units, unit = "machine", random_effects = "rate",
                  priors = list(rate = ww_lognormal("2 um/km", log_sd = 2), sigma = ww_half_normal("50 um"), rate_scatter = ww_half_normal(1)))
  expect_identical(keys(fit)[c("prior", "random_effects")], keys(own)[c("prior", "random_effects")])
  expect_identical(keys(fit)$formula$path, keys(own)$likelihood$depth$mean)
  expect_match(fit$notes, "no limit is given: wear is fitted, and no life is predicted")
  text <- function(...) ww_degradation(..., data = wear, fit = FALSE)$text
  expect_match(text(depth ~ km | machine, limit = "100 um", units = units), "limit = { path = \"100 um\" }", fixed = TRUE)
  expect_match(text(depth ~ km, unit = "machine"), "[random_effects.machine]", fixed = TRUE)
  expect_match(text(depth ~ km | machine, path = "power"), "path = \"rate * 50 * (km/50)^power\"", fixed = TRUE)
  expect_match(text(depth ~ km | machine, start = TRUE), "start = { distribution = \"normal\", sd = \"start_scatter\" }", fixed = TRUE)
  expect_match(text(depth ~ km | machine, family = "gamma-process"), "family = \"gamma-process\"\nmean = \"rate * km\"\nscale = \"step_ratio\"", fixed = TRUE)
  expect_identical(ww_degradation(wear, "depth", "km", unit = "machine", fit = FALSE)$text, text(depth ~ km | machine))
  rising <- function(km, depth, family) ww_degradation(depth ~ km, data.frame(km, depth), family = family, fit = FALSE)
  refused(rising(0:2, c(0, 1.1, 2), "gamma-process"), "data, row 1, column 'km': 0; a path of the family \"gamma-process\" begins at 0, so a reading there says nothing: leave out the row")
  refused(rising(c(-1, 1, 2), c(0.1, 1.1, 2), "lognormal"), "data, row 1, column 'km': -1 must be positive: a path of the family \"lognormal\" begins at 0")
  refused(rising(1:3, c(1.1, 0, 3.1), "lognormal"), "data, row 2, column 'depth': 0 must be positive for the family \"lognormal\"; family = \"normal\" takes")
  refused(rising(1:3, c(TRUE, TRUE, FALSE), "normal"), "column 'depth' holds TRUE and FALSE; it is a number in each row")
  refused(text(depth ~ km | mashine), "unit: data has no column 'mashine'")
  expect_match(text(-depth ~ km | machine), "path = \"-rate * km\"", fixed = TRUE)
  expect_match(text(500 - depth ~ km | machine, limit = 400), "path = \"start - rate * km\"", fixed = TRUE)
  expect_match(text(depth ~ km | machine, starts_at_zero = FALSE), "start = { distribution = \"normal\", mean = 25", fixed = TRUE)
  refused(text(-depth ~ km | machine, family = "gamma-process"), "its paths only rise, and wear falls")
  refused(text(depth ~ km | machine, start = TRUE, starts_at_zero = TRUE), "each unit begins at a value of its own")
  refused(text(depth ~ km | machine, family = "gamma-process", start = TRUE), "start = TRUE needs family = \"normal\"")
  refused(text(depth ~ km | machine, limt = "100 um"), "did you mean 'limit'?")
  refused(suppressWarnings(text(depth ~ km)), "unit is missing: km falls at row 4 from 30 to 10")
  expect_no_match(suppressWarnings(text(depth ~ km, unit = FALSE)), "random_effects")
})

test_that("an S-N study of arguments is that of the file", {
  tests <- read.csv(example("fatigue", "tests.csv"))
  priors <- list(log10_a = ww_normal("3.3 log10(MPa)", 0.3), b = ww_normal(-0.1, 0.04), log10_Sut = ww_normal("3.08 log10(MPa)", 0.05), sigma = ww_half_normal(0.3))
  units <- c(stress_amplitude_MPa = "MPa", cycles = "cycles")
  sn <- function(..., data = tests) ww_sn(data, life = "cycles", stress = "stress_amplitude_MPa", units = units, ...)
  study <- sn(event = "status", stress_ratio = "stress_ratio", correction = "goodman", priors = priors, fit = FALSE, at = list(shaft = list(alternating_stress = "400 MPa", stress_ratio = -1)))
  keys <- wearwell:::core(wearwell:::C_keys, study$text)
  file <- wearwell:::core(wearwell:::C_keys, paste(readLines(example("fatigue", "study.toml")), collapse = "\n"))
  expect_identical(keys$law, file$law)
  expect_identical(keys$predict$stress$shaft, file$predict$stress$shaft)
  expect_identical(keys$prior$b, file$prior$b)
  reversed <- tests[tests$stress_ratio == -1, ]
  fit <- quiet(sn(event = "status", stress_ratio = -1, data = reversed, at = "400 MPa", seed = 1, method = "exact", draws = 100, report = FALSE))
  coded <- quiet(sn(event = "failed", stress_ratio = -1, data = transform(reversed[names(reversed) != "status"], failed = as.integer(reversed$status == "failure")),
                    at = "400 MPa", seed = 1, method = "exact", draws = 100, report = FALSE))
  expect_identical(coded$parameters, fit$parameters)
  expect_output(print(fit), "Default priors.*log10_a +normal")
  refused(sn(event = "status", correction = "gerber"), "correction = \"gerber\" needs stress_ratio or mean_stress")
  asked <- function(at, ...) wearwell:::core(wearwell:::C_keys, sn(event = "status", stress_ratio = -1, data = reversed, at = at, fit = FALSE, ...)$text)
  expect_identical(wearwell:::name_of_stress(100000), "100000")
  expect_identical(asked(320)$predict$stress$`320`, list(alternating_stress = "320 MPa", stress_ratio = -1))
  expect_identical(asked(c("320 MPa", "0.33 GPa"), scatter = "grows")$predict$stress$`0.33 GPa`$alternating_stress, "0.33 GPa")
  refused(asked("soon"), "at: 'soon': alternating_stress: 'soon' is not a number with a unit")
  refused(sn(stress_ratio = -1), "looks like how each life ended")
  refused(sn(event = "status", stress_ratio = "ratio"), "stress_ratio: data has no column 'ratio'")
  expect_error(sn(event = "status", stress_ratio = -1, curve = "knees", fit = FALSE), "curve", class = "wearwell_input_error")
})

test_that("staircase, joint and bearing are the studies of their files", {
  stairs <- read.csv(example("staircase", "tests.csv"), check.names = FALSE)
  fit <- quiet(ww_staircase(stairs, "amplitude", "status", seed = 1, method = "exact", draws = 100, report = FALSE,
                            priors = list(log10_limit = ww_normal("2.5 log10(MPa)", 0.2), sigma_limit = ww_half_normal(0.05))))
  same <- quiet(ww_fit(example("staircase", "study.toml"), seed = 1, method = "exact", draws = 100, report = FALSE))
  expect_identical(fit$parameters$mean, same$parameters$mean)
  joint <- data.frame(cycles = c(1, 100, 1000, 5000, 10000), volume = c(4.4, 8.8, 8.1, 25.9, 45.3))
  one <- ww_joint(joint, "volume", "cycles", work_per_cycle = "5.966 N m", limit = "100 mm^3", units = c(volume = "mm^3"), fit = FALSE)
  expect_output(print(one), "V = k W, W = cycles x 5.966 N m")
  refused(ww_joint(joint, "volume", "cycles"), "work_per_cycle is missing")
  expect_identical(wearwell:::core(wearwell:::C_keys, one$text)$predict$cycles, 20000)
  refused(ww_joint(transform(joint, w = cycles * 6), "volume", "cycles", work = "w", work_per_cycle = "6 N m", units = c(volume = "mm^3", w = "N m")),
          "predict = list(work_per_cycle = \"6 N m\")")
  refused(ww_joint(data.frame(V = 1:4, n = 1:4 * 1000), "V", "n", work_per_cycle = "1 J", fit = FALSE), "column 'V' needs a unit: units = c(V = \"m^3\"), or 'V [m^3]' as the heading")
  refused(ww_joint(joint, "volum", "cycles", work_per_cycle = "1 N m"), "volume: data has no column 'volum'")
  worn <- read.csv(example("bearing", "inspections.csv"))
  bearing <- function(...) ww_bearing(worn, "depth_um", revolutions = "revolutions", unit = "bearing", contact = "stationary", force = "force_N", length = "20 mm",
                                      depth_error = "2 um", units = c(depth_um = "um", clearance_um = "um", force_N = "N"), ..., fit = FALSE)
  two <- bearing(radius = "10 mm", clearance = "clearance_um", limit = "80 um", predict = list(clearance = "30 um", pressure = "1.5 MPa"))
  expect_match(two$text, "[conditions]\ncontact = \"stationary\"\nradius = \"10 mm\"\nlength = \"20 mm\"", fixed = TRUE)
  expect_match(two$notes, "differs from bearing to bearing")
  refused(bearing(radius = "10 mm", clearance = "clearance_um", limit = "80 um"), "needs predict = list(clearance = ...)")
  timed <- ww_bearing(data.frame(hours = c(10, 20), depth = c(16.7, 31.9)), "depth", contact = "journal", radius = "10 mm", clearance = "25 um", time = "hours",
                      speed = "60 rpm", pressure = "1.5 MPa", units = c(depth = "um", hours = "h"), fit = FALSE)
  expect_match(timed$text, "speed = \"60 rpm\"\npressure = \"1.5 MPa\"", fixed = TRUE)
  expect_match(timed$text, "time = { column = \"time\", unit = \"h\" }", fixed = TRUE)
  refused(bearing(radius = "radius", clearance = "clearance_um"), "radius: data has no column 'radius'")
})

test_that("a clutch takes three tables", {
  refused(ww_clutch(design = data.frame(point = 1), cycles = 3, weighings = 4, density = "1 g/cm^3", depth = "1 mm", area = "1 cm^2", balance_sd = "1 mg"), "cycles is double")
  expect_error(ww_clutch(design = data.frame(point = 1), cycles = data.frame(plate = 1), weighings = data.frame(plate = 1), density = "2.2 g/cm^3",
                         depth = "1 mm", area = "100 cm^2", balance_sd = "1 mg", fit = FALSE), "design", class = "wearwell_input_error")
  refused(ww_clutch(density = "1 g/cm^3"), "ww_clutch(): design, cycles, weighings, depth, area, balance_sd are missing; it takes three data frames and quantities of the lining: ww_clutch(design = , ")
})

test_that("level takes the place of the default confidence", {
  level_of <- function(study) {
    predict <- wearwell:::core(wearwell:::C_keys, study$text)$predict
    expect_null(predict$credible_level)
    predict$level
  }
  expect_identical(level_of(ww_life(data.frame(hours = c(310, 540, 700, 820)), "hours", predict = list(level = 0.95), fit = FALSE)), 0.95)
  wear <- data.frame(km = c(10, 20, 10, 20), depth = c(9, 19, 11, 22), machine = c("A", "A", "B", "B"))
  expect_identical(level_of(ww_degradation(depth ~ km | machine, wear, limit = "100 um", units = c(depth = "um", km = "km"),
                                           predict = list(level = 0.95), fit = FALSE)), 0.95)
})

test_that("presets name columns that they do not use", {
  said <- function(code) {
    found <- character()
    withCallingHandlers(code, wearwell_column_warning = function(w) {
      found <<- c(found, conditionMessage(w))
      invokeRestart("muffleWarning")
    })
    found
  }
  looks <- data.frame(cycles = c(1, 100, 1000, 5000), V = c(1.59, 2.57, 8.10, 24.48), joint = c("A", "A", "B", "B"))
  joint <- function(...) ww_joint(looks, "V", "cycles", work_per_cycle = "5.966 N m", units = c(V = "mm^3"), fit = FALSE, ...)
  expect_identical(said(joint()), paste0(
    "column 'joint' looks like a label of units with several rows each and is not used, so all rows count as those of one joint: write ",
    "ww_degradation(..., unit = \"joint\"), whose rate differs from unit to unit, or unused = \"joint\" if that is so"))
  expect_length(said(joint(unused = "joint")), 0)
  worn <- read.csv(example("bearing", "inspections.csv"))
  bearing <- function(...) ww_bearing(worn, "depth_um", revolutions = "revolutions", contact = "stationary", radius = "10 mm", clearance = "25 um",
                                      pressure = "1 MPa", units = c(depth_um = "um"), fit = FALSE, ...)
  expect_match(said(bearing()), "column 'bearing' looks like a label of units .* write unit = \"bearing\", or unused = \"bearing\" if that is so")
  expect_length(said(bearing(unit = "bearing")), 0)
})

test_that("a preset without its columns says which are missing", {
  tests <- data.frame(stress = c(400, 350, 300), cycles = c(1e5, 3e5, 1e6))
  expect_error(ww_sn(cycles ~ stress, data = tests),
               "ww_sn(): life is missing; it takes a data frame and names of its columns: ww_sn(data, stress = , life = , ...)", fixed = TRUE)
  expect_error(ww_bearing(tests, "cycles"), "ww_bearing(): contact, radius, clearance are missing", fixed = TRUE)
  refused(ww_bearing(tests, "cycles", "journal", "10 mm", "25 um", speed = "60 rpm"), "revolutions is missing")
  expect_error(ww_staircase(), "ww_staircase(): data, stress, event are missing", fixed = TRUE)
})

# The arguments of Python's functions of one name, "data", "b=(1, 10)": one list for each definition.
of_python <- function(name) {
  folder <- file.path(source_of_project(), "python", "wearwell")
  files <- c(file.path(folder, c("plan.py", "bearing.py")), list.files(file.path(folder, "_impl"), "[.]py$", full.names = TRUE))
  found <- unlist(lapply(files, function(file) {
    text <- paste(readLines(file, warn = FALSE, encoding = "UTF-8"), collapse = "\n")
    regmatches(text, gregexpr(paste0("(?m)^ *def ", name, "(\\((?:[^()]|(?1))*\\)):"), text, perl = TRUE))[[1]]
  }))
  lapply(found, function(definition) {
    inside <- gsub("\\s+", " ", sub("^[^(]*\\((.*)\\):$", "\\1", gsub("\n", " ", definition)))
    parts <- trimws(strsplit(inside, ",(?![^(]*\\))", perl = TRUE)[[1]])
    parts <- parts[!parts %in% c("self", "*", "/")]
    stats::setNames(sub("^[^=]*=?", "", parts), sub("=.*", "", parts))
  })
}

# A default of R as Python writes it. Of the choices that match.arg() takes, the first is the default.
in_python_words <- function(default, choices) {
  if (is.name(default)) return("")
  value <- eval(default)
  if (is.null(value)) return("None")
  if (is.character(value) && length(value) > 1 && choices) value <- value[1]
  each <- if (is.character(value)) encodeString(value, quote = "\"") else if (is.logical(value)) ifelse(value, "True", "False") else
    sub("[.]0$", "", format(value, scientific = FALSE, trim = TRUE))
  if (length(value) == 1) each else paste0("(", paste(each, collapse = ", "), ")")
}

test_that("arguments and defaults are those of Python", {
  formula <- function(name) getS3method(name, "formula")
  of_r <- list(sn = ww_sn, staircase = ww_staircase, joint = ww_joint, bearing = ww_bearing, clutch = ww_clutch, repairable = ww_repairable,
               returns = ww_returns, life = formula("ww_life"), degradation = formula("ww_degradation"), fit = ww_fit, update = ww_update,
               decide = ww_decide, damage = ww_damage, spectrum = ww_spectrum, rainflow = ww_rainflow, backtest = ww_backtest, design = ww_design,
               export_c = ww_export_c, export_sql = ww_export_sql, compare = ww_compare, percentile = ww_percentile, conditional = ww_conditional,
               against = ww_against, ask = ww_ask, survival_function = ww_survival_function, hazard = ww_hazard, select = ww_select,
               accelerate = ww_plan_accelerate, demonstrate = ww_plan_demonstrate, inspect = ww_plan_inspect, `next` = ww_plan_next, size = ww_plan_size,
               lognormal = ww_lognormal, gamma = ww_gamma, beta = ww_beta, student_t = ww_student_t, uniform = ww_uniform)
  # What ww_fit() takes of all; the left side of a formula and its data; `fit` of methods; several fits.
  of_fits <- c("seed", "method", "chains", "warmup", "draws", "threads", "report", "progress")
  of_formulas <- list(life = c("data", "life", "event", "entry"), degradation = c("data", "y", "x"))
  # `along` and its like stand in a formula; `fit` asks for a study alone; a frame of ww_fit() is that of a path.
  only_r <- list(life = c("x", "data", "weights", "fit"), degradation = c("x", "data", "start", "given", "fit"), fit = c("data", "units"))
  choices <- c("repairable", "rainflow")
  for (name in names(of_r)) {
    formals <- formals(of_r[[name]])
    ours <- stats::setNames(vapply(formals, in_python_words, "", name %in% choices), names(formals))
    ours <- ours[setdiff(names(ours), c("...", if ("..." %in% names(ours)) of_fits, "progress", c(only_r[[name]], if (is.null(only_r[[name]])) "fit")))]
    theirs <- lapply(of_python(name), function(each) {
      each[setdiff(names(each), c("progress", "fit", of_formulas[[name]], if ("..." %in% names(formals)) of_fits, grep("^[*]", names(each), value = TRUE)))]
    })
    theirs <- lapply(theirs, function(each) stats::setNames(gsub("_(?=[0-9])", "", sub("[.]0$", "", gsub("[(][)]", "()", gsub("'", "\"", each))), perl = TRUE), names(each)))
    # Of a method and a function, the one that has the defaults.
    theirs <- theirs[order(-vapply(theirs, function(each) sum(nzchar(each)), 0))]
    same <- vapply(theirs, function(each) setequal(names(each), names(ours)), NA)
    expect(any(same), paste0(name, ": R has ", paste(names(ours), collapse = ", "), "\nPython: ", paste(vapply(theirs, function(each) paste(names(each), collapse = ", "), ""), collapse = "\n")))
    if (!any(same)) next
    each <- theirs[[which(same)[1]]]
    if (is.null(of_formulas[[name]])) expect_identical(names(ours), names(each), info = name)
    expect_identical(ours, each[names(ours)], info = name)
  }
})
