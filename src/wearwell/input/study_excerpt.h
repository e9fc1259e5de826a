#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace wearwell {

/// A correction of a line of a study.
struct Repair {
  std::string wrong;    ///< the present text
  std::string right;    ///< its replacement
  bool is_key = false;  ///< a key, which precedes the position of its value
};

/// The excerpt after a message about a study: its line, a caret below the position, and the
/// corrected line if there is a repair, all indented (base/shown.h). `line` and `column` count from
/// 1, columns in characters. Empty if the text has no such line.
std::string study_excerpt(std::string_view text, std::size_t line, std::size_t column,
                          const Repair& repair = {});

/// A message without its excerpts.
std::string without_excerpt(const std::string& message);

}  // namespace wearwell
