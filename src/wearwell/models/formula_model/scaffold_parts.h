#pragma once

#include <string>

#include "wearwell/study/column_roles.h"

namespace wearwell::formula_model {

/// "20 km"; a plain number of the unit "1", and 20e6 cycles of 20 "1e6 cycles".
std::string quantity_text(double value, const std::string& unit);

/// "um/(kN km)", of units and plain numbers.
std::string unit_of_ratio(const std::string& over, const std::vector<std::string>& under);

/// The column along which things wear: cycles, time or distance. Where it has several the question is asked.
std::optional<ColumnRoles::Found> take_axis(ColumnRoles& roles, const std::string& key);

/// Whether it has one.
bool has_axis(const ColumnRoles& roles);

/// The unit in which it counts: "cycles" where cycles are plain numbers.
std::string counting_unit(const ColumnRoles::Found& found);

/// The heading as a name in expressions where it is one, else `otherwise`.
std::string name_of(const Column& column, const std::string& otherwise);

/// A line of [data.columns] with its unit.
std::string column_line(const std::string& name, ColumnRoles::Found found);

/// The label whose rows are those of one unit, where its cells repeat. Where other columns may be it, and rows do not all
/// follow each other along `axis`, the question is asked.
std::optional<ColumnRoles::Found> take_units(ColumnRoles& roles, const Column& axis);

/// Whether the table has several rows of a unit.
bool has_units(const ColumnRoles& roles);

/// Whether the number differs between rows of one unit.
bool differs_within(const Table& table, const Column& column, const Column* unit);

}  // namespace wearwell::formula_model
