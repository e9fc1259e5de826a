# Run by R CMD INSTALL: what the build holds for R goes into libs/, and DuckDB into duckdb/ beside it. WEARWELL_BUILD names the build, as tools/module does.
build <- Sys.getenv("WEARWELL_BUILD", readLines("build.txt"))
libs <- file.path(R_PACKAGE_DIR, paste0("libs", R_ARCH))
dir.create(libs, recursive = TRUE, showWarnings = FALSE)
status <- system2("cmake", c("--install", shQuote(build), "--component", "r", "--prefix", shQuote(libs)), stdout = FALSE)
if (status != 0) stop("cmake --install ", build, " ends with ", status)
