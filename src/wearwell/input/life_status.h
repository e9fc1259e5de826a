#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/prob/response.h"

namespace wearwell {

/// The column of [data.columns] that says how life tests ended: status = "HEADING", or
/// { column = "HEADING", failure = 1 }, or with words of the table, { column = "HEADING", failure =
/// "broke", runout = ["ran", "stopped"] }. Words say it themselves (status_words.h); of codes two sets
/// are in use: 0 failure, 1 runout, -1 left, 2 interval (an indicator of censoring, as SAS, JMP and SurPyval have it),
/// and 1 failure, 0 runout, 2 left, 3 interval (an indicator of the event, as R's Surv and lifelines have it).
struct LifeStatus {
  std::string column;  ///< its heading
  std::optional<int> failure_code =
      {};  ///< what a failure is written as; none where all cells are words
  std::vector<std::pair<std::string, Censoring>> words =
      {};  ///< of the study, folded; they come first
};

/// Nothing where the study names none. Throws InputError, and with both readings where neither the study
/// nor the heading ("censored", "event") tells what codes mean.
std::optional<LifeStatus> read_life_status(const TomlReader& columns, const Table& table);

/// What a row says of its life. Throws InputError that names its cell.
Censoring seen_in(const Table& table, const LifeStatus& status, std::size_t row);

/// What a failure is written as by what a heading says: "censored?" has 0, "event" 1; nothing where it does not tell.
std::optional<int> failure_code_of(const std::string& heading);

/// The letters of a heading, small and without accents, without what stands between them.
std::string letters_of(const std::string& heading);

}  // namespace wearwell
