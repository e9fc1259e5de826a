#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/present/table.h"
#include "wearwell/prognosis/life_bounds.h"
#include "wearwell/prognosis/unit_life.h"
#include "wearwell/prognosis/updated_study.h"

namespace wearwell::prognosis {

/// The readings since the fit that a life counts in, and how the nodes followed them.
struct LifeReadings {
  std::string how = {};  ///< empty without readings
  std::size_t counted = 0, repeated = 0;
  std::vector<Contradiction> contradictions = {};
};

/// The answer of `wearwell life` for a terminal; ends with a newline. `trusted`: no check of the fit
/// failed.
std::string life_text(const UnitLife& life, const LifeBounds& bounds, const LifeReadings& moved,
                      bool trusted);

/// The same as JSON (docs/how-to/state.md).
nlohmann::ordered_json life_json(const UnitLife& life, const LifeBounds& bounds,
                                 const LifeReadings& moved, bool trusted);

/// The survival curve.
present::Table survival_table(const UnitLife& life);

}  // namespace wearwell::prognosis
