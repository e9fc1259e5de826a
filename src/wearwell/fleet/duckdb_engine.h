#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/fleet/engine.h"

namespace wearwell::fleet {

/// DuckDB within the program, over files of cycles (Parquet, CSV). What does not fit into memory goes
/// to a folder of its own, which is gone at the end.
struct DuckdbSettings {
  std::vector<std::string> files;  ///< names, or patterns as of a shell: "cycles/*.parquet"
  std::string unit = {};  ///< the column that names units: words in CSV, whatever they look like
  std::filesystem::path state = {};  ///< a database that keeps sums; empty: none
  std::filesystem::path spill = {};  ///< a folder where that one is made
  int threads = 0;                   ///< 0: all
  long memory = 0;                   ///< MB; 0: half of the machine's
  bool progress = false;             ///< of statements, which costs a little
};

/// The files are the table `cycles`; nothing else can be read or written. Throws InputError where a pattern
/// meets no file, or files have different columns.
std::unique_ptr<Engine> duckdb_engine(const DuckdbSettings& settings);

}  // namespace wearwell::fleet
