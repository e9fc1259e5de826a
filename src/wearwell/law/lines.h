#pragma once

#include <string>
#include <vector>

#include "wearwell/law/complaint.h"
#include "wearwell/law/program.h"
#include "wearwell/law/tape.h"
#include "wearwell/law/tokens.h"

namespace wearwell::law {

/// A text with its words.
struct Written {
  std::string name;  ///< of a line
  Text text;
  std::vector<Token> tokens = {};
};

/// The lines of [law], sorted by what they are.
struct Lines {
  std::vector<Written> named;
  std::string state;  ///< empty without one
  Written rate, beginning;
  bool has_beginning = false;
  StateStart start;
};

/// Sorts the lines and reads their words; throws InputError where the name of a line is no name,
/// or is taken, and where there is more than one state.
Lines sort_lines(const std::vector<Line>& law, const Symbols& symbols);

}  // namespace wearwell::law
