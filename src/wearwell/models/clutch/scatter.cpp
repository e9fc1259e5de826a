#include "wearwell/models/clutch/scatter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "wearwell/base/rng.h"
#include "wearwell/math/minimizer.h"

namespace wearwell::clutch {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Lower bound of sigma_w at a fitted point, as a share of the overall residual scatter.
constexpr double least_share = 0.02;
constexpr int random_starts = 10;

VectorXd corrected_residuals(const WearMap& map) {
  return map.fit.residuals.array() / (1 - map.fit.leverages.array()).max(leverage_tolerance).sqrt();
}

/// A candidate in coordinates of order one: sigma_w = unit * exp(a0 + a1 x1) or unit * sum a_i x_i,
/// where x are centered and scaled features with x0 = 1.
class Candidate {
 public:
  Candidate(ScatterKind kind, const WearPoints& points, const WearMap& map)
      : kind_(kind),
        points_(points),
        cycles_(points.effective_cycles()),
        residuals_(corrected_residuals(map)) {
    unit_ = std::sqrt((residuals_.array().square() * cycles_.array()).mean());
    const Index n = points.size();
    features_.resize(n, size_of(kind));
    features_.col(0).setOnes();
    for (Index j = 0; j < n; ++j) {
      const double w = map.fit.fitted[j];
      const OperatingPoint& at = points.at[static_cast<std::size_t>(j)];
      if (kind == ScatterKind::conditions) {
        features_.row(j).tail(4) << at.temperature, at.slip_speed, at.torque, at.closing_time;
      } else {
        features_(j, 1) = w;
        if (kind == ScatterKind::quadratic) features_(j, 2) = w * w;
      }
    }
    centre_ = features_.colwise().mean();
    centre_[0] = 0;
    scale_ = Eigen::RowVectorXd::Ones(features_.cols());
    for (Index c = 1; c < features_.cols(); ++c) {
      features_.col(c).array() -= centre_[c];
      const double spread = std::sqrt(features_.col(c).squaredNorm() / static_cast<double>(n));
      if (spread > 0) scale_[c] = spread;
      features_.col(c) /= scale_[c];
    }
  }

  Index size() const { return features_.cols(); }

  double value(std::span<const double> a, std::span<double> gradient) const {
    const Eigen::Map<const VectorXd> x(a.data(), size());
    const VectorXd linear = features_ * x;
    const bool exponential = kind_ == ScatterKind::exponential;
    Eigen::ArrayXd sigma = linear.array();
    if (exponential) sigma = sigma.exp().eval();
    if (!(sigma.minCoeff() > least_share) || !sigma.allFinite()) return INFINITY;
    const Eigen::ArrayXd residual = residuals_.array() / unit_;
    const Eigen::ArrayXd balance = points_.balance_sd.array() / unit_;
    const Eigen::ArrayXd variance = sigma.square() / cycles_.array() + balance.square();
    const Eigen::ArrayXd square = residual.square() / variance;
    if (!gradient.empty()) {
      Eigen::ArrayXd by_linear = (1 - square) / variance * sigma / cycles_.array();
      if (exponential) by_linear *= sigma;
      Eigen::Map<VectorXd>(gradient.data(), size()) = features_.transpose() * by_linear.matrix();
    }
    return 0.5 * (variance.log() + square).sum();
  }

  /// Of the wear rates in mm^3/MJ.
  double negative_log_likelihood(double value) const {
    return value + static_cast<double>(points_.size()) *
                       (0.5 * std::log(2 * std::numbers::pi) + std::log(unit_ / mm3_per_MJ));
  }

  VectorXd constant() const {
    VectorXd start = VectorXd::Zero(size());
    start[0] = kind_ == ScatterKind::exponential ? 0 : 1;
    return start;
  }

  /// From a regression of |e| sqrt(n), whose mean is sigma_w sqrt(2/pi).
  VectorXd regressed() const {
    const Eigen::ArrayXd sizes =
        residuals_.array().abs() * cycles_.array().sqrt() * std::sqrt(std::numbers::pi / 2) / unit_;
    if (kind_ == ScatterKind::exponential)
      return features_.colPivHouseholderQr().solve(sizes.max(0.05).log().matrix().eval());
    return features_.colPivHouseholderQr().solve(sizes.matrix().eval());
  }

