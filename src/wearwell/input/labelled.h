#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/table.h"

namespace wearwell {

/// A column whose heading carries its unit: "torque [N m]".
struct LabelledColumn {
  std::string heading;
  Unit unit;
};

/// The heading among `headings` that is "name [unit]" with a unit of the dimension of `si`; where
/// a plain number will do so will the name alone. Throws InputError that names `source` and the nearest
/// heading, or the unit that is missing or wrong.
LabelledColumn find_labelled(const std::vector<std::string>& headings, std::string_view name,
                             std::string_view si, const std::string& source);
LabelledColumn find_labelled(const Table& table, std::string_view name, std::string_view si);

/// The column's values in SI. Throws InputError as find_labelled and si_numbers do.
std::vector<double> labelled_numbers(const Table& table, std::string_view name,
                                     std::string_view si);

}  // namespace wearwell
