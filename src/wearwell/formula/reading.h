#pragma once

#include <map>
#include <string>
#include <vector>

#include "wearwell/formula/graph.h"
#include "wearwell/formula/tokens.h"

namespace wearwell::formula {

/// The meaning of names in an expression.
struct Names {
  const Symbols& symbols;
  std::map<std::string, int> lines = {};  ///< the nodes of lines of [formula] already read
  std::vector<std::string> all_lines = {};
  std::string state = {};  ///< name of the state; empty without one
  int state_node = -1;     ///< node of the name; -1 if it must not be used here
  int axis = -1;           ///< the column that is the axis of the state
  bool in_rate = false;    ///< reads a rate: the axis is a running variable
};

/// Reads an expression into the graph and returns its node. Throws InputError with a caret at the
/// position.
int read_expression(Graph& graph, const Text& text, const std::vector<Token>& tokens,
                    const Names& names);

}  // namespace wearwell::formula
