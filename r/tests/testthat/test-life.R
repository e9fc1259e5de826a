# ww_life: what it reads of a formula, and that its numbers are those of maximum likelihood and of the study it stands for.

pumps <- data.frame(hours = c(150, 340, 560, 800, 1150, 2470, 100, 900, 300, 700), event = c(1, 1, 1, 1, 0, 1, 1, 1, 1, 0),
                    site = rep(c("A", "B"), 5), load = c(10, 12, 14, 16, 18, 20, 11, 13, 15, 17))
flat <- list(characteristic = ww_flat("1"), slope = ww_flat("1"))

study_of <- function(...) ww_life(..., fit = FALSE)
data_of <- function(study) as.data.frame(study$given$data$data)
mode_of <- function(fit) vapply(fit$summary$mode$parameters, `[[`, 0, "value")
quick <- function(...) quiet(ww_life(..., seed = 1, method = "exact", draws = 100, report = FALSE))

# Minus the Weibull log-likelihood of any censoring and entry.
loss <- function(p, from, to, entry = 0) {
  survival <- function(t) stats::pweibull(t, exp(p[2]), exp(p[1]), lower.tail = FALSE)
  term <- ifelse(from == to, stats::dweibull(from, exp(p[2]), exp(p[1])), survival(from) - survival(to))
  -sum(log(term / survival(entry)))
}
maximum <- function(...) exp(stats::optim(c(log(800), 0), loss, ..., method = "BFGS", control = list(reltol = 1e-14))$par)

test_that("every type of Surv has its likelihood", {
  t <- pumps$hours
  ended <- pumps$event == 1
  entry <- t / 4
  right <- quick(Surv(hours, event) ~ 1, pumps, priors = flat, unused = c("site"))
  expect_equal(unname(mode_of(right)), maximum(from = t, to = ifelse(ended, t, Inf)), tolerance = 1e-4)
  left <- quick(Surv(hours, event, type = "left") ~ 1, pumps, priors = flat)
  expect_equal(unname(mode_of(left)), maximum(from = ifelse(ended, t, 0), to = t), tolerance = 1e-4)
  late <- quick(Surv(start, hours, event) ~ 1, transform(pumps, start = entry), priors = flat)
  expect_equal(unname(mode_of(late)), maximum(from = t, to = ifelse(ended, t, Inf), entry = entry), tolerance = 1e-4)
  looks <- data.frame(from = ifelse(seq_along(t) == 1, NA, floor(t / 300) * 300), to = ifelse(ended, ceiling(t / 300) * 300, Inf))
  looks$from[which(looks$from == 0)] <- NA
  between <- quick(Surv(from, to, type = "interval2") ~ 1, looks, priors = flat)
  best <- maximum(from = ifelse(is.na(looks$from), 0, looks$from), to = looks$to)
  expect_equal(unname(mode_of(between)), best, tolerance = 1e-4)
  codes <- transform(looks, code = ifelse(is.na(from), 2, ifelse(is.infinite(to), 0, 3)), a = ifelse(is.na(from), to, from))
  expect_equal(data_of(study_of(Surv(a, to, code, type = "interval") ~ 1, codes)), data_of(study_of(Surv(from, to, type = "interval2") ~ 1, looks)))
})

test_that("objects of survival are read as the call", {
  skip_if_not_installed("survival")
  made <- list(quote(Surv(hours, event)), quote(Surv(hours, event, type = "left")), quote(Surv(hours / 4, hours, event)),
               quote(Surv(hours / 2, hours, c(0, 1, 2, 3, 3, 3, 3, 1, 0, 2), type = "interval")))
  for (call in made) {
    with_package <- pumps
    with_package$y <- eval(call, pumps, asNamespace("survival"))
    own <- study_of(stats::as.formula(base::call("~", call, 1)), pumps, unused = "event")
    expect_equal(data_of(study_of(y ~ 1, with_package, unused = "event")), data_of(own), info = deparse(call))
  }
})

