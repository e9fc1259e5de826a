# Selections, comparisons, and what needs no posterior.

texts <- function(x, what) {
  if (is.null(x)) return(character())
  if (!is.character(x) || anyNA(x)) stop_input(what, " is ", kind_of(x), "; it holds texts")
  enc2utf8(x)
}

one_number <- function(x, what) {
  if (!is.numeric(x) || is.object(x) || length(x) != 1 || is.na(x)) stop_input(what, " is ", shown_value(x), "; it is a number")
  as.double(x)
}

ww_select <- function(data, response, inputs = character(), degree = NULL, terms = character(), criterion = "loo", keep = 10,
                      near = 0, force = character(), weights = "", folds = 0, nested = NULL, seed = 1, time = NULL, threads = 0,
                      report = FALSE) {
  most <- .Machine$integer.max
  asked <- list(response = one_text(response, "response"), inputs = texts(inputs, "inputs"), degree = whole(degree, "degree", 0, 100),
                terms = texts(terms, "terms"), weights = one_text(weights, "weights"), force = texts(force, "force"))
  how <- list(criterion = one_text(criterion, "criterion"), keep = whole(keep, "keep", 0, most), near = one_number(near, "near"),
              folds = whole(folds, "folds", 0, most), nested = if (is.null(nested)) -1L else whole(nested, "nested", 0, most),
              seed = seed_text(seed), time = one_number(if (is.null(time)) Inf else time, "time"), threads = whole(threads, "threads", 0, 1024),
              report = one_truth(report, "report"))
  if (is_path(data)) {
    source <- path_of(data)
  } else {
    require_columns(data, "data")
    used <- unlist(c(asked[c("response", "weights", "inputs", "terms")], strsplit(asked$terms, "*", fixed = TRUE)))
    only <- intersect(names(data), trimws(used))
    source <- table_of(data, only = if (length(only)) only)
  }
  found <- core(C_select, source, asked, how, NULL)
  checks <- checks_of(found$summary)
  warn_of(checks)
  structure(class = "ww_selection", list(
    summary = found$summary, trusted = found$summary$trusted, checks = checks,
    models = read.csv(text = found$models, check.names = FALSE), text = in_arguments(found$text), page = found$page))
}

print.ww_selection <- function(x, ...) {
  cat_verdict(x)
  cat("\n", x$text, sep = "")
  invisible(x)
}

ww_compare <- function(..., names = NULL, families = NULL, threads = 0, progress = interactive()) {
  found <- if (!is.null(families)) {
    compared_families(list(...), names, families, whole(threads, "threads", 0, 1024), progress)
  } else with_folders(list(...), names, "a comparison", function(folders) {
    if (length(folders) < 2) stop_input("a comparison takes two fits at least")
    core(C_compared, folders)
  })
  found$text <- in_arguments(found$text)
  structure(class = "ww_comparison", found)
}

# One study of a life, fitted with each family.
compared_families <- function(given, names, families, threads, progress) {
  if (!is.null(names)) stop_input("names: families have their own names; leave names out")
  if (length(given) != 1) stop_input("families ranks distributions of one study, but ", length(given), " are given")
  if (!is.character(families) || !length(families) || anyNA(families)) {
    stop_input("families is ", shown_value(families), "; it is like c(\"weibull\", \"lognormal\"), or \"all\"")
  }
  study <- given[[1]]
  if (inherits(study, "ww_fit")) study <- study$study
  if (is_path(study) && !grepl("[.]toml$", study)) stop_input("families needs a study, FILE.toml, or a fit, but got '", study, "'")
  if (!is_path(study) && !inherits(study, "ww_study")) {
    stop_input("families needs a fit of a life, a study or the path of a study file, not ", kind_of(study), "; of a data frame: ww_life()")
  }
  address <- study_address(as_study(study))
  found <- tryCatch(with_progress(progress, function(report) core(C_compared_families, address, paste(families, collapse = ","), threads, report)),
                    wearwell_input_error = function(error) stop_input(in_words_of_caller(conditionMessage(error))))
  ranked <- found$summary$studies
  found$close <- found$summary$close
  found$lives <- do.call(rbind, lapply(ranked, function(each) {
    lives <- each$b_lives
    text <- function(key) column(lives, key, "")
    cbind(data.frame(family = rep(each$study, length(lives)), name = text("name"), of = text("of"), at = text("at"), unit = text("unit")),
          numbers_of(lives, c("q05", "q50", "q95")))
  }))
  for (each in ranked[!column(ranked, "trusted", NA)]) {
    warn(paste0(each$study, ": the fit is not trusted; fit the life with this family to see its checks"))
  }
  found
}

