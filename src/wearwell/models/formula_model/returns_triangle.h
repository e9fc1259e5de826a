#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/mode_words.h"

namespace wearwell::formula_model {

/// Returns by one failure mode.
struct ModeReturns {
  std::string mode;     ///< "seal"; "seal|motor", one of the two; empty if it is not known
  std::size_t row = 0;  ///< of the table that names it first
  std::vector<int> returns = {};
};

/// The units sold in one period, and how many of them came back in each later one.
struct SalesPeriod {
  int at = 0;  ///< the period of sale
  int sold = 0;
  std::vector<int> returns = {};  ///< by period from that of the sale to the last of the table
  std::vector<ModeReturns> by_mode =
      {};               ///< the same by failure mode, if the table has a column of modes
  std::size_t row = 0;  ///< the first one of the table

  int returned(int until) const;  ///< up to and including this period
};

/// The periods of a returns triangle: months of the calendar, or numbers.
struct PeriodNames {
  bool calendar = true;
  std::string prefix = {};  ///< of numbers: "M" of "M3"
  std::string text(int period) const;
};

/// A returns triangle (Nevada table): a row for each period of sale with its quantity, a column for
/// each period of return.
struct ReturnsTriangle {
  Table table;  ///< as read
  PeriodNames names;
  std::string period_column, quantity_column;
  std::string mode_column = {};         ///< of failure modes; empty: the table has none
  std::vector<std::string> modes = {};  ///< that its rows name, with or without returns
  int first = 0, last = 0;              ///< periods of the first and the last column of returns
  std::vector<SalesPeriod> sales;
  std::vector<std::string> unread;      ///< headings that are no period
  std::vector<std::string> notes = {};  ///< of its rows, as sentences
};

/// The columns of a table that looks like a triangle.
struct TriangleColumns {
  std::string period, quantity;          ///< of sale
  std::string mode = {};                 ///< of failure modes, if it is named
  std::string first = {}, last = {};     ///< of return
  std::vector<std::string> unread = {};  ///< headings that are no period
  bool calendar = true;                  ///< months, not numbers
  std::string prefix = {};               ///< of numbers
};

/// Recognizes a triangle by its headings and cells: two or more columns headed by periods that follow
/// each other, and a column of periods of the same kind. Empty for any other table.
std::optional<TriangleColumns> triangle_columns(const Table& table);

/// Reads a triangle. `keys` names the columns (`sold`, `quantity`, `mode`) and is the place of messages. An
/// empty cell is no return. With `mode` a period of sale has a row for each failure mode; its quantity may stand
/// in one of them; `words` are those of [failure_modes]. Throws InputError that names file, row and column: an unreadable period,
/// months beside numbers, a missing or repeated period, no quantity, a return before the sale, more
/// returns than sold, a last column without any entry.
ReturnsTriangle read_triangle(const TomlReader& keys, Table table, const ModeWords& words = {});
/// The same with known columns.
ReturnsTriangle read_triangle(const TomlReader& keys, Table table, const TriangleColumns& columns,
                              const ModeWords& words);

/// Quantities that will be sold, by period, from a table of its own with the same headings. Throws
/// InputError: likewise, and for periods up to `last`.
std::vector<std::pair<int, int>> read_planned_sales(const TomlReader& keys, const Table& table,
                                                    const PeriodNames& names, int last);

}  // namespace wearwell::formula_model
