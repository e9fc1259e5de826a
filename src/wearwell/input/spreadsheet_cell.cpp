#include "wearwell/input/spreadsheet_cell.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

namespace wearwell {
namespace {

constexpr double last_day = 2958466;  // after 9999-12-31
constexpr std::size_t most_columns = 16'384, most_rows = 1'048'576;

bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

std::string clock(long long seconds) {
  return fmt::format("{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60);
}

std::string day(long long serial, bool from_1904) {
  using namespace std::chrono;
  // Day 60 of 1900 is the nonexistent February 29 of spreadsheets.
  const sys_days zero = from_1904     ? sys_days(year(1904) / 1 / 1)
                        : serial < 60 ? sys_days(year(1899) / 12 / 31)
                                      : sys_days(year(1899) / 12 / 30);
  const year_month_day date(zero + days(serial));
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

}  // namespace

CellFormat built_in_format(int number) {
  if (number == 9 || number == 10) return CellFormat::percent;
  if ((number >= 14 && number <= 17) || (number >= 27 && number <= 31) ||
      (number >= 50 && number <= 58) || number == 36)
    return CellFormat::date;
  if ((number >= 18 && number <= 21) || (number >= 32 && number <= 35)) return CellFormat::time;
  if (number == 22) return CellFormat::date_and_time;
  if (number >= 45 && number <= 47) return CellFormat::duration;
  return CellFormat::number;
}

CellFormat format_of_code(std::string_view code) {
  bool days = false, hours = false, months_or_minutes = false, percent = false;
  code = code.substr(0, code.find(';'));  // the format of positive numbers
  for (std::size_t i = 0; i < code.size(); ++i) {
    const char c = code[i];
    if (c == '"') {
      i = std::min(code.find('"', i + 1), code.size());
    } else if (c == '\\' || c == '_' || c == '*') {
      ++i;
    } else if (c == '[') {
      const std::size_t end = std::min(code.find(']', i), code.size());
      const std::string_view inside = code.substr(i + 1, end - i - 1);
      if (!inside.empty() && inside.find_first_not_of("hmsHMS") == inside.npos)
        return CellFormat::duration;
      i = end;
    } else if (code.substr(i).starts_with("General") || code.substr(i).starts_with("Standard")) {
      break;
    } else {
      days = days || c == 'd' || c == 'y' || c == 'D' || c == 'Y';
      hours = hours || c == 'h' || c == 's' || c == 'H' || c == 'S';
      months_or_minutes = months_or_minutes || c == 'm' || c == 'M';
      percent = percent || c == '%';
    }
  }
  if (days && hours) return CellFormat::date_and_time;
  if (hours) return CellFormat::time;
  if (days || months_or_minutes) return CellFormat::date;
  return percent ? CellFormat::percent : CellFormat::number;
}

std::string formatted(const std::string& number, CellFormat format, bool from_1904) {
  if (format == CellFormat::number) return number;
  double value = 0;
  const auto [end, failure] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (failure != std::errc{} || end != number.data() + number.size()) return number;
  if (format == CellFormat::percent) return fmt::format("{:.12g} %", 100 * value);
  if (!(value >= 0 && value < last_day)) return "#####";  // as in spreadsheets
  const auto seconds = static_cast<long long>(std::llround(value * 86'400));
  if (format == CellFormat::duration) return clock(seconds);
  const bool has_time = seconds % 86'400 != 0;
  if (format == CellFormat::time && seconds < 86'400) return clock(seconds);
  const std::string date = day(seconds / 86'400, from_1904);
  return format == CellFormat::date && !has_time ? date : date + " " + clock(seconds % 86'400);
}

CellName read_cell_name(std::string_view text, std::string_view& rest) {
  CellName name;
  std::size_t i = 0;
  if (i < text.size() && text[i] == '$') ++i;
  for (; i < text.size() && is_letter(text[i]) && name.column <= most_columns; ++i)
    name.column = 26 * name.column + static_cast<std::size_t>((text[i] & ~0x20) - 'A' + 1);
  if (i < text.size() && text[i] == '$') ++i;
  for (; i < text.size() && text[i] >= '0' && text[i] <= '9' && name.row <= most_rows; ++i)
    name.row = 10 * name.row + static_cast<std::size_t>(text[i] - '0');
  rest = text.substr(i);
  return name;
}

std::string column_letters(std::size_t column) {
  std::string letters;
  for (; column > 0; column = (column - 1) / 26)
    letters.insert(letters.begin(), static_cast<char>('A' + (column - 1) % 26));
  return letters;
}

}  // namespace wearwell
