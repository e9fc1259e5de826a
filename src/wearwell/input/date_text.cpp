#include "wearwell/input/date_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "wearwell/base/printable.h"
#include "wearwell/input/cell_text.h"

namespace wearwell {
namespace {

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(date_blanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(date_blanks) + 1 - begin);
}

// Takes a number of `least` to `most` digits from the front; -1 if there is none.
int taken_number(std::string_view& text, std::size_t least, std::size_t most) {
  int value = 0;
  std::size_t digits = 0;
  for (; digits < most && digits < text.size() && text[digits] >= '0' && text[digits] <= '9';
       ++digits)
    value = 10 * value + (text[digits] - '0');
  if (digits < least) return -1;
  text.remove_prefix(digits);
  return value;
}

struct DateParts {
  int year = -1, month = -1, day = -1, hour = 0, minute = 0, second = 0;
};

// A field that is not there gets -1.
void take_field(std::string_view& text, char field, DateParts& parts) {
  constexpr int turn = 69, century = 1900, first_year = 1000;
  switch (field) {
    case 'Y':
      // DuckDB reads the first of 01-02-24 as the year 1.
      parts.year = taken_number(text, 4, 4);
      if (parts.year < first_year) parts.year = -1;
      break;
    case 'y': {
      const int year = taken_number(text, 2, 2);
      parts.year = year < 0 ? -1 : year + century + (year < turn ? 100 : 0);
      break;
    }
    case 'm':
      parts.month = taken_number(text, 1, 2);
      break;
    case 'd':
      parts.day = taken_number(text, 1, 2);
      break;
    case 'H':
      parts.hour = taken_number(text, 1, 2);
      break;
    case 'M':
      parts.minute = taken_number(text, 2, 2);
      break;
    default:
      parts.second = taken_number(text, 2, 2);
  }
}

std::optional<long long> seconds_of(const DateParts& parts) {
  using namespace std::chrono;
  if (parts.year < 0 || parts.month < 0 || parts.day < 0 || parts.hour < 0 || parts.hour > 23 ||
      parts.minute < 0 || parts.minute > 59 || parts.second < 0 || parts.second > 59)
    return {};
  const year_month_day date{year(parts.year), month(static_cast<unsigned>(parts.month)),
                            day(static_cast<unsigned>(parts.day))};
  if (!date.ok()) return {};
  const seconds since = sys_days(date).time_since_epoch();
  return since.count() + 3600LL * parts.hour + 60LL * parts.minute + parts.second;
}

std::vector<std::string> known_layouts() {
  std::vector<std::string> layouts;
  for (const char* date : {"%Y-%m-%d", "%Y/%m/%d", "%Y.%m.%d", "%d.%m.%Y", "%d/%m/%Y", "%m/%d/%Y",
                           "%d-%m-%Y", "%m-%d-%Y", "%d.%m.%y", "%d/%m/%y", "%m/%d/%y"}) {
    for (const char* time : {"", " %H:%M", " %H:%M:%S", "T%H:%M", "T%H:%M:%S"})
      layouts.push_back(std::string(date) + time);
  }
  return layouts;
}

bool begins_with_digit(const std::string& cell) {
  const std::string_view text = without_blanks(cell);
  return !text.empty() && text.front() >= '0' && text.front() <= '9';
}

std::size_t count_of_dates(const Column& column, const std::string& layout, std::size_t rows) {
  return static_cast<std::size_t>(
      std::count_if(column.text.begin(), column.text.begin() + static_cast<std::ptrdiff_t>(rows),
                    [&](const std::string& cell) { return date_in(cell, layout).has_value(); }));
}

}  // namespace

std::optional<long long> date_in(std::string_view text, std::string_view layout) {
  text = without_blanks(text);
  DateParts parts;
  for (std::size_t i = 0; i < layout.size(); ++i) {
    if (layout[i] == '%' && i + 1 < layout.size()) {
      take_field(text, layout[++i], parts);
      continue;
    }
    if (text.empty() || text.front() != layout[i]) return {};
    text.remove_prefix(1);
  }
  if (!text.empty()) return {};
  return seconds_of(parts);
}

std::vector<std::string> date_layouts(const Column& column) {
  constexpr std::size_t looked_at = 200;
  static const std::vector<std::string> known = known_layouts();
  if (column.is_number) return {};
  const std::size_t first = std::min(looked_at, column.text.size());
  std::vector<std::string> possible;
  if (std::none_of(column.text.begin(), column.text.begin() + static_cast<std::ptrdiff_t>(first),
                   begins_with_digit))
    return {};
  for (const std::string& each : known) {
    if (count_of_dates(column, each, first) > 0) possible.push_back(each);
  }
  std::size_t most = 0;
  std::vector<std::string> found;
  for (const std::string& each : possible) {
    const std::size_t dates = count_of_dates(column, each, column.text.size());
    if (dates > most) found.clear();
    most = std::max(most, dates);
    if (dates == most) found.push_back(each);
  }
  const auto absent = static_cast<std::size_t>(
      found.empty() ? 0 : std::count_if(column.text.begin(), column.text.end(), is_absent));
  return 2 * most >= column.text.size() - absent ? found : std::vector<std::string>();
}

std::string columns_of_dates(const Table& table) {
  std::vector<std::string> names;
  for (const Column& each : table.columns) {
    if (!date_layouts(each).empty())
      names.push_back(fmt::format("'{}'", printable(shortened(each.name))));
  }
  if (names.empty()) return "";
  constexpr std::size_t most = 5;
  const bool several = names.size() > 1, more = names.size() > most;
  if (more) names.resize(most);
  return fmt::format("column{} {}{} {}", several ? "s" : "", fmt::join(names, ", "),
                     more ? ", …" : "", several ? "are dates" : "holds dates");
}

std::string layout_words(std::string layout) {
  for (const auto& [field, word] :
       {std::pair("%d", "day"), std::pair("%m", "month"), std::pair("%Y", "year"),
        std::pair("%y", "year"), std::pair("%H", "hour"), std::pair("%M", "minute"),
        std::pair("%S", "second")}) {
    const std::size_t at = layout.find(field);
    if (at != layout.npos) layout.replace(at, 2, word);
  }
  return layout;
}

bool has_time_of_day(std::string_view layout) {
  return layout.find("%H") != layout.npos;
}

}  // namespace wearwell
