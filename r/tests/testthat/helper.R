# The project around the package: R CMD check of the package alone has none, and skips what needs it.
source_of_project <- function() {
  source <- Sys.getenv("WEARWELL_SOURCE")
  skip_if(source == "", "WEARWELL_SOURCE names no project")
  source
}

example <- function(...) file.path(source_of_project(), "examples", ...)

# Runs the program; gives exit code, standard output and standard error.
program <- function(...) {
  binary <- Sys.getenv("WEARWELL_BINARY")
  skip_if(binary == "", "WEARWELL_BINARY names no program")
  out <- tempfile()
  error <- tempfile()
  code <- system2(binary, vapply(c(...), shQuote, ""), stdout = out, stderr = error)
  text <- function(file) paste0(paste(readLines(file, encoding = "UTF-8"), collapse = "\n"), "\n")
  list(code = code, out = text(out), error = text(error))
}

quiet <- function(code) withCallingHandlers(code, wearwell_check_warning = function(w) invokeRestart("muffleWarning"))

# Six joints, each worn at its own rate: the numbers of docs/reference/r.md.
joints <- function() {
  rates <- 1e-7 * c(0.83, 1.06, 0.78, 1.61, 1.10, 0.78)
  frame <- expand.grid(pair = 1:3, joint = paste0("J", 1:6), stringsAsFactors = FALSE)
  frame$F <- c(100, 200, 300)[frame$pair]
  frame$s <- c(3e4, 4e4, 5e4)[frame$pair]
  frame$V <- rates[match(frame$joint, paste0("J", 1:6))] * frame$F * frame$s + rep(c(0.05, -0.08, 0.03, 0.11, -0.04, 0.02), 3)
  frame[c("joint", "F", "s", "V")]
}

of_a_formula <- function(data = joints(), ..., units = c(F = "N", s = "m", V = "mm^3")) {
  ww_study(formula = "V = k*F*s", data = data, units = units,
           priors = list(k = ww_lognormal("1e-7 mm^3/(N m)", log_sd = 3), sigma = ww_half_normal("5 mm^3")), ...)
}

# Texts of numbers to their last bit; R's own reader may be off by one.
exactly <- function(texts) wearwell:::core(wearwell:::C_keys, paste0("x = [", paste(texts, collapse = ", "), "]"))$x

refused <- function(code, message) expect_error(code, message, fixed = TRUE, class = "wearwell_input_error")