  ScatterLaw law(const VectorXd& a) const {
    ScatterLaw law{kind_, {}};
    const VectorXd slope = a.array() / scale_.transpose().array();
    const double intercept = a[0] - slope.tail(size() - 1).dot(centre_.tail(size() - 1));
    const bool exponential = kind_ == ScatterKind::exponential;
    law.p.push_back(unit_ * (exponential ? std::exp(intercept) : intercept));
    for (Index i = 1; i < size(); ++i) law.p.push_back(exponential ? slope[i] : unit_ * slope[i]);
    return law;
  }

 private:
  ScatterKind kind_;
  const WearPoints& points_;
  VectorXd cycles_;  ///< effective
  VectorXd residuals_;
  double unit_ = 1;
  Eigen::MatrixXd features_;
  Eigen::RowVectorXd centre_, scale_;
};

ScatterFit fit_candidate(ScatterKind kind, const WearPoints& points, const WearMap& map) {
  const Candidate candidate(kind, points, map);
  const Objective objective = [&](std::span<const double> a, std::span<double> gradient) {
    return candidate.value(a, gradient);
  };
  std::vector<VectorXd> starts = {candidate.constant(), candidate.regressed()};
  Rng rng(1, static_cast<std::uint64_t>(kind));
  for (int i = 0; i < random_starts; ++i) {
    VectorXd start = starts[static_cast<std::size_t>(i % 2)];
    for (double& each : start) each += 0.3 * rng.normal();
    starts.push_back(start);
  }
  Minimum best;
  best.value = INFINITY;
  std::vector<double> values;
  for (const VectorXd& start : starts) {
    if (!std::isfinite(candidate.value({start.data(), static_cast<std::size_t>(start.size())}, {})))
      continue;
    const Minimum found = minimize(objective, start);
    values.push_back(found.value);
    if (found.value < best.value) best = found;
  }
  ScatterFit fit;
  fit.law = candidate.law(best.position);
  fit.negative_log_likelihood = candidate.negative_log_likelihood(best.value);
  fit.aic = 2 * (size_of(kind) + fit.negative_log_likelihood);
  fit.converged = best.converged;
  fit.starts = static_cast<int>(values.size());
  fit.agreeing = static_cast<int>(std::count_if(
      values.begin(), values.end(), [&](double value) { return value < best.value + 1e-4; }));
  const VectorXd scaled = scaled_residuals(points, map, fit.law);
  const std::vector<double> list(scaled.begin(), scaled.end());
  fit.kolmogorov = kolmogorov_test(list);
  fit.lilliefors = lilliefors_test(list);
  return fit;
}

}  // namespace

VectorXd point_sd(const ScatterLaw& law, const WearPoints& points, const VectorXd& mean) {
  VectorXd sd(points.size());
  const VectorXd cycles = points.effective_cycles();
  for (Index j = 0; j < sd.size(); ++j) {
    const double sigma = law.formula(mean[j], points.at[static_cast<std::size_t>(j)]);
    sd[j] = std::hypot(sigma / std::sqrt(cycles[j]), points.balance_sd[j]);
  }
  return sd;
}

VectorXd scaled_residuals(const WearPoints& points, const WearMap& map, const ScatterLaw& law) {
  return corrected_residuals(map).array() / point_sd(law, points, map.fit.fitted).array();
}

ScatterSearch fit_scatter(const WearPoints& points, const WearMap& map) {
  ScatterSearch search;
  for (const ScatterKind kind : scatter_kinds) {
    search.candidates.push_back(fit_candidate(kind, points, map));
    double least = INFINITY;
    for (Index j = 0; j < points.size(); ++j)
      least = std::min(least, search.candidates.back().law.formula(
                                  map.fit.fitted[j], points.at[static_cast<std::size_t>(j)]));
    search.floors.push_back(0.5 * least);
  }
  for (std::size_t i = 1; i < search.candidates.size(); ++i) {
    if (search.candidates[i].aic < search.candidates[search.best].aic) search.best = i;
  }
  return search;
}

}  // namespace wearwell::clutch
