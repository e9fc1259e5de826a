#include "wearwell/input/month_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <vector>

#include "wearwell/input/life_status.h"

namespace wearwell {
namespace {

constexpr int months_of_year = 12;

// In folded form, January first.
constexpr std::array<std::array<std::string_view, months_of_year>, 4> month_names = {
    {{"january", "february", "march", "april", "may", "june", "july", "august", "september",
      "october", "november", "december"},
     {"januar", "februar", "marz", "april", "mai", "juni", "juli", "august", "september", "oktober",
      "november", "dezember"},
     {"janvier", "fevrier", "mars", "avril", "mai", "juin", "juillet", "aout", "septembre",
      "octobre", "novembre", "decembre"},
     {"enero", "febrero", "marzo", "abril", "mayo", "junio", "julio", "agosto", "septiembre",
      "octubre", "noviembre", "diciembre"}}};

// From 1: by a beginning of three letters or more that all languages read alike.
std::optional<int> month_by_name(const std::string& letters) {
  constexpr std::size_t shortest = 3;
  if (letters == "mrz" || letters == "maerz") return 3;
  if (letters.size() < shortest) return {};
  std::optional<int> found;
  for (const auto& names : month_names) {
    for (int m = 0; m < months_of_year; ++m) {
      if (!names[static_cast<std::size_t>(m)].starts_with(letters)) continue;
      if (found && *found != m + 1) return {};
      found = m + 1;
    }
  }
  return found;
}

bool is_digit_of_month(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

// Runs of digits and of letters; other characters separate them.
std::vector<std::string> month_tokens(std::string_view text) {
  std::vector<std::string> tokens;
  char last = 0;
  for (const char c : text) {
    const bool letter = std::isalpha(static_cast<unsigned char>(c)) || (c & 0x80);
    const char kind = is_digit_of_month(c) ? 'd' : letter ? 'l' : 0;
    if (kind && kind != last) tokens.emplace_back();
    if (kind) tokens.back() += c;
    last = kind;
  }
  return tokens;
}

std::optional<int> month_number(const std::string& token) {
  int value = 0;
  const auto [rest, failure] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (failure != std::errc{} || rest != token.data() + token.size()) return {};
  return value;
}

std::optional<int> month_of_year(int year, int month) {
  constexpr int first = 1900, last = 2199;
  if (year < first || year > last || month < 1 || month > months_of_year) return {};
  return year * months_of_year + month - 1;
}

bool is_day_of_month(int year, int month, int day) {
  using namespace std::chrono;
  return month > 0 && day > 0 &&
         year_month_day{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                        std::chrono::day(static_cast<unsigned>(day))}
             .ok();
}

int whole_year(int year, std::size_t digits) {
  constexpr int century = 100, turn = 70;
  if (digits > 2) return year;
  return year < turn ? 2000 + year % century : 1900 + year;
}

// 31.01.2024, 31/01/2024 and 01/31/2024. Between points the day is first; elsewhere only a number
// above 12 tells the day.
std::optional<int> month_with_day(std::string_view text, const std::vector<std::string>& tokens) {
  if (tokens[0].size() > 2 || tokens[1].size() > 2 || tokens[2].size() != 4) return {};
  const int first = *month_number(tokens[0]), second = *month_number(tokens[1]);
  const int year = *month_number(tokens[2]);
  const bool points = text.find('.') == tokens[0].size();
  if (!points && first <= months_of_year && second <= months_of_year && first != second) return {};
  const bool month_first = !points && second > months_of_year;
  const int month = month_first ? first : second, day = month_first ? second : first;
  return is_day_of_month(year, month, day) ? month_of_year(year, month) : std::nullopt;
}

}  // namespace

std::optional<int> month_in(std::string_view text) {
  constexpr std::size_t year_digits = 4, compact_digits = 6;
  const std::vector<std::string> tokens = month_tokens(text);
  if (tokens.empty() || !(is_digit_of_month(text.front()) || tokens[0].front() == text.front()))
    return {};
  const auto number = [&](std::size_t i) { return month_number(tokens[i]); };
  if (tokens.size() == 1) {
    if (tokens[0].size() != compact_digits || !number(0)) return {};
    return month_of_year(*number(0) / 100, *number(0) % 100);
  }
  const auto first = number(0), second = number(1);
  // With a day, and the time of a spreadsheet.
  if (first && second && tokens[0].size() == year_digits && tokens[1].size() <= 2) {
    // A spreadsheet makes the number 2024.1 of 2024.10.
    if (tokens[1].size() == 1 && text.find('.') != text.npos) return {};
    const bool day =
        tokens.size() >= 3 && number(2) && is_day_of_month(*first, *second, *number(2));
    return tokens.size() == 2 || day ? month_of_year(*first, *second) : std::nullopt;
  }
  if (tokens.size() >= 3 && first && second && number(2)) return month_with_day(text, tokens);
  if (tokens.size() != 2) return {};
  if (first && second)
    return tokens[1].size() == year_digits && tokens[0].size() <= 2 ? month_of_year(*second, *first)
                                                                    : std::nullopt;
  if (!first && second && (tokens[1].size() == year_digits || tokens[1].size() == 2)) {
    const auto named = month_by_name(letters_of(tokens[0]));
    return named ? month_of_year(whole_year(*second, tokens[1].size()), *named) : std::nullopt;
  }
  if (first && !second && tokens[0].size() == year_digits) {
    const auto named = month_by_name(letters_of(tokens[1]));
    return named ? month_of_year(*first, *named) : std::nullopt;
  }
  return {};
}

std::string month_text(int month) {
  return fmt::format("{:04}-{:02}", month / months_of_year, month % months_of_year + 1);
}

}  // namespace wearwell
