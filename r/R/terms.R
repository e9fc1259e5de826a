# The right side of a formula: effects of conditions, and random effects as lme4 and brms write them.

# 1, 2 or 5 times a power of ten, not below x: the size of the data, of which weak priors are made.
rounded_up <- function(x) {
  if (!is.finite(x) || x <= 0) return(1)
  power <- 10^floor(log10(x) + 1e-9)
  power * c(1, 2, 5, 10)[which(c(1, 2, 5, 10) * power >= x * (1 - 1e-9))[1]]
}

# "20 km"; a plain number without a unit, and "20000000 cycles" of 20 "1e6 cycles".
quantity_text <- function(x, unit) {
  if (unit %in% c("", "1")) return(as.double(x))
  size <- sub("^([0-9.]+([eE][+-]?[0-9]+)?) .*$", "\\1", unit)
  if (size == unit) return(paste(number_text(x), unit))
  quantity_text(as.double(sprintf("%.15g", x * as.double(size))), substring(unit, nchar(size) + 2))
}

inverse_unit <- function(unit) if (unit == "") "" else if (unit %in% c("degC", "degF")) "1/K" else paste0("1/(", unit, ")")

# Differences of temperatures are in kelvin.
in_kelvin <- function(difference, unit) if (unit == "degF") difference * 5 / 9 else difference

# A name of the formula language: letters, digits and _, a letter first, that nothing else has.
language_name <- function(name, taken = character()) {
  plain <- gsub("[^A-Za-z0-9_]+", "_", name)
  plain <- gsub("^[^A-Za-z]+|_+$", "", plain)
  if (plain == "") plain <- "x"
  if (plain %in% c(special, "pi", "exp", "log", "log10", "sqrt", "abs", "min", "max", "where", "cum", "and", "or", "not")) {
    plain <- paste0(plain, "_")
  }
  while (plain %in% taken) plain <- paste0(plain, "_")
  plain
}

has_bar <- function(term) is.call(term) && (identical(term[[1]], quote(`|`)) || identical(term[[1]], quote(`||`)))

# The terms of a sum, brackets removed.
summands <- function(side) {
  if (is.call(side) && identical(side[[1]], quote(`+`)) && length(side) == 3) return(c(summands(side[[2]]), summands(side[[3]])))
  if (is.call(side) && identical(side[[1]], quote(`(`))) {
    if (has_bar(side[[2]])) return(list(side[[2]]))
    return(summands(side[[2]]))
  }
  list(side)
}

# list(fixed = one-sided formula without random effects, random = the calls with bars)
split_terms <- function(side) {
  all <- summands(side)
  bars <- vapply(all, has_bar, NA)
  fixed <- all[!bars]
  list(fixed = if (length(fixed)) Reduce(function(a, b) call("+", a, b), fixed) else 1, random = all[bars])
}

# ---- Effects on the logarithm of a location.

is_label <- function(values) is.factor(values) || is.character(values) || is.logical(values)

levels_of <- function(values) {
  if (is.factor(values)) return(levels(droplevels(values)))
  if (is.logical(values)) return(c("FALSE", "TRUE"))
  sort(unique(values[!is.na(values)]))
}

# What a study has of a condition: its column, the name of that, and its reference.
# `fitted`: rows for a fit that is there, in which a condition may be the same in all rows.
condition_of <- function(name, columns, taken, what, fitted = FALSE) {
  each <- find_column(columns, name, what)
  values <- plain_values(each)
  column_values(values, place_of(each))
  row <- which(is.na(values))
  if (length(row)) stop_input(place_of_row(each, row[1]), ": a value is missing; the formula uses it")
  row <- if (is.numeric(values)) which(is.infinite(values))
  if (length(row)) stop_input(place_of_row(each, row[1]), ": ", values[row[1]], " is not a finite number")
  found <- list(source = name, name = language_name(name, taken), label = is_label(values), unit = each$unit, of = each$of, heading = each$heading)
  if (found$label) {
    found$levels <- levels_of(values)
    if (length(found$levels) < 2 && !fitted) stop_input(what, ": column '", each$heading, "' has one level only, ", found$levels, ": leave it out")
    found$values <- as.character(values)
    found$reference <- found$levels[1]
    return(found)
  }
  found$values <- as.double(values)
  found$range <- diff(range(found$values))
  if (found$range == 0) {
    if (!fitted) stop_input(what, ": column '", each$heading, "' is ", found$values[1], " in all rows: leave it out")
    found$range <- 1  # the priors of the fit hold, not those that this would scale
  }
  found$reference <- signif(mean(found$values), 3)
  found
}

