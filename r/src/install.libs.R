# Run by R CMD INSTALL: what the build holds for R goes into libs/, and DuckDB into duckdb/ beside it. WEARWELL_BUILD names the build, as tools/module does.
build <- Sys.getenv("WEARWELL_BUILD", readLines("build.txt"))
libs <- file.path(R_PACKAGE_DIR, paste0("libs", R_ARCH))
dir.create(libs, recursive = TRUE, showWarnings = FALSE)
status <- system2("cmake", c("--install", shQuote(build), "--component", "r", "--prefix", shQuote(libs)), stdout = FALSE)
if (status != 0) stop("cmake --install ", build, " ends with ", status)

# What R's own linking leaves for R CMD check: the symbols of the module's objects, of which some (exit, stdout) are not for R.
if (isTRUE(as.logical(Sys.getenv("_R_SHLIB_BUILD_OBJECTS_SYMBOL_TABLES_", "FALSE")))) {
  objects <- list.files(file.path(build, "r", "CMakeFiles", "wearwell_r.dir"), "[.]o$", recursive = TRUE, full.names = TRUE)
  if (!length(objects)) stop("no objects of wearwell_r in ", build)
  saveRDS(stats::setNames(lapply(objects, tools:::read_symbols_from_object_file), basename(objects)), file.path(libs, "symbols.rds"), version = 2)
}