test_that("conditions are those of survreg", {
  skip_if_not_installed("survival")
  fit <- quick(Surv(hours, event) ~ load, pumps, priors = c(flat, list(b_load = ww_flat("1"))))
  peer <- survival::survreg(survival::Surv(hours, event) ~ load, pumps)
  found <- mode_of(fit)
  expect_equal(unname(found["b_load"]), unname(coef(peer)[2]), tolerance = 1e-3)
  expect_equal(unname(found["slope"]), 1 / peer$scale, tolerance = 1e-3)
  expect_equal(unname(log(found["characteristic"])), unname(coef(peer)[1] + 14.6 * coef(peer)[2]), tolerance = 1e-3)  # at the mean load
  expect_equal(as.numeric(logLik(fit)), as.numeric(logLik(peer)), tolerance = 1e-6)
  by_level <- quick(Surv(hours, event) ~ site, pumps, priors = c(flat, list(b_site_B = ww_flat("1"))), family = "weibull")
  expect_equal(unname(mode_of(by_level)["b_site_B"]), unname(coef(survival::survreg(survival::Surv(hours, event) ~ site, pumps))[2]), tolerance = 1e-3)
})

test_that("the study is the formula model that one would write", {
  fit <- quick(Surv(hours, event) ~ 1, pumps, units = c(hours = "h"), unused = c("site", "load"))
  own <- ww_study(formula = "hours = characteristic", data = data.frame(hours = pumps$hours, status = ifelse(pumps$event == 1, "failure", "runout")),
                  units = c(hours = "h"), family = "weibull",
                  priors = list(characteristic = ww_lognormal("5000 h", log_sd = 2), shape = ww_lognormal(1.5, log_sd = 0.7)))  # ww_study's own name
  same <- quiet(ww_fit(own, seed = 1, method = "exact", draws = 100, report = FALSE))
  expect_identical(unname(as.matrix(fit$parameters[c("mean", "sd", "q05", "q95")])), unname(as.matrix(same$parameters[c("mean", "sd", "q05", "q95")])))
  expect_identical(fit$toml, fit$study$text)
  expect_output(print(fit), "Default priors.*characteristic +lognormal, median 5000, sd of the logarithm 2")
  expect_identical(quiet(ww_life(pumps, "hours", event = "event", units = c(hours = "h"), seed = 1, method = "exact", draws = 100,
                                 report = FALSE))$parameters, fit$parameters)
})

test_that("random effects are those of lme4 and brms", {
  table <- transform(pumps, batch = rep(c("x", "y"), each = 5), lot = as.character(seq_len(10) %% 5))
  text <- function(formula) study_of(formula, table)$text
  expect_match(text(Surv(hours, event) ~ (1 | batch)), "[random_effects.batch]\ncharacteristic = { distribution = \"lognormal\", log_sd = \"characteristic_scatter\" }", fixed = TRUE)
  # The rest is not read as a study, which evaluates its likelihood.
  entries <- function(right) {
    columns <- wearwell:::frame_columns(table, NULL)
    sides <- wearwell:::split_terms(right)
    effects <- wearwell:::effects_of(sides$fixed, columns, list(), "the formula")
    wearwell:::with_random(wearwell:::random_of(sides$random, "characteristic", effects, columns, "the formula"), "characteristic", effects, columns, character(), "the formula")
  }
  slopes <- entries(quote(load + (load | batch)))
  expect_identical(slopes$entries$batch$b_load, list(distribution = "normal", sd = "b_load_scatter"))
  expect_identical(slopes$entries$batch$correlation, "rho")
  expect_identical(names(slopes$priors), c("characteristic_scatter", "b_load_scatter", "rho"))
  expect_identical(names(entries(quote(load + (load || batch)))$entries$batch), c("characteristic", "b_load"))
  expect_identical(names(entries(quote(load + (0 + load | batch)))$entries$batch), "b_load")
  nested <- entries(quote((1 | batch / lot)))
  expect_identical(wearwell:::finest(nested), "batch_lot")
  expect_identical(nested$columns$batch_lot$values[1:2], c("x:1", "x:2"))
  expect_identical(nested$entries$batch_lot$characteristic$log_sd, "characteristic_batch_lot_scatter")
  refused(text(Surv(hours, event) ~ (load | batch)), "load is no effect of the formula; it stands beside it")
  refused(text(Surv(hours, event) ~ (1 | id | batch)), "random effects are written (1 | label)")
})

