#pragma once

#include <string>

#include "wearwell/study/column_roles.h"

namespace wearwell::formula_model {

/// "20 km"; a plain number for the unit "1", and 20e6 cycles for 20 "1e6 cycles".
std::string quantity_text(double value, const std::string& unit);

/// "um/(kN km)", from units and plain numbers.
std::string unit_of_ratio(const std::string& over, const std::vector<std::string>& under);

/// The axis of wear: cycles, time or distance. If there are several candidates, asks the question.
std::optional<ColumnRoles::Found> take_axis(ColumnRoles& roles, const std::string& key);

/// Whether there is one.
bool has_axis(const ColumnRoles& roles);

/// Its unit: "cycles" where cycles are plain numbers.
std::string counting_unit(const ColumnRoles::Found& found);

/// The heading if it is a valid name in expressions, else `otherwise`.
std::string name_of(const Column& column, const std::string& otherwise);

/// A line of [data.columns] with its unit.
std::string column_line(const std::string& name, ColumnRoles::Found found);

/// The label that identifies units, if its cells repeat. If other columns are candidates, and the
/// rows do not form one series along `axis`, asks the question.
std::optional<ColumnRoles::Found> take_units(ColumnRoles& roles, const Column& axis);

/// Whether the table has several rows per unit.
bool has_units(const ColumnRoles& roles);

/// Whether the number varies between rows of one unit.
bool differs_within(const Table& table, const Column& column, const Column* unit);

}  // namespace wearwell::formula_model
