#pragma once

#include <optional>
#include <vector>

#include "wearwell/models/recurrence/process.h"

namespace wearwell::recurrence {

/// Ends of an interval; each leaves the probability `outside` beyond it. An open upper end is infinite.
struct Interval {
  double lower = 0, upper = 0;
};

/// What the exact distributions of the power law are made of (Crow 1975, 1982; MIL-HDBK-189C, 5.5 and 6.2): given the numbers of
/// failures, ln(end/age) of the failures that do not end an observation are exponential with the rate beta. Ages in SI.
struct PowerLawSample {
  std::size_t units = 0, failures = 0;
  std::size_t random = 0;      ///< failures that do not end an observation
  double logs = 0;             ///< sum of their ln(end/age)
  double end = 0;              ///< the common end of observation; NaN if ends differ
  bool time_ended = true;      ///< no observation ended at a failure
  bool failure_ended = false;  ///< one unit, whose observation ended at its last failure

  /// The unbiased estimate (random - 1)/logs, beta-bar; needs two such failures.
  std::optional<double> unbiased_beta() const;
};
/// Empty if a unit was not observed from age 0.
std::optional<PowerLawSample> power_law_sample(const std::vector<UnitHistory>& units);

/// beta: 2 beta sum ln(end/age) is chi-square distributed with 2 `random` degrees of freedom. Empty without failures.
std::optional<Interval> exact_beta(const PowerLawSample& sample, double outside);

/// The instantaneous mean time between failures of one unit at the common end of observation (Crow 1982, Technometrics
/// 24, 67-72). Failure ended: the end times sum ln(end/age), over the MTBF, is a product of independent gamma variables
/// with the shapes n - 1 and n. Time ended: n given the sum has a distribution of the MTBF alone, as a Poisson
/// distribution with a Bessel function for its sum; as n is a whole number, coverage is at least the nominal one, and
/// after one failure there is no upper bound. Empty if ends differ, or with a mixture of both ends.
std::optional<Interval> exact_mtbf(const PowerLawSample& sample, double outside);

/// A constant intensity: the mean time between failures of `failures` within `time` in total, by chi-square quantiles
/// (NIST/SEMATECH e-Handbook 8.4.5.1): 2 time/chi^2 with 2 n degrees of freedom, for the lower bound of a test that a time
/// limit ended 2 n + 2.
Interval exact_constant_mtbf(std::size_t failures, double time, bool failure_ended, double outside);
/// The mean age per failure until the common end of observation, end/M(end) (the cumulative mean time between failures
/// of Crow's bounds), by the same quantiles: failures are Poisson distributed with the mean `units` M(end), or M at the
/// last of n failures is gamma distributed with the shape n. Empty if ends differ, or with a mixture of both ends.
std::optional<Interval> exact_age_per_failure(const PowerLawSample& sample, double outside);
/// The same of a phase. Empty if observations within it ended in both ways.
std::optional<Interval> exact_phase(const Process& process, const std::vector<UnitHistory>& units,
                                    std::size_t phase, double outside);

}  // namespace wearwell::recurrence
