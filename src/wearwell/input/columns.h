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

/// The column of numbers that a [columns] table has for `name`; nothing where it has none. Its unit
/// is what the study says or else what the table says: in the heading, "volume [mm³]", or in a row of
/// units. Throws InputError where there is no unit and one is needed, and where the two contradict.
std::optional<ColumnChoice> read_column(const TomlReader& columns, const std::string& name,
                                        const std::string& si, const Table& table);
ColumnChoice required_column(const TomlReader& columns, const std::string& name,
                             const std::string& si, const Table& table);

/// The column of this heading, which `name` in the study's [columns] names. Throws InputError at that line of
/// the study, with the nearest heading.
const Column& study_column(const TomlReader& columns, const std::string& name,
                           const std::string& heading, const Table& table);

/// The same of a column of words; units in its heading mean nothing.
std::optional<ColumnChoice> read_word_column(const TomlReader& columns, const std::string& name,
                                             const Table& table);

/// The unit of a column: `given`, or what the table says, or a plain number. Throws InputError where
/// these contradict.
Unit column_unit(const Table& table, const Column& column, const std::string& si,
                 const std::optional<Unit>& given);

/// What is said of a column `name` in whose heading there stands in brackets what is no unit, `why`:
/// the heading, and how a study states the unit, one like `unit`.
std::string no_unit_of(const Table& table, const Column& column, const std::string& name,
                       const std::string& unit, const std::string& why);

/// A cell as a word: a number is written as short as it can be, and empty where there is none.
std::string cell_word(const Column& column, std::size_t row);

/// The label in a cell. Throws InputError where it is empty: it may be that of a row above, or none.
std::string label_word(const Table& table, const Column& column, std::size_t row);

/// The table with each row as often as the column says that `count` names in `columns`; the table
/// itself where there is no such key. Throws InputError.
Table with_counts(const TomlReader& columns, Table table);

/// The chosen column's values, SI.
inline std::vector<double> si_numbers(const Table& table, const ColumnChoice& choice) {
  return si_numbers(table, choice.column, choice.unit);
}

/// The same where cells may be limits, "<0.5" and ">5000": the limit, and that the value lies below or above it.
struct CensoredNumbers {
  std::vector<double> values;
  std::vector<Censoring> seen;
};
CensoredNumbers censored_numbers(const Table& table, const ColumnChoice& choice);

/// Throws InputError of a cell such as "<LOD". `key` is what states it in the study, if anything does.
[[noreturn]] void refuse_unstated_limit(const Table& table, const Column& column, std::size_t row,
                                        const std::string& key = {});

/// The same of temperatures. Throws InputError where one is below absolute zero.
std::vector<double> kelvins(const Table& table, const ColumnChoice& choice);

/// Throws InputError unless `good`: "FILE, row 3, column 'volume': -1 must be ALLOWED".
void require(bool good, const Table& table, const ColumnChoice& choice, std::size_t row,
             const char* allowed);

}  // namespace wearwell
