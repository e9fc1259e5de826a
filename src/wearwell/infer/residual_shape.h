#pragma once

#include <span>
#include <string>

namespace wearwell {

struct Remedies;

/// In which way residuals are not normal.
enum class ResidualShape { two_groups, long_lower, long_upper, long_tails, short_tails };

struct ResidualShapeFound {
  ResidualShape shape;
  std::size_t lower_group = 0;  ///< of two groups, how many are in the lower one
};

/// By the largest share of the variance that a cut in two explains (0.64 of a normal distribution, 0.75 of a uniform
/// one), then by skewness and kurtosis over their standard errors. At least two values.
ResidualShapeFound shape_of(std::span<const double> residuals);

std::string description(const ResidualShapeFound& found, std::size_t count);
/// What to try.
std::string advice_on(ResidualShape shape, const Remedies& remedies);

}  // namespace wearwell
