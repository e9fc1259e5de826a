#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/formula/complaint.h"
#include "wearwell/formula/program.h"
#include "wearwell/formula/state.h"
#include "wearwell/formula/tape.h"

namespace wearwell::formula {

/// The content of a program.
struct Program::Body {
  Symbols symbols;
  Graph graph;              ///< as written
  std::vector<int> roots;   ///< its nodes of the outputs
  std::vector<Text> texts;  ///< texts, indexed by a node's origin
  std::vector<Output> outputs;
  StateStart start;
  int rate = -1, beginning = -1;                  ///< nodes of the state, if there is one
  std::vector<bool> parameters, columns, labels;  ///< whether an output uses them
  Tape tape;
  bool continued = false;
};

struct Data::Body {
  std::size_t rows = 0;
  std::vector<std::vector<double>> columns;  ///< by slot of Cell::data
  std::vector<std::vector<int>> labels;      ///< as Symbols::labels; only the labels used for picks
  std::vector<std::uint8_t> starts;          ///< 1 at the beginning of a path
  std::vector<double> from, repeats;         ///< as in Rows, by row; empty if not given
};

struct Workspace::Body {
  std::size_t rows = 0, most = 0;
  std::vector<double> numbers, number_adjoints;
  std::vector<double> level_values, level_adjoints;  ///< by slot of Cell::level
  std::vector<double> values, adjoints;              ///< by slot of Cell::row, `most` rows each
  std::vector<const double*> at;                     ///< by cell
  std::vector<double*> adjoint_at;                   ///< by cell; null without adjoints
  std::vector<std::vector<double>> output_adjoints;
  std::vector<int> output_cells;
  std::vector<bool> output_uniform;
  std::optional<StateSolver> solver;
  StateRows state_rows;
  StateAdjoints state_adjoints;
};

}  // namespace wearwell::formula
