#include "wearwell/input/text_records.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/stop_scope.h"

namespace wearwell {
namespace {

/// Whether a quote is open after `text`, given whether one is open before it. A quote opens at the
/// beginning of a cell, or after leading blanks.
bool open_behind(std::string_view text, char delimiter, bool open) {
  bool at_start = !open;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (open) {
      if (c != '"') continue;
      if (i + 1 < text.size() && text[i + 1] == '"') {
        ++i;
      } else {
        open = false;
      }
    } else if (c == delimiter) {
      at_start = true;
      continue;
    } else if (c == '"' && at_start) {
      open = true;
    }
    at_start = at_start && c == ' ';
  }
  return open;
}

}  // namespace

TextRecords::TextRecords(TextLines& lines, char delimiter, std::string comment,
                         std::size_t first_line)
    : lines_(lines), delimiter_(delimiter), comment_(std::move(comment)), first_line_(first_line) {}

/// Cells of a `line_` with quotes.
void TextRecords::split_quoted() {
  // Views into `unquoted_`, which must not reallocate.
  unquoted_.clear();
  unquoted_.reserve(line_.size());
  std::size_t begin = 0;
  bool open = false, at_start = true, closed = false;
  const auto end_cell = [&] {
    cells_.push_back(std::string_view(unquoted_).substr(begin));
    begin = unquoted_.size();
    at_start = true;
    closed = false;
  };
  for (std::size_t i = 0; i < line_.size(); ++i) {
    const char c = line_[i];
    if (open) {
      if (c == '"' && i + 1 < line_.size() && line_[i + 1] == '"') {
        unquoted_ += c;
        ++i;
      } else if (c == '"') {
        open = false;
        closed = true;
      } else {
        unquoted_ += c;
      }
      continue;
    }
    if (c == delimiter_) {
      end_cell();
      continue;
    }
    if (closed) (c == ' ' ? blank_beside_quote_ : text_behind_quote_) = true;
    if (closed && c == ' ') continue;
    if (c == '"' && at_start) {
      open = true;
      blank_beside_quote_ = blank_beside_quote_ || unquoted_.size() > begin;
      unquoted_.resize(begin);
    } else {
      unquoted_ += c;
    }
    at_start = at_start && c == ' ' && !open;
  }
  end_cell();
}

void TextRecords::refuse_text_behind_quote(const std::string& source) const {
  throw InputError(
      fmt::format("{}, line {}: a cell goes on behind its closing quote: '{}' (a quoted cell ends "
                  "at its second quote; a quote within it "
                  "is doubled)",
                  source, line_number_, shortened(line_, 200)));
}

bool TextRecords::next() {
  check_stop();
  for (;;) {
    if (!lines_.next(line_)) return false;
    if (line_.empty() || lines_.number < first_line_) continue;
    if (!comment_.empty() && line_.starts_with(comment_)) {
      ++comments_;
      continue;
    }
    break;
  }
  line_number_ = lines_.number;
  text_behind_quote_ = false;
  cells_.clear();
  if (line_.find('"') == line_.npos) {
    for (std::size_t from = 0;;) {
      const std::size_t end = line_.find(delimiter_, from);
      cells_.push_back(line_.substr(from, end - from));
      if (end == line_.npos) return true;
      from = end + 1;
    }
  }
  bool open = open_behind(line_, delimiter_, false);
  if (open) {
    joined_ = line_;
    for (std::string_view more; open;) {
      if (joined_.size() > longest_line || !lines_.next(more))
        lines_.refuse_open_quote(line_number_);
      joined_ += '\n';
      joined_ += more;
      open = open_behind(more, delimiter_, true);
    }
    line_ = joined_;
  }
  split_quoted();
  return true;
}

}  // namespace wearwell
