#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"
#include "wearwell/input/number_text.h"
#include "wearwell/input/table_settings.h"

namespace wearwell {

/// One column as it was read: numbers (NaN where there is no value) or text (empty where there is
/// no value).
struct Column {
  std::string name;
  bool is_number = false;
  std::vector<double> numbers;
  std::vector<std::string> text;
  std::string unit = {};  ///< from a row of units or from the cells; the heading may have one too
  std::optional<NumberMarks> marks = {};  ///< of the numbers in a text
  std::string doubt = {};                 ///< "row 1, ...": why these cannot be read
  bool unit_in_cells = false;             ///< "12 mm"
};

/// How a file holds a table, for people.
struct TableLayout {
  std::string
      text;  ///< "semicolons, decimal comma", then the remarks; empty where nothing is to say
  std::vector<std::string> remarks = {};  ///< "2 hidden rows read like the others (rows 5, 9)"
};

/// "; 2 hidden rows read like the others (rows 5, 9)", to follow the name of a file; empty without remarks.
std::string remarks_suffix(const std::vector<std::string>& remarks);

/// Named columns of equal length, in the units of the file. Row 1 is the first row of data.
struct Table {
  std::string source;  ///< the file, for messages
  std::vector<Column> columns;
  std::size_t rows = 0;
  TableLayout layout = {};
  std::vector<std::size_t> lines = {};    ///< of the file, for each row, where that is not row + 1
  std::vector<std::size_t> origins = {};  ///< the row of the file, where rows were repeated; from 1

  /// The column of this heading, or else the only one of this name before its unit. Throws InputError naming the column and the nearest one there is.
  const Column& column(std::string_view name) const;
};

/// What a query of the user may take; its memory is bounded too, by half of the machine's.
struct QueryLimits {
  double seconds = 60;
};

/// A query that is refused or fails.
struct QueryError : InputError {
  using InputError::InputError;
};

/// Reads exactly this file, by its ending: text (.csv, .tsv, .txt, .dat, .asc), .json, .ndjson,
/// .jsonl (each also with .gz behind), .parquet, .xlsx (docs/reference/tables.md). `sql`, when given, is one
/// SELECT over the table `data`; it can read nothing else. Throws InputError: no such file, no
/// regular file, unreadable, empty, cut off, no rows, two columns of one name, malformed; and
/// QueryError.
Table read_table(const std::filesystem::path& file, const std::optional<std::string>& sql = {},
                 const QueryLimits& limits = {}, const TableSettings& settings = {});

/// A column's values in SI. Throws InputError naming file, row, column and value where one is
/// missing, not a number, has two readings, or is not finite.
std::vector<double> si_numbers(const Table& table, std::string_view column, const Unit& unit);

/// What a cell says of a number: its value, or a limit that it lies below or above ("<0.5").
struct CellValue {
  double number = std::numeric_limits<double>::quiet_NaN();  ///< NaN where there is none
  char sign = 0;                                             ///< '<' or '>' of a limit
  bool unstated = false;  ///< a limit whose number the cell does not state, as in "<LOD"
};
/// Throws InputError that names file, row, column and value where it says nothing of a number.
CellValue cell_value(const Table& table, const Column& column, std::size_t index);

/// The number in a cell, NaN where it is empty. Throws InputError that names file, row, column and
/// value where it is no number, or a limit.
double cell_number(const Table& table, const Column& column, std::size_t index);

/// "row 3", or "row 3 (line 9)" where lines were left out; both from 1, a line of 0 is not known.
std::string row_name(std::size_t row, std::size_t line);

/// "FILE, row 3, column 'volume'": where a value stands; `index` is 0-based.
std::string place(const Table& table, std::string_view column, std::size_t index);

}  // namespace wearwell
