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

/// One column: numbers (NaN for missing values) or text (empty for missing values).
struct Column {
  std::string name;
  bool is_number = false;
  std::vector<double> numbers;
  std::vector<std::string> text;
  std::string unit = {};  ///< from a units row or from the cells; the heading may state one too
  std::optional<NumberMarks> marks = {};  ///< of the numbers in a text
  std::string doubt = {};                 ///< "row 1, ...": why the numbers cannot be read
  bool unit_in_cells = false;             ///< "12 mm"
};

/// The layout of a table in a file, as text.
struct TableLayout {
  std::string text;  ///< "semicolons, decimal comma", then the remarks; empty if trivial
  std::vector<std::string> remarks = {};  ///< "2 hidden rows read like the others (rows 5, 9)"
};

/// "; 2 hidden rows read like the others (rows 5, 9)", to follow the name of a file; empty without
/// remarks.
std::string remarks_suffix(const std::vector<std::string>& remarks);

/// Named columns of equal length, in the units of the file. Row 1 is the first row of data.
struct Table {
  std::string source;  ///< the file, for messages
  std::vector<Column> columns;
  std::size_t rows = 0;
  TableLayout layout = {};
  std::vector<std::size_t> lines = {};    ///< line of each row in the file; empty if always row + 1
  std::vector<std::size_t> origins = {};  ///< row of the file, from 1, if rows were repeated

  /// The column with this heading, or the only one with this name before its unit. Throws
  /// InputError that names the column and the nearest one.
  const Column& column(std::string_view name) const;
};

/// The time limit of a user's query. Its memory limit is half of the machine's memory.
struct QueryLimits {
  double seconds = 60;
};

/// A refused or failed query.
struct QueryError : InputError {
  using InputError::InputError;
};

/// Reads exactly this file, by its extension: text (.csv, .tsv, .txt, .dat, .asc), .json, .ndjson,
/// .jsonl (each also with .gz), .parquet, .xlsx (docs/reference/tables.md). `sql`, if given, is one
/// SELECT over the table `data`; it can read nothing else. Throws InputError (missing, irregular,
/// unreadable, empty, truncated or malformed file, no rows, duplicate column names) and QueryError.
Table read_table(const std::filesystem::path& file, const std::optional<std::string>& sql = {},
                 const QueryLimits& limits = {}, const TableSettings& settings = {});

/// A column's values in SI. Throws InputError that names file, row, column and value if one is
/// missing, not a number, ambiguous, or not finite.
std::vector<double> si_numbers(const Table& table, std::string_view column, const Unit& unit);

/// The number in a cell: its value, or a limit that it lies below or above ("<0.5").
struct CellValue {
  double number = std::numeric_limits<double>::quiet_NaN();  ///< NaN if missing
  char sign = 0;                                             ///< '<' or '>' for a limit
  bool unstated = false;  ///< a limit without a number, as in "<LOD"
};
/// Throws InputError that names file, row, column and value if the cell is not a number.
CellValue cell_value(const Table& table, const Column& column, std::size_t index);

/// The number in a cell, NaN if it is empty. Throws InputError that names file, row, column and
/// value if it is not a number, or a limit.
double cell_number(const Table& table, const Column& column, std::size_t index);

/// "row 3", or "row 3 (line 9)" if lines were omitted; both from 1, a line of 0 is unknown.
std::string row_name(std::size_t row, std::size_t line);

/// "FILE, row 3, column 'volume'": the position of a value; `index` is 0-based.
std::string place(const Table& table, std::string_view column, std::size_t index);

}  // namespace wearwell