reference_name <- function(condition) paste0(condition$name, "_ref")

# Pieces of a condition: parameter -> expression that it multiplies in the logarithm, and the scale of that.
pieces_of <- function(condition) {
  if (condition$label) {
    levels <- condition$levels[-1]
    return(lapply(stats::setNames(levels, paste0(condition$name, language_suffix(levels))[seq_along(levels)]), function(level) {
      list(expression = paste0("(", condition$name, " == ", quoted(level), ")"), unit = "", size = 1, label = TRUE,
           value = as.double(condition$values == level))
    }))
  }
  piece <- list(expression = paste0("(", condition$name, " - ", reference_name(condition), ")"), unit = condition$unit,
                size = in_kelvin(condition$range, condition$unit), label = FALSE,
                value = in_kelvin(condition$values - condition$reference, condition$unit))
  stats::setNames(list(piece), condition$name)
}

language_suffix <- function(levels) {
  plain <- gsub("[^A-Za-z0-9_]+", "_", levels)
  if (anyDuplicated(plain)) plain <- paste0(plain, "_", seq_along(plain))
  paste0("_", plain)
}

# The product of two pieces is their interaction.
crossed <- function(a, b) {
  unit <- if (a$unit == "") b$unit else if (b$unit == "") a$unit else paste0(a$unit, " ", b$unit)
  if (a$unit %in% c("degC", "degF") && b$unit != "" || b$unit %in% c("degC", "degF") && a$unit != "") {
    unit <- paste(sub("^deg[CF]$", "K", a$unit), sub("^deg[CF]$", "K", b$unit))
  }
  list(expression = paste0(a$expression, " * ", b$expression), unit = unit, size = a$size * b$size, label = a$label && b$label,
       value = a$value * b$value)
}

# b of an effect: over the range that was tested it changes the logarithm by 3 at one standard deviation, a level by 2.
effect_prior <- function(piece) {
  if (piece$label) return(ww_normal(0, 2))
  ww_normal(quantity_text(0, inverse_unit(piece$unit)), quantity_text(signif(3 / piece$size, 2), inverse_unit(piece$unit)))
}

known_stresses <- c("arrhenius", "eyring", "inverse power", "exponential")

