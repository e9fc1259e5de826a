#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/text_lines.h"

namespace wearwell {

/// Records of a text: lines cut into cells, as far as quotes hold together also several lines.
class TextRecords {
 public:
  /// `comment`: lines that begin so are left out; empty for none. `first_line`: those above it are.
  TextRecords(TextLines& lines, char delimiter, std::string comment = "",
              std::size_t first_line = 1);

  /// The next record that is no empty line. Throws InputError where a quote never ends.
  bool next();

  /// Of the record that came last; they live until the next.
  const std::vector<std::string_view>& cells() const { return cells_; }
  std::string_view text() const { return line_; }    ///< as it is written, without the last end
  std::size_t line() const { return line_number_; }  ///< in which it begins
  bool blank_before_quote() const { return blank_before_quote_; }  ///< so far; "1, \"a\""
  std::size_t comments() const { return comments_; }               ///< lines left out until here

 private:
  void split_quoted();

  TextLines& lines_;
  char delimiter_;
  std::string comment_;
  std::size_t first_line_;
  std::string_view line_;
  std::string joined_, unquoted_;
  std::vector<std::string_view> cells_;
  std::size_t line_number_ = 0, comments_ = 0;
  bool blank_before_quote_ = false;
};

}  // namespace wearwell
