#include "wearwell/models/bearing/seen_bearing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/models/bearing/inspected.h"
#include "wearwell/models/bearing/rate_integral.h"
#include "wearwell/models/bearing/wear_number.h"
#include "wearwell/prognosis/weighted_lives.h"

namespace wearwell::bearing {
namespace {

constexpr double sigma = 2e-6;

// Four bearings, each read twice; the last one wears fast.
Inspections four() {
  Inspections data;
  const double depth[] = {12e-6, 21e-6, 16e-6, 27e-6, 11e-6, 20e-6, 24e-6, 44e-6};
  for (std::size_t i = 0; i < 8; ++i) {
    data.duty.push_back(
        {Contact::stationary, 10e-3, 25e-6, 1e6, i % 2 == 0 ? 50'000.0 : 100'000.0});
    data.depth.push_back(depth[i]);
    data.bearing.push_back(i / 2);
  }
  return data;
}

// A posterior on a lattice over k and k_scatter, even in their logarithms, under flat priors on these.
WeightedDraws lattice(const WearModel& model, const Inspections& data, const LogDensity& density) {
  constexpr int ks = 60, scatters = 40;
  WeightedDraws draws;
  draws.values.resize(ks * scatters, 2);
  draws.weights.resize(ks * scatters);
  std::vector<double> log_l;
  for (int i = 0; i < ks; ++i) {
    for (int j = 0; j < scatters; ++j) {
      const int row = i * scatters + j;
      draws.values(row, 0) = 1.5e-15 * std::exp(0.04 * (i - ks / 2));
      draws.values(row, 1) = 0.05 * std::exp(0.08 * j);
      log_l.push_back(density.value({draws.values.row(row).data(), 2}));
    }
  }
  const double top = *std::max_element(log_l.begin(), log_l.end());
  for (Eigen::Index row = 0; row < draws.weights.size(); ++row)
    draws.weights[row] = std::exp(log_l[static_cast<std::size_t>(row)] - top);
  draws.weights /= draws.weights.sum();
  static_cast<void>(model);
  static_cast<void>(data);
  return draws;
}

// The law of ln k of one bearing by brute force: ln k, k_scatter and each bearing's z on plain sums, with the exact
// inverse geometry and nothing of the fit.
class BruteForce {
 public:
  BruteForce(const Inspections& data, const WeightedDraws& draws) : data_(data) {
    std::vector<double> mass(points, 0);
    for (std::size_t b = 0; b < 4; ++b) {
      for (int n = 0; n < points; ++n) likelihood_[b].push_back(std::exp(log_likelihood(b, at(n))));
    }
    for (Eigen::Index row = 0; row < draws.weights.size(); ++row) {
      const double log_k = std::log(draws.values(row, 0)), scatter = draws.values(row, 1);
      double others = 1;
      std::vector<double> own(points);
      for (std::size_t b = 0; b < 4; ++b) {
        double sum = 0;
        for (int n = 0; n < points; ++n) {
          const double z = (at(n) - log_k) / scatter;
          const double term = std::exp(-0.5 * z * z) / scatter * likelihood_[b][std::size_t(n)];
          sum += term;
          if (b == 3) own[static_cast<std::size_t>(n)] = term;
        }
        if (b < 3) others *= sum;
      }
      for (std::size_t n = 0; n < points; ++n) mass[n] += others * own[n];
    }
    const double all = std::accumulate(mass.begin(), mass.end(), 0.0);
    double before = 0;
    for (const double each : mass) {
      before += each / all;
      cdf_.push_back(before);
    }
  }

  // P(ln k <= x), whole steps.
  double cdf(double x) const {
    const double n = (x - from) / step - 0.5;
    const auto i = static_cast<std::size_t>(std::clamp(n, 0.0, points - 2.0));
    return std::lerp(cdf_[i], cdf_[i + 1], n - static_cast<double>(i));
  }

 private:
  static constexpr int points = 2000;
  static constexpr double from = -38, step = 8.0 / points;
  static double at(int n) { return from + (n + 0.5) * step - 0.5 * step; }

  double log_likelihood(std::size_t bearing, double log_k) const {
    double sum = 0;
    for (std::size_t i = 0; i < data_.depth.size(); ++i) {
      if (data_.bearing[i] != bearing) continue;
      const Duty& duty = data_.duty[i];
      const double w = std::exp(log_k) * duty.pressure * duty.revolutions;
      if (w > 0.2) return -1e9;
      const double depth = duty.radius * depth_for(duty.contact, duty.clearance / duty.radius, w);
      sum -= 0.5 * std::pow((data_.depth[i] - depth) / sigma, 2);
    }
    return sum;
  }

  const Inspections& data_;
  std::vector<double> likelihood_[4], cdf_;
};

TEST(SeenBearing, RateIsThatOfBruteForce) {
  const Inspections data = four();
  const WearModel model{ObservationFamily::normal, sigma, true};
  const WeightedDraws draws =
      lattice(model, data, *wear_likelihood(model, data, data.depth.size()));
  const BearingRate rate = bearing_rate(model, inspections_of(data, 3), guess(data).k, draws);
  const prognosis::WeightedLives curve(rate.log_k, rate.weight);
  const BruteForce brute(data, draws);
  for (const double p : {0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.999})
    EXPECT_NEAR(brute.cdf(curve.quantile(p)), p, 0.002 * std::sqrt(p * (1 - p)) + 5e-5) << p;
}

TEST(SeenBearing, NodesComeToTheIntegralOfTheFit) {
  const Inspections data = four();
  for (const ObservationFamily family : {ObservationFamily::normal, ObservationFamily::lognormal}) {
    for (std::size_t b = 0; b < 4; ++b) {
      const Inspections own = inspections_of(data, b);
      const Inspected inspected(family, depth_functions(own.duty, 1.5e-15), own.duty, own.depth);
      for (const double scatter : {1e-4, 0.02, 0.3, 3.0}) {
        for (const double s : {1e-8, 1e-6, 1e-4}) {
          double sum = 0, top = -INFINITY;
          const auto nodes = rate_nodes(inspected, std::log(1.5e-15), s, scatter, 0.8, 0.3);
          for (const RateNode& each : nodes) top = std::max(top, each.log_weight);
          for (const RateNode& each : nodes) sum += std::exp(each.log_weight - top);
          const double exact = log_rate_integral(inspected, std::log(1.5e-15), s, scatter).value;
          EXPECT_NEAR(top + std::log(sum), exact, 2e-3) << scatter << ' ' << s;
        }
      }
    }
  }
}

TEST(SeenBearing, WearsEvenlyUntilNowAndThenUnderThePressureToCome) {
  GoingOn going{{Contact::stationary, 10e-3, 25e-6, 1e6, 100'000}, 2e6, 3e-4, 50, 1e-3};
  const double at_now = std::log(3e-4 / 1e11);
  EXPECT_NEAR(life_at(going, at_now), 50, 1e-9);
  EXPECT_NEAR(life_at(going, at_now + std::log(2)), 25, 1e-9);  // was there in the middle
  // As much again at twice the pressure: half the revolutions.
  EXPECT_NEAR(life_at(going, at_now - std::log(2)), 50 + 50'000 * 1e-3, 1e-9);
}

}  // namespace
}  // namespace wearwell::bearing
