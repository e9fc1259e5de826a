#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace wearwell {

/// What would be right in a line of a study.
struct Repair {
  std::string wrong;    ///< as it stands there
  std::string right;    ///< what belongs in its place
  bool is_key = false;  ///< a key, which stands in front of the place of its value
};

/// What stands behind a message about a study: its line with a caret below the place, and the line as it would be
/// right where there is a repair, each on a line of its own and indented (base/shown.h). `line` and `column` count from 1,
/// columns in characters. Empty where the text has no such line.
std::string study_excerpt(std::string_view text, std::size_t line, std::size_t column,
                          const Repair& repair = {});

/// A message without the excerpts behind it.
std::string without_excerpt(const std::string& message);

}  // namespace wearwell
