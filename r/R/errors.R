# Conditions: the words are those of the command line, with arguments in place of its options.

condition <- function(message, ...) structure(class = c(..., "condition"), list(message = message, call = NULL))

stop_input <- function(...) stop(condition(paste0(...), "wearwell_input_error", "wearwell_error", "error"))

# A message, a check's advice or a report in text, with arguments and functions in place of options and commands. What
# stands in quotes is the user's text.
in_arguments <- function(text) {
  if (!any(grepl("--|-o |wearwell ", text))) return(text)
  text <- gsub("fitted with --no-report", "fitted with report = FALSE", text, fixed = TRUE)
  text <- gsub("-o writes all to tables/([\\w-]+)\\.csv", "tables[[\"\\1\"]] has all", text, perl = TRUE)
  text <- gsub("with --rows here,\\s+or in", "in", text, perl = TRUE)
  text <- gsub("\\bwearwell update \\S+ TESTS -o NEW", "ww_update(fit, tests)", text, perl = TRUE)
  text <- gsub("wearwell decide --inspect-after", "ww_decide(inspect_after = ...)", text, fixed = TRUE)
  others <- !grepl("for the command line", text, fixed = TRUE)
  text[others] <- gsub("`?\\bwearwell plan (next|size|inspect|demonstrate|accelerate)\\b`?(?! -)", "ww_plan_\\1", text[others], perl = TRUE)
  text[others] <- gsub("`?\\bwearwell (decide|update)\\b`?(?! -)", "ww_\\1", text[others], perl = TRUE)
  # Options whose values are few; the blank of a wrapped line is kept, the line breaks there.
  few <- "(?<![\\w-])--(method|repeated)%s(exact|nuts|metropolis|once|another)(?![\\w-])"
  text <- gsub(sprintf(few, " "), "\\1 = \"\\2\"", text, perl = TRUE)
  text <- gsub(paste0(" ?", sprintf(few, "(\\s+)")), "\\2\\1 = \"\\3\"", text, perl = TRUE)
  text <- gsub("(?:^|(?<=[\\s(]))--b-lives(?![\\w=-])", "b", text, perl = TRUE)
  option <- "(?:^|(?<=[\\s(]))--([a-z][a-z-]*[a-z])(?![\\w=-])"
  found <- gregexpr(option, text, perl = TRUE)
  regmatches(text, found) <- lapply(regmatches(text, found), function(each) gsub("-", "_", substring(each, 3), fixed = TRUE))
  text
}

# Calls the library. What it refuses comes as a value, and is raised here, where nothing of C++ stands on the stack.
core <- function(door, ...) {
  found <- .Call(door, ...)
  if (inherits(found, "wearwell_failure"))
    stop(condition(in_arguments(found[2]), paste0("wearwell_", found[1], "_error"), "wearwell_error", "error"))
  found
}

warn <- function(message) warning(condition(in_arguments(message), "wearwell_check_warning", "warning"))

reason <- function(check) trimws(paste0(check$name, ": ", check$detail, ". ", check$advice), "right")

warn_of <- function(checks) {
  for (i in which(checks$verdict != "pass")) {
    check <- checks[i, ]
    check$name <- paste(check$name, if (check$verdict == "warn") "warns" else "fails")
    warn(reason(check))
  }
}

words <- function(x) paste(x, collapse = ", ")

# What a value is called in messages.
kind_of <- function(x) if (is.object(x)) class(x)[1] else if (is.matrix(x)) "matrix" else typeof(x)

shown_value <- function(x) {
  text <- paste(deparse(x), collapse = " ")
  if (nchar(text) > 60) paste0(substr(text, 1, 57), "...") else text
}

one_text <- function(x, what) {
  if (!is.character(x) || length(x) != 1 || is.na(x)) stop_input(what, " is ", shown_value(x), "; it is one text")
  enc2utf8(x)
}

# A path, as the library takes it.
path_of <- function(path, what = "path") path.expand(one_text(path, what))

whole <- function(x, what, least, most) {
  if (is.null(x)) return(NULL)
  fine <- is.numeric(x) && !is.object(x) && length(x) == 1 && !is.na(x) && x == floor(x) && x >= least && x <= most
  if (!fine) {
    stop_input(what, " is ", shown_value(x), "; it is a whole number from ", least, " to ", format(most, scientific = FALSE))
  }
  as.integer(x)
}

most_seed <- "18446744073709551615"

# A seed has 64 bits, of which R's numbers hold 53: a text holds all.
seed_text <- function(seed) {
  if (is.null(seed)) return("")
  text <- if (is.character(seed)) seed else if (is.numeric(seed) && length(seed) == 1 && !is.object(seed) && isTRUE(abs(seed) <= 2^53))
    format(seed, digits = 17, scientific = FALSE)
  if (length(text) == 1 && grepl("^[0-9]+$", text)) {
    text <- sub("^0+(?=.)", "", text, perl = TRUE)
    if (nchar(text) < 20 || (nchar(text) == 20 && text <= most_seed)) return(text)
  }
  stop_input("seed is ", shown_value(seed), "; it is a whole number from 0 to ", most_seed, ", beyond 2^53 as a text")
}
