#include "wearwell/in_service/unit_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/heading.h"
#include "wearwell/input/labelled.h"

namespace wearwell::in_service {
namespace {

const std::vector<std::string> roles = {"unit", "age", "in_study", "life"};

bool has(const std::vector<std::string>& all, const std::string& name) {
  return std::find(all.begin(), all.end(), name) != all.end();
}

// Whether a heading has this name, with or without a unit.
bool names_it(const std::vector<std::string>& headings, const Condition& condition) {
  return std::any_of(headings.begin(), headings.end(), [&](const std::string& each) {
    return each == condition.name ||
           (!condition.si.empty() && read_heading(each, condition.si).name == condition.name);
  });
}

fleet::UnitColumn looked_up(const std::vector<std::string>& headings, const std::string& name,
                            const std::string& si, const std::string& source) {
  const ColumnChoice found = find_labelled(headings, name, si, source, "--columns");
  return {found.column, found.unit};
}

[[noreturn]] void fail_without(const char* name, const std::string& hint,
                               const std::vector<std::string>& headings,
                               const std::string& source) {
  std::vector<std::string> shown;
  constexpr std::size_t most_shown = 30;
  for (std::size_t i = 0; i < std::min(headings.size(), most_shown); ++i)
    shown.push_back("'" + printable(shortened(headings[i])) + "'");
  throw InputError(fmt::format("{} has no column '{}'; it has {}. State the column: --columns {}",
                               source, name, fmt::join(shown, ", "), hint));
}

}  // namespace

std::string unit_name_column(const std::vector<std::string>& options) {
  for (const std::string& each : options)
    if (each.starts_with("unit=")) return each.substr(5);
  return "unit";
}

UnitColumns read_unit_columns(const std::vector<std::string>& options,
                              const std::vector<fleet::EngineColumn>& known,
                              const std::vector<Condition>& conditions, const Unit& axis,
                              const std::string& source) {
  std::vector<std::string> names = roles, headings;
  for (const Condition& each : conditions)
    if (!has(names, each.name)) names.push_back(each.name);
  const auto given = fleet::split_columns(options, names);
  UnitColumns columns;
  for (const fleet::EngineColumn& each : known) {
    headings.push_back(each.name);
    if (each.text_decimal != 0) columns.text_decimal = each.text_decimal;
  }
  const auto text_of = [&](const char* name) -> std::string {
    const auto at = given.find(name);
    if (at == given.end()) return has(headings, name) ? name : "";
    fleet::require_column(known, at->second, source, false);
    return at->second;
  };
  columns.unit = text_of("unit");
  if (columns.unit.empty()) fail_without("unit", "unit=COLUMN", headings, source);
  columns.in_study = text_of("in_study");
  columns.life = text_of("life");
  const std::string age_hint = fmt::format("'age=COLUMN:{}'", axis.text);
  if (const auto at = given.find("age"); at != given.end()) {
    columns.age = fleet::column_with_unit("age", at->second, axis.text);
  } else {
    if (!names_it(headings, {"age", axis.text})) fail_without("age", age_hint, headings, source);
    columns.age = looked_up(headings, "age", axis.text, source);
    // Counts may stand without a unit; here they could be of lives or of single cycles.
    if (read_heading(columns.age.column, axis.text).unit.empty())
      throw InputError(fmt::format("{}: the column '{}' has no unit: write --columns {}", source,
                                   printable(columns.age.column), age_hint));
  }
  fleet::require_column(known, columns.age.column, source, true);
  for (const Condition& each : conditions) {
    if (has(roles, each.name)) continue;  // unit, age: taken
    const auto at = given.find(each.name);
    if (at == given.end() && (each.name == columns.unit || !names_it(headings, each))) continue;
    fleet::UnitColumn column;
    if (each.si.empty()) {
      column.column = at == given.end() ? each.name : at->second;
    } else {
      column = at == given.end() ? looked_up(headings, each.name, each.si, source)
                                 : fleet::column_with_unit(each.name, at->second, each.si);
    }
    fleet::require_column(known, column.column, source, !each.si.empty());
    columns.conditions.push_back({each, std::move(column)});
  }
  return columns;
}

}  // namespace wearwell::in_service
