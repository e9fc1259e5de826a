# Studies: from a file, from text with tables in memory, or put together of a formula, data and priors.

special <- c("status", "lower", "upper", "entry", "count")
# Of a family: the slot that the formula gives, the slot of its scatter, and the default name of that parameter.
slots <- list(
  normal = c("mean", "sd", "sigma"),
  lognormal = c("median", "log_sd", "sigma"),
  `log10-normal` = c("median", "log10_sd", "sigma"),
  weibull = c("scale", "shape", "shape"),
  loglogistic = c("scale", "shape", "shape"),
  frechet = c("scale", "shape", "shape"),
  `inverse-gaussian` = c("mean", "shape", "shape"),
  `birnbaum-saunders` = c("scale", "shape", "shape"),
  `smallest-extreme-value` = c("location", "scale", "sigma"),
  `largest-extreme-value` = c("location", "scale", "sigma"),
  exponential = "mean",
  poisson = "mean")
# Distributions of priors that say nothing of a sign, or of a fraction; under all others a parameter is positive.
of_any_sign <- c("flat", "uniform", "normal", "student-t", "smallest-extreme-value", "largest-extreme-value", "beta", "default")
scatters <- c("family", "sd", "log_sd", "log10_sd", "shape", "df", "trials")

# Names in expressions; texts and units are none.
names_in <- function(x) {
  texts <- c(names(unlist(x)), names(x), as.character(unlist(x)))
  texts <- gsub("\"[^\"]*\"|\\[[^]]*\\]", " ", texts)
  unique(unlist(regmatches(texts, gregexpr("[A-Za-z][A-Za-z0-9_]*", texts))))
}

law_lines <- function(formula) {
  if (!is.null(names(formula)) && (is.list(formula) || is.character(formula))) return(stats::setNames(as.list(formula), trimws(names(formula))))
  if (!is.character(formula) || anyNA(formula)) stop_input("the formula is ", kind_of(formula), "; it is a text like 'V = k*F*s', one equation a line")
  lines <- list()
  for (line in unlist(strsplit(formula, "[\n;]"))) {
    if (trimws(line) == "") next
    at <- regexpr("(?<![<>=!])=(?!=)", line, perl = TRUE)  # the first = that is no comparison
    name <- trimws(substr(line, 1, at - 1))
    side <- trimws(substr(line, at + 1, nchar(line)))
    if (at < 0 || name == "" || side == "") stop_input("'", trimws(line), "' is not an equation; write one like 'V = k*F*s'")
    if (name %in% names(lines)) stop_input("the formula gives '", name, "' twice")
    lines[[name]] <- side
  }
  if (!length(lines)) stop_input("the formula is empty; write one like 'V = k*F*s'")
  lines
}

likelihood_of <- function(lines, columns, family, scatter) {
  if (!is_path(family) || !family %in% names(slots)) {
    stop_input("family ", shown_value(family), ": a formula does not give one of its parameters; likelihood = list(...) gives all of them ",
               "(families that take a formula: ", words(names(slots)), ")")
  }
  slot <- slots[[family]]
  measured <- intersect(names(lines), names(columns))
  if (!length(measured)) {
    stop_input("no left side of the formula is a column of data: ", words(names(lines)), " (columns: ", words(names(columns)), ")")
  }
  likelihood <- lapply(lines[measured], function(line) stats::setNames(list(family, line), c("family", slot[1])))
  if (length(slot) > 1) {
    for (name in measured) {
      each <- if (is.list(scatter) || !is.null(names(scatter))) scatter[[name]] else scatter
      likelihood[[name]][[slot[2]]] <- if (is.null(each)) slot[3] else each
    }
  }
  likelihood
}

# (entries of [random_effects], priors that they need): which parameters differ from item to item.
varies_of <- function(random_effects, unit, lines, likelihood, priors) {
  middles <- c(lines, lapply(likelihood, function(slots) slots[setdiff(names(slots), scatters)]))
  if (is.null(random_effects)) {
    in_law <- intersect(names(priors), names_in(unname(lapply(middles, function(m) unname(unlist(m))))))
    if (length(in_law) != 1) {
      stop_input("which of ", if (length(in_law)) words(in_law) else "its parameters", " differ from ", unit, " to ", unit,
                 "? random_effects = '", c(in_law, "k")[1], "' says so")
    }
    random_effects <- in_law
  }
  if (is.null(names(random_effects))) {
    kind <- function(p) if (is.null(priors[[p]]$distribution) || priors[[p]]$distribution %in% of_any_sign) "normal" else "lognormal"
    random_effects <- stats::setNames(lapply(random_effects, kind), random_effects)
  }
  entries <- added <- list()
  for (parameter in names(random_effects)) {
    how <- random_effects[[parameter]]
    if (!is.character(how) || parameter == "correlation") {
      entries[[parameter]] <- how
      next
    }
    scatter <- paste0(parameter, "_scatter")
    entries[[parameter]] <- stats::setNames(list(how, scatter), c("distribution", if (how == "lognormal") "log_sd" else "sd"))
    if (!scatter %in% names(priors)) {
      if (how != "lognormal") stop_input("priors has no '", scatter, "': by how much ", parameter, " differs from ", unit, " to ", unit)
      added[[scatter]] <- list(distribution = "half-normal", scale = 1)
    }
  }
  list(entries = entries, added = added)
}

