#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/models/bearing/solve.h"
#include "wearwell/models/bearing/uncertain.h"

namespace wearwell::bearing {

using Input = std::optional<double> Bearing::*;

/// One option that describes a bearing: --radius, --clearance, ...
struct InputOption {
  const char* flag;
  Input input;
  const char* si;
  const char* help;
  double factor = 1;  ///< from the value of the input to the solved quantity
};
inline constexpr std::array<InputOption, 12> input_options = {{
    {"--radius", &Bearing::radius, "m", "Radius r of the journal"},
    {"--clearance", &Bearing::clearance, "m",
     "Radial clearance: bushing radius less journal radius"},
    {"--depth", &Bearing::depth, "m", "Wear depth d"},
    {"--scar-width", &Bearing::scar_width, "m", "Width b of the scar, instead of --depth"},
    {"--rate", &Bearing::rate, "m^3/(N m)", "Wear rate k: volume per load and sliding distance"},
    {"--pressure", &Bearing::pressure, "Pa", "Apparent pressure p_a = F/(2 r L)"},
    {"--force", &Bearing::force, "N", "Radial force F, with --length instead of --pressure"},
    {"--length", &Bearing::length, "m", "Length L of the bearing"},
    {"--revolutions", &Bearing::revolutions, "rev", "Number of revolutions n"},
    {"--speed", &Bearing::speed, "rev/s",
     "Speed (rpm, Hz, rad/s), with --time instead of --revolutions"},
    {"--time", &Bearing::time, "s", "Running time"},
    {"--diameter", &Bearing::radius, "m", "Diameter of the journal, instead of --radius", 0.5},
}};

/// A bearing with inputs that may be uncertain.
struct UncertainBearing {
  struct Given {
    const InputOption* option;
    Uncertain value;
  };
  Contact contact;
  std::vector<Given> given;

  Bearing mean() const;
  bool is_exact() const;
};

/// A bearing as written, before it is parsed.
struct BearingInputs {
  std::string contact;
  std::array<std::string, input_options.size()> texts;

  const std::string& text(Input input) const;

  /// Throws InputError that starts with the wrong flag.
  UncertainBearing read() const;
};

}  // namespace wearwell::bearing
