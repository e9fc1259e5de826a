#pragma once

#include <span>
#include <vector>

#include "wearwell/prognosis/population_weights.h"

namespace wearwell::prognosis {

/// The number of units that fail within a horizon; each counts once.
struct FleetFailures {
  double expected = 0;
  double low = 0, high = 0;  ///< 5 and 95 %, whole numbers
};

/// Failure probabilities of a fleet's units, summed up by horizon and population. Given the
/// population units are independent: their number of failures is a mixture over the populations of
/// Poisson-binomial distributions, summed exactly up to 400 units; of more units of binomial
/// distributions with the same means and variances.
class FailureTotals {
 public:
  FailureTotals(std::size_t horizons, std::size_t populations);
  /// So many units with the same probabilities, by horizon and population.
  void add(const std::vector<std::vector<double>>& failing, double units);
  /// One unit, whose probabilities are kept while there are few.
  void keep(const std::vector<std::vector<double>>& failing);
  FleetFailures failures(std::size_t horizon, std::span<const double> weight) const;

 private:
  std::vector<std::vector<double>> mean_, variance_;    // by horizon, by population
  std::vector<std::vector<std::vector<double>>> kept_;  // by horizon, by unit, by population
  bool few_ = true;
};

}  // namespace wearwell::prognosis