# The effects of a formula's terms, with the stress laws that take the place of some.
effects_of <- function(fixed, columns, stress, what, fitted = FALSE) {
  terms <- tryCatch(stats::terms(stats::as.formula(call("~", fixed), env = emptyenv())), error = function(error) {
    stop_input(what, ": ", conditionMessage(error))
  })
  if (attr(terms, "intercept") == 0) stop_input(what, ": a formula without its intercept (0 + ...) has no reference; by = \"...\" gives each level its own")
  if (!is.null(attr(terms, "offset"))) stop_input(what, ": offset() is not read; make the column in the data")
  labels <- attr(terms, "term.labels")
  variables <- unique(c(unlist(lapply(as.list(attr(terms, "variables"))[-1], function(variable) {
    if (!is.symbol(variable)) {
      if (is.call(variable) && length(variable) == 2 && as.character(variable[[1]])[1] %in% c(known_stresses, "inverse_power")) {
        stop_input(what, ": ", shown_value(variable), " is no column; the law of a stress is stress = c(", all.vars(variable)[1], " = \"",
                   sub("_", " ", as.character(variable[[1]])), "\")")
      }
      stop_input(what, ": ", shown_value(variable), " is no column; make one of it first, like data$x <- ", shown_value(variable))
    }
    as.character(variable)
  })), names(stress)))
  conditions <- list()
  for (name in variables) {
    conditions[[name]] <- condition_of(name, columns, vapply(conditions, `[[`, "", "name"), what, fitted)
  }
  # Of a stress the reference is the harshest tested, and lives are predicted at the mildest.
  for (name in names(stress)) {
    if (conditions[[name]]$label) next
    conditions[[name]]$reference <- max(conditions[[name]]$values)
    conditions[[name]]$mildest <- min(conditions[[name]]$values)
  }
  effects <- list(terms = character(), priors = list(), constants = list(), conditions = conditions, pieces = list(),
                  values = list(), fixed = list())
  for (label in setdiff(labels, names(stress))) {
    parts <- strsplit(label, ":", fixed = TRUE)[[1]]
    parts <- gsub("`", "", parts)
    wrong <- intersect(parts, names(stress))
    if (length(wrong)) stop_input("stress: ", wrong[1], " stands in the interaction ", label, ", and its law is ", stress[[wrong[1]]])
    pieces <- pieces_of(conditions[[parts[1]]])
    for (part in parts[-1]) {
      more <- pieces_of(conditions[[part]])
      pieces <- unlist(lapply(names(pieces), function(a) {
        stats::setNames(lapply(names(more), function(b) crossed(pieces[[a]], more[[b]])), paste0(a, "_by_", names(more)))
      }), recursive = FALSE)
    }
    for (name in names(pieces)) {
      parameter <- paste0("b_", name)
      effects$terms <- c(effects$terms, paste0(parameter, " * ", pieces[[name]]$expression))
      effects$priors[[parameter]] <- effect_prior(pieces[[name]])
      effects$pieces[[parameter]] <- pieces[[name]]
      effects$values[[parameter]] <- pieces[[name]]$value
    }
  }
  for (condition in conditions) {
    if (!condition$label) effects$constants[[reference_name(condition)]] <- quantity_text(condition$reference, condition$unit)
  }
  for (name in names(stress)) effects <- with_stress(effects, conditions[[name]], stress[[name]])
  effects
}

with_stress <- function(effects, condition, law) {
  if (condition$label) stop_input("stress: column '", condition$source, "' holds texts; the ", law, " law needs numbers")
  reference <- reference_name(condition)
  if (law %in% c("arrhenius", "eyring")) {
    if (!condition$unit %in% c("degC", "degF", "K")) {
      stop_input("stress: the ", law, " law needs a temperature, and ", condition$source, " has ",
                 if (condition$unit == "") "no unit" else paste0("the unit ", condition$unit), ": units = c(", condition$source,
                 " = \"degC\") states it, or \"K\"")
    }
    parameter <- if ("energy" %in% names(effects$priors)) paste0(condition$name, "_energy") else "energy"
    effects$constants$boltzmann <- "8.617333262e-5 eV/K"
    effects$terms <- c(effects$terms, paste0(parameter, "/boltzmann * (1/", condition$name, " - 1/", reference, ")"))
    if (law == "eyring") effects$terms <- c(effects$terms, paste0("log(", reference, "/", condition$name, ")"))
    effects$priors[[parameter]] <- ww_normal("0.7 eV", "0.3 eV")
    kelvin <- kelvin_of(condition$values, condition$unit)
    at <- kelvin_of(condition$reference, condition$unit)
    effects$values[[parameter]] <- (1 / kelvin - 1 / at) / 8.617333262e-5
    if (law == "eyring") effects$fixed <- c(effects$fixed, list(log(at / kelvin)))
  } else if (law == "inverse power") {
    if (any(condition$values <= 0)) {
      stop_input("stress: the inverse power law needs values above 0, and ", place_of_row(condition, which(condition$values <= 0)[1]), " is ", condition$values[condition$values <= 0][1])
    }
    if (condition$unit %in% c("degC", "degF")) stop_input("stress: the inverse power law of a temperature in ", condition$unit, ": \"arrhenius\" is usual")
    parameter <- paste0(condition$name, "_power")
    effects$terms <- c(effects$terms, paste0("-", parameter, " * log(", condition$name, "/", reference, ")"))
    effects$priors[[parameter]] <- ww_normal(5, 5)
    effects$values[[parameter]] <- -log(condition$values / condition$reference)
  } else {
    piece <- pieces_of(condition)[[1]]
    parameter <- paste0("b_", condition$name)
    effects$terms <- c(effects$terms, paste0(parameter, " * ", piece$expression))
    effects$priors[[parameter]] <- effect_prior(piece)
    effects$values[[parameter]] <- piece$value
  }
  effects
}

