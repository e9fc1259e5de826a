#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/text_lines.h"

namespace wearwell {

/// Records of a text: lines split into cells; a quoted cell can span several lines.
class TextRecords {
 public:
  /// `comment`: prefix of omitted lines; empty for none. Lines above `first_line` are omitted.
  TextRecords(TextLines& lines, char delimiter, std::string comment = "",
              std::size_t first_line = 1);

  /// The next non-empty record. Throws InputError if a quote is not closed.
  bool next();

  /// Of the last record; valid until the next call.
  const std::vector<std::string_view>& cells() const { return cells_; }
  std::string_view text() const { return line_; }    ///< raw text, without the final line ending
  std::size_t line() const { return line_number_; }  ///< its first line
  /// Whether a blank has been beside a quoted cell so far: "1, \"a\"".
  bool blank_beside_quote() const { return blank_beside_quote_; }
  /// Whether a cell of the last record goes on behind its closing quote: "\"2\"5", 2 or 25.
  bool text_behind_quote() const { return text_behind_quote_; }
  [[noreturn]] void refuse_text_behind_quote(const std::string& source) const;
  std::size_t comments() const { return comments_; }  ///< lines omitted so far

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
  bool blank_beside_quote_ = false, text_behind_quote_ = false;
};

}  // namespace wearwell
