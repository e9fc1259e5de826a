#include "wearwell/study/first_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"
#include "wearwell/input/heading.h"

namespace wearwell {
namespace {

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

// What stands in the last brackets of a heading.
std::string bracketed(const std::string& heading) {
  const std::size_t close = heading.find_last_of("])");
  if (close == heading.npos) return "";
  const std::size_t open = heading.rfind(heading[close] == ']' ? '[' : '(', close);
  return open == heading.npos ? "" : bare_unit(heading.substr(open + 1, close - open - 1));
}

// Name and unit of a heading; no unit where it has none of the dimension. Words may stand behind
// brackets, and a unit behind a blank alone.
Heading named(const std::string& heading, std::string_view si) {
  const std::size_t close = heading.find_last_of("])");
  const bool brackets = close != heading.npos && heading.find_first_of("[(") < close;
  Heading found = read_heading(heading, si);
  if (brackets && found.unit.empty()) found = read_heading(heading.substr(0, close + 1), si);
  found.unit = plain_powers(found.unit);
  if (found.certain && !is_unit(found.unit, si)) found.unit.clear();
  if (brackets || !found.unit.empty()) return found;
  for (std::size_t at = heading.find(' '); at != heading.npos && at > 0;
       at = heading.find(' ', at + 1)) {
    const std::string unit = plain_powers(heading.substr(at + 1));
    if (unit.find_first_not_of("0123456789") != unit.npos && is_unit(unit, si))
      return {heading.substr(0, at), unit};
  }
  return found;
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
      const Heading heading = named(column.name, si);
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
  const std::string brackets = unit.empty() ? bracketed(found.column->name) : "";
  if (!brackets.empty() && found.column->unit.empty()) {
    try {
      read_unit(brackets, si);
    } catch (const InputError& error) {
      if (!may_be_plain(si)) {
        taken.push_back(fmt::format("{}: column '{}'", what, found.column->name));
        unstated.push_back(fmt::format("column '{}': {}", found.column->name, error.what()));
        return found;
      }
    }
  }
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

std::string HeadingGuesses::unstated_line(const std::string& name, const std::string& what,
                                          const std::string& like) {
  unstated.push_back(fmt::format("{}: {}, like {}", name, what, toml_text(like)));
  return fmt::format("{} = {}    # STATE IT: {}, like {}\n", name, toml_text(not_stated), what,
                     toml_text(like));
}

FirstStudy HeadingGuesses::study(std::string text) const {
  FirstStudy study{std::move(text), taken, guesses, unstated};
  for (const Column& column : table_.columns) {
    if (std::find(used_.begin(), used_.end(), &column) == used_.end())
      study.guesses.push_back(fmt::format("column '{}' is not used", column.name));
  }
  return study;
}

}  // namespace wearwell