test_that("stress laws are written out, by is a level's own scale", {
  hot <- transform(pumps, T = rep(c(40, 60), 5))
  arrhenius <- study_of(Surv(hours, event) ~ 1, hot, stress = c(T = "arrhenius"), units = c(T = "degC"))$text
  expect_match(arrhenius, "scale = \"life_ref * exp(energy/boltzmann * (1/T - 1/T_ref))\"", fixed = TRUE)
  expect_match(study_of(Surv(hours, event) ~ 1, hot, stress = c(load = "inverse-power"))$text, "-load_power * log(load/load_ref)", fixed = TRUE)
  expect_match(study_of(Surv(hours, event) ~ 1, hot, by = "site")$text, "scale = \"characteristic[site]\"", fixed = TRUE)
  expect_match(study_of(Surv(hours, event) ~ load * site, hot)$text, "b_load_by_site_B * (load - load_ref) * (site == \\\"B\\\")", fixed = TRUE)
  # The scale is that at the harshest stress, lives are those at the mildest, as in Python and `wearwell new`.
  expect_match(arrhenius, "T_ref = \"60 degC\"", fixed = TRUE)
  expect_match(arrhenius, "given = { T = \"40 degC\" }", fixed = TRUE)
  refused(study_of(Surv(hours, event) ~ arrhenius(T), hot), "the law of a stress is stress = c(T = \"arrhenius\")")
  refused(study_of(Surv(hours, event) ~ 1, hot, count = "load", weights = "load"), "count and weights are one")
  refused(study_of(Surv(hours, event) ~ 1, hot, stress = c(T = "arrhenius")), "T has no unit: units = c(T = \"degC\") states it")
  refused(study_of(Surv(hours, event) ~ 1, hot, stress = c(T = "arhenius")), "it is one of arrhenius")
  refused(study_of(Surv(hours, event) ~ 1, hot, stress = c(site = "inverse-power")), "holds texts")
})

test_that("what can be read in two ways is refused with both readings", {
  refused(study_of(Surv(hours, event + 1) ~ 1, pumps), "2 is a failure and 1 was stopped (as survival reads it), or 1 is a failure and 2 was stopped")
  refused(study_of(Surv(hours, censored) ~ 1, transform(pumps, censored = 1 - event)), "write Surv(..., censored == 0) for the first, Surv(..., censored == 1)")
  refused(study_of(hours ~ 1, pumps), "column 'event' looks like how each life ended")
  refused(study_of(Surv(hours) ~ 1, pumps), "column 'event' looks like how each life ended")
  expect_identical(data_of(study_of(hours ~ 1, pumps, unused = "event"))$life, pumps$hours)
  expect_identical(data_of(study_of(Surv(hours, event + 1 == 2) ~ 1, pumps)), data_of(study_of(Surv(hours, event) ~ 1, pumps)))
  expect_warning(study_of(Surv(hours, event) ~ 1, transform(pumps, failed = event == 1)), "column 'failed' looks like how a life ended",
                 class = "wearwell_column_warning")
})

