#include "wearwell/fleet/clickhouse_text.h"

#include <fmt/format.h>

#include <boost/algorithm/string/trim.hpp>
#include <charconv>
#include <limits>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::fleet {
namespace {

/// The text after `from` up to the first of what may follow a message.
std::string message_at(std::string_view said, std::size_t from) {
  std::size_t to = said.size();
  for (const char* end : {", e.what()", "\n", " (version ", ". Stack trace", " Stack trace:"})
    to = std::min(to, said.find(end, from));
  std::string text(said.substr(from, to - from));
  boost::algorithm::trim(text);
  for (const char* tail : {" Log:", ".", ": "}) {
    const std::string_view end(tail);
    if (text.size() > end.size() && text.ends_with(end)) text.erase(text.size() - end.size());
  }
  return text;
}

/// With backslash escapes removed.
char escaped(char c) {
  switch (c) {
    case 'b':
      return '\b';
    case 'f':
      return '\f';
    case 'r':
      return '\r';
    case 'n':
      return '\n';
    case 't':
      return '\t';
    case '0':
      return '\0';
    default:
      return c;
  }
}

std::string cell_of(std::string_view text) {
  if (text == "\\N") return "";
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i)
    out += text[i] == '\\' && i + 1 < text.size() ? escaped(text[++i]) : text[i];
  return out;
}

}  // namespace

int error_code(std::string_view said) {
  const std::size_t at = said.find("Code: ");
  int code = 0;
  if (at != said.npos) std::from_chars(said.data() + at + 6, said.data() + said.size(), code);
  return code;
}

std::string error_sentence(std::string_view said) {
  constexpr std::string_view begins[] = {
      "DB::Exception: ", "DB::NetException: ", "e.displayText() = "};
  std::string text;
  std::size_t after = 0;
  for (const std::string_view begin : begins) {
    const std::size_t at = said.find(begin);
    const bool last = begin == begins[2];  // which precedes either of the others
    if (at == said.npos || (!text.empty() && (last || at >= after))) continue;
    after = at + begin.size();
    text = message_at(said, after);
  }
  if (text.empty())
    return printable(shortened(boost::algorithm::trim_copy(std::string(said)), 300));
  for (const std::string_view begin : begins) {
    const std::size_t at = said.find(begin, after);
    if (at == said.npos) continue;
    const std::string cause = message_at(said, at + begin.size());
    if (begin == begins[2] || cause.empty() || text.find(cause) != text.npos) continue;
    text += ": " + cause;
    break;
  }
  return printable(shortened(text, 300));
}

std::vector<std::string> single_statements(std::string_view text) {
  std::vector<std::string> all;
  std::string one;
  const auto finish = [&] {
    boost::algorithm::trim(one);
    if (!one.empty()) all.push_back(one);
    one.clear();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (text.substr(i, 2) == "--") {
      while (i + 1 < text.size() && text[i + 1] != '\n') ++i;
    } else if (c == ';') {
      finish();
    } else if (c == '\'' || c == '"' || c == '`') {
      const std::size_t from = i++;
      while (i < text.size() && text[i] != c) i += text[i] == '\\' ? 2 : 1;
      one += text.substr(from, i + 1 - from);
    } else {
      one += c;
    }
  }
  finish();
  return all;
}

void SeparatedText::add(std::string_view piece,
                        const std::function<void(const std::vector<std::string>&)>& take) {
  for (;;) {
    const std::size_t end = piece.find('\n');
    rest_ += piece.substr(0, end);
    if (end == piece.npos) return;
    piece.remove_prefix(end + 1);
    cells_.clear();
    std::string_view line = rest_;
    for (;;) {
      const std::size_t tab = line.find('\t');
      cells_.push_back(cell_of(line.substr(0, tab)));
      if (tab == line.npos) break;
      line.remove_prefix(tab + 1);
    }
    take(cells_);
    rest_.clear();
  }
}

double separated_number(const std::string& cell) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  double x = 0;
  const auto read = std::from_chars(cell.data(), cell.data() + cell.size(), x);
  if (read.ec != std::errc() || read.ptr != cell.data() + cell.size())
    throw InputError(fmt::format("'{}' is not a number", printable(shortened(cell))));
  return x;
}

}  // namespace wearwell::fleet
