#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "wearwell/formula/graph.h"
#include "wearwell/formula/kernels.h"

namespace wearwell::formula {

/// The storage of a node's values.
struct Cell {
  enum Home : unsigned char { number, data, row, by_row, level };
  Home home = number;
  int slot = 0;  ///< index within its storage; first index for a level, -1 for entries of the
                 ///< parameters
  bool uniform() const { return home == number; }
};

/// One operation on cells.
struct Step {
  Op op = Op::constant;
  Kernels kernels;
  int out = -1, a = -1, b = -1, c = -1;  ///< cells
  double extra = 0;
  int run = -1;        ///< index of a running value (cum, state, recurrence)
  int label = -1;      ///< expand
  int levels = 0;      ///< of the label: expand, and steps by label
  unsigned gives = 0;  ///< bit i: argument i takes an adjoint
  unsigned first = 0;  ///< bit i: argument i takes its first adjoint here, in backward order
};

/// A column of the data that is not the result of a step.
struct DataLeaf {
  Op op = Op::column;  ///< column, label_is, step
  int cell = -1, index = -1, level = -1;
};

/// A parameter's value: an entry of the parameter vector, or a pointer to rows.
struct ParameterLeaf {
  int cell = -1, slot = -1;
};

/// The beginning of a state.
struct StateStart {
  int axis = -1;  ///< the column
  bool at_first_row = false;
  double at = 0;  ///< on the axis, SI
};

/// A state whose rate depends on the state or the axis, computed sequentially.
struct StatePlan {
  int out = -1, beginning = -1, axis = -1;  ///< cells
  std::vector<int> inputs;                  ///< cells that the rate depends on
  std::vector<bool> gives, first;           ///< of each input, as in Step
  bool beginning_gives = false, beginning_first = false;
  // The rate on numbers: state, axis, inputs, constants, then one result per step.
  std::vector<Step> steps;
  std::vector<double> numbers;  ///< initial values of all numbers of the rate
  int state = -1, running = -1, result = -1;
  int first_input = 0;
  // The rate as factor * shape, where the shape does not depend on the axis (rate_factor.h):
  int factor = -1;                 ///< the number of the factor, -1 for 1
  int shape = -1;                  ///< the number of the shape, -1 if paths share no trajectory
  std::vector<Step> shape_steps;   ///< the steps of the shape
  std::vector<bool> shape_inputs;  ///< the inputs of the shape
};

struct OutputCell {
  int cell = -1;
  bool active = false;  ///< takes adjoints
  bool owner = false;   ///< owns the adjoints of the cell; other outputs of the cell add to them
};

/// A program for the kernels (kernels.h). Data steps run once when rows are bound, number steps
/// once per call, row steps on all rows of a call.
struct Tape {
  std::vector<Cell> cells;
  std::vector<double> numbers;         ///< initial values: the constants
  int data = 0, rows = 0, levels = 0;  ///< numbers of slots
  std::vector<ParameterLeaf> parameters, by_row, by_level;
  std::vector<DataLeaf> leaves;
  std::vector<Step> bind_steps, number_steps, level_steps, row_steps;
  std::vector<OutputCell> outputs;
  std::vector<StatePlan> states;  ///< at most one; run by Op::state among the row steps
  int state = -1;                 ///< the cell of the state; -1 without one
  bool has_paths = false;
  // For a continuable program:
  std::vector<int> runs;  ///< cells of running values
  bool sums = false;      ///< `cum` as it is written, which counts rows
  bool nested = false;    ///< a running value depends on another one
};

/// `graph` and `roots` come from `regrouped`. `continued`: running values are computed in each
/// call, never when rows are bound.
Tape make_tape(const Graph& graph, const std::vector<int>& roots, const Symbols& symbols,
               const StateStart& start, bool continued = false);

}  // namespace wearwell::formula
