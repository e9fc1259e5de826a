#include "wearwell/models/clutch/scatter.h"

#include <gmock/gmock.h>

#include <cmath>

#include "models/clutch/sample_campaign.h"
#include "wearwell/base/rng.h"

namespace wearwell::clutch {
namespace {

/// Wear rates that rise with torque, scattering by `law`.
WearPoints scattered_points(const ScatterLaw& law, int count, std::uint64_t seed) {
  Rng rng(seed, 0);
  WearPoints points;
  points.w.resize(count);
  points.cycles.resize(count);
  points.balance_sd = Eigen::VectorXd::Constant(count, 0.3 * mm3_per_MJ);
  for (int j = 0; j < count; ++j) {
    points.number.push_back(j + 1);
    points.at.push_back(
        {rng.uniform(120, 300), rng.uniform(25, 75), rng.uniform(120, 240), rng.uniform(0.9, 3.4)});
    points.cycles[j] = std::round(rng.uniform(500, 3000));
    const OperatingPoint& at = points.at.back();
    const double mean = 0.5 * at.torque * mm3_per_MJ, sigma = law.formula(mean, at);
    points.w[j] =
        mean + std::hypot(sigma / std::sqrt(points.cycles[j]), points.balance_sd[j]) * rng.normal();
  }
  return points;
}

WearMap linear_map(const WearPoints& points) {
  return fit_map("linear", points, Surrogate::distance, 1, 1, 1, {});
}

/// By the formula of the header, written out.
double negative_log_likelihood(const ScatterLaw& law, const WearPoints& points,
                               const WearMap& map) {
  double sum = 0;
  for (Eigen::Index j = 0; j < points.size(); ++j) {
    const double sigma =
        law.formula(map.fit.fitted[j], points.at[static_cast<std::size_t>(j)]) / mm3_per_MJ;
    const double balance = points.balance_sd[j] / mm3_per_MJ;
    const double variance = sigma * sigma / points.cycles[j] + balance * balance;
    const double e = map.fit.residuals[j] / mm3_per_MJ / std::sqrt(1 - map.fit.leverages[j]);
    sum += 0.5 * (std::log(2 * M_PI * variance) + e * e / variance);
  }
  return sum;
}

// The two-parameter candidates against every point of a grid around the best, and the likelihood
// against its formula.
TEST(Scatter, IsTheMostLikely) {
  const WearPoints points = scattered_points({ScatterKind::linear, {40 * mm3_per_MJ, 2}}, 80, 1);
  const WearMap map = linear_map(points);
  const ScatterSearch search = fit_scatter(points, map);
  ASSERT_EQ(search.candidates.size(), 4u);
  for (std::size_t c = 0; c < 4; ++c) {
    const ScatterFit& fit = search.candidates[c];
    EXPECT_EQ(fit.law.kind, scatter_kinds[c]);
    EXPECT_TRUE(fit.converged);
    EXPECT_GE(fit.agreeing, 2) << name_of(fit.law.kind);
    EXPECT_NEAR(fit.negative_log_likelihood, negative_log_likelihood(fit.law, points, map), 1e-8);
    EXPECT_DOUBLE_EQ(fit.aic, 2 * (size_of(fit.law.kind) + fit.negative_log_likelihood));
    // Each parameter by itself, and for two parameters all of a grid.
    const std::size_t size = fit.law.p.size();
    for (std::size_t i = 0; i < size; ++i) {
      for (const double step : {-0.02, -1e-3, 1e-3, 0.02}) {
        ScatterLaw other = fit.law;
        other.p[i] *= 1 + step;
        EXPECT_GE(negative_log_likelihood(other, points, map), fit.negative_log_likelihood - 1e-7);
      }
    }
    if (size > 2) continue;
    for (int i = -40; i <= 40; ++i) {
      for (int j = -40; j <= 40; ++j) {
        ScatterLaw other = fit.law;
        other.p[0] *= std::exp(0.05 * i);
        other.p[1] += 0.05 * j * std::abs(fit.law.p[1]);
        const double nll = negative_log_likelihood(other, points, map);
        if (std::isfinite(nll)) {
          EXPECT_GE(nll, fit.negative_log_likelihood - 1e-7);
        }
      }
    }
  }
  // Linear is within quadratic.
  EXPECT_LE(search.candidates[2].negative_log_likelihood,
            search.candidates[1].negative_log_likelihood + 1e-6);
  for (const ScatterFit& fit : search.candidates)
    EXPECT_GE(fit.aic, search.candidates[search.best].aic);
}

// Over many sets the estimates surround the truth: means of 12 within four standard errors.
TEST(Scatter, RecoversItsTruth) {
  const ScatterLaw truth{ScatterKind::linear, {40 * mm3_per_MJ, 2}};
  constexpr int sets = 12;
  double mean = 0, square = 0;
  for (int set = 0; set < sets; ++set) {
    const WearPoints points = scattered_points(truth, 100, 100 + static_cast<std::uint64_t>(set));
    const ScatterFit fit = fit_scatter(points, linear_map(points)).candidates[1];
    const double sigma = fit.law.formula(25 * mm3_per_MJ, {}) / mm3_per_MJ;  // 40 + 2 * 25 = 90
    mean += sigma / sets;
    square += sigma * sigma / sets;
  }
  EXPECT_NEAR(mean, 90, 4 * std::sqrt((square - mean * mean) / sets));
}

// Scatter that falls to nothing at one end: no candidate may go negative at a point.
TEST(Scatter, StaysPositive) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const WearPoints points =
        scattered_points({ScatterKind::linear, {-60 * mm3_per_MJ, 5}}, 60, seed);
    const WearMap map = linear_map(points);
    const ScatterSearch search = fit_scatter(points, map);
    for (std::size_t c = 0; c < search.candidates.size(); ++c) {
      double least = INFINITY;
      for (Eigen::Index j = 0; j < points.size(); ++j)
        least = std::min(least, search.candidates[c].law.formula(
                                    map.fit.fitted[j], points.at[static_cast<std::size_t>(j)]));
      EXPECT_GT(least, 0) << name_of(search.candidates[c].law.kind);
      EXPECT_DOUBLE_EQ(search.floors[c], 0.5 * least);
    }
  }
}

// sigma_j = sigma_w/sqrt(n_j), and the balance beside it.
TEST(Scatter, OfAPointFallsWithItsCycles) {
  WearPoints points;
  points.w = points.cycles = points.balance_sd = Eigen::VectorXd::Zero(2);
  points.at = {{200, 50, 170, 2}, {200, 50, 170, 2}};
  points.cycles << 100, 400;
  points.balance_sd << 0, 1.2;
  const ScatterLaw law{ScatterKind::conditions, {1, 0.1, 0.01, 0.02, 0.5}};
  // 1 + 17 + 2 + 1 + 1 = 22
  const Eigen::VectorXd sd = point_sd(law, points, Eigen::Vector2d(1, 1));
  EXPECT_NEAR(sd[0], 2.2, 1e-12);
  EXPECT_NEAR(sd[1], std::hypot(1.1, 1.2), 1e-12);
}

TEST(Scatter, KindsHaveNames) {
  for (const ScatterKind kind : scatter_kinds) EXPECT_EQ(read_scatter_kind(name_of(kind)), kind);
}

}  // namespace
}  // namespace wearwell::clutch