# Calls `work` with the folders of fits or of results, by name. `of`: what takes them, in messages.
with_folders <- function(fits, names, of, work) {
  if (is.null(names)) names <- names(fits)
  if (!is.null(names) && length(names) != length(fits)) stop_input(length(names), " names are given for ", length(fits), " fits")
  parent <- tempfile("wearwell")
  dir.create(parent)
  on.exit(unlink(parent, recursive = TRUE))
  folders <- vapply(seq_along(fits), function(i) {
    each <- fits[[i]]
    if (is_path(each)) return(path_of(each))
    if (!inherits(each, "ww_fit")) stop_input(of, " takes fits or folders of results, not ", kind_of(each))
    folder <- file.path(parent, i)
    core(C_write_folder, folder, files_of(each))
    folder
  }, "")
  usual <- as.character(ifelse(vapply(fits, is_path, NA), folders, c(letters, seq_along(fits)[-(1:26)])[seq_along(fits)]))
  if (is.null(names)) names <- usual
  names[names == ""] <- usual[names == ""]
  work(stats::setNames(folders, enc2utf8(names)))
}

print.ww_comparison <- function(x, ...) {
  cat(x$text)
  invisible(x)
}

ww_rainflow <- function(signal, method = c("four-point", "three-point"), residual = c("half", "repeat")) {
  if (missing(method)) method <- method[1]
  if (missing(residual)) residual <- residual[1]
  if (!isTRUE(method %in% c("four-point", "three-point"))) {
    stop_input("method is ", shown_value(method), "; it is 'four-point' or 'three-point'")
  }
  if (!isTRUE(residual %in% c("half", "repeat"))) stop_input("residual is ", shown_value(residual), "; it is 'half' or 'repeat'")
  values <- column_values(signal, "signal")
  if (!is.double(values)) stop_input("signal holds no numbers")
  cycles <- core(C_rainflow, values, method == "three-point", residual == "repeat")
  data.frame(from = cycles$from, to = cycles$to, range = abs(cycles$to - cycles$from), mean = (cycles$from + cycles$to) / 2,
             count = cycles$count)
}

bearing <- function(command, contact, inputs, unit, limit, draws, seed) {
  inputs <- inputs[!vapply(inputs, is.null, NA)]
  if (length(inputs) && (is.null(names(inputs)) || any(names(inputs) == ""))) {
    stop_input("inputs have names, like radius = \"10 mm\"")
  }
  written <- vapply(names(inputs), function(name) as.character(quantity(inputs[[name]], name)), "")
  names(written) <- gsub("_", "-", names(inputs))
  text <- function(x, what) if (is.null(x)) "" else as.character(quantity(x, what))
  found <- core(C_bearing, command, one_text(contact, "contact"), written, text(unit, "unit"), text(limit, "limit"),
                whole(draws, "draws", 100, 1e7), seed_text(seed))
  for (each in found$warnings) warn(each)
  if (nzchar(found$margin)) found$answer$margin <- found$margin
  found$answer
}

ww_bearing_rate <- function(contact, ..., unit = NULL, draws = 100000, seed = 1) {
  bearing("rate", contact, list(...), unit, NULL, draws, seed)
}

ww_bearing_depth <- function(contact, ..., unit = NULL, limit = NULL, draws = 100000, seed = 1) {
  bearing("depth", contact, list(...), unit, limit, draws, seed)
}

ww_bearing_pressure <- function(contact, ..., unit = NULL, draws = 100000, seed = 1) {
  bearing("pressure", contact, list(...), unit, NULL, draws, seed)
}

ww_bearing_length <- function(contact, ..., unit = NULL, draws = 100000, seed = 1) {
  bearing("length", contact, list(...), unit, NULL, draws, seed)
}

ww_bearing_life <- function(contact, ..., unit = NULL, draws = 100000, seed = 1) {
  bearing("life", contact, list(...), unit, NULL, draws, seed)
}

ww_clutch_cycles <- function(model, cycles, units = NULL, scatter_only = FALSE, skip_not_finite = FALSE) {
  sum <- core(C_plate_cycles, path_of(model, "model"), one_truth(scatter_only, "scatter_only"),
              one_truth(skip_not_finite, "skip_not_finite"))
  one <- is_path(cycles) || is.data.frame(cycles) || !is.list(cycles) || !is.null(names(cycles))
  for (each in if (one) list(cycles) else cycles) {
    if (is_path(each)) core(C_add_cycles_of_file, sum, path_of(each)) else core(C_add_cycles, sum, table_of(each, "cycles", units))
  }
  found <- core(C_worn, sum)
  keys <- setdiff(unique(unlist(lapply(found$plates, names))), c("plate", "outside"))
  plates <- numbers_of(found$plates, keys)
  plates <- cbind(plate = vapply(found$plates, function(plate) as.character(plate$plate), ""), plates)
  list(plates = plates, summary = found)
}
