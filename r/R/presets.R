# Presets in one line: S-N curves, staircases, joints, bearings, clutches. Their default priors are the models' own.

# Of an argument: the heading of a column, or a quantity, which holds for all rows.
column_or_quantity <- function(value, columns, what) {
  if (is_path(value) && (value %in% names(columns) || value %in% vapply(columns, `[[`, "", "heading"))) return(list(column = value))
  if (is.character(value) && length(value) == 1 && !grepl("^[[:space:]]*[-+.]?[0-9]", value)) {
    stop_input(what, ": data has no column '", value, "' (columns: ", words(names(columns)), "), and it is no quantity, like \"10 mm\"")
  }
  list(constant = quantity(value, what))
}

preset_labels <- c("label", "unit", "bearing", "mode", "contact")  # columns whose cells a study reads as texts
argument_of_role <- function(role) if (role == "alternating_stress") "stress" else role

# The frame of a preset, by the names that the model has for its columns.
preset_study <- function(columns, roles, what) {
  found <- list()
  for (role in names(roles)) {
    if (is.null(roles[[role]])) next
    each <- find_column(columns, one_text(roles[[role]], role), role)
    if (!role %in% preset_labels) require_no_truths(each, argument_of_role(role))
    found[[role]] <- study_column(plain_values(each), each$unit, each$heading)
  }
  found
}

# A column of endings as the library reads it; codes and truths by failures_of().
with_status <- function(study, event, columns, what) {
  if (is.null(event)) return(study)
  each <- find_column(columns, one_text(event, "event"), "event")
  failures <- tryCatch(failures_of(each, "event"), wearwell_input_error = function(error) {
    heading <- each$heading
    message <- gsub("Surv(..., ", "event = (", conditionMessage(error), fixed = TRUE)
    stop_input(gsub("event = [(]([^)]*)[)]", paste0("data$failed <- data$", heading, " \\1, event = \"failed\""),
                    gsub(paste0("event = (", heading, " "), "event = (", message, fixed = TRUE)))
  })
  study$status <- study_column(ended(failures, "runout"), "", each$heading)
  study
}

preset_text <- function(model, title, columns, extra, priors) {
  parts <- c(toml_table("", list(title = title, model = model)), toml_table("data", list(file = "data")), columns_table(columns))
  for (name in names(extra)) if (length(extra[[name]])) parts <- c(parts, toml_table(name, extra[[name]]))
  if (length(priors)) parts <- c(parts, toml_table("prior", checked_priors(priors, NULL)))
  paste(parts, collapse = "\n")
}

# The call with the function's own name; refused if an argument without a default is missing.
preset_call <- function(call, name) {
  defaults <- formals(get(name, mode = "function"))
  needed <- setdiff(names(defaults)[vapply(defaults, function(each) is.name(each) && !nzchar(as.character(each)), TRUE)], "...")
  missing <- setdiff(needed, names(call))
  if (length(missing)) {
    takes <- if ("data" %in% needed) "a data frame and names of its columns" else "three data frames and quantities of the lining"
    stop_input(name, "(): ", words(missing), if (length(missing) > 1) " are" else " is", " missing; it takes ", takes, ": ",
               name, "(", paste(c(intersect("data", needed), sprintf("%s = ", setdiff(needed, "data")), "..."), collapse = ", "), ")")
  }
  call[[1]] <- as.name(name)
  call
}

given_arguments <- function(...) Filter(Negate(is.null), list(...))

