#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/base/unit.h"

namespace wearwell {

/// One column as it was read: numbers (NaN where there is no value) or text (empty where there is
/// no value).
struct Column {
  std::string name;
  bool is_number = false;
  std::vector<double> numbers;
  std::vector<std::string> text;
};

/// Named columns of equal length, in the units of the file. Row 1 is the first row of data.
struct Table {
  std::string source;  ///< the file, for messages
  std::vector<Column> columns;
  std::size_t rows = 0;

  /// Throws InputError naming the column and the nearest one there is.
  const Column& column(std::string_view name) const;
};

/// Reads any file that DuckDB reads, by its ending: CSV or TSV with a header, Parquet, JSON. `sql`,
/// when given, is one query over the view `data`. Throws InputError: no such file, unreadable,
/// empty, no rows, two columns of one name, malformed.
Table read_table(const std::filesystem::path& file, const std::optional<std::string>& sql = {});

/// A column's values in SI. Throws InputError naming file, row, column and value where one is
/// missing, not a number or not finite.
std::vector<double> si_numbers(const Table& table, std::string_view column, const Unit& unit);

/// "FILE, row 3, column 'volume'": where a value stands; `index` is 0-based.
std::string place(const Table& table, std::string_view column, std::size_t index);

}  // namespace wearwell
