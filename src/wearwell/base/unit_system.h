#pragma once

#include <map>
#include <optional>
#include <string>

namespace wearwell {

/// Powers of the base units, none of them 0: {"meter": 3, "second": -1}. Two of them are pure
/// numbers in the SI: "cycle" for every count (cycles, revolutions, strokes, closings), and
/// "radian" for angles.
using Dimension = std::map<std::string, int>;

/// A parsed unit: si = offset + scale * value.
struct ParsedUnit {
  Dimension dimension;
  double scale = 1;
  double offset = 0;
  bool linear = true;  ///< false for decibels and other logarithms, and for points in time
};

/// Reads a unit with UDUNITS-2 and additional names (docs/reference/units.md); empty if it is not a
/// unit. Throws MachineError if the database of UDUNITS-2 is missing.
std::optional<ParsedUnit> parse_unit(const std::string& text);

/// The two sizes of an ambiguous word in `text` ("ton"), which is therefore not accepted; empty
/// without such a word.
std::string two_sizes(const std::string& text);

}  // namespace wearwell