ww_sn <- function(data, stress, life, event = NULL, stress_ratio = NULL, mean_stress = NULL, correction = NULL, curve = "basquin",
                  fatigue_limit = "none", family = "log10-normal", scatter = "constant", count = NULL, label = NULL, units = NULL, priors = NULL,
                  b = c(1, 10), confidence = 0.9, at = NULL, survival_to = NULL, required_life = NULL, reliability = NULL, predict = NULL,
                  unused = NULL, title = NULL, fit = TRUE, ...) {
  call <- preset_call(match.call(), "ww_sn")
  own <- names(formals(ww_sn))
  require_options("ww_sn", ..., own = own)
  columns <- frame_columns(data, units)
  study <- preset_study(columns, list(life = life, alternating_stress = stress, label = label, count = count))
  study <- with_status(study, event, columns)
  constants <- list()
  for (name in c("stress_ratio", "mean_stress")) {
    value <- get(name)
    if (is.null(value)) next
    found <- column_or_quantity(value, columns, name)
    if (!is.null(found$column)) study <- c(study, preset_study(columns, stats::setNames(list(found$column), name))) else
      constants[[name]] <- found$constant
  }
  look_at_unused(columns, c(life, stress, event, label, count, stress_ratio, mean_stress), !is.null(event), unused, "event = \"COLUMN\"",
                 counts = if (is.null(count)) "count = \"%s\"")
  if (!is.null(stress_ratio) && !is.null(mean_stress)) stop_input("stress_ratio and mean_stress say the same in two ways; give one of them")
  if (is.null(correction)) correction <- if (any(c("stress_ratio", "mean_stress") %in% names(study))) "goodman" else "none"
  if (!identical(correction, "none") && is.null(stress_ratio) && is.null(mean_stress)) {
    stop_input("correction = ", shown_value(correction), " needs stress_ratio or mean_stress: a column, or a value such as -1 of all tests")
  }
  law <- list(mean_stress = correction)
  if (!identical(curve, "basquin")) law$curve <- one_text(curve, "curve")
  if (!identical(fatigue_limit, "none")) law$fatigue_limit <- one_text(fatigue_limit, "fatigue_limit")
  if (!identical(scatter, "constant")) law$scatter <- one_text(scatter, "scatter")
  asked <- predict_of(predict, c(list(types = "all", b_lives = as.list(b), credible_level = confidence), given_arguments(
    survival_to = quantities(survival_to, "survival_to"), required_life = quantities(required_life, "required_life"),
    reliability = quantities(reliability, "reliability"))))
  if (is.null(title)) title <- paste0("S-N curve: ", stress, " and ", life)
  text <- preset_text("sn", one_text(title, "title"), study,
                      list(conditions = constants, law = law, likelihood = list(family = one_text(family, "family")), predict = asked), priors)
  if (length(at)) {
    if (is.null(names(at))) names(at) <- vapply(at, function(each) name_of_stress(quantity(each, "at")), "")
    of_tests <- function(each) {
      value <- quantity(each, "at")
      if (is.character(value)) value else quantity_text(value, study$alternating_stress$unit)
    }
    lines <- lapply(at, function(each) {
      if (!is.list(each)) return(c(list(alternating_stress = of_tests(each)), ratio_of(constants)))
      if (!is.null(each$alternating_stress)) each$alternating_stress <- of_tests(each$alternating_stress)
      each
    })
    text <- paste(text, toml_table("predict.stress", lines), sep = "\n")
  }
  one_line(text, study, NULL, NULL, fit, call, ..., arguments = c(credible_level = "confidence", b_lives = "b"))
}

# 100000, not 1e+05.
name_of_stress <- function(value) if (is.character(value)) value else number_text(value)

# A list of one or several.
quantities <- function(values, what) if (!is.null(values)) lapply(unname(as.list(values)), quantity, what)

ratio_of <- function(constants) constants[intersect(names(constants), c("stress_ratio", "mean_stress"))]

ww_staircase <- function(data, stress, event, count = NULL, limit_family = "normal", units = NULL, priors = NULL, reliability = c("50 %", "90 %"),
                         confidence = 0.9, predict = NULL, unused = NULL, title = NULL, fit = TRUE, ...) {
  call <- preset_call(match.call(), "ww_staircase")
  require_options("ww_staircase", ..., own = names(formals(ww_staircase)))
  columns <- frame_columns(data, units)
  study <- with_status(preset_study(columns, list(alternating_stress = stress, count = count)), event, columns)
  look_at_unused(columns, c(stress, event, count), TRUE, unused, "", counts = if (is.null(count)) "count = \"%s\"")
  asked <- predict_of(predict, list(reliability = I(reliability), credible_level = confidence))
  law <- if (!identical(limit_family, "normal")) list(limit_family = one_text(limit_family, "limit_family"))
  if (is.null(title)) title <- paste0("Fatigue limit: ", stress)
  one_line(preset_text("staircase", one_text(title, "title"), study, list(law = law, predict = asked), priors), study, NULL, NULL, fit, call, ...,
           arguments = c(credible_level = "confidence"))
}

