#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace wearwell::prognosis {

/// The number of events: probabilities of 0, 1, 2, ...
using Count = std::vector<double>;

/// The distribution of the number of independent events that happen (Poisson-binomial), by
/// successive convolution: sums of positive numbers, exact to rounding for any magnitude (Hong,
/// Computational Statistics & Data Analysis 59 (2013) 41, compares methods). Probabilities lie
/// between 0 and 1.
Count how_many(std::span<const double> probability);

/// The same where events are independent only given the population: the distribution in each
/// population, mixed by weight. `probability[k]` holds all units in population k.
Count how_many(std::span<const std::vector<double>> probability, std::span<const double> weight);

double mean(const Count& count);
double sd(const Count& count);

/// The smallest number that is not exceeded with at least this probability: spare parts for a
/// service level.
std::size_t enough_for(const Count& count, double level);

}  // namespace wearwell::prognosis
