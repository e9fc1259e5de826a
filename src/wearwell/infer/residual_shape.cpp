#include "wearwell/infer/residual_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "wearwell/infer/fit_check.h"

namespace wearwell {

ResidualShapeFound shape_of(std::span<const double> residuals) {
  std::vector<double> x(residuals.begin(), residuals.end());
  std::sort(x.begin(), x.end());
  const double n = static_cast<double>(x.size());
  double mean = 0, square = 0, cube = 0, fourth = 0;
  for (const double each : x) mean += each / n;
  for (const double each : x) {
    const double d = each - mean;
    square += d * d / n;
    cube += d * d * d / n;
    fourth += d * d * d * d / n;
  }
  double below = 0, explained = 0;
  std::size_t cut = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    below += x[i] - mean;
    const double k = static_cast<double>(i) + 1;
    const double share = below * below / (k * (n - k)) / square;
    if (share > explained) explained = share, cut = i + 1;
  }
  // A few extreme values are outliers, not a group.
  constexpr double apart = 0.8, of_all = 0.1;
  const double smaller = std::min(static_cast<double>(cut), n - static_cast<double>(cut));
  if (explained > apart && smaller >= of_all * n) return {ResidualShape::two_groups, cut};
  const double skew = cube / std::pow(square, 1.5) / std::sqrt(6 / n);
  const double excess = (fourth / (square * square) - 3) / std::sqrt(24 / n);
  if (std::abs(skew) > 2 && 2 * std::abs(skew) > excess)
    return {skew < 0 ? ResidualShape::long_lower : ResidualShape::long_upper};
  return {excess > 0 ? ResidualShape::long_tails : ResidualShape::short_tails};
}

std::string description(const ResidualShapeFound& found, std::size_t count) {
  switch (found.shape) {
    case ResidualShape::two_groups:
      return fmt::format("they form two groups, of {} and {}", found.lower_group,
                         count - found.lower_group);
    case ResidualShape::long_lower:
      return "the lower tail is too long";
    case ResidualShape::long_upper:
      return "the upper tail is too long, or the lower one too short";
    case ResidualShape::long_tails:
      return "both tails are too long";
    case ResidualShape::short_tails:
      break;
  }
  return "the center is too flat";
}

std::string advice_on(ResidualShape shape, const Remedies& remedies) {
  switch (shape) {
    case ResidualShape::two_groups:
    case ResidualShape::short_tails:
      return remedies.life ? "Try a mixture of two subpopulations ([subpopulations], "
                             "docs/how-to/subpopulations.md). If a column can state the failure "
                             "mode of each failure, use [failure_modes] instead; if it can state "
                             "the group, fit the groups separately."
                           : "Look for two mixed groups (machines, batches, operators): name the "
                             "column that distinguishes them, or fit them separately.";
    case ResidualShape::long_lower:
      return remedies.life ? "More early failures than the distribution expects. Try a mixture of "
                             "two subpopulations, early failures beside wear-out "
                             "([subpopulations], docs/how-to/subpopulations.md), or "
                             "[failure_modes] if a column can state the mode; or another family, "
                             "because lognormal and Weibull have different lower tails."
                           : "Try a family with a longer lower tail (smallest-extreme-value), or "
                             "check what the lowest readings have in common.";
    case ResidualShape::long_upper:
      return remedies.life
                 ? "Fewer early failures than the distribution expects, or fewer late ones: if "
                   "many "
                   "parts are still running and failures have ceased, perhaps only a share can "
                   "fail (share_defective, docs/how-to/subpopulations.md). Else try a threshold "
                   "(no "
                   "failure before t0: threshold of the "
                   "Weibull family), left truncation (the table does not contain units that failed "
                   "before it began: data.columns.entry), or a family with a longer upper tail "
                   "(lognormal)."
                 : "Try a family with a longer upper tail: lognormal, or a response in logarithms.";
    case ResidualShape::long_tails:
      break;
  }
  return remedies.heavy_tails.empty()
             ? "Check the outermost rows for errors; if there are none, try a family with longer "
               "tails, or a mixture of two modes or populations."
             : remedies.heavy_tails;
}

}  // namespace wearwell