ww_joint <- function(data, volume, cycles, work_per_cycle = NULL, work = NULL, force = NULL, slip = NULL, limit = NULL, risk = NULL, at = NULL,
                     family = "normal", count = NULL, units = NULL, priors = NULL, b = c(1, 10), confidence = 0.9, predict = NULL, unused = NULL,
                     title = NULL, stages = FALSE, fit = TRUE, ...) {
  call <- preset_call(match.call(), "ww_joint")
  require_options("ww_joint", ..., own = names(formals(ww_joint)))
  columns <- frame_columns(data, units)
  study <- preset_study(columns, list(cycles = cycles, volume = volume, work = work, force = force, slip = slip, count = count))
  if (is.null(work_per_cycle) && is.null(work) && (is.null(force) || is.null(slip))) {
    stop_input("work_per_cycle is missing, the friction work of one cycle like \"6.2 N m\"; or work, or force and slip: columns of data")
  }
  if (!is.null(work_per_cycle) && !(is.null(work) && is.null(force))) {
    stop_input("work_per_cycle and ", if (is.null(work)) "force" else "work", " say the same of the rows in two ways; give one of them, and the work ",
               "of one cycle for which lives are predicted by predict = list(work_per_cycle = \"6 N m\")")
  }
  constants <- given_arguments(work_per_cycle = if (!is.null(work_per_cycle)) quantity(work_per_cycle, "work_per_cycle"))
  if (is.null(at) && !is.null(work_per_cycle) && is.numeric(study$cycles$values)) at <- 2 * max(study$cycles$values, 1, na.rm = TRUE)
  asked <- given_arguments(cycles = quantities(at, "at"), limit = if (!is.null(limit)) quantity(limit, "limit"), risk = if (!is.null(risk)) quantity(risk, "risk"))
  if (!is.null(limit)) asked <- c(asked, list(b_lives = as.list(b), credible_level = confidence))
  look_at_unused(columns, c(volume, cycles, work, force, slip, count), TRUE, unused, "", noun = "joint", counts = if (is.null(count)) "count = \"%s\"", count_as = "those of one joint",
                 units = "ww_degradation(..., unit = \"%s\"), whose rate differs from unit to unit")
  extra <- list(conditions = constants, likelihood = list(family = one_text(family, "family")), predict = predict_of(predict, asked))
  if (is.null(title)) title <- paste0("Joint wear: ", volume, " against ", cycles)
  if (one_truth(stages, "stages")) extra$update <- list(stages = "row")
  one_line(preset_text("archard-joint", one_text(title, "title"), study, extra, priors), study, NULL,
           if (is.null(limit)) "no limit is given: no life is predicted; limit = \"100 mm^3\" gives one", fit, call, ...,
           arguments = c(cycles = "at", credible_level = "confidence", b_lives = "b"))
}

ww_bearing <- function(data, depth, contact, radius, clearance, unit = NULL, revolutions = NULL, time = NULL, speed = NULL, pressure = NULL,
                       force = NULL, length = NULL, limit = NULL, risk = NULL, at = NULL, depth_error = NULL, family = "normal", count = NULL,
                       units = NULL, priors = NULL, b = c(1, 10), confidence = 0.9, predict = NULL, unused = NULL, title = NULL, fit = TRUE, ...) {
  call <- preset_call(match.call(), "ww_bearing")
  require_options("ww_bearing", ..., own = names(formals(ww_bearing)))
  columns <- frame_columns(data, units)
  study <- preset_study(columns, list(depth = depth, bearing = unit, count = count))
  if (is.null(revolutions) && (is.null(time) || is.null(speed))) {
    stop_input("revolutions is missing: the column of the revolutions until each inspection; or time and speed")
  }
  if (is.null(pressure) && (is.null(force) || is.null(length))) {
    stop_input("pressure is missing, like \"1.5 MPa\" or a column of data; or force and length")
  }
  constants <- list()
  arguments <- given_arguments(contact = contact, radius = radius, clearance = clearance, revolutions = revolutions, time = time, speed = speed, pressure = pressure, force = force, length = length)
  for (name in names(arguments)) {
    value <- arguments[[name]]
    if (name == "contact" && is_path(value) && value %in% c("stationary", "journal", "bushing") && !value %in% names(columns)) {
      constants$contact <- value
      next
    }
    found <- column_or_quantity(value, columns, name)
    if (!is.null(found$column)) study <- c(study, preset_study(columns, stats::setNames(list(found$column), name))) else
      constants[[name]] <- found$constant
  }
  look_at_unused(columns, c(depth, unit, count, unlist(arguments)), TRUE, unused, "", noun = "bearing", counts = if (is.null(count)) "count = \"%s\"",
                 units = if (is.null(unit)) "unit = \"%s\"")
  likelihood <- c(list(family = one_text(family, "family")), given_arguments(depth_error = if (!is.null(depth_error)) quantity(depth_error, "depth_error")))
  notes <- NULL
  if (!is.null(unit) && is.null(priors$k_scatter)) {
    priors <- c(priors, list(k_scatter = ww_half_normal(1)))
    notes <- paste0("the wear rate differs from ", unit, " to ", unit, ": k_scatter, with the prior half-normal, scale 1")
  }
  asked <- given_arguments(revolutions = quantities(at, "at"), limit = if (!is.null(limit)) quantity(limit, "limit"),
                           risk = if (!is.null(risk)) quantity(risk, "risk"))
  if (!is.null(limit)) asked <- c(asked, list(b_lives = as.list(b), credible_level = confidence))
  if (is.null(title)) title <- paste0("Bearing wear: ", depth)
  one_line(preset_text("bearing-wear", one_text(title, "title"), study,
                       list(conditions = constants, likelihood = likelihood, predict = predict_of(predict, asked)), priors),
           study, NULL, c(notes, if (is.null(limit)) "no limit is given: no life is predicted; limit = \"80 um\" gives one"), fit, call, ...,
           arguments = c(revolutions = "at", credible_level = "confidence", b_lives = "b"))
}

