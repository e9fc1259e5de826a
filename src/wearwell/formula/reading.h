#pragma once

#include <map>
#include <string>
#include <vector>

#include "wearwell/formula/graph.h"
#include "wearwell/formula/tokens.h"

namespace wearwell::formula {

/// What names stand for where an expression is read.
struct Names {
  const Symbols& symbols;
  std::map<std::string, int> lines = {};  ///< the nodes of the lines of [formula] read before
  std::vector<std::string> all_lines = {};
  std::string state = {};  ///< its name; empty without one
  int state_node = -1;     ///< what the name stands for here; -1 where it may not be used
  int axis = -1;           ///< the column along which the state runs
  bool in_rate = false;    ///< of the state: the axis is then a running variable
};

/// Reads an expression into the graph and returns its node. Throws InputError with a caret at the
/// place.
int read_expression(Graph& graph, const Text& text, const std::vector<Token>& tokens,
                    const Names& names);

}  // namespace wearwell::formula
