#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell::recurrence {

/// Whether a word of the event column is a failure, else an end of observation; empty if it is neither.
/// `failure_code`: what a failure is among 0 and 1, if that is known.
std::optional<bool> is_failure_word(const std::string& word, std::optional<int> failure_code);

/// What the cells of the event column mean.
struct EventWords {
  std::string column;
  std::optional<int> failure_code = {};
  std::vector<std::string> failures = {}, ends = {};  ///< the study's own words, folded
};

/// By data.columns.event; throws InputError if it is missing.
EventWords read_event_words(const TomlReader& columns, const Table& table);
/// Whether the row is a failure, else an end of observation. Throws InputError that names the cell.
bool read_event(const Table& table, const EventWords& words, std::size_t row);

}  // namespace wearwell::recurrence
