#pragma once

#include <utility>
#include <vector>

#include "wearwell/models/recurrence/recurrence_data.h"

namespace wearwell::recurrence {

/// Histories and gaps of units that were observed from age 0 until `ends`.
inline RecurrenceData observed(const std::vector<std::vector<double>>& failures,
                               const std::vector<double>& ends) {
  RecurrenceData data;
  for (std::size_t i = 0; i < failures.size(); ++i) {
    UnitHistory unit{std::to_string(i + 1), 0, ends[i], failures[i], false};
    double last = 0;
    for (const double at : failures[i]) {
      data.gaps.push_back({i, last, at, true, last == 0});
      last = at;
    }
    data.gaps.push_back({i, last, ends[i], false, last == 0});
    data.units.push_back(std::move(unit));
  }
  return data;
}

/// Crow (1975, AMSAA technical report 138; MIL-HDBK-189): three systems that were simulated until 200 hours.
inline RecurrenceData three_systems() {
  return observed(
      {{4.3, 4.4, 10.2, 23.5, 23.8, 26.4, 74.0, 77.1, 92.1, 197.2},
       {0.1, 5.6, 18.6, 19.5, 24.2, 26.7, 45.1, 45.8, 75.7, 79.7, 98.6, 120.1, 161.8, 180.6, 190.8},
       {8.4, 32.5, 44.7, 48.4, 50.6, 73.6, 98.7, 112.2, 129.8, 136.0, 195.8}},
      {200, 200, 200});
}

}  // namespace wearwell::recurrence
