#include "wearwell/study/first_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"

namespace wearwell {
namespace {

struct Named {
  std::string name, unit;  // the unit empty where the heading has none of the dimension
};

bool is_unit(const std::string& text, std::string_view si) {
  if (text.empty()) return false;
  try {
    read_unit(text, si);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::string plain_powers(std::string text) {
  for (const auto& [raised, plain] : {std::pair{"²", "^2"}, {"³", "^3"}, {"µ", "u"}, {"μ", "u"}}) {
    for (std::size_t at; (at = text.find(raised)) != text.npos;)
      text.replace(at, std::string_view(raised).size(), plain);
  }
  return text;
}

// "volume [mm³]", "volume (mm³)", "volume / mm³", "volume in mm³", "volume_mm3".
Named named(const std::string& heading, std::string_view si) {
  const auto split = [&](std::size_t name_end, std::size_t begin, std::size_t end) {
    Named result{heading.substr(0, name_end), plain_powers(heading.substr(begin, end - begin))};
    if (!is_unit(result.unit, si)) result.unit.clear();
    return result;
  };
  for (const auto& [open, close] : {std::pair{'[', ']'}, {'(', ')'}}) {
    const std::size_t begin = heading.find(open), end = heading.rfind(close);
    if (begin != heading.npos && end != heading.npos && begin < end)
      return split(begin, begin + 1, end);
  }
  for (const std::string_view separator : {" / ", " in ", ", ", "/", "_", " "}) {
    for (std::size_t at = heading.find(separator); at != heading.npos && at > 0;
         at = heading.find(separator, at + 1)) {
      const Named result = split(at, at + separator.size(), heading.size());
      if (!result.unit.empty() && result.unit.find_first_not_of("0123456789") != std::string::npos)
        return result;
    }
  }
  return {heading, ""};
}

// In lower case, with one blank for whatever is neither letter nor digit, and one at either end.
std::string in_words(std::string_view text) {
  std::string words = " ";
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) || u >= 0x80) {
      words += static_cast<char>(std::tolower(u));
    } else if (words.back() != ' ') {
      words += ' ';
    }
  }
  return words.back() == ' ' ? words : words + ' ';
}

// Words as words; long ones also within others, as languages put words together.
bool is_called(const std::string& heading, std::string_view name) {
  constexpr std::size_t telling = 5;
  const std::string words = in_words(heading), wanted = in_words(name);
  if (words.find(wanted) != words.npos) return true;
  return name.size() >= telling && words.find(wanted.substr(1, wanted.size() - 2)) != words.npos;
}

bool has_numbers(const Column& column) {
  return column.is_number || !values_of(column).empty();
}

}  // namespace

std::vector<double> values_of(const Column& column) {
  std::vector<double> values;
  const std::size_t rows = column.is_number ? column.numbers.size() : column.text.size();
  for (std::size_t i = 0; i < rows; ++i) {
    double value = NAN;
    if (column.is_number) {
      value = column.numbers[i];
    } else {
      try {
        value = read_quantity(column.text[i], "1").si();
      } catch (const InputError&) {
        continue;
      }
    }
    if (std::isfinite(value)) values.push_back(value);
  }
  return values;
}

std::string toml_text(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

HeadingGuesses::HeadingGuesses(const Table& table) : table_(table) {}

const Column* HeadingGuesses::find(std::string_view si, const std::vector<std::string_view>& names,
                                   bool numbers, std::string& unit) const {
  for (const std::string_view name : names) {
    for (const Column& column : table_.columns) {
      if (std::find(used_.begin(), used_.end(), &column) != used_.end()) continue;
      if (numbers && !has_numbers(column)) continue;
      const Named heading = named(column.name, si);
      if (!is_called(heading.name, name)) continue;
      unit = heading.unit;
      return &column;
    }
  }
  return nullptr;
}

bool HeadingGuesses::has(std::string_view si, const std::vector<std::string_view>& names) const {
  std::string unit;
  return find(si, names, true, unit) != nullptr;
}

std::optional<HeadingGuesses::Found> HeadingGuesses::take(
    const char* what, std::string_view si, std::string_view usual,
    const std::vector<std::string_view>& names, bool numbers) {
  Found found;
  std::string unit;
  found.column = find(si, names, numbers, unit);
  if (!found.column) return {};
  used_.push_back(found.column);
  found.unit_guessed = unit.empty() && !may_be_plain(si);
  found.unit = unit.empty() ? std::string(usual) : unit;
  taken.push_back(fmt::format("{}: column '{}'{}", what, found.column->name,
                              found.unit == "1" ? "" : " in " + found.unit));
  if (found.unit_guessed)
    guesses.push_back(fmt::format("column '{}' has no unit in its heading: {} is a guess",
                                  found.column->name, found.unit));
  return found;
}

std::string HeadingGuesses::line(const std::string& name, const Found& found) {
  if (found.unit == "1") return fmt::format("{} = {}\n", name, toml_text(found.column->name));
  return fmt::format("{} = {{ column = {}, unit = {} }}{}\n", name, toml_text(found.column->name),
                     toml_text(found.unit), found.unit_guessed ? "    # the unit is a GUESS" : "");
}

std::vector<std::string> HeadingGuesses::left() const {
  std::vector<std::string> names;
  for (const Column& column : table_.columns) {
    if (std::find(used_.begin(), used_.end(), &column) == used_.end()) names.push_back(column.name);
  }
  return names;
}

}  // namespace wearwell
