#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/number_text.h"
#include "wearwell/input/table_settings.h"
#include "wearwell/input/text_layout.h"

namespace wearwell {

/// A cell that is evidence, and its row of data.
struct CellWitness {
  std::size_t row = 0, line = 0;
  std::string cell;
};

/// What the cells of a column reveal about its number format.
struct ColumnEvidence {
  std::optional<CellWitness> decimal[2], doubtful[2];  // of '.' and ','
  std::set<char> thousands;
  bool any_number = false, any_text = false;
  bool other_signs = false;  ///< signs that no C number has
  // Cells that contain more than a number, or no number.
  std::optional<CellWitness> missing, limit, bare, with_unit, other_unit;
  std::size_t missing_cells = 0, limits = 0;
  std::string unit;  ///< of `with_unit`

  bool shows(std::size_t mark) const { return decimal[mark].has_value(); }
  bool agrees_with(const NumberMarks& marks) const;
  /// Whether its numbers have C format.
  bool is_plain(char decimal_mark) const {
    if (!thousands.empty() || other_signs || missing || shows(1) || doubtful[1]) return false;
    return decimal_mark == '.' || (!shows(0) && !doubtful[0]);
  }
};

/// Adds the evidence of a cell; `row` counts rows of data, from 1.
void look_at(std::string_view cell, std::size_t row, std::size_t line, ColumnEvidence& seen);

/// The decimal mark in the number columns; 0 if none, '?' if both.
char shown_by_all(const std::vector<ColumnEvidence>& all);

/// Decides the marks of a column's numbers and whether it contains only numbers; else states why
/// this is ambiguous.
void decide_marks(const ColumnEvidence& seen, char of_all, const std::vector<ColumnEvidence>& all,
                  char delimiter, const TableSettings& settings, TextColumn& column);

/// Decides the unit in the cells of a number column; else states why it is ambiguous.
void decide_unit(const ColumnEvidence& seen, TextColumn& column);

/// Whether the evidence so far decides every column, regardless of later rows.
bool is_settled(const std::vector<ColumnEvidence>& all, char delimiter);

/// The index of '.' and ',' in `decimal` and `doubtful`, and the inverse.
inline constexpr char decimal_signs[2] = {'.', ','};
inline std::size_t mark_place(char mark) {
  return mark == ',';
}

}  // namespace wearwell
