#include "wearwell/study/wide_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "wearwell/input/quoted.h"
#include "wearwell/study/heading_words.h"
#include "wearwell/study/role_words.h"

namespace wearwell {
namespace {

constexpr std::size_t least_units = 3;

// "pump" for "Pump 12" and "pump B", "" for "3"; empty optional if the heading does not end with a
// number or a single letter.
std::optional<std::string> stem_of(const std::string& heading) {
  std::string words = plain_words(heading);
  while (!words.empty() && words.back() == ' ') words.pop_back();
  std::size_t end = words.size();
  while (end > 0 && std::isdigit(static_cast<unsigned char>(words[end - 1]))) --end;
  if (end == words.size()) {  // a single letter
    if (end < 2 || words[end - 2] != ' ') return {};
    --end;
  }
  while (end > 0 && words[end - 1] == ' ') --end;
  const std::size_t begin = words.find_first_not_of(' ');
  return begin < end ? words.substr(begin, end - begin) : "";
}

bool is_word_of(std::string_view role, const std::string& text) {
  const auto& words = role_form(role).words;
  return std::any_of(words.begin(), words.end(),
                     [&](const RoleWord& each) { return is_exactly(text, each.text); });
}

// T1, T2, T3 are temperatures.
bool is_symbol(const std::string& stem) {
  const auto& forms = role_forms();
  return std::any_of(forms.begin(), forms.end(), [&](const RoleForm& each) {
    return each.name != "unit" && is_word_of(each.name, stem);
  });
}

bool names_units(const std::string& stem) {
  constexpr std::size_t letters = 3;
  if (stem.size() <= letters && stem.find(' ') == stem.npos) return !is_symbol(stem);
  return is_word_of("unit", stem);
}

bool is_along(const Column& column) {
  for (const char* role : {"time", "distance", "cycles"}) {
    const RoleForm& form = role_form(role);
    for (const std::string_view si : form.si) {
      const NameAndUnit found = name_and_unit(column, si);
      if (!found.unit.empty() && si != "1") return true;
      if (std::any_of(form.words.begin(), form.words.end(),
                      [&](const RoleWord& each) { return is_called(found.name, each.text); }))
        return true;
    }
  }
  return false;
}

// The column under its own heading, with the unit from elsewhere.
std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
}

}  // namespace

std::optional<WideTable> wide_table(const Table& table) {
  std::vector<const Column*> numbers;
  for (const Column& column : table.columns) {
    if (!column.is_number)
      return {};  // a word column shows that rows are not readings of several
                  // units
    numbers.push_back(&column);
  }
  if (numbers.size() < least_units + 1) return {};
  const Column* along = nullptr;
  std::vector<const Column*> units;
  for (const Column* each : numbers) {
    if (!along && is_along(*each)) {
      along = each;
    } else {
      units.push_back(each);
    }
  }
  if (!along || units.size() + 1 != numbers.size()) return {};
  const auto stem = [](const Column* column) { return stem_of(name_and_unit(*column, "").name); };
  const auto first = stem(units.front());
  const std::string unit = stated_unit(*units.front());
  if (!first || !names_units(*first)) return {};
  for (const Column* each : units) {
    if (stem(each) != first || stated_unit(*each) != unit) return {};
  }
  WideTable wide{along->name, {}, {}};
  std::vector<std::string> names;
  for (const Column* each : units) {
    wide.units.push_back(each->name);
    names.push_back(quoted(each->name, '"'));
  }
  const std::string value = quoted(with_unit("value", unit), '"');
  wide.sql = fmt::format(
      "select {0} as {1}, unit, {2} from data unpivot ({2} for unit in ({3}))",
      quoted(along->name, '"'),
      quoted(along->unit.empty() ? along->name : with_unit(along->name, along->unit), '"'), value,
      fmt::join(names, ", "));
  return wide;
}

}  // namespace wearwell
