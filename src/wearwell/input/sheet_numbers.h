#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "wearwell/input/table_settings.h"

namespace wearwell {

/// Numbers that a sheet stores as text: "3,2", "<0,5", "12,5 mm". As in text files (number_text.h),
/// the decimal mark follows from the cells of the column, else from the whole sheet, else from the
/// study.
class SheetNumbers {
 public:
  explicit SheetNumbers(const TableSettings& settings);

  /// Call once for each text cell, before rewriting any.
  void look_at(std::size_t column, std::size_t row, const std::string& cell);

  /// The cell with its number in C format; unchanged if it has no number or is ambiguous.
  std::string rewritten(std::size_t column, const std::string& cell);

  /// Why numbers of a column cannot be read, by column index.
  std::map<std::size_t, std::string> doubts() const;
  /// Whether any number had a decimal comma.
  bool any_comma() const { return any_comma_; }

 private:
  struct Witness {
    std::size_t row = 0;
    std::string cell;
  };
  struct Evidence {
    std::optional<Witness> point, comma, doubtful;
  };
  char mark_of(const Evidence& evidence) const;

  char said_ = 0;  // decimal mark stated by the study
  std::map<std::size_t, Evidence> columns_;
  bool any_point_ = false, any_comma_shown_ = false, any_comma_ = false;
};

}  // namespace wearwell
