#pragma once

#include <string_view>

#include "wearwell/input/table.h"

namespace wearwell::formula_model {

/// A straight path fitted to readings, by least squares over all rows: orders of magnitude for a
/// first study.
struct StraightLine {
  bool begins_at_zero = true;
  bool falls = false;
  double rate = 1;  ///< its size, in the units of the columns; above 0
};

/// `unit`: the label of the units whose paths these are; null for one.
StraightLine straight_line(const Table& table, const Column& axis, const Column& measured,
                           const Column* unit);

/// Refuses rows that paths of this family cannot have. Paths of all families but "normal" are 0
/// where the axis is 0, and certain there; only those of a Wiener process fall below. Missing cells
/// are no matter here. Throws InputError that names row and column.
void require_rows_of_family(const Table& table, const Column& axis, const Column& measured,
                            std::string_view family);

}  // namespace wearwell::formula_model
