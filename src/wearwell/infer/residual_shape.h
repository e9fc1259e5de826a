#pragma once

#include <span>
#include <string>

namespace wearwell {

struct Remedies;

/// The kind of non-normality of residuals.
enum class ResidualShape { two_groups, long_lower, long_upper, long_tails, short_tails };

struct ResidualShapeFound {
  ResidualShape shape;
  std::size_t lower_group = 0;  ///< size of the lower of two groups
};

/// From the largest fraction of the variance explained by a split in two (0.64 for a normal
/// distribution, 0.75 for a uniform one), then from skewness and kurtosis over their standard
/// errors. Needs two values.
ResidualShapeFound shape_of(std::span<const double> residuals);

std::string description(const ResidualShapeFound& found, std::size_t count);
/// Advice for the shape.
std::string advice_on(ResidualShape shape, const Remedies& remedies);

}  // namespace wearwell
