#include "wearwell/plan/linear_gain.h"

#include <algorithm>
#include <cmath>

namespace wearwell::plan {

LinearGain linear_gain(Eigen::MatrixXd covariance, const Eigen::VectorXd& goal,
                       std::span<const LinearTest> tests) {
  LinearGain gain;
  for (const LinearTest& each : tests) {
    const Eigen::VectorXd with = covariance * each.row;
    const double known = each.row.dot(with), error = each.error_variance / each.tests;
    gain.information += 0.5 * std::log1p(known / error);
    covariance -= with * with.transpose() / (known + error);
  }
  gain.variance = std::max(0.0, goal.dot(covariance * goal));
  return gain;
}

}  // namespace wearwell::plan