test_that("columns of counts and units that are not used are named", {
  said <- function(...) {
    caught <- character()
    withCallingHandlers(study_of(...), wearwell_column_warning = function(w) {
      caught <<- c(caught, conditionMessage(w))
      invokeRestart("muffleWarning")
    })
    caught
  }
  rows <- nrow(pumps)
  with <- function(name, values) stats::setNames(data.frame(pumps, values), c(names(pumps), name))
  for (name in c("count", "Counts", "weight", "weights", "n", "quantity", "qty", "freq", "frequency", "number")) {
    frame <- with(name, rep_len(c(1, 20), rows))
    expect_identical(said(Surv(hours, event) ~ 1, frame),
                     paste0("column '", name, "' looks like a number of equal rows and is not used: write count = \"", name, "\", or unused = \"",
                            name, "\" if it says something else"))
    expect_length(said(Surv(hours, event) ~ 1, frame, count = name), 0)
    expect_length(said(Surv(hours, event) ~ 1, frame, weights = name), 0)
    expect_length(said(Surv(hours, event) ~ 1, frame, unused = name), 0)
  }
  for (values in list(1, seq_len(rows), 1.5, rep_len(c(0, 2), rows), "a", rep_len(c(2, NA), rows))) {
    expect_length(said(Surv(hours, event) ~ 1, with("n", values)), 0)
  }
  expect_length(said(Surv(hours, event) ~ 1, with("weight [kg]", rep_len(c(1, 20), rows))), 0)
  for (name in c("unit", "machine", "Serial", "id", "machine_id")) {
    frame <- with(name, rep_len(LETTERS[1:4], rows))
    expect_match(said(Surv(hours, event) ~ 1, frame), paste0("write + (1 | ", name, ") in the formula, or unit = \"", name, "\" of a frame, or unused = "),
                 fixed = TRUE)
    expect_length(said(Surv(hours, event) ~ 1, frame, unused = name), 0)
    expect_length(said(Surv(hours, event) ~ 1, frame, by = name), 0)
    expect_length(said(frame, "hours", event = "event", unit = name), 0)
    expect_length(said(Surv(hours, event) ~ 1, with(name, as.character(seq_len(rows)))), 0)
    expect_match(said(Surv(hours, event) ~ 1, frame, by = "site"), "of a frame in place of by, or unused", fixed = TRUE)
  }
})

test_that("priors = \"flat\", B-lives and marks of defaults are those of Python", {
  study <- study_of(Surv(hours, event) ~ 1, pumps, units = c(hours = "h"), priors = "flat")
  expect_match(study$text, "characteristic = { distribution = \"flat\", unit = \"h\", lower = \"0 h\" }\nslope = { distribution = \"flat\", unit = \"1\", lower = 0 }\n",
               fixed = TRUE)
  expect_match(study$text, "b_lives = [1, 10, 50]", fixed = TRUE)
  expect_false(grepl("# default", study$text, fixed = TRUE))
  mixed <- study_of(Surv(hours, event) ~ 1, pumps, priors = list(slope = ww_lognormal(2, log_sd = 0.5)))$text
  expect_match(mixed, "\ncharacteristic = [^\n]*  # default\nslope = [^\n#]*\n")
  refused(study_of(Surv(hours, event) ~ 1, pumps, priors = "flatt"), "or \"flat\"")
  fit <- quick(Surv(hours, event) ~ 1, pumps, priors = "flat")
  stated <- quick(Surv(hours, event) ~ 1, pumps, priors = list(characteristic = ww_flat("1", lower = 0), slope = ww_flat("1", lower = 0)))
  expect_identical(mode_of(fit), mode_of(stated))
})

