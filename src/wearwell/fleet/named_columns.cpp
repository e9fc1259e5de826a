#include "wearwell/fleet/named_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/heading.h"

namespace wearwell::fleet {

std::string_view usual_unit(std::string_view si) {
  return si == "K" ? "degC" : si;
}

std::map<std::string, std::string> split_columns(const std::vector<std::string>& options,
                                                 const std::vector<std::string>& names) {
  std::map<std::string, std::string> given;
  for (const std::string& option : options) {
    const std::size_t equals = option.find('=');
    const std::string name = option.substr(0, equals);
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(fmt::format("--columns: '{}' is unknown; use one of {} (nearest: '{}')",
                                   printable(name), fmt::join(names, ", "),
                                   nearest_name(name, names)));
    if (equals == std::string::npos || equals + 1 == option.size())
      throw InputError(fmt::format("--columns: '{0}' has no column: write '{0}=COLUMN'", name));
    if (!given.emplace(name, option.substr(equals + 1)).second)
      throw InputError(fmt::format("--columns: '{}' occurs twice", name));
  }
  return given;
}

void require_column(const std::vector<EngineColumn>& known, const std::string& column,
                    const std::string& source, bool is_number) {
  if (known.empty()) return;
  std::vector<std::string> all;
  for (const auto& each : known) all.push_back(each.name);
  const auto at = std::find(all.begin(), all.end(), column);
  if (at == all.end())
    throw InputError(fmt::format("{} has no column '{}' (nearest: '{}')", source, printable(column),
                                 printable(nearest_name(column, all))));
  const EngineColumn& found = known[static_cast<std::size_t>(at - all.begin())];
  if (is_number && !found.is_number && found.text_decimal == 0)
    throw InputError(
        fmt::format("{}: column '{}' does not hold numbers", source, printable(column)));
}

UnitColumn column_with_unit(const std::string& name, const std::string& text,
                            const std::string& si) {
  const std::size_t colon = text.rfind(':');
  const std::string column = text.substr(0, colon);
  std::string unit = colon == std::string::npos ? "" : text.substr(colon + 1);
  if (column.empty()) throw InputError(fmt::format("--columns: '{}' has no column", name));
  const Heading heading = read_heading(column, si);
  if (unit.empty() && !heading.certain)
    throw InputError(fmt::format("--columns: '{0}={1}' has no unit: write '{0}={2}:{3}'", name,
                                 printable(text), printable(column), usual_unit(si)));
  const Unit read = read_unit(unit.empty() ? heading.unit : unit, si);
  if (!unit.empty() && heading.certain) {
    const Unit other = read_unit(heading.unit, si);
    if (other.scale != read.scale || other.offset != read.offset)
      throw InputError(
          fmt::format("--columns: '{}' has the unit '{}' in its name and '{}' after the colon",
                      printable(column), heading.unit, printable(unit)));
  }
  return {column, read, !heading.certain};
}

std::string number_cell(const std::string& name, char text_decimal) {
  if (text_decimal == 0) return name;
  if (text_decimal == '.') return fmt::format("try_cast({} as double)", name);
  // A point would be one of thousands, or of another country.
  return fmt::format(
      "case when not contains({0}, '.') then try_cast(replace({0}, ',', '.') as double) end", name);
}

}  // namespace wearwell::fleet
