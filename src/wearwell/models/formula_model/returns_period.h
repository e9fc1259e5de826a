#pragma once

#include <optional>
#include <string>

#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell::formula_model {

inline constexpr const char* allowed_months =
    "a month like 2024-01, 01/2024 or Jan 2024, or a number of a period";

/// A period as a number with its prefix, "M3"; the prefix of a month of the calendar is empty.
struct Period {
  bool calendar = false;
  int number = 0;
  std::string prefix = {};
  bool is_like(const Period& other) const {
    return calendar == other.calendar && prefix == other.prefix;
  }
};

/// The period that a heading or a cell names; empty if it names none.
std::optional<Period> period_in(const std::string& text);

/// The periods that the cells of a column name. Where one layout alone fits all its dates (one of them is 25/06/2025), they are
/// read by it, 01/02/2024 too.
class PeriodColumn {
 public:
  explicit PeriodColumn(const Column& column);
  const std::string& name() const { return column_.name; }
  std::optional<Period> at(std::size_t row) const;

 private:
  const Column& column_;
  std::string layout_;  // of `strptime`; empty unless one alone fits
};

/// "FILE, row 3, column 'sold': 'May'".
std::string quoted_place(const Table& table, const std::string& column, std::size_t row);

/// The period of sale in a cell. Throws InputError that names the cell.
Period required_period(const Table& table, const PeriodColumn& column, std::size_t row);

/// Throws InputError if this period of a table is numbered in another way than those before: weeks beside months. A number
/// alone takes the kind of the others. `prefix` is theirs.
void require_kind(const Table& table, const std::string& column, std::size_t row,
                  const Period& period, std::string& prefix);

/// A whole number of units in a cell; an empty cell is `empty`, or an error if that is negative. Throws InputError that names
/// the cell.
int units_in(const Table& table, const std::string& column, std::size_t row, int empty);

/// The heading that `key` names, or `otherwise`. Throws InputError if there is none.
std::string column_named(const TomlReader& keys, const std::string& key, const Table& table,
                         const std::string& otherwise);

}  // namespace wearwell::formula_model
