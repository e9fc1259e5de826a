#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "wearwell/formula/graph.h"
#include "wearwell/formula/kernels.h"

namespace wearwell::formula {

/// Where the values of a node live.
struct Cell {
  enum Home : unsigned char { number, data, row, by_row, level };
  Home home = number;
  int slot = 0;  ///< within its home; of a level its first place, -1 for slots of the parameters
  bool uniform() const { return home == number; }
};

/// One operation on cells.
struct Step {
  Op op = Op::constant;
  Kernels kernels;
  int out = -1, a = -1, b = -1, c = -1;  ///< cells
  double extra = 0;
  int run = -1;        ///< of what runs along a path (cum, state, recurrence): which
  int label = -1;      ///< expand
  int levels = 0;      ///< of the label: expand, and steps by label
  unsigned gives = 0;  ///< bit i: argument i takes an adjoint
  unsigned first = 0;  ///< bit i: and is the first to take one, walking backwards
};

/// A column of the data that is no result of a step.
struct DataLeaf {
  Op op = Op::column;  ///< column, label_is, step
  int cell = -1, index = -1, level = -1;
};

/// A parameter's value: a slot of the vector of parameters, or a pointer to rows.
struct ParameterLeaf {
  int cell = -1, slot = -1;
};

/// Where and how a state begins.
struct StateStart {
  int axis = -1;  ///< the column
  bool at_first_row = false;
  double at = 0;  ///< on the axis, SI
};

/// A state whose rate depends on itself or on the axis: one number after the other.
struct StatePlan {
  int out = -1, beginning = -1, axis = -1;  ///< cells
  std::vector<int> inputs;                  ///< cells that the rate depends on
  std::vector<bool> gives, first;           ///< of each input, as in Step
  bool beginning_gives = false, beginning_first = false;
  // The rate on numbers: state, axis, inputs, constants, then a result a step.
  std::vector<Step> steps;
  std::vector<double> numbers;  ///< initial values of all numbers of the rate
  int state = -1, running = -1, result = -1;
  int first_input = 0;
  // The rate as factor * shape, where the shape does not depend on the axis (rate_factor.h):
  int factor = -1;                 ///< the number of the factor, -1 for 1
  int shape = -1;                  ///< the number of the shape, -1 where paths share nothing
  std::vector<Step> shape_steps;   ///< those of `steps` that make it
  std::vector<bool> shape_inputs;  ///< the inputs that it depends on
};

struct OutputCell {
  int cell = -1;
  bool active = false;  ///< takes adjoints
  bool owner = false;   ///< its adjoints are those of the cell; another output of it adds to them
};

/// A program for the machine in kernels.h. Steps of the data run once when rows are bound, those of
/// numbers once a call, those of rows on all rows of a call.
struct Tape {
  std::vector<Cell> cells;
  std::vector<double> numbers;         ///< initial values: the constants
  int data = 0, rows = 0, levels = 0;  ///< how many slots
  std::vector<ParameterLeaf> parameters, by_row, by_level;
  std::vector<DataLeaf> leaves;
  std::vector<Step> bind_steps, number_steps, level_steps, row_steps;
  std::vector<OutputCell> outputs;
  std::vector<StatePlan> states;  ///< one or none; Op::state among the row steps runs it
  int state = -1;                 ///< the cell of the state, however it is computed; -1 without one
  bool has_paths = false;
  // Of a program whose paths may be continued:
  std::vector<int> runs;  ///< cells of what runs along a path
  bool sums = false;      ///< `cum` as it is written, which counts rows
  bool nested = false;    ///< what runs along a path depends on another that does
};

/// `graph` and its `roots` as `regrouped` makes them. `continued`: what runs along a path is computed with
/// the rows of a call, never when they are bound.
Tape make_tape(const Graph& graph, const std::vector<int>& roots, const Symbols& symbols,
               const StateStart& start, bool continued = false);

}  // namespace wearwell::formula
