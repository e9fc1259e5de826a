#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "wearwell/base/unit.h"

namespace wearwell::prognosis {

/// A reading since a change may have begun, SI, with what the unit's readings before that predict
/// for it: the median, and half of the range from 16 to 84 %.
struct ReadingSince {
  double at = 0, measured = 0;
  double expected = 0, spread = 0;
  double added = 0;  ///< of `measured` and `expected`: what repairs took back, not measured
};

enum class ChangeKind {
  unclear,   ///< outside the forecast
  step,      ///< off by the same amount
  rate,      ///< off by an amount that grows along the axis
  factor,    ///< a change of unit
  replaced,  ///< as those of a new unit
  scatter,   ///< off in both directions
  single     ///< one reading is far off, and those after it agree again
};

struct ChangeCause {
  ChangeKind kind = ChangeKind::unclear;
  std::size_t first = 0;  ///< of the readings since: where the change begins
  double size = 0;        ///< step: SI; factor, scatter: the factor; rate: new over old, or 0
  bool above = false;     ///< the forecast
};

/// The readings from `first` on, as those of a new unit put to use after the reading before it:
/// `expected` and `spread` of each, given the earlier ones.
struct AsNew {
  std::size_t first = 0;
  std::span<const ReadingSince> readings;
};

/// The cause that explains these readings best: normal deviations, each cause with a penalty for
/// its parameters (Schwarz 1978), large deviations bounded. `before`: the position of the last
/// reading before them. Not empty.
ChangeCause cause_of(std::span<const ReadingSince> since, double before,
                     const std::optional<AsNew>& as_new);

inline constexpr std::size_t unit_factor_count = 14;
/// Factors by which readings in a wrong unit fit again: 10, 25.4, 100, 1000, 10,000, 25,400, a million and their inverses.
std::span<const double, unit_factor_count> unit_factors();
/// "such as mm in place of um"; "1/25.4".
std::string unit_change(double factor);
/// "the unit is not that of the study (such as mm in place of um)"
std::string wrong_unit(double factor);
std::string factor_text(double factor);

/// A value of a reading, SI, in its unit: up to six digits, "100.6 um".
std::string reading_text(double si, const Unit& unit);

/// Nouns and units of a description.
struct ChangeWords {
  std::string noun;  ///< "machine"
  Unit measured;
};

/// "the last 4 readings lie above the forecast; the rate has changed (about 3 times as fast), or
/// the sensor has". `dropped`: readings since the change that are no longer in `since`.
std::string description(const ChangeCause& cause, std::span<const ReadingSince> since,
                        std::uint64_t dropped, const ChangeWords& words);

}  // namespace wearwell::prognosis