# Headings by the names that formulas have for them: "F [N]" is F.
named_columns <- function(headings) {
  match <- regmatches(headings, regexec("^\\s*([A-Za-z][A-Za-z0-9_]*)\\s*([[(].*)?$", headings))
  known <- lengths(match) > 0
  names <- vapply(match[known], `[`, "", 2)
  columns <- stats::setNames(headings[known], names)
  twice <- names[duplicated(names)]
  if (length(twice)) {
    both <- columns[names == twice[1]]
    stop_input("data: the columns '", both[1], "' and '", both[2], "' have one name, ", twice[1])
  }
  columns
}

# What stands in [data.columns] of the column that says how each life ended.
status_entry <- function(status, columns, headings) {
  entry <- if (is.list(status)) status else list(column = status)
  if (isTRUE(entry$column %in% names(columns))) entry$column <- columns[[entry$column]]
  if (!isTRUE(entry$column %in% headings)) {
    stop_input("status: data has no column '", words(entry$column), "' (columns: ", words(headings), "); it is like \"event\" or ",
               "list(column = \"event\", failure = 1)")
  }
  if (is.numeric(entry$failure)) entry$failure <- as.integer(entry$failure)
  if (length(entry) > 1) entry else entry$column
}

# A column of a few numbers or words again and again.
has_few_kinds <- function(column) {
  kinds <- tryCatch(unique(column_values(column, "data, column 'x'")), wearwell_input_error = function(error) NULL)
  !is.null(kinds) && sum(!is.na(kinds)) <= 6
}

# What a message says of keys of a study file, as arguments of ww_study().
in_r <- function(message) {
  message <- gsub("status = \\{ column = (\"[^\"]*\"), failure = ([0-9]|\"[^\"]*\") \\}", "status = list(column = \\1, failure = \\2)", message)
  gsub("unused = \\[([^]]*)\\] under \\[data\\]", "unused = \\1", message)
}

ww_study <- function(formula, data, units = NULL, priors, unit = NULL, random_effects = NULL, family = "normal", scatter = NULL,
                     likelihood = NULL, constants = NULL, predict = NULL, sampler = NULL, title = NULL, status = NULL,
                     unused = NULL) {
  units <- unit_texts(units, "units")
  table <- NULL
  if (is_path(data)) table <- table_of(data) else require_columns(data, "data")
  headings <- headings_of(data, table)
  columns <- named_columns(headings)
  for (key in names(units)) {
    if (!key %in% c(columns, names(columns))) stop_input("units: data has no column '", key, "' (columns: ", words(headings), ")")
  }
  by_name <- ifelse(names(units) %in% columns, names(columns)[match(names(units), columns)], names(units))
  names(units) <- by_name
  if (!is.null(unit) && !isTRUE(unit %in% names(columns))) {
    stop_input("unit: data has no column '", words(unit), "' (columns: ", words(headings), ")")
  }
  all_lines <- lines <- law_lines(formula)
  if (missing(priors)) stop_input("priors is missing: a list like list(k = ww_lognormal(\"1e-7 mm^3/(N m)\", log_sd = 3))")
  for (parameter in names(priors)) {
    if (!is.list(priors[[parameter]])) {
      stop_input("priors: ", parameter, " is ", kind_of(priors[[parameter]]), "; ww_lognormal(...) and its like make one")
    }
  }
  if (is.null(likelihood)) {
    likelihood <- likelihood_of(lines, columns, family, scatter)
    lines <- lines[setdiff(names(lines), names(likelihood))]
  }
  if (is.null(unit) && !is.null(random_effects)) stop_input("random_effects needs unit: the column that names the units")
  entries <- list()
  if (!is.null(unit)) {
    found <- varies_of(random_effects, unit, lines, likelihood, priors)
    entries <- found$entries
    priors <- c(priors, found$added)
  }
  used <- c(names_in(lines), names_in(likelihood), names_in(predict), special, unit)
  chosen <- columns[names(columns) %in% used]
  in_table <- Map(function(name, heading) {
    if (name %in% names(units)) list(column = heading, unit = units[[name]]) else heading
  }, names(chosen), unname(chosen))
  if (!is.null(status)) {
    in_table$status <- status_entry(status, columns, headings)
    chosen[["status"]] <- if (is.list(in_table$status)) in_table$status$column else in_table$status
  }
  unknown <- setdiff(unused, c(headings, names(columns)))
  if (length(unknown)) stop_input("unused: data has no column '", unknown[1], "' (columns: ", words(headings), ")")
  unused <- unname(ifelse(unused %in% names(columns), columns[unused], unused))
  if (is.null(title)) title <- paste(names(all_lines), all_lines, sep = " = ", collapse = "; ")
  parts <- c(toml_table("", list(title = title, model = "formula")),
             toml_table("data", c(list(file = "data"), if (length(unused)) list(unused = as.list(unused)))),
             toml_table("data.columns", in_table))
  if (length(constants)) parts <- c(parts, toml_table("constants", Map(quantity, constants, paste0("constants.", names(constants)))))
  if (length(lines)) parts <- c(parts, toml_table("formula", lines))
  for (measured in names(likelihood)) parts <- c(parts, toml_table(paste0("likelihood.", measured), likelihood[[measured]]))
  parts <- c(parts, toml_table("prior", priors))
  if (length(entries)) parts <- c(parts, toml_table(paste0("random_effects.", unit), entries))
  if (length(predict)) parts <- c(parts, toml_table("predict", predict))
  if (length(sampler)) parts <- c(parts, toml_table("sampler", sampler))
  # Columns that may say how lives ended go along: the library refuses to pass over them.
  others <- setdiff(headings, c(chosen, unused))
  only <- if (is.null(table)) c(unname(unlist(chosen)), others[vapply(others, function(h) has_few_kinds(.subset2(data, h)), NA)])
  text <- paste(parts, collapse = "\n")
  tryCatch(new_study(text, "study", list(data = list(data = data, units = NULL, only = only))),
           wearwell_input_error = function(error) stop_input(in_r(conditionMessage(error))))
}

