#pragma once

#include <string_view>
#include <vector>

namespace wearwell {

/// The content of a column's cells; `names` are words or whole numbers.
enum class Cells { numbers, names, any };

/// A word of headings, in lower case, and the unit that it implies: "hours" is h.
struct RoleWord {
  std::string_view text;
  std::string_view unit = "";
};

/// A role of a column, and how it is recognized: by words of its heading in English, German, French
/// and Spanish, the more specific ones first, or by its unit.
struct RoleForm {
  std::string_view name;             ///< of `wearwell new --column NAME=HEADING`
  std::vector<std::string_view> si;  ///< allowed dimensions; empty: any
  std::string_view usual;            ///< the unit guessed if none is stated; "1": needs none
  Cells cells = Cells::numbers;
  std::vector<RoleWord> words = {};
  /// If the size of the unit in SI lies between these, the unit alone identifies the role; 0:
  /// never.
  double least_unit = 0, largest_unit = 0;
};

const std::vector<RoleForm>& role_forms();
/// Words of headings of a date of sale, and of a date of return, in a table with a row for each unit.
const std::vector<std::string_view>& sale_words();
const std::vector<std::string_view>& return_words();
const RoleForm& role_form(std::string_view name);

}  // namespace wearwell
