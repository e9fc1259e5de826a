# Tables as the library takes them: data frames, named lists of columns, paths of files.

# A vector of doubles or of texts; NA is an empty cell, refused with row and column where a value is needed.
column_values <- function(column, where) {
  if (length(dim(column)) > 1) stop_input(where, " has ", length(dim(column)), " dimensions; a column has one")
  if (is.factor(column)) column <- as.character(column)
  class <- setdiff(oldClass(column), c("AsIs", "units"))
  if (inherits(column, "difftime")) stop_input(where, " holds durations (", class[1], "); as.double(..., units = \"hours\") makes numbers of them")
  if (inherits(column, c("Date", "POSIXt"))) {
    stop_input(where, " holds dates or times (", class[1], "); give a number with a unit, like hours since the start")
  }
  # as.double() alone does not know it: its bits would be read as another number.
  if (inherits(column, "integer64")) stop_input(where, " is of class integer64; bit64::as.double.integer64() makes numbers")
  if (length(class)) {
    stop_input(where, " is of class ", class[1], "; a column is numeric, integer, logical, character or a factor (as.double() ",
               "makes numbers)")
  }
  switch(typeof(column),
    double = , integer = , logical = as.double(column),
    character = {
      column <- enc2utf8(as.character(column))
      wrong <- which(!is.na(column) & !validUTF8(column))
      if (length(wrong)) stop_input(sub(", column", paste0(", row ", wrong[1], ", column"), where), ": the text is not Unicode")
      column
    },
    complex = stop_input(where, " holds complex numbers"),
    list = {
      row <- which(lengths(column) != 1)[1]
      stop_input(where, " is a list", if (!is.na(row)) paste0(" (row ", row, " has ", lengths(column)[row], " elements)"),
                 "; a column has one number or text a row (unlist() may make one)")
    },
    stop_input(where, " is ", typeof(column), "; a column is numeric, integer, logical, character or a factor"))
}

require_headings <- function(headings, name) {
  unnamed <- which(is.na(headings) | headings == "")
  if (length(unnamed)) stop_input(name, ": column ", unnamed[1], " has no name")
  twice <- headings[duplicated(headings)]
  if (length(twice)) stop_input(name, ": two columns are called '", twice[1], "'")
}

is_path <- function(x) is.character(x) && length(x) == 1 && is.null(names(x))

require_columns <- function(data, name) {
  if (is.matrix(data)) stop_input(name, " is a matrix; as.data.frame() makes columns of it")
  if (!is.list(data) || (is.object(data) && !is.data.frame(data))) {
    stop_input(name, " is ", kind_of(data), "; it may be a data frame, a named list of columns, or the path of a file")
  }
  if (length(data) && is.null(names(data))) stop_input(name, ": the columns have no names")
  require_headings(names(data), name)
}

# The library's table. `units`: by heading; `only`: headings that are taken of data in memory.
table_of <- function(data, name = "data", units = NULL, only = NULL) {
  units <- unit_texts(units, "units")
  if (is_path(data)) return(core(C_table_of_file, path_of(data), as.character(names(units)), as.character(units)))
  require_columns(data, name)
  headings <- names(data)
  unknown <- setdiff(names(units), headings)
  if (length(unknown)) stop_input("units: ", name, " has no column '", unknown[1], "' (columns: ", words(headings), ")")
  taken <- if (is.null(only)) headings else headings[headings %in% only]
  each_unit <- vapply(taken, function(heading) {
    if (heading %in% names(units)) units[[heading]] else if (inherits(data[[heading]], "units")) units_of(data[[heading]]) else ""
  }, "")
  values <- lapply(taken, function(heading) column_values(.subset2(data, heading), paste0(name, ", column '", heading, "'")))
  core(C_table_of, name, enc2utf8(taken), enc2utf8(as.character(each_unit)), values)
}

# Names of the columns.
headings_of <- function(data, table) if (is_path(data)) core(C_headings, table) else names(data)

unit_texts <- function(units, what) {
  if (is.null(units) || length(units) == 0) return(character())
  if (is.null(names(units)) || any(names(units) == "")) stop_input(what, " has no names; it is like c(F = \"N\", s = \"m\")")
  vapply(names(units), function(name) one_text(units[[name]], paste0(what, "['", name, "']")), "")
}
