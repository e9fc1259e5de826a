#pragma once

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "calibration/formula_design.h"
#include "support/followed_unit.h"
#include "wearwell/base/rng.h"
#include "wearwell/models/formula_model/formula_tracker.h"

namespace wearwell::formula_model {

/// How often 90 % intervals of the remaining useful life of units followed on line hold the truth, when a population was
/// learned from 5 units of 5 readings: straight paths y = b t, read each half hour.
struct TrackedCoverage {
  static constexpr std::array<int, 3> shown = {3, 5, 10};  ///< readings of the unit
  struct Count {
    int units = 0, held = 0, shorter = 0, longer = 0;  ///< the truth below the interval, above
    int bins[20] = {};                                 ///< of P(remaining useful life <= truth)
    double share() const { return static_cast<double>(held) / units; }
  };
  std::array<Count, 3> of;
  int failed = 0;  ///< populations without quadrature
};

/// Where the truth lies in what is said after 3, 5 and 10 readings; NaN of a unit that was at its limit by then.
using TrackedPlaces = std::array<double, 3>;

/// What follows units of the population of `straight` that these rows tell; none where its posterior could not be integrated.
inline std::unique_ptr<const prognosis::Tracker> tracker_of(const std::vector<Column>& columns) {
  const FormulaDesign design(straight, columns);
  const ExactPosterior exact = exact_posterior(
      std::make_shared<const FormulaRows>(design.model, design.model->data.table.rows), 3e-3);
  if (!exact.failure.empty()) return nullptr;
  prognosis::CarriedState state;
  state.source = design.source;
  for (const Parameter& each : design.model->parameters) state.parameters.push_back(each.name);
  state.posterior = exact.nodes;
  return track_units(state);
}

/// One population: truth `fixed` (SI), or drawn from the priors where that is empty. Empty where its posterior
/// could not be integrated.
inline std::vector<TrackedPlaces> follow_units(const std::vector<double>& fixed, int units,
                                               std::uint64_t stream) {
  constexpr double um = 1e-6, h = 3600, limit = 12 * um;
  Rng rng(20261122, stream);
  std::vector<double> depth, time;
  std::vector<std::string> unit;
  for (int u = 0; u < 5; ++u) {
    for (int i = 1; i <= 5; ++i) {
      depth.push_back(i);
      time.push_back(i);
      unit.push_back("u" + std::to_string(u));
    }
  }
  const std::vector<double> x =
      fixed.empty() ? FormulaDesign(straight, {numbers("depth", depth), numbers("time", time),
                                               texts("unit", unit)})
                          .from_priors(rng)
                    : fixed;
  const auto rate = [&] { return x[0] * std::exp(x[1] * rng.normal()); };
  for (std::size_t u = 0; u < 5; ++u) {
    const double b = rate();
    for (std::size_t i = 0; i < 5; ++i) {
      depth[5 * u + i] = (b * time[5 * u + i] * h + x[2] * rng.normal()) / um;
    }
  }
  const auto tracker =
      tracker_of({numbers("depth", depth), numbers("time", time), texts("unit", unit)});
  if (!tracker) return {};
  std::vector<TrackedPlaces> all;
  for (int u = 0; u < units; ++u) {
    const double b = rate();
    FollowedUnit followed(*tracker, "new");
    all.push_back({NAN, NAN, NAN});
    for (int i = 1; i <= TrackedCoverage::shown.back(); ++i) {
      const double t = 0.5 * i * h;
      followed.update({b * t + x[2] * rng.normal(), t});
      for (std::size_t s = 0; s < TrackedCoverage::shown.size(); ++s) {
        if (TrackedCoverage::shown[s] != i || b * t >= limit) continue;
        all.back()[s] = followed.unit->forecast().remaining.cdf(limit / b - t);
      }
    }
  }
  return all;
}

inline TrackedCoverage tracked_coverage(const std::vector<double>& fixed, int populations,
                                        int units, std::uint64_t first) {
  std::vector<std::vector<TrackedPlaces>> places(static_cast<std::size_t>(populations));
  tbb::parallel_for(0, populations, [&](int p) {
    places[static_cast<std::size_t>(p)] =
        follow_units(fixed, units, first + static_cast<std::uint64_t>(p));
  });
  TrackedCoverage coverage;
  for (const auto& each : places) {
    coverage.failed += each.empty();
    for (const TrackedPlaces& place : each) {
      for (std::size_t s = 0; s < place.size(); ++s) {
        if (std::isnan(place[s])) continue;
        TrackedCoverage::Count& count = coverage.of[s];
        ++count.units;
        (place[s] < 0.05 ? count.shorter : place[s] > 0.95 ? count.longer : count.held) += 1;
        ++count.bins[std::min(19, static_cast<int>(20 * place[s]))];
      }
    }
  }
  return coverage;
}

}  // namespace wearwell::formula_model
