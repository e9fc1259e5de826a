#pragma once

#include <string>

#include "wearwell/models/recurrence/recurrence_data.h"

namespace wearwell::recurrence {

/// A classical test. `problem` says why it does not apply; then the rest is not set.
struct TrendTest {
  std::string problem;
  double statistic = 0;
  double p = 1;
  std::size_t failures =
      0;  ///< that it uses: a failure that ends an observation is not random, and does not count
};

/// Laplace's test of a constant intensity (Cox and Lewis 1966; MIL-HDBK-189C): the ages of the failures against the middle
/// of each unit's observation, in standard deviations. Positive if failures come later, so more and more often. p is
/// two-sided, by the normal distribution.
TrendTest laplace_test(const std::vector<UnitHistory>& units);

/// Crow's Cramer-von Mises test of the power law for units observed from age 0 (Crow 1990, Proc. Ann. Reliability and
/// Maintainability Symp., 275-279; IEC 61710). p is the share of simulated samples of this size with as large a statistic,
/// from 10 000 samples (fewer beyond 1000 failures, at least 250); the published critical values are quantiles of the same distribution.
TrendTest cramer_von_mises_test(const std::vector<UnitHistory>& units);

/// Of failures that are counted by interval: the sum of (number - expected)^2/expected over intervals, in the order of their
/// ends, joined until at least 5 failures are expected of each (MIL-HDBK-189C, 6.2.4); expected by maximum likelihood. p is by
/// the chi-square distribution with two degrees of freedom fewer than intervals.
TrendTest grouped_power_law_test(const std::vector<Gap>& gaps);

/// The probability of a statistic as large as this one among this number of failures, if the power law holds.
double crow_p_value(double statistic, std::size_t failures);

/// Tests whether units have the same intensity, by the numbers of their failures: the sum of (number - expected)^2/expected,
/// where the failures are shared out in proportion to `weights`, the expected numbers of a fitted Poisson process. p is the
/// share of simulated shares-out (multinomial) with as large a sum, from 10 000 (fewer beyond 1000 failures).
TrendTest dispersion_test(const std::vector<UnitHistory>& units,
                          const std::vector<double>& weights);

}  // namespace wearwell::recurrence
