#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/prob/response.h"

namespace wearwell {

/// The column of [data.columns] that states how life tests ended: status = "HEADING", or
/// { column = "HEADING", failure = 1 }, or with words of the table, { column = "HEADING", failure =
/// "broke", runout = ["ran", "stopped"] }. Common words are known (status_words.h). Two sets of
/// codes are in use: 0 failure, 1 runout, -1 left, 2 interval (an indicator of censoring, as SAS,
/// JMP and SurPyval have it), and 1 failure, 0 runout, 2 left, 3 interval (an indicator of the
/// event, as R's Surv and lifelines have it).
struct LifeStatus {
  std::string column;                    ///< its heading
  std::optional<int> failure_code = {};  ///< the code of a failure; empty if all cells are words
  std::vector<std::pair<std::string, Censoring>> words = {};  ///< of the study, folded; they take
                                                              ///< precedence
};

/// Empty if the study names none. Throws InputError; explains both readings if neither the study
/// nor the heading ("censored", "event") defines the codes.
std::optional<LifeStatus> read_life_status(const TomlReader& columns, const Table& table);

/// The status of a row. Throws InputError that names its cell.
Censoring seen_in(const Table& table, const LifeStatus& status, std::size_t row);

/// The code of a failure according to a heading: 0 for "censored?", 1 for "event"; else empty.
std::optional<int> failure_code_of(const std::string& heading);

/// The letters of a heading, in lower case, without accents and other characters.
std::string letters_of(const std::string& heading);

}  // namespace wearwell
