# Presets in one line: S-N curves, staircases, joints, bearings, clutches. Their default priors are the models' own.

# Of an argument: the heading of a column, or a quantity, which holds for all rows.
column_or_quantity <- function(value, columns, what) {
  if (is_path(value) && (value %in% names(columns) || value %in% vapply(columns, `[[`, "", "heading"))) return(list(column = value))
  if (is.character(value) && length(value) == 1 && !grepl("^[[:space:]]*[-+.]?[0-9]", value)) {
    stop_input(what, ": data has no column '", value, "' (columns: ", words(names(columns)), "), and it is no quantity, like \"10 mm\"")
  }
  list(constant = quantity(value, what))
}

# The frame of a preset, by the names that the model has for its columns.
preset_study <- function(columns, roles, what) {
  found <- list()
  for (role in names(roles)) {
    if (is.null(roles[[role]])) next
    each <- find_column(columns, one_text(roles[[role]], role), role)
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
    stop_input(name, "(): ", words(missing), if (length(missing) > 1) " are" else " is", " missing; it takes a data frame and names of its columns: ",
               name, "(", paste(c("data", sprintf("%s = ", setdiff(needed, "data")), "..."), collapse = ", "), ")")
  }
  call[[1]] <- as.name(name)
  call
}

given_arguments <- function(...) Filter(Negate(is.null), list(...))

ww_sn <- function(data, stress, life, event = NULL, stress_ratio = NULL, mean_stress = NULL, correction = NULL, curve = "basquin",
                  fatigue_limit = "none", family = "log10-normal", count = NULL, label = NULL, units = NULL, priors = NULL, b = c(1, 10),
                  confidence = 0.9, survival_to = NULL, required_life = NULL, reliability = NULL, predict = NULL, unused = NULL, title = NULL,
                  scatter = "constant", at = NULL, conditions = NULL, fit = TRUE, ...) {
  call <- preset_call(match.call(), "ww_sn")
  own <- names(formals(ww_sn))
  require_options("ww_sn", ..., own = own)
  columns <- frame_columns(data, units)
  study <- preset_study(columns, list(life = life, alternating_stress = stress, label = label, count = count))
  study <- with_status(study, event, columns)
  constants <- as.list(conditions)
  for (name in c("stress_ratio", "mean_stress")) {
    value <- get(name)
    if (is.null(value)) next
    found <- column_or_quantity(value, columns, name)
    if (!is.null(found$column)) study <- c(study, preset_study(columns, stats::setNames(list(found$column), name))) else
      constants[[name]] <- found$constant
  }
  if (is.null(stress_ratio) && is.null(mean_stress)) {
    stop_input("stress_ratio or mean_stress is missing: -1 for fully reversed tests, or a column of data")
  }
  look_at_unused(columns, c(life, stress, event, label, count, stress_ratio, mean_stress), !is.null(event), unused, "event = \"COLUMN\"",
                 counts = if (is.null(count)) "count = \"%s\"")
  if (!is.null(stress_ratio) && !is.null(mean_stress)) stop_input("stress_ratio and mean_stress say the same in two ways; give one of them")
  if (is.null(correction)) correction <- if (any(c("stress_ratio", "mean_stress") %in% names(study))) "goodman" else "none"
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
    if (is.null(names(at)) && is.character(at)) names(at) <- at
    lines <- lapply(at, function(each) if (is.list(each)) each else c(list(alternating_stress = quantity(each, "at")), ratio_of(constants)))
    text <- paste(text, toml_table("predict.stress", lines), sep = "\n")
  }
  one_line(text, study, NULL, NULL, fit, call, ..., arguments = c(credible_level = "confidence", b_lives = "b"))
}

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

ww_joint <- function(data, volume, cycles, work_per_cycle = NULL, work = NULL, force = NULL, slip = NULL, limit = NULL, risk = "1 %", at = NULL,
                     family = "normal", count = NULL, units = NULL, priors = NULL, b = c(1, 10), confidence = 0.9, predict = NULL, unused = NULL,
                     title = NULL, stages = FALSE, conditions = NULL, fit = TRUE, ...) {
  call <- preset_call(match.call(), "ww_joint")
  require_options("ww_joint", ..., own = names(formals(ww_joint)))
  columns <- frame_columns(data, units)
  study <- preset_study(columns, list(cycles = cycles, volume = volume, work = work, force = force, slip = slip, count = count))
  if (is.null(work_per_cycle) && is.null(work) && is.null(force)) {
    stop_input("work_per_cycle is missing, the friction work of one cycle like \"6.2 N m\"; or work, or force and slip: columns of data")
  }
  constants <- as.list(conditions)
  asked <- given_arguments(cycles = if (!is.null(at)) as.list(at), limit = if (!is.null(limit)) quantity(limit, "limit"))
  if (!is.null(limit)) asked <- c(asked, list(risk = risk, b_lives = as.list(b), credible_level = confidence))
  if (!is.null(work_per_cycle)) {
    if (is.null(work) && is.null(force)) constants$work_per_cycle <- quantity(work_per_cycle, "work_per_cycle") else
      asked$work_per_cycle <- quantity(work_per_cycle, "work_per_cycle")
  }
  look_at_unused(columns, c(volume, cycles, work, force, slip, count), TRUE, unused, "", noun = "joint", counts = if (is.null(count)) "count = \"%s\"", count_as = "those of one joint",
                 units = "ww_degradation(..., unit = \"%s\"), whose rate differs from unit to unit")
  extra <- list(conditions = constants, likelihood = list(family = one_text(family, "family")), predict = predict_of(predict, asked))
  if (is.null(title)) title <- paste0("Joint wear: ", volume, " against ", cycles)
  if (one_truth(stages, "stages")) extra$update <- list(stages = "row")
  one_line(preset_text("archard-joint", one_text(title, "title"), study, extra, priors), study, NULL,
           if (is.null(limit)) "no limit is given: no life is predicted; limit = \"100 mm^3\" gives one", fit, call, ...,
           arguments = c(cycles = "at", credible_level = "confidence", b_lives = "b"))
}

