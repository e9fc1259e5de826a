#pragma once

#include <string_view>
#include <vector>

namespace wearwell {

/// What the cells of a column are; `names` are words or whole numbers.
enum class Cells { numbers, names, any };

/// A word that people write in a heading, in small letters, and the unit that the word itself says: "hours" is h.
struct RoleWord {
  std::string_view text;
  std::string_view unit = "";
};

/// What a column may be, and how it is recognized: by words of its heading in English, German, French
/// and Spanish, the more telling ones first, or by its unit.
struct RoleForm {
  std::string_view name;             ///< of `wearwell new --column NAME=HEADING`
  std::vector<std::string_view> si;  ///< the dimensions that it may have; none: any
  std::string_view usual;  ///< the unit that is guessed where none is stated; "1": needs none
  Cells cells = Cells::numbers;
  std::vector<RoleWord> words = {};
  /// Where one unit lies between these in SI, the unit alone tells the role; 0: it never does.
  double least_unit = 0, largest_unit = 0;
};

const std::vector<RoleForm>& role_forms();
const RoleForm& role_form(std::string_view name);

}  // namespace wearwell
