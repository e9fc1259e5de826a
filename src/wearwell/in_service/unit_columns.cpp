#include "wearwell/in_service/unit_columns.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/in_service/table_headings.h"
#include "wearwell/input/heading.h"

namespace wearwell::in_service {
namespace {

const std::vector<std::string> roles = {"unit", "age", "in_study", "life"};

bool has(const std::vector<std::string>& all, const std::string& name) {
  return std::find(all.begin(), all.end(), name) != all.end();
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
  if (columns.unit.empty()) fail_without_column("unit", "unit=COLUMN", headings, source);
  columns.in_study = text_of("in_study");
  columns.life = text_of("life");
  const std::string age_hint = fmt::format("'age=COLUMN:{}'", axis.text);
  if (const auto at = given.find("age"); at != given.end()) {
    columns.age = fleet::column_with_unit("age", at->second, axis.text);
  } else {
    if (!has_column(headings, "age", axis.text))
      fail_without_column("age", age_hint, headings, source);
    columns.age = column_by_heading(headings, "age", axis.text, source);
    // Counts may stand without a unit; here they could be of lives or of single cycles.
    if (read_heading(columns.age.column, axis.text).unit.empty())
      throw InputError(fmt::format("{}: the column '{}' has no unit: write --columns {}", source,
                                   printable(columns.age.column), age_hint));
  }
  fleet::require_column(known, columns.age.column, source, true);
  for (const Condition& each : conditions) {
    if (has(roles, each.name)) continue;  // unit, age: taken
    const auto at = given.find(each.name);
    if (at == given.end() &&
        (each.name == columns.unit || !has_column(headings, each.name, each.si)))
      continue;
    fleet::UnitColumn column;
    if (each.si.empty()) {
      column.column = at == given.end() ? each.name : at->second;
    } else {
      column = at == given.end() ? column_by_heading(headings, each.name, each.si, source)
                                 : fleet::column_with_unit(each.name, at->second, each.si);
    }
    fleet::require_column(known, column.column, source, !each.si.empty());
    columns.conditions.push_back({each, std::move(column)});
  }
  return columns;
}

}  // namespace wearwell::in_service
