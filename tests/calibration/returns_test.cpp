// Forecasts of warranty returns: parameters drawn from their priors, triangles from the parameters; how often the 90 % intervals hold
// the returns of the months that are held out. WEARWELL_REPLICATIONS says how many.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdio>

#include "calibration/shares.h"
#include "models/formula_model/simulated_returns.h"

namespace wearwell::formula_model {
namespace {

void calibrate_returns(const std::string& name, double units, int later) {
  const int count = replications(1000);
  std::vector<int> first(static_cast<std::size_t>(count)), all(first.size());
  std::vector<double> difference(first.size());
  tbb::parallel_for(std::size_t{0}, first.size(), [&](std::size_t i) {
    const SimulatedReturns one(units, later, i);
    first[i] = one.first;
    all[i] = one.all;
    difference[i] = one.returned - one.expected;
  });
  int first_held = 0, all_held = 0;
  double sum = 0, square = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    first_held += first[i];
    all_held += all[i];
    sum += difference[i];
    square += difference[i] * difference[i];
  }
  fmt::print(
      "{}, {} triangles: 90 % intervals hold the first month {:.1f} %, six months {:.1f} %; "
      "mean error {:.2f} +- {:.2f}\n",
      name, count, 100.0 * first_held / count, 100.0 * all_held / count, sum / count,
      std::sqrt(square) / count);
  std::fflush(stdout);
  // Whole numbers hold more.
  expect_share(count - first_held, count, 0.1, name + ", first month outside");
  expect_share(count - all_held, count, 0.1, name + ", six months outside");
  EXPECT_LT(std::abs(sum), 4.5 * std::sqrt(square)) << name;
}

TEST(ReturnsCalibration, HeldOutReturns) {
  calibrate_returns("20 units a month", 20, 0);
  calibrate_returns("60 units a month, sales go on", 60, 3);
  calibrate_returns("600 units a month", 600, 0);
}

// Simulation-based calibration (Talts et al. 2018): the places of the true parameters in their posteriors are even.
TEST(ReturnsCalibration, LivesBehindDelays) {
  constexpr int bins = 20;
  const int count = replications(400);
  std::vector<std::array<double, 2>> places(static_cast<std::size_t>(count));
  std::vector<double> difference(places.size());
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    const SimulatedReturns one(100, 2, 100000 + i, true);
    places[i] = {one.place[0], one.place[1]};
    difference[i] = one.returned - one.expected;
  });
  for (std::size_t p = 0; p < 2; ++p) {
    double bin[bins] = {}, chi_squared = 0;
    for (const auto& each : places) bin[std::min(bins - 1, static_cast<int>(bins * each[p]))] += 1;
    const double expected = static_cast<double>(count) / bins;
    for (const double n : bin) chi_squared += (n - expected) * (n - expected) / expected;
    const double p_value = cdf(complement(boost::math::chi_squared(bins - 1), chi_squared));
    fmt::print("returns with delays, {}: {} triangles, chi-squared {:.1f}, p {:.3f}\n",
               p == 0 ? "scale" : "shape", count, chi_squared, p_value);
    EXPECT_GT(p_value, 1e-3) << p;
  }
  double sum = 0, square = 0;
  for (const double each : difference) {
    sum += each;
    square += each * each;
  }
  fmt::print("mean error of the forecast {:.2f} +- {:.2f}\n", sum / count,
             std::sqrt(square) / count);
  EXPECT_LT(std::abs(sum), 4.5 * std::sqrt(square));
}

}  // namespace
}  // namespace wearwell::formula_model
