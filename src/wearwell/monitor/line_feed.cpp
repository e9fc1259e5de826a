#include "wearwell/monitor/line_feed.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/monitor/message.h"

namespace wearwell::monitor {

namespace {

bool is_json(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r\n");
  return first != line.npos && (line[first] == '{' || line[first] == '[');
}

bool is_blank(std::string_view line) {
  return line.find_first_not_of(" \t\r\n") == line.npos;
}

}  // namespace

bool LineFeed::is_heading(std::string_view line) const {
  try {
    std::vector<std::string> cells = cells_of(line);
    for (std::string& cell : cells) {
      const std::size_t from = std::min(cell.find_first_not_of(" \t\r"), cell.size());
      cell = cell.substr(from, cell.find_last_not_of(" \t\r") + 1 - from);
    }
    return std::all_of(needed_.begin(), needed_.end(), [&](const std::string& each) {
      return std::find(cells.begin(), cells.end(), each) != cells.end();
    });
  } catch (const InputError&) {  // an unclosed quote
    return false;
  }
}

void LineFeed::set_heading(std::string_view beginning) {
  while (!beginning.empty()) {
    const std::string_view line = beginning.substr(0, beginning.find('\n'));
    if (is_json(line)) return;
    if (!is_blank(line) && is_heading(line)) {
      heading_ = line;
      return;
    }
    beginning.remove_prefix(std::min(line.size() + 1, beginning.size()));
  }
}

// Lines up to the first of JSON, or with the heading of CSV.
LineFeed::Piece LineFeed::begin(std::string_view lines) {
  Piece piece{"", Form::any, 0};
  while (piece.bytes < lines.size()) {
    const std::string_view left = lines.substr(piece.bytes);
    const std::string_view line = left.substr(0, left.find('\n'));
    if (is_json(line)) {
      begun_ = true;
      break;
    }
    piece.bytes += std::min(line.size() + 1, left.size());
    if (is_blank(line)) continue;
    if (is_heading(line)) {
      heading_ = line;
      begun_ = true;
      break;
    }
    piece.refused.push_back(fmt::format("'{}' is neither JSON nor a heading with {}{}",
                                        printable(shortened(line)), fmt::join(needed_, ", "),
                                        separator_problem(line)));
  }
  return piece;
}

std::optional<LineFeed::Piece> LineFeed::next(bool ended) {
  if (text_.empty()) return {};
  std::size_t from = 0;
  if (skipping_) {  // the rest of an overlong line
    const std::size_t end = text_.find('\n');
    if (end == text_.npos) return Piece{"", Form::any, text_.size(), true};
    from = end + 1;
  }
  const std::size_t last = ended ? text_.size() : text_.rfind('\n') + 1;  // 0 if there is none
  if (last == 0) {
    if (text_.size() <= longest_row) return {};
    return Piece{"",
                 Form::any,
                 text_.size(),
                 true,
                 {fmt::format("a line of more than {} bytes", longest_row)}};
  }
  std::string_view lines = std::string_view(text_).substr(from, last - from);
  Piece piece{"", Form::any, last};
  if (!begun_ && heading_.empty()) {
    Piece before = begin(lines);
    if (before.bytes > 0) {
      before.bytes += from;
      return before;
    }
  }
  begun_ = true;
  if (is_blank(lines)) return piece;
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