test_that("questions are refused in the words of arguments", {
  fit <- quick(Surv(hours, event) ~ 1, pumps, units = c(hours = "h"))
  refused_as <- function(code, message) expect_identical(conditionMessage(tryCatch(code, wearwell_input_error = identity)), message)
  refused_as(ww_ask(fit, list(survival_to = "5 kg")), "survival_to: \"5 kg\": unit 'kg' has the wrong dimension (expected one like 's')")
  refused_as(ww_life(fit, survived = "5 kg"), "survived: \"5 kg\": unit 'kg' has the wrong dimension (expected one like 's')")
  refused_as(ww_life(fit, survived = -1), "survived is -1; lives of this study are 0 or more")
  refused_as(ww_life(fit, survived = "-1 h"), "survived is \"-1 h\"; lives of this study are 0 or more")
  wear <- data.frame(km = c(10, 20, 30, 40), wear = c(11, 19, 32, 41))
  refused_as(ww_degradation(wear ~ km, wear, units = c(wear = "um", km = "km"), limit = "100 kg", fit = FALSE),
             "limit: \"100 kg\": unit 'kg' has the wrong dimension (expected one like 'm')")
  refused_as(study_of(Surv(hours, event) ~ 1, pumps, units = c(hours = "h"), priors = list(characteristic = ww_flat(lower = 0, unit = "day"))),
             "priors: characteristic.lower: 0 has no unit (write one like \"0 s\")")
  refused_as(ww_flat(), "unit is missing: ww_flat(unit = \"h\"), that of the parameter, or ww_flat(unit = \"1\") of a plain number")
})

test_that("errors name arguments and columns", {
  refused(study_of(Surv(hours, evnt) ~ 1, pumps), "data has no column 'evnt' (columns: hours, event, site, load); did you mean 'event'?")
  refused(ww_life(Surv(hours, event) ~ 1, pumps, familly = "weibull"), "ww_life() has no argument 'familly'; did you mean 'family'?")
  refused(study_of(Surv(hours, event) ~ 1, pumps, family = "weibul"), "family is \"weibul\"; it is one of weibull")
  refused(study_of(Surv(hours, event) ~ 1, transform(pumps, hours = hours - 100)), "data, row 7: the life is 0; lives are above 0; with share_dead_on_arrival = TRUE a life of 0 is a part that is dead on arrival")
  refused(study_of(Surv(hours, event) ~ 1, transform(pumps, hours = c(NA, hours[-1]))), "data, row 1: the life is missing")
  refused(study_of(Surv(hours, event) ~ 1, transform(pumps, event = c(NA, event[-1]))), "data, row 1, column 'event': a value is missing")
  refused(study_of(Surv(hours, event) ~ load, transform(pumps, load = c(1, NA, load[-(1:2)]))), "data, row 2, column 'load': a value is missing")
  refused(study_of(Surv(hours, event) ~ load, transform(pumps, load = 1)), "column 'load' is 1 in all rows")
  refused(study_of(Surv(hours, event) ~ log(load), pumps), "log(load) is no column; make one of it first")
  refused(study_of(Surv(hours, event) ~ 1, pumps, priors = list(beta = ww_lognormal(1, log_sd = 1))), "priors: the model has no parameter 'beta' (parameters: characteristic, slope)")
  refused(study_of(Surv(hours, event) ~ 1, pumps, priors = list(eta = ww_flat("1"))), "priors: 'eta' is called 'characteristic'")
  refused(study_of(Surv(hours, event) ~ 1, pumps, priors = list(shape = ww_flat("1"))), "priors: 'shape' is called 'slope'")
  refused(study_of(Surv(hours, event) ~ 1, pumps, units = c(hrs = "h")), "units: data has no column 'hrs'")
  spread <- study_of(Surv(hours, event) ~ load, pumps, given = list(load = list(distribution = "uniform", lower = 1, upper = 2)))
  expect_match(spread$text, 'distribution = "uniform"', fixed = TRUE)
  refused(study_of(Surv(hours, event) ~ load, pumps, given = list(lod = 3)), "given: lod is no condition of the formula (conditions: load)")
  refused(study_of(Surv(hours, event, type = "mstate") ~ 1, pumps), "failure modes: Surv(time, event) with mode = ")
  refused(study_of(Surv(hours, end) ~ 1, transform(pumps[-2], end = c("kaputt", rep("runout", 9)))), "row 1, column 'end': 'kaputt' is not a status")
  refused(ww_life("lives.toml"), "ww_life() takes a formula")
  refused(study_of(Surv(hours, event) ~ 1, pumps[0, ]), "data has no rows")
  refused(study_of(Surv(day, event) ~ 1, transform(pumps, day = as.Date("2024-01-01") + hours)), "holds dates or times")
})