ww_clutch <- function(design, cycles, weighings, density, depth, area, balance_sd, traces = NULL, points = NULL, levels = NULL,
                      missing_cycles = "refuse", search = NULL, replicates = NULL, units = NULL, title = NULL, fit = TRUE, ...) {
  call <- preset_call(match.call(), "ww_clutch")
  require_options("ww_clutch", ..., own = names(formals(ww_clutch)))
  tables <- given_arguments(design = design, cycles = cycles, weighings = weighings, traces = traces)
  unknown <- setdiff(names(units), names(tables))
  if (length(unknown)) stop_input("units: '", unknown[1], "' is no table; tables are ", words(names(tables)), ", as units = list(cycles = c(torque = \"N m\"))")
  given <- lapply(stats::setNames(names(tables), names(tables)), function(name) {
    if (!is_path(tables[[name]])) {
      require_columns(tables[[name]], name)
      for (heading in names(tables[[name]])) require_no_truths(list(values = tables[[name]][[heading]], heading = heading), name)
    }
    list(data = tables[[name]], units = units[[name]], only = NULL)
  })
  parts <- c(toml_table("", list(title = if (is.null(title)) "Clutch wear" else one_text(title, "title"), model = "clutch-wear")),
             toml_table("data", c(as.list(stats::setNames(names(tables), names(tables))),
                                  if (!identical(missing_cycles, "refuse")) list(missing_cycles = one_text(missing_cycles, "missing_cycles")))),
             toml_table("lining", list(density = quantity(density, "density"), depth = quantity(depth, "depth"), area = quantity(area, "area"))),
             toml_table("balance", list(sd = quantity(balance_sd, "balance_sd"))))
  if (length(search)) parts <- c(parts, toml_table("search", as.list(search)))
  if (!is.null(replicates)) parts <- c(parts, toml_table("uncertainty", list(replicates = whole(replicates, "replicates", 0, 10000))))
  if (!is.null(levels)) parts <- c(parts, toml_table("life", list(levels = as.list(levels))))
  if (length(points)) {
    if (is.null(names(points))) stop_input("points has no names; it is like list(launch = list(slip_speed = \"1700 rpm\", ...))")
    for (name in names(points)) parts <- c(parts, toml_table(paste0("life.points.", toml_key(name)), as.list(points[[name]])))
  }
  one_line(paste(parts, collapse = "\n"), NULL, NULL, NULL, fit, call, ..., tables = given,
           arguments = c(`lining.density` = "density", `lining.depth` = "depth", `lining.area` = "area", `balance.sd` = "balance_sd",
                         `data.missing_cycles` = "missing_cycles", `life.levels` = "levels", `life.points` = "points",
                         `uncertainty.replicates` = "replicates"))
}
