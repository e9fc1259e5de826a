#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/models/fatigue/load_history.h"
#include "wearwell/present/section.h"

namespace wearwell::fatigue {

/// A counted history with what is needed to speak of it.
struct HistoryReport {
  std::string source, column, unit;  ///< unit: empty where nobody said
  CountingRule rule;
  LoadHistory::Counted counted;
  std::size_t most_ranges = 32;   ///< classes of range that are shown
  std::string unread_times = {};  ///< a column of times in which nobody asked for gaps
};

/// Counted cycles by range and mean, every class that holds any.
present::Table cycles_table(const HistoryReport& report);
/// The same in the wider classes that are shown: from-to of range and mean.
present::Table matrix_table(const HistoryReport& report);
/// Cycles by range, and how many have at least that.
present::Table spectrum_table(const HistoryReport& report);
present::Table levels_table(const HistoryReport& report);

/// How it was counted, in a sentence.
std::string counted_text(const HistoryReport& report);

std::string history_text(const HistoryReport& report);
std::vector<present::Section> history_sections(const HistoryReport& report);
nlohmann::ordered_json history_json(const HistoryReport& report);

/// The table as a Parquet file; its columns are numbers.
std::string parquet(const present::Table& table);

}  // namespace wearwell::fatigue
