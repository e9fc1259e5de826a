# Help pages: every exported function has its usage, each argument, what it returns, and examples that run (R CMD check runs them).

pages <- function() {
  folder <- file.path(source_of_project(), "r", "man")
  files <- list.files(folder, pattern = "[.]Rd$", full.names = TRUE)
  stats::setNames(lapply(files, tools::parse_Rd), basename(files))
}

tags_of <- function(rd) vapply(rd, function(each) attr(each, "Rd_tag"), "")

texts_of <- function(rd, tag) vapply(rd[tags_of(rd) == tag], function(each) paste(unlist(each), collapse = ""), "")

# Names in \item{...} of \arguments; \dots stands for ... .
arguments_of <- function(rd) {
  items <- unlist(lapply(rd[tags_of(rd) == "\\arguments"], function(each) each[tags_of(each) == "\\item"]), recursive = FALSE)
  names <- unlist(lapply(items, function(item) strsplit(paste(unlist(item[[1]]), collapse = ""), ",", fixed = TRUE)[[1]]))
  sub("\\dots", "...", trimws(names), fixed = TRUE)
}

test_that("every exported function has a page, and each of its arguments a line", {
  all <- pages()
  aliases <- lapply(all, texts_of, "\\alias")
  exported <- getNamespaceExports("wearwell")
  expect_setequal(setdiff(exported, unlist(aliases)), character())
  for (name in exported) {
    page <- all[[which(vapply(aliases, function(each) name %in% each, NA))]]
    missing <- setdiff(as.character(names(formals(get(name, asNamespace("wearwell"))))), arguments_of(page))
    expect_identical(missing, character(), info = name)
    expect_match(paste(texts_of(page, "\\usage"), collapse = ""), paste0(name, "("), fixed = TRUE, info = name)
  }
})

test_that("every page says what it returns, and all of its examples run", {
  for (name in names(all <- pages())) {
    expect_true(all(c("\\title", "\\description", "\\usage", "\\arguments", "\\value", "\\examples") %in% tags_of(all[[name]])), info = name)
    examples <- all[[name]][[which(tags_of(all[[name]]) == "\\examples")]]
    expect_false(any(c("\\dontrun", "\\donttest") %in% tags_of(examples)), info = name)
  }
})

test_that("pages stand alone: they point to no file of the project's documents", {
  files <- list.files(file.path(source_of_project(), "r", "man"), full.names = TRUE)
  for (file in files) expect_false(any(grepl("docs/|[.]md\\b", readLines(file))), info = basename(file))
})
