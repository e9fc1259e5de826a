#include "wearwell/predict/item_mixture.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/boost_policy.h"
#include "wearwell/math/root.h"

namespace wearwell {

ItemMixture::ItemMixture(const WeightedDraws& draws, const Function& center,
                         const Function& log_sd) {
  const DominantDraws dominant(draws);
  for (std::size_t i = 0; i < dominant.rows.size(); ++i) {
    const Eigen::VectorXd x = draws.values.row(dominant.rows[i]);
    weight_.push_back(dominant.weights[i]);
    log_center_.push_back(std::log(center(x.data())));
    log_sd_.push_back(log_sd(x.data()));
    defined_ = defined_ && !std::isnan(log_center_.back()) && log_sd_.back() > 0;
  }
}

double ItemMixture::below(double log_value) const {
  check_stop();
  double sum = 0;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    sum +=
        weight_[i] * 0.5 * std::erfc((log_center_[i] - log_value) / (log_sd_[i] * std::sqrt(2.0)));
  }
  return sum;
}

double ItemMixture::cdf(double value) const {
  return defined_ ? below(std::log(value)) : std::nan("");
}

double ItemMixture::quantile(double p) const {
  if (!defined_) return std::nan("");
  // Searches outward from the dominant point, within the range of doubles.
  constexpr double beyond = 1e4;
  const double start = std::clamp(log_center_.front(), -beyond, beyond);
  const double root = solve_increasing([&](double x) { return below(x) - p; }, start, 1,
                                       {.absolute = 1e-9}, -2 * beyond, 2 * beyond);
  return std::exp(root);  // 0 or infinity at the ends
}

void stratified_normals(std::size_t draw, std::size_t count, std::vector<double>& z) {
  constexpr double golden = 0.6180339887498949;  // its multiples modulo 1 have low discrepancy
  double whole = 0;
  const double shift = std::modf((static_cast<double>(draw) + 0.5) * golden, &whole);
  z.clear();
  for (std::size_t j = 0; j < count; ++j) {
    const double p = (static_cast<double>(j) + shift) / static_cast<double>(count);
    z.push_back(-std::sqrt(2.0) *
                boost::math::erfc_inv(2 * std::clamp(p, 1e-15, 1 - 1e-15), Quiet()));
  }
}

}  // namespace wearwell
