# Conditions: the words are those of the command line.

condition <- function(message, ...) structure(class = c(..., "condition"), list(message = message, call = NULL))

stop_input <- function(...) stop(condition(paste0(...), "wearwell_input_error", "wearwell_error", "error"))

# Calls the library. What it refuses comes as a value, and is raised here, where nothing of C++ stands on the stack.
core <- function(door, ...) {
  found <- .Call(door, ...)
  if (inherits(found, "wearwell_failure"))
    stop(condition(found[2], paste0("wearwell_", found[1], "_error"), "wearwell_error", "error"))
  found
}

warn <- function(message) warning(condition(message, "wearwell_check_warning", "warning"))

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
