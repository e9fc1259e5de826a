#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/study/column_roles.h"
#include "wearwell/study/model.h"
#include "wearwell/study/scaffold.h"
#include "wearwell/study/wide_table.h"

namespace wearwell {

/// One way to read a table: a study of this preset.
struct GuessedStudy {
  std::string preset;
  Scaffold study;
};

/// Guesses the study of a table (Model::scaffold).
using StudyGuess = std::optional<Scaffold> (*)(ColumnRoles& roles);

/// All studies that the models make of the table `file`, the best fit first. `preset`: only of this
/// one; empty: of all. `more`: guesses that are no model's, by name.
std::vector<GuessedStudy> guessed_studies(
    Models models, const Table& table, const std::string& file, const TableChoices& choices,
    const std::string& preset, const std::vector<std::pair<std::string, StudyGuess>>& more = {});

/// Lines of TOML for [data]: how the file stores the table, and the SELECT of a wide one.
std::string data_lines(const std::map<std::string, std::string>& keys,
                       const std::optional<WideTable>& wide);

/// "columns P1, P2 are units with one column each: ...".
std::string wide_description(const WideTable& wide);

/// How many of them fit equally well, from the first.
std::size_t equally_good(const std::vector<GuessedStudy>& studies);

/// Adds the choice "ROLE=HEADING" ("ROLE=": no column has it; "unused=HEADING"). Throws InputError
/// that names --column.
void choose_column(const Table& table, const std::string& choice, TableChoices& choices);

}  // namespace wearwell
