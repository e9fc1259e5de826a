#pragma once

#include <Eigen/Dense>
#include <span>

namespace wearwell {

/// The entries of a vector as a span, without a copy.
inline std::span<const double> view(const Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}
inline std::span<double> view(Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

}  // namespace wearwell