absorbers <- function() read.csv(example("life", "shock_absorbers.csv"), check.names = FALSE)

test_that("failure modes: means of exponential lives in closed form, simulated lives are the earliest", {
  table <- absorbers()
  fit <- quick(Surv(km) ~ 1, table, mode = "failure mode", family = "exponential", priors = list(mean_life = ww_flat("1")))
  failures <- table(table[["failure mode"]])
  expect_equal(mode_of(fit), c(`mean_life[mode 1]` = sum(table$km) / failures[["mode 1"]], `mean_life[mode 2]` = sum(table$km) / failures[["mode 2"]]), tolerance = 1e-4)
  expect_identical(fit$lives$of, c("new unit", "new unit with mode 1 alone", "new unit with mode 2 alone"))
  b10 <- fit$lives$b10[1]
  draws <- unclass(fit$draws)  # of two exponential lives the earliest is exponential
  rate <- 1 / draws[, , 1] + 1 / draws[, , 2]
  lives <- unlist(simulate(fit, nsim = 500, seed = 3))
  expect_lt(abs(mean(lives < b10) - mean(1 - exp(-b10 * rate))), 4 * sqrt(0.09 / 500))
})

test_that("failure modes are read from words, codes and events", {
  table <- absorbers()
  code <- unname(c(`mode 1` = 1, `mode 2` = 2, censored = 0)[table[["failure mode"]]])
  coded <- study_of(Surv(km) ~ 1, data.frame(km = table$km, cause = code), mode = list(column = "cause", runout = 0))
  beside <- study_of(Surv(km, ended) ~ 1, data.frame(km = table$km, cause = ifelse(code > 0, code, NA), ended = code > 0), mode = "cause")
  for (study in list(coded, beside)) expect_match(ww_description(study), "27 run-outs, 7 failed by 1, 4 failed by 2", fixed = TRUE)
  expect_match(coded$text, "shape = \"slope[mode]\"", fixed = TRUE)
  expect_match(study_of(Surv(km) ~ 1, table, mode = "failure mode", shape = "shared")$text, "shape = \"slope\"", fixed = TRUE)
  expect_match(study_of(table, "km", event = NULL, mode = "failure mode")$text, "mode = \"mode\"", fixed = TRUE)
  refused(study_of(Surv(km) ~ 1, table), "or mode = \"failure mode\" of failure modes, or unused")
  refused(study_of(Surv(km) ~ 1, data.frame(km = table$km, cause = code), mode = "cause"), "or write mode = list(column = ..., runout = \"0\")")
  refused(study_of(Surv(km, cause) ~ 1, data.frame(km = table$km, cause = code)), "mode = list(column = \"cause\", runout = 0) without an event")
  refused(study_of(Surv(km) ~ 1, table, mode = "cause"), "mode: data has no column 'cause'")
  refused(study_of(Surv(km) ~ 1, table, mode = list(columns = "x")), "it is the name of a column, or like list(column = \"cause\", runout = 0)")
  supplied <- transform(table, supplier = rep(c("A", "B"), 19), check.names = FALSE)
  names(supplied)[2] <- "cause"
  refused(study_of(Surv(km) ~ 1, supplied, mode = "cause", by = "supplier"), "by and mode: each failure mode has its own characteristic")
  refused(study_of(Surv(km) ~ 1 + (1 | supplier), supplied, mode = "cause"), "mode: failure modes have no random effects")
  refused(study_of(Surv(km) ~ 1, supplied, unused = "cause", shape = "separate"), "shape = 'separate' needs by or mode")
})

