#include "wearwell/plan/new_level_integral.h"

#include <cmath>
#include <numbers>

#include "wearwell/math/constants.h"
#include "wearwell/math/log_sum_exp.h"

namespace wearwell::plan {
namespace {

using Eigen::Index;

constexpr double reach = 6;  // a standard normal z beyond it has a probability of 2e-9
constexpr double step = 0.03;

double log_normal_weight(double z, double width) {
  return -0.5 * z * z - 0.5 * std::log(2 * std::numbers::pi) + std::log(width);
}

double log_sum(Eigen::VectorXd terms) {
  for (double& each : terms)
    if (std::isnan(each)) each = -infinity;
  return log_sum_exp({terms.data(), static_cast<std::size_t>(terms.size())});
}

}  // namespace

NewLevelIntegral::NewLevelIntegral(int intervals) {
  const int nodes = intervals + 1;
  for (int i = 0; i < nodes; ++i) z_.push_back(-reach * std::cos(std::numbers::pi * i / intervals));
  node_log_weight_.resize(nodes);
  for (int i = 0; i < nodes; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double from = i > 0 ? z_[k - 1] : z_[k], to = i + 1 < nodes ? z_[k + 1] : z_[k];
    node_log_weight_[i] = log_normal_weight(z_[k], 0.5 * (to - from));
  }
  const auto many = static_cast<Index>(std::round(2 * reach / step)) + 1;
  interpolation_ = Eigen::MatrixXd::Zero(many, nodes);
  log_weight_.resize(many);
  for (Index m = 0; m < many; ++m) {
    const double z = -reach + step * static_cast<double>(m);
    log_weight_[m] = log_normal_weight(z, step);
    double sum = 0;
    for (int i = 0; i < nodes; ++i) {
      const double distance = z - z_[static_cast<std::size_t>(i)];
      if (std::abs(distance) < 1e-12) {
        interpolation_.row(m).setZero();
        interpolation_(m, i) = sum = 1;
        break;
      }
      const double end = i == 0 || i + 1 == nodes ? 0.5 : 1;
      interpolation_(m, i) = (i % 2 == 0 ? end : -end) / distance;
      sum += interpolation_(m, i);
    }
    interpolation_.row(m) /= sum;
  }
}

std::vector<double> NewLevelIntegral::log_means(const Eigen::MatrixXd& log_density) const {
  std::vector<double> found;
  for (Index i = 0; i < log_density.cols(); ++i)
    found.push_back(log_density.col(i).allFinite()
                        ? log_sum(interpolation_ * log_density.col(i) + log_weight_)
                        : log_sum(log_density.col(i) + node_log_weight_));
  return found;
}

std::vector<double> NewLevelIntegral::rough_log_means(const Eigen::MatrixXd& log_density) const {
  std::vector<double> found;
  for (Index i = 0; i < log_density.cols(); ++i)
    found.push_back(log_sum(log_density.col(i) + node_log_weight_));
  return found;
}

const std::vector<NewLevelIntegral>& new_level_integrals() {
  static const std::vector<NewLevelIntegral> all = [] {
    std::vector<NewLevelIntegral> made;
    for (const int intervals : {12, 24, 48, 96}) made.emplace_back(intervals);
    return made;
  }();
  return all;
}

}  // namespace wearwell::plan
