#include "wearwell/input/labelled.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"

namespace wearwell {
namespace {

/// "torque" of "torque [N m]".
std::string_view name_part(std::string_view heading) {
  std::string_view name = heading.substr(0, heading.find('['));
  while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
  return name;
}

}  // namespace

LabelledColumn find_labelled(const std::vector<std::string>& headings, std::string_view name,
                             std::string_view si, const std::string& source) {
  for (const std::string& heading : headings) {
    if (name_part(heading) != name) continue;
    const std::size_t open = heading.find('['), close = heading.rfind(']');
    if (open == std::string::npos || close == std::string::npos || close < open) {
      if (may_be_plain(si)) return {heading, Unit{"1", 1, 0}};
      throw InputError(
          fmt::format("{}, column '{}' has no unit: name it '{} [{}]'", source, heading, name, si));
    }
    try {
      return {heading, read_unit(heading.substr(open + 1, close - open - 1), si)};
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}, column '{}': {}", source, heading, error.what()));
    }
  }
  std::vector<std::string> names;
  for (const std::string& heading : headings) names.emplace_back(name_part(heading));
  const auto nearest = std::find(names.begin(), names.end(), nearest_name(name, names));
  throw InputError(fmt::format("{} has no column '{}{}' (nearest: '{}')", source, name,
                               may_be_plain(si) ? "" : fmt::format(" [{}]", si),
                               headings[static_cast<std::size_t>(nearest - names.begin())]));
}

LabelledColumn find_labelled(const Table& table, std::string_view name, std::string_view si) {
  std::vector<std::string> headings;
  for (const Column& column : table.columns) headings.push_back(column.name);
  return find_labelled(headings, name, si, table.source);
}

std::vector<double> labelled_numbers(const Table& table, std::string_view name,
                                     std::string_view si) {
  const LabelledColumn found = find_labelled(table, name, si);
  std::vector<double> values = si_numbers(table, found.heading, found.unit);
  for (std::size_t i = 0; si == "K" && i < values.size(); ++i) {
    if (values[i] < 0) {
      throw InputError(fmt::format("{}: {:.6g} is below absolute zero",
                                   place(table, found.heading, i), from_si(found.unit, values[i])));
    }
  }
  return values;
}

}  // namespace wearwell