ww_bearing <- function(data, depth, revolutions, contact, radius, clearance, pressure = NULL, force = NULL, length = NULL, unit = NULL,
                       limit = NULL, risk = "1 %", at = NULL, depth_error = NULL, family = "normal", count = NULL, units = NULL, priors = NULL,
                       b = c(1, 10), confidence = 0.9, predict = NULL, unused = NULL, title = NULL, speed = NULL, given = NULL, fit = TRUE, ...) {
  call <- preset_call(match.call(), "ww_bearing")
  require_options("ww_bearing", ..., own = names(formals(ww_bearing)))
  columns <- frame_columns(data, units)
  study <- preset_study(columns, list(revolutions = revolutions, depth = depth, bearing = unit, count = count))
  if (is.null(pressure) && (is.null(force) || is.null(length))) {
    stop_input("pressure is missing, like \"1.5 MPa\" or a column of data; or force and length")
  }
  constants <- list()
  arguments <- given_arguments(contact = contact, radius = radius, clearance = clearance, pressure = pressure, force = force, length = length)
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
  look_at_unused(columns, c(depth, revolutions, unit, count, unlist(arguments)), TRUE, unused, "", noun = "bearing", counts = if (is.null(count)) "count = \"%s\"",
                 units = if (is.null(unit)) "unit = \"%s\"")
  likelihood <- c(list(family = one_text(family, "family")), given_arguments(depth_error = if (!is.null(depth_error)) quantity(depth_error, "depth_error")))
  notes <- NULL
  if (!is.null(unit) && is.null(priors$k_scatter)) {
    priors <- c(priors, list(k_scatter = ww_half_normal(1)))
    notes <- paste0("the wear rate differs from ", unit, " to ", unit, ": k_scatter, with the prior half-normal, scale 1")
  }
  asked <- given_arguments(revolutions = quantities(at, "at"))
  if (!is.null(limit)) asked <- c(asked, list(limit = quantity(limit, "limit"), risk = risk, b_lives = as.list(b), credible_level = confidence), given_arguments(speed = if (!is.null(speed)) quantity(speed, "speed")),
                                  as.list(given))
  if (is.null(title)) title <- paste0("Bearing wear: ", depth)
  one_line(preset_text("bearing-wear", one_text(title, "title"), study,
                       list(conditions = constants, likelihood = likelihood, predict = predict_of(predict, asked)), priors),
           study, NULL, c(notes, if (is.null(limit)) "no limit is given: no life is predicted; limit = \"80 um\" gives one"), fit, call, ...,
           arguments = c(revolutions = "at", credible_level = "confidence", b_lives = "b"))
}

ww_clutch <- function(design, cycles, weighings, density, depth, area, balance = "1 mg", traces = NULL, points = NULL, levels = c(0.5, 1),
                      replicates = 50, units = NULL, title = "Clutch wear", fit = TRUE, ...) {
  call <- preset_call(match.call(), "ww_clutch")
  require_options("ww_clutch", ..., own = names(formals(ww_clutch)))
  tables <- given_arguments(design = design, cycles = cycles, weighings = weighings, traces = traces)
  given <- lapply(stats::setNames(names(tables), names(tables)), function(name) {
    if (!is_path(tables[[name]])) require_columns(tables[[name]], name)
    list(data = tables[[name]], units = units[[name]], only = NULL)
  })
  parts <- c(toml_table("", list(title = one_text(title, "title"), model = "clutch-wear")),
             toml_table("data", as.list(stats::setNames(names(tables), names(tables)))),
             toml_table("lining", list(density = quantity(density, "density"), depth = quantity(depth, "depth"), area = quantity(area, "area"))),
             toml_table("balance", list(sd = quantity(balance, "balance"))), toml_table("uncertainty", list(replicates = whole(replicates, "replicates", 0, 10000))))
  if (length(points)) {
    if (is.null(names(points))) stop_input("points has no names; it is like list(launch = list(slip_speed = \"1700 rpm\", ...))")
    parts <- c(parts, toml_table("life", list(levels = as.list(levels))))
    for (name in names(points)) parts <- c(parts, toml_table(paste0("life.points.", toml_key(name)), as.list(points[[name]])))
  }
  one_line(paste(parts, collapse = "\n"), NULL, NULL, NULL, fit, call, ..., tables = given)
}