ww_study_toml <- function(text, data = NULL, units = NULL, folder = "", name = "study") {
  if (!is.character(text)) {
    stop_input("text is ", kind_of(text), "; it is a study as text", if (inherits(text, c("ww_fit", "ww_study"))) ", which fit$toml and study$text have")
  }
  text <- paste(text, collapse = "\n")
  if (!is.null(data) && (!is.list(data) || is.null(names(data)) || is.data.frame(data))) {
    stop_input("data is a list of tables by the names that the study gives them, like list(\"wear.csv\" = df)")
  }
  given <- lapply(stats::setNames(names(data), names(data)), function(each) list(data = data[[each]], units = units[[each]], only = NULL))
  new_study(text, if (folder == "") name else file.path(path.expand(folder), name), given)
}

ww_read_study <- function(path, data = NULL, units = NULL) {
  path <- path_of(path, "study")
  if (is.null(data)) {
    study <- core(C_read_file, path)
    return(structure(class = "ww_study", list(text = core(C_study_text, study), path = normalizePath(path), shown = path, given = list(),
                                              live = living(study))))
  }
  if (!file.exists(path)) core(C_read_file, path)  # says so
  text <- readChar(path, file.size(path), useBytes = TRUE)
  Encoding(text) <- "UTF-8"
  is_table <- is.data.frame(data) || is_path(data) || !all(vapply(data, function(x) is.data.frame(x) || is_path(x), NA))
  if (is_table) {
    file <- core(C_keys, text)$data$file
    if (!is_path(file)) stop_input(path, ": [data] names no one file; data = list(NAME = ...) says which table stands for which")
    data <- stats::setNames(list(data), file)
    if (!is.null(units)) units <- stats::setNames(list(units), file)
  }
  ww_study_toml(text, data, units, dirname(path), basename(path))
}

# An address that R may keep beyond its session, in a place that may be filled again.
living <- function(address) {
  live <- new.env(parent = emptyenv())
  live$address <- address
  live
}

new_study <- function(text, path, given) {
  study <- structure(class = "ww_study", list(text = text, path = path, shown = path, given = given, live = living(NULL)))
  study_address(study)
  study
}

read_again <- function(study, text) {
  if (!is.null(study$state)) {  # of ww_update
    of_state <- core(C_study_of_state, study$state)
    return(if (nzchar(text)) core(C_study_with_text, of_state, text) else of_state)
  }
  core(C_read_text, text, study$path, lapply(stats::setNames(names(study$given), names(study$given)), function(name) {
    each <- study$given[[name]]
    table_of(each$data, name, each$units, each$only)
  }))
}

study_address <- function(study) {
  if (!core(C_is_there, study$live$address)) study$live$address <- read_again(study, study$text)
  study$live$address
}

ww_description <- function(study) core(C_description, study_address(as_study(study)))

print.ww_study <- function(x, ...) {
  cat(ww_description(x))
  invisible(x)
}

# What ww_fit takes.
as_study <- function(study, data = NULL, units = NULL) {
  if (inherits(study, "ww_study")) {
    if (!is.null(data) || !is.null(units)) stop_input("the study has its data; ww_study(..., data, units) takes others")
    return(study)
  }
  if (is_path(study)) return(ww_read_study(study, data, units))
  if (!is.list(study) || is.null(names(study)) || is.object(study)) {
    stop_input("study is ", kind_of(study), "; it is the path of a study file, or what ww_study() makes, or a list of its arguments")
  }
  unknown <- setdiff(names(study), names(formals(ww_study)))
  if (length(unknown)) stop_input("study has no '", unknown[1], "' (it has: ", words(names(formals(ww_study))), ")")
  if (!is.null(data)) study["data"] <- list(data)
  if (!is.null(units)) study["units"] <- list(units)
  if (is.null(study$formula)) stop_input("study has no 'formula'")
  if (is.null(study$data)) stop_input("study has no 'data'")
  do.call(ww_study, study, quote = TRUE)
}
