#pragma once

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

}  // namespace wearwell::formula_model
