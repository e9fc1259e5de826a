# Study files as text.

# A number or a text like "5 mm^3", as a study file writes it; an object of the package units is both.
quantity <- function(value, what) {
  if (inherits(value, "units") && length(value) == 1) return(paste(number_text(as.double(value)), units_of(value)))
  if (is.character(value) && length(value) == 1 && !is.na(value)) return(enc2utf8(value))
  if (is.numeric(value) && !is.object(value) && length(value) == 1 && !is.na(value)) return(as.double(value))
  stop_input(what, " is ", shown_value(value), "; it is a number or a text with a unit, like '5 mm^3'")
}

# The unit of an object of the package units: "mm^3/(N m)".
units_of <- function(x) {
  unit <- attr(x, "units")
  above <- paste(unit$numerator, collapse = " ")
  below <- paste(unit$denominator, collapse = " ")
  if (above == "") above <- "1"
  if (below == "") above else paste0(above, "/(", below, ")")
}

number_text <- function(x) {
  x <- as.double(x)
  text <- character(length(x))
  plain <- is.finite(x) & x == trunc(x) & abs(x) < 2^53
  text[plain] <- sprintf("%.0f", x[plain])
  rest <- is.finite(x) & !plain
  text[rest] <- core(C_written, x[rest])
  text[is.nan(x) | is.na(x)] <- "nan"
  text[is.infinite(x)] <- ifelse(x[is.infinite(x)] > 0, "inf", "-inf")
  text
}

# JSON's strings are TOML's, but for DEL, which must be escaped here.
quoted <- function(x) gsub("\x7f", "\\u007F", core(C_written, enc2utf8(x)), fixed = TRUE)

toml_key <- function(name) if (grepl("^[A-Za-z0-9_-]+$", name)) name else quoted(name)

# One value in one line. What has names is a table, what has one element is itself; list(x) and I(x) are arrays always.
toml_value <- function(item, what) {
  if (is.factor(item)) item <- as.character(item)
  if (inherits(item, "units")) item <- vapply(seq_along(item), function(i) quantity(item[i], what), "")
  names <- names(item)
  if (!is.null(names) && (is.list(item) || is.atomic(item))) {
    inside <- vapply(names, function(key) paste(toml_key(key), "=", toml_value(item[[key]], paste0(what, ".", key))), "")
    return(if (length(inside)) paste0("{ ", paste(inside, collapse = ", "), " }") else "{}")
  }
  known <- is.list(item) || is.character(item) || is.logical(item) || (is.numeric(item) && (!is.object(item) || inherits(item, "AsIs")))
  if (!known || (is.object(item) && !inherits(item, "AsIs")))
    stop_input(what, " is ", kind_of(item), "; a study holds texts, numbers, truths, and lists of them")
  if (is.list(item)) {
    each <- vapply(item, toml_value, "", what)
  } else {
    if (anyNA(item) && !is.numeric(item)) stop_input(what, " holds NA")
    each <- if (is.character(item)) quoted(unclass(item)) else if (is.logical(item)) ifelse(item, "true", "false") else
      number_text(unclass(item))
    if (length(item) == 1 && !inherits(item, "AsIs")) return(each)
  }
  paste0("[", paste(each, collapse = ", "), "]")
}

# A table with its keys, one a line. `comments`: by key.
toml_table <- function(name, entries, comments = NULL) {
  lines <- vapply(names(entries), function(key) {
    line <- paste(toml_key(key), "=", toml_value(entries[[key]], if (name == "") key else paste0(name, ".", key)))
    if (key %in% names(comments)) paste0(line, "  # ", comments[[key]]) else line
  }, "")
  paste0(paste(c(if (name != "") paste0("[", name, "]"), lines), collapse = "\n"), "\n")
}

# A study without the table of this name and those below it.
without_table <- function(text, name) {
  lines <- strsplit(text, "\n", fixed = TRUE)[[1]]
  header <- regmatches(lines, regexec("^\\s*\\[+\\s*([A-Za-z0-9_-]+)[^=]*\\]\\s*(#.*)?$", lines))
  inside <- FALSE
  keep <- logical(length(lines))
  for (i in seq_along(lines)) {
    if (length(header[[i]])) inside <- header[[i]][2] == name
    keep[i] <- !inside
  }
  paste(lines[keep], collapse = "\n")
}
