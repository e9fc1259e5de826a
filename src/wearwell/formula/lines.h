#pragma once

#include <string>
#include <vector>

#include "wearwell/formula/complaint.h"
#include "wearwell/formula/program.h"
#include "wearwell/formula/tape.h"
#include "wearwell/formula/tokens.h"

namespace wearwell::formula {

/// A text with its tokens.
struct Written {
  std::string name;  ///< of a line
  Text text;
  std::vector<Token> tokens = {};
};

/// The lines of [formula], sorted by kind.
struct Lines {
  std::vector<Written> named;
  std::string state;  ///< empty without one
  Written rate, beginning;
  bool has_beginning = false;
  StateStart start;
};

/// Sorts and tokenizes the lines; throws InputError if the name of a line is invalid or taken, or
/// if there is more than one state.
Lines sort_lines(const std::vector<Line>& law, const Symbols& symbols);

}  // namespace wearwell::formula