test_that("a frame with the name of a unit is the formula with a random effect", {
  batches <- data.frame(hours = c(210, 340, 460, 610, 150, 190), batch = rep(c("A", "B", "C"), each = 2))
  expect_identical(study_of(batches, "hours", unit = "batch")$text, study_of(hours ~ 1 + (1 | batch), batches)$text)
  refused(study_of(batches, "hours", unit = "lot"), "unit: data has no column 'lot'")
})

test_that("parameters and default priors are those of the Python package", {  # tests/golden/life_families.json: of both, of the same lives
  lives <- data.frame(hours = c(312, 480, 510, 640, 700, 700, 150, 260, 420), failed = c(1, 1, 1, 1, 0, 0, 1, 1, 1))
  text <- paste(readLines(file.path(source_of_project(), "tests", "golden", "life_families.json")), collapse = "\n")
  expected <- wearwell:::core(wearwell:::C_keys, paste0("families = ", gsub("\": ", "\" = ", gsub("\n", " ", text))))$families
  expect_setequal(names(expected), names(wearwell:::life_families))
  by_name <- function(keys) keys[order(names(keys))]
  for (family in names(expected)) {
    keys <- wearwell:::core(wearwell:::C_keys, study_of(Surv(hours, failed) ~ 1, lives, family = family, standard = expected[[family]]$likelihood$standard,
                                                                units = c(hours = "h"))$text)
    expect_equal(by_name(keys$likelihood[[1]]), by_name(expected[[family]]$likelihood), info = family)
    expect_equal(lapply(by_name(keys$prior), by_name), lapply(by_name(expected[[family]]$prior), by_name), info = family)
  }
})

test_that("lives from where hardly any survive are refused, and not infinite in frames", {
  fit <- quick(Surv(hours, event) ~ 1, pumps, units = c(hours = "h"))
  refused(ww_life(fit, survived = 1e6), "survived: a new item survives to 1e+06 with a probability of")
  refused(ww_life(fit, survived = 1e6), "%; lives from there on need at least 0.1 %")
  answered <- wearwell:::quantities_of(ww_ask(fit, list(survived = "1e6 h", b_lives = 10)))
  expect_true(all(is.na(answered$q50[grepl("remaining", answered$name)])))
  expect_true(all(is.finite(ww_life(fit, survived = 3000)$q50)))
})

test_that("classical estimates stand beside the posterior", {
  fit <- quick(Surv(hours, event) ~ 1, data = pumps, classical = TRUE)
  found <- fit$summary$classical$maximum_likelihood$parameters
  values <- vapply(found, `[[`, 0, "value")
  names(values) <- vapply(found, `[[`, "", "name")
  to <- ifelse(pumps$event == 1, pumps$hours, Inf)
  expect_equal(unname(values[c("characteristic", "slope")]), maximum(from = pumps$hours, to = to), tolerance = 1e-4)
  expect_false(grepl("classical", study_of(Surv(hours, event) ~ 1, data = pumps)$text, fixed = TRUE))
  expect_error(study_of(Surv(hours, event) ~ 1, data = pumps, classical = "yes"), "it is TRUE or FALSE")
})

test_that("a life under a stress is that of ww.life in Python", {
  # Numbers of the second example of help(wearwell.life), printed to more digits.
  ovens <- data.frame(T = rep(c(150, 175, 200), each = 4), hours = c(3200, 4100, 5000, 5000, 1100, 1500, 1900, 2600, 410, 560, 700, 880),
                      status = c("failed", "failed", "censored", "censored", rep("failed", 8)))
  fit <- quiet(ww_life(Surv(hours, status) ~ 1, ovens, family = "exponential", stress = c(T = "arrhenius"), given = list(T = 100),
                       units = c(T = "degC", hours = "h"), method = "exact", draws = 50, report = FALSE, seed = 1))
  expect_equal(fit$parameters[c("life_ref", "energy"), "mean"], c(811.9283731662, 0.7900556943), tolerance = 1e-8)
  expect_equal(fit$parameters["life_ref", "q05"], 391.8880139712, tolerance = 1e-8)
})
