#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "wearwell/present/number.h"

namespace wearwell::present {

/// The format of a column's numbers in reports; files have all digits.
struct Format {
  enum class Kind {
    significant,  ///< significant digits: "7.759 × 10⁻⁴"
    given,        ///< a given number with all digits
    fixed,        ///< fixed number of decimals
    life,         ///< whole cycles; "never" if infinite
  };
  Kind kind = Kind::significant;
  int digits = 4;
};
inline constexpr Format given{Format::Kind::given, 0};
constexpr Format digits(int count) {
  return {Format::Kind::significant, count};
}
constexpr Format fixed(int decimals) {
  return {Format::Kind::fixed, decimals};
}
constexpr Format life(int count = 4) {
  return {Format::Kind::life, count};
}

/// An interval. In a file it becomes two columns.
struct Range {
  double low = 0, high = 0;
};

/// "pass", "warn" or "fail", with its label.
struct Badge {
  std::string kind, word;
};

/// Nothing, text, a number, an interval, a badge.
using Cell = std::variant<std::monostate, std::string, double, Range, Badge>;

/// A count as a cell.
inline double count(std::size_t n) {
  return static_cast<double>(n);
}

struct Column {
  std::string name;
  std::string unit = "1";  ///< unit of its numbers: "mm^3"
  Format format = {};
  bool is_range = false;  ///< its numbers are intervals
};

/// The heading of a column: "life [h]"; the name alone if the unit is 1.
std::string heading(const std::string& name, const std::string& unit);
std::string heading(const Column& column);

/// A table for reports, files and terminals. Rows are as long as `columns`.
struct Table {
  std::string id;       ///< file name, unique in a result: "predictions"
  std::string caption;  ///< one line
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows = {};
  bool words = false;  ///< cells are sentences, not numbers
};

/// The maximum number of rows in a report and a terminal; the file has all.
inline constexpr std::size_t most_rows_shown = 1000;

/// A number in a column's format: "21 600"; "–" if not finite.
std::string description(double x, const Format& format, Script script = Script::page);
std::string description(const Cell& cell, const Column& column);

/// RFC 4180, with the units in the heading: `life [h]`. Numbers in the shortest form that reads
/// back to the same; an interval is two columns, `, from` and `, to`; a missing value is an empty
/// cell. Text that a spreadsheet would interpret as a formula begins with an apostrophe.
std::string csv(const Table& table);

/// For a terminal, aligned.
std::string text(const Table& table);

}  // namespace wearwell::present
