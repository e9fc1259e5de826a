#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/fleet/engine.h"

namespace wearwell::fleet {

/// DuckDB within the program, over files of cycles (Parquet, CSV). Data that do not fit into memory
/// go to a temporary folder, which is removed at the end.
struct DuckdbSettings {
  std::vector<std::string> files;  ///< names, or shell patterns: "cycles/*.parquet"
  std::string unit = {};  ///< the column that names units: text in CSV, whatever it looks like
  std::filesystem::path state = {};  ///< a database that stores sums; empty: none
  std::filesystem::path spill = {};  ///< parent of the temporary folder
  int threads = 0;                   ///< 0: all
  long memory = 0;                   ///< MB; 0: half of the machine's
  bool skip_bad = false;  ///< cells of CSV that are not numbers are missing values, not errors
  /// whether to report progress of statements, which costs a little time
  bool progress = false;
};

/// The files are the table `cycles`; nothing else can be read or written. Throws InputError if a
/// pattern matches no file, or files have different columns.
std::unique_ptr<Engine> duckdb_engine(const DuckdbSettings& settings);

}  // namespace wearwell::fleet
