#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/models/fatigue/load_history.h"
#include "wearwell/present/section.h"

namespace wearwell::fatigue {

/// A counted history with what is needed to describe it.
struct HistoryReport {
  std::string source, column, unit;  ///< unit: empty if unknown
  CountingRule rule;
  LoadHistory::Counted counted;
  std::size_t most_ranges = 32;   ///< displayed classes of range
  std::string unread_times = {};  ///< a column of times that was not checked for gaps
};

/// Counted cycles by range and mean, every nonempty class.
present::Table cycles_table(const HistoryReport& report);
/// The same in the wider displayed classes: from-to of range and mean.
present::Table matrix_table(const HistoryReport& report);
/// Cycles by range, and the number with at least that range.
present::Table spectrum_table(const HistoryReport& report);
present::Table levels_table(const HistoryReport& report);

/// A sentence on the counting.
std::string counted_text(const HistoryReport& report);

std::string history_text(const HistoryReport& report);
std::vector<present::Section> history_sections(const HistoryReport& report);
nlohmann::ordered_json history_json(const HistoryReport& report);

/// The table as a Parquet file; its columns are numeric.
std::string parquet(const present::Table& table);

}  // namespace wearwell::fatigue
