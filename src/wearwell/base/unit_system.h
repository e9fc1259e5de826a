#pragma once

#include <map>
#include <optional>
#include <string>

namespace wearwell {

/// Powers of the base units, none of them 0: {"meter": 3, "second": -1}. Beside those of the SI
/// there are two that the SI takes for numbers: "cycle", whatever is counted (cycles, revolutions,
/// strokes, closings), and "radian", an angle.
using Dimension = std::map<std::string, int>;

/// What a text says of a unit: si = offset + scale * value.
struct ParsedUnit {
  Dimension dimension;
  double scale = 1;
  double offset = 0;
  bool linear = true;  ///< false for decibels and other logarithms, and for points in time
};

/// Reads a unit as UDUNITS-2 does, with names of our own (docs/reference/units.md); nothing where it is none.
/// Throws MachineError when the database of UDUNITS-2 is missing.
std::optional<ParsedUnit> parse_unit(const std::string& text);

/// The sizes of a word in `text` that has two, and so is no unit here ("ton"); empty where there is
/// no such word.
std::string two_sizes(const std::string& text);

}  // namespace wearwell
