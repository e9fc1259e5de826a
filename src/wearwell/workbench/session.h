#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/study/model.h"
#include "wearwell/study/wide_table.h"

namespace wearwell::workbench {

/// A table of the folder, as it was read.
struct OpenTable {
  std::string file;
  std::map<std::string, std::string> settings = {};  ///< keys of [data]: "sheet"
  Table table = {};
  std::optional<WideTable> wide = {};  ///< then `table` is what its SELECT makes,
  Table as_stored = {};                ///< and this is the table before it
  std::uint64_t number = 0;            ///< of its reading: a request names the one it means
  std::string stamp = {};              ///< `stamp_of` its file, from before the reading
  nlohmann::ordered_json shown = {};   ///< its `table_json`, and the first lines of its file
};

enum class ReadState { none, running, done, sheets, failed, stopped };

/// The latest reading of a table. A later one replaces it.
struct ReadProgress {
  ReadState state = ReadState::none;
  std::string file;
  std::uint64_t number = 0;
  std::chrono::steady_clock::time_point begin = {};
  std::vector<std::string> sheets = {};  ///< of a workbook, to choose from
  std::string problem = {};              ///< why it failed
};

enum class FitState { none, running, done, failed, stopped };

/// The latest run of a study.
struct FitProgress {
  FitState state = FitState::none;
  std::string study, result;      ///< the file, and the folder of its result
  std::uint64_t run = 0;          ///< its number
  std::uint64_t written = 0;      ///< the number of the latest run that wrote a result
  std::string what = {};          ///< the steps: "iterations"
  long long done = 0, total = 0;  ///< of them; a total of 0 is unknown
  double seconds = 0;             ///< since the start
  std::string problem = {};       ///< why it failed
};

/// What one `wearwell open` works on. Everything that lasts is a file in `folder`.
struct Session {
  Session(std::filesystem::path of, Models known) : folder(std::move(of)), models(known) {}

  const std::filesystem::path folder;
  const Models models;
  /// How long a request waits for a table; then the answer is that it is being read. The page
  /// answers within 100 ms.
  std::chrono::milliseconds patience{50};

  /// Held from the comparison of a file to its writing. Taken before `mutex`.
  std::mutex writing;
  std::mutex mutex;            ///< guards the members below
  std::uint64_t version = 1;   ///< increases with each change of them
  std::uint64_t readings = 0;  ///< begun so far
  std::shared_ptr<const OpenTable> table = {};
  std::string workbook = {};               ///< the file whose sheet is still to be chosen; "" none
  std::string study = {}, result = {};     ///< open: a file, a folder; "" none
  std::vector<std::string> compared = {};  ///< results that were compared last
  FitProgress fit = {};
  ReadProgress read = {};
  std::condition_variable read_ended = {};
  // Last, so that they end first.
  std::jthread fitting = {};
  std::jthread reading = {};
};

}  // namespace wearwell::workbench