stress_laws <- function(stress) {
  if (is.null(stress)) return(list())
  if (is.null(names(stress)) || any(names(stress) == "")) stop_input("stress has no names; it is like c(temperature = \"arrhenius\")")
  stress <- as.list(stress)
  for (name in names(stress)) {
    if (identical(stress[[name]], "inverse-power")) stress[[name]] <- "inverse power"
    if (!isTRUE(stress[[name]] %in% known_stresses)) {
      stop_input("stress: ", name, " is ", shown_value(stress[[name]]), "; it is one of ", words(known_stresses))
    }
  }
  as.list(stress)
}

# ---- Random effects.

# Of each bar: the label's columns, the parameters that differ (the location's name, or b_x), whether the two are correlated.
random_of <- function(bars, location, effects, columns, what) {
  all <- list()
  for (bar in bars) {
    if (has_bar(bar[[2]])) stop_input(what, ": (", shown_value(bar), "): random effects are written (1 | label) or (x | label)")
    group <- bar[[3]]
    labels <- if (is.call(group) && identical(group[[1]], quote(`/`))) {
      outer <- all.vars(group[[2]])
      c(list(outer), list(c(outer, all.vars(group[[3]]))))
    } else {
      list(all.vars(group))
    }
    slopes <- stats::terms(stats::as.formula(call("~", bar[[2]]), env = emptyenv()))
    differs <- c(if (attr(slopes, "intercept") == 1) location, if (length(attr(slopes, "term.labels"))) paste0("b_", attr(slopes, "term.labels")))
    for (parameter in setdiff(differs, location)) {
      if (!parameter %in% names(effects$priors)) {
        stop_input(what, ": (", shown_value(bar), "): ", sub("^b_", "", parameter), " is no effect of the formula; it stands beside it, like ",
                   sub("^b_", "", parameter), " + (", shown_value(bar), ")")
      }
    }
    correlated <- identical(bar[[1]], quote(`|`)) && length(differs) > 1
    for (label in labels) all <- c(all, list(list(label = label, parameters = differs, correlated = correlated)))
  }
  all
}

# Entries of [random_effects], columns of labels, priors.
with_random <- function(random, location, effects, columns, taken, what) {
  found <- list(entries = list(), columns = list(), priors = list(), labels = character())
  several <- length(random) > 1
  for (each in random) {
    values <- lapply(each$label, function(name) {
      column <- find_column(columns, name, what)
      value <- column_values(plain_values(column), place_of(column))
      row <- which(is.na(value))
      if (length(row)) stop_input(place_of_row(column, row[1]), ": a value is missing; random effects need one")
      if (is.double(value)) number_text(value) else value
    })
    name <- language_name(paste(each$label, collapse = "_"), taken)
    taken <- c(taken, name)
    found$columns[[name]] <- study_column(do.call(paste, c(values, sep = ":")), "")
    found$labels <- c(found$labels, name)
    entries <- list()
    for (parameter in each$parameters) {
      scatter <- paste0(parameter, if (several) paste0("_", name), "_scatter")
      if (parameter == location) {
        entries[[parameter]] <- list(distribution = "lognormal", log_sd = scatter)
        found$priors[[scatter]] <- ww_half_normal(1)
      } else {
        entries[[parameter]] <- list(distribution = "normal", sd = scatter)
        piece <- effects$pieces[[parameter]]
        found$priors[[scatter]] <- ww_half_normal(quantity_text(signif(1 / piece$size, 2), inverse_unit(piece$unit)))
      }
    }
    if (each$correlated) {
      if (length(each$parameters) != 2) stop_input(what, ": correlations are of two random effects; (", words(each$parameters), " || ", name, ") has none")
      correlation <- paste0("rho", if (several) paste0("_", name))
      entries$correlation <- correlation
      found$priors[[correlation]] <- ww_uniform(-1, 1)
    }
    found$entries[[name]] <- entries
  }
  found
}
