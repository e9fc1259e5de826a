#include "wearwell/monitor/line_feed.h"

#include <algorithm>

namespace wearwell::monitor {

bool LineFeed::is_json(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r\n");
  return first != line.npos && (line[first] == '{' || line[first] == '[');
}

std::optional<LineFeed::Piece> LineFeed::next(bool ended) {
  if (text_.empty()) return {};
  std::size_t from = 0;
  if (skipping_) {  // the rest of a line that was too long
    const std::size_t end = text_.find('\n');
    if (end == text_.npos) return Piece{"", Form::any, text_.size(), false, true};
    from = end + 1;
  }
  const std::size_t last = ended ? text_.size() : text_.rfind('\n') + 1;  // 0 where there is none
  if (last == 0) {
    if (text_.size() <= longest_row) return {};
    return Piece{"", Form::any, text_.size(), true, true};
  }
  std::string_view lines = std::string_view(text_).substr(from, last - from);
  Piece piece{"", Form::any, last};
  if (!begun_ && heading_.empty() && !is_json(lines)) {
    const std::size_t first = lines.find_first_not_of("\r\n");
    if (first == lines.npos) return piece;
    const std::size_t end = std::min(lines.find('\n', first), lines.size());
    heading_ = lines.substr(first, end - first);
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  begun_ = true;
  if (lines.find_first_not_of(" \t\r\n") == lines.npos) return piece;
  if (heading_.empty()) {
    piece.payload = lines;
    piece.form = Form::json_lines;
  } else {
    piece.payload = heading_ + "\n" + std::string(lines);
  }
  return piece;
}

void LineFeed::taken(const Piece& piece) {
  skipping_ = piece.skips;
  text_.erase(0, piece.bytes);
}

}  // namespace wearwell::monitor
