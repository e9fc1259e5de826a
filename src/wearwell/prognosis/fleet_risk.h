#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace wearwell::prognosis {

/// How many of a number of units: probabilities of 0, 1, 2, ...
using Count = std::vector<double>;

/// The distribution of how many of independent events happen (Poisson-binomial), by convolution of one after the
/// other: sums of positive numbers, exact to rounding however small they are (Hong, Computational Statistics & Data Analysis 59
/// (2013) 41, compares methods). Probabilities lie between 0 and 1.
Count how_many(std::span<const double> probability);

/// The same where events are independent only in a given population: of each population how many of its units,
/// mixed by their weights. `probability[k]` is of all units in population k.
Count how_many(std::span<const std::vector<double>> probability, std::span<const double> weight);

double mean(const Count& count);
double sd(const Count& count);

/// The least number that is not exceeded with at least this probability: spare parts for a service level.
std::size_t enough_for(const Count& count, double level);

}  // namespace wearwell::prognosis
