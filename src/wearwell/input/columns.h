#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/prob/response.h"

namespace wearwell {

/// A column that a study names: NAME = "column", or { column = "...", unit = "..." }.
struct ColumnChoice {
  std::string column;  ///< its heading
  Unit unit;
};

/// The number column that [columns] assigns to `name`; empty if none. Its unit is stated by the
/// study, else by the table: in the heading, "volume [mm³]", or in a units row. Throws InputError
/// if a required unit is missing, or if study and table contradict each other.
std::optional<ColumnChoice> read_column(const TomlReader& columns, const std::string& name,
                                        const std::string& si, const Table& table);
ColumnChoice required_column(const TomlReader& columns, const std::string& name,
                             const std::string& si, const Table& table);

/// The column with this heading, assigned to `name` in [columns]. Throws InputError at that line of
/// the study, with the nearest heading.
const Column& study_column(const TomlReader& columns, const std::string& name,
                           const std::string& heading, const Table& table);

/// The same for a column of words; units in its heading are ignored.
std::optional<ColumnChoice> read_word_column(const TomlReader& columns, const std::string& name,
                                             const Table& table);

/// The unit of a column: `given`, else that of the table, else a plain number. Throws InputError if
/// these contradict each other.
Unit column_unit(const Table& table, const Column& column, const std::string& si,
                 const std::optional<Unit>& given);

/// The message for a column `name` whose heading has text in brackets that is not a unit (`why`):
/// quotes the heading and shows how a study states a unit such as `unit`.
std::string no_unit_of(const Table& table, const Column& column, const std::string& name,
                       const std::string& unit, const std::string& why);

/// A cell as a word: a number in its shortest form; empty for an empty cell.
std::string cell_word(const Column& column, std::size_t row);

/// The label in a cell. Throws InputError if it is empty, because that can mean the label above or
/// none.
std::string label_word(const Table& table, const Column& column, std::size_t row);

/// The table with each row repeated by the column that `count` names in `columns`; unchanged
/// without this key. Throws InputError.
Table with_counts(const TomlReader& columns, Table table);

/// The chosen column's values, SI.
inline std::vector<double> si_numbers(const Table& table, const ColumnChoice& choice) {
  return si_numbers(table, choice.column, choice.unit);
}

/// The same for cells that may be limits, "<0.5" and ">5000": the limit, and whether the value lies
/// below or above it.
struct CensoredNumbers {
  std::vector<double> values;
  std::vector<Censoring> seen;
};
CensoredNumbers censored_numbers(const Table& table, const ColumnChoice& choice);

/// Throws InputError for a cell such as "<LOD". `key` is the study key that states the limit, if
/// any.
[[noreturn]] void refuse_unstated_limit(const Table& table, const Column& column, std::size_t row,
                                        const std::string& key = {});

/// The same for temperatures. Throws InputError if one is below absolute zero.
std::vector<double> kelvins(const Table& table, const ColumnChoice& choice);

/// Throws InputError unless `good`: "FILE, row 3, column 'volume': -1 must be ALLOWED".
void require(bool good, const Table& table, const ColumnChoice& choice, std::size_t row,
             const char* allowed);

}  // namespace wearwell
