#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "wearwell/input/table_settings.h"

namespace wearwell {

/// Numbers that a sheet holds as texts: "3,2", "<0,5", "12,5 mm". As in a text (number_text.h), the cells of a column show
/// which decimal mark they have, or else those of the whole sheet do, or the study says it.
class SheetNumbers {
 public:
  explicit SheetNumbers(const TableSettings& settings);

  /// Of each cell of text, once, before any is rewritten.
  void look_at(std::size_t column, std::size_t row, const std::string& cell);

  /// The cell with its number as C has it; the cell itself where it holds none, or where nobody can tell.
  std::string rewritten(std::size_t column, const std::string& cell);

  /// Why numbers of a column cannot be read, by its number.
  std::map<std::size_t, std::string> doubts() const;
  /// Whether a number had a decimal comma.
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

  char said_ = 0;  // by the study
  std::map<std::size_t, Evidence> columns_;
  bool any_point_ = false, any_comma_shown_ = false, any_comma_ = false;
};

}  // namespace wearwell
