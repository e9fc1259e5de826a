#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/base/monitor.h"
#include "wearwell/fleet/engine.h"
#include "wearwell/present/result_folder.h"
#include "wearwell/study/result.h"

namespace wearwell {

/// The options of wearwell fleet. Some are for clutches alone, some for lives alone.
struct FleetOptions {
  std::filesystem::path result, output = "fleet-results", state;
  std::vector<std::string> engines = {"duckdb"}, files, columns;
  std::string table, prefix = "wearwell", point;
  std::vector<std::string> horizons;
  std::vector<double> levels = {25, 50, 75, 100}, days;
  int threads = 0;
  long memory = 0;
  bool scatter_only = false, statements = false, read_only = false, skip_bad = false, json = false,
       quiet = false, in_study = false;
  std::vector<std::string> given = {};  ///< the options that the user wrote: "--level"

  bool has(const std::string& option) const;
};

/// The databases, or DuckDB over the files; `unit` is the column that names units, `spill` the folder of DuckDB's temporary
/// files. Throws InputError.
std::vector<std::unique_ptr<fleet::Engine>> engines_of(const FleetOptions& options,
                                                       const std::string& unit,
                                                       const std::filesystem::path& spill);

/// Runs `find` with a line of progress, writes its result and prints it; returns the exit code.
int show_fleet(const FleetOptions& options, ResultFolder& folder,
               const std::function<Result(const Monitor& monitor)>& find);

}  // namespace wearwell
