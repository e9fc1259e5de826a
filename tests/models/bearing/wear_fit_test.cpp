#include "wearwell/models/bearing/wear_fit.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "support/between.h"
#include "wearwell/input/table.h"
#include "wearwell/math/quadrature.h"

namespace wearwell::bearing {
namespace {

// examples/bearing/inspections.csv: eight bearings, three inspections each.
Inspections example() {
  const Table table = read_table(PROJECT_SOURCE_DIR "/examples/bearing/inspections.csv");
  const auto column = [&](const char* name) { return table.column(name).numbers; };
  Inspections data;
  std::map<std::string, std::size_t> names;
  for (std::size_t i = 0; i < table.rows; ++i) {
    data.duty.push_back({Contact::stationary, 10e-3, column("clearance_um")[i] * 1e-6,
                         column("force_N")[i] / (2 * 10e-3 * 20e-3), column("revolutions")[i]});
    data.depth.push_back(column("depth_um")[i] * 1e-6);
    data.bearing.push_back(
        names.emplace(table.column("bearing").text[i], names.size()).first->second);
  }
  return data;
}

WearModel full_model(ObservationFamily family) {
  return {family, {}, true};
}

// tests/golden/bearing_fit.R integrates each bearing with R's adaptive rule.
TEST(WearLikelihood, AgreesWithR) {
  const Inspections data = example();
  const auto likelihood =
      wear_likelihood(full_model(ObservationFamily::normal), data, data.depth.size());
  const Table golden =
      read_table(PROJECT_SOURCE_DIR "/tests/golden/bearing_fit.csv",
                 "select k, sigma, k_scatter, value from data where what = 'log_likelihood'");
  ASSERT_EQ(golden.rows, 5u);
  for (std::size_t i = 0; i < golden.rows; ++i) {
    const double x[] = {golden.columns[0].numbers[i], golden.columns[1].numbers[i],
                        golden.columns[2].numbers[i]};
    EXPECT_NEAR(likelihood->value(x), golden.columns[3].numbers[i], 2e-7) << "row " << i + 1;
  }
}

void expect_gradient(const LogDensity& density, std::vector<double> x, double tolerance) {
  std::vector<double> gradient(x.size()), unused(x.size());
  const double value = density.value_and_gradient(x, gradient);
  RC_ASSERT(std::abs(value - density.value(x)) <= 1e-12 * std::abs(value));
  for (std::size_t i = 0; i < x.size(); ++i) {
    // Wide enough for what the integrals of eight bearings leave open, 1e-7 each.
    const double middle = x[i], h = 5e-3 * middle;
    const auto at = [&](double there) {
      x[i] = there;
      return density.value(x);
    };
    // Fourth order, so that the difference is as good as the values.
    const double slope =
        (8 * (at(middle + h) - at(middle - h)) - (at(middle + 2 * h) - at(middle - 2 * h))) /
        (12 * h);
    x[i] = middle;
    const double scale = std::max(1.0, std::abs(slope * middle));
    RC_ASSERT(std::abs(gradient[i] - slope) * middle < tolerance * scale);
  }
}

RC_GTEST_PROP(WearLikelihood, GradientIsThatOfFiniteDifferences, ()) {
  static const Inspections data = example();
  static const auto normal =
      wear_likelihood(full_model(ObservationFamily::normal), data, data.depth.size());
  static const auto lognormal =
      wear_likelihood(full_model(ObservationFamily::lognormal), data, data.depth.size());
  static const auto alike =
      wear_likelihood({ObservationFamily::lognormal, {}, false}, data, data.depth.size());
  static const auto known =
      wear_likelihood({ObservationFamily::normal, 2e-6, true}, data, data.depth.size());
  // Around the posterior: farther out the gradient is large, and errors with it.
  const double k = *between(1e-15, 4e-15), sigma = *between(1e-6, 2e-5), scatter = *between(0.2, 2);
  // The quadrature itself is good to 1e-8 mostly, which a difference over 5e-3 makes 2e-6.
  expect_gradient(*normal, {k, sigma, scatter}, 1e-3);
  expect_gradient(*lognormal, {k, sigma, scatter}, 1e-2);
  expect_gradient(*alike, {k, sigma}, 1e-4);
  expect_gradient(*known, {k, scatter}, 1e-3);
}

// As the scatter vanishes, so does what it changes.
TEST(WearLikelihood, WithoutScatterIsTheLimit) {
  const Inspections data = example();
  for (const auto family : {ObservationFamily::normal, ObservationFamily::lognormal}) {
    const auto alike = wear_likelihood({family, {}, false}, data, data.depth.size());
    const auto scattered = wear_likelihood({family, {}, true}, data, data.depth.size());
    const double two[] = {2e-15, 8e-6}, three[] = {2e-15, 8e-6, 1e-7};
    EXPECT_NEAR(scattered->value(three), alike->value(two), 1e-6);
  }
}

// log of the integral over one bearing by brute force: ten-point Gauss-Legendre panels, finer and
// finer towards the highest of many values of z.
double brute_force(const LogDensity& alike, double k, double scatter) {
  const auto g = [&](double z) {
    const double rate[] = {k * std::exp(scatter * z)};
    return alike.value(rate) - 0.5 * z * z;
  };
  constexpr double far = 50;
  double top = 0, stride = 1e-2;
  for (double z = -far; z <= far; z += stride) {
    if (g(z) > g(top)) top = z;
  }
  for (; stride > 1e-8; stride /= 50) {
    const double around = top;
    for (int i = -100; i <= 100; ++i) {
      const double z = around + stride * i / 50;
      if (g(z) > g(top)) top = z;
    }
  }
  std::vector<double> edges = {-far, top, far};
  for (double width = 1e-7; width < 2 * far; width *= 1.25) {
    if (top - width > -far) edges.push_back(top - width);
    if (top + width < far) edges.push_back(top + width);
  }
  std::sort(edges.begin(), edges.end());
  static const GaussLegendre rule = gauss_legendre(10);
  double sum = 0;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const double half = 0.5 * (edges[i] - edges[i - 1]), middle = edges[i] - half;
    for (std::size_t j = 0; j < rule.node.size(); ++j)
      sum += half * rule.weight[j] * std::exp(g(middle + half * rule.node[j]) - g(top));
  }
  return g(top) + std::log(sum / std::sqrt(2 * M_PI));
}

// Noise from a thousandth of the depth (where the integrand is narrow) to ten times the depth
// (where no wear at all is likely as well); both families; bearings of one to four inspections,
// half of them with a revolution count that was mistyped by a factor of 10, and some whose
// depth is below zero.
RC_GTEST_PROP(WearLikelihood, IntegralIsThatOfBruteForce, ()) {
  const auto family =
      *rc::gen::arbitrary<bool>() ? ObservationFamily::normal : ObservationFamily::lognormal;
  Inspections data;
  const double truth = *between(1e-16, 1e-14);
  const double noise = std::pow(10, *between(0, 4) - 3);
  const int rows = *rc::gen::inRange(1, 5);
  const bool mistyped = *rc::gen::arbitrary<bool>();
  for (int i = 0; i < rows; ++i) {
    Duty duty{Contact::stationary, 0.01, *between(1e-5, 1e-4), 1e6, *between(5e4, 5e5)};
    const double depth = depth_functions({duty}, truth).front().depth(std::log(truth));
    if (mistyped && i == 0) duty.revolutions *= *rc::gen::arbitrary<bool>() ? 0.1 : 10;
    data.duty.push_back(duty);
    data.depth.push_back(depth * *between(0.7, 1.4));
    data.bearing.push_back(0);
  }
  if (family == ObservationFamily::normal && rows > 1 && *rc::gen::inRange(0, 4) == 0)
    data.depth[1] *= -1;
  const double sigma = noise * std::abs(data.depth.front()), scatter = *between(0.01, 3);
  const double k = truth * std::exp(*between(0, 6) - 3);
  const auto count = static_cast<std::size_t>(rows);
  const auto alike = wear_likelihood({family, sigma, false}, data, count);
  const auto scattered = wear_likelihood({family, sigma, true}, data, count);
  const double x[] = {k, scatter};
  const double value = scattered->value(x);
  // A top farther out than brute force looks is above what that finds.
  const double limit = depth_functions(data.duty, truth).front().limit();
  if (value < -300 || limit - std::log(k) < 8 * scatter) return;
  RC_ASSERT(std::abs(value - brute_force(*alike, k, scatter)) < 2e-6 * std::max(1.0, -value));
}

// Whatever the parameters, an evaluation ends, with a number or with zero likelihood.
RC_GTEST_PROP(WearLikelihood, EndsForAllParameters, ()) {
  static const Inspections data = [] {
    Inspections typo = example();
    typo.duty[2].revolutions /= 10;
    typo.depth[5] = typo.depth[4] = typo.depth[3];
    typo.depth[6] = -1e-6;
    return typo;
  }();
  const auto likelihood =
      wear_likelihood(full_model(ObservationFamily::normal), data, data.depth.size());
  const double x[] = {std::pow(10, *between(0, 300) - 165), std::pow(10, *between(0, 300) - 155),
                      std::pow(10, *between(0, 300) - 150)};
  double gradient[3];
  const double value = likelihood->value_and_gradient(x, gradient);
  RC_ASSERT(value < INFINITY);  // nor NaN
  if (value == -INFINITY) return;
  for (const double slope : gradient) RC_ASSERT(std::isfinite(slope));
}

TEST(WearLikelihood, IsZeroBeyondTheGeometry) {
  const Inspections data = example();
  const auto alike =
      wear_likelihood({ObservationFamily::normal, {}, false}, data, data.depth.size());
  const double x[] = {1e-12, 2e-6};
  EXPECT_EQ(alike->value(x), -INFINITY);
  // With scatter a bearing may still be within, but not 1e10 standard deviations away.
  const auto scattered =
      wear_likelihood(full_model(ObservationFamily::normal), data, data.depth.size());
  const double far[] = {1e-11, 2e-6, 1e-10};
  EXPECT_EQ(scattered->value(far), -INFINITY);
}

TEST(WearLikelihood, OfTheFirstInspectionsKnowsNoOthers) {
  Inspections data = example();
  const auto first = wear_likelihood(full_model(ObservationFamily::normal), data, 4);
  const double x[] = {2e-15, 2e-6, 0.3};
  const double before = first->value(x);
  for (std::size_t i = 4; i < data.depth.size(); ++i) data.depth[i] *= 1.3;
  EXPECT_NEAR(wear_likelihood(full_model(ObservationFamily::normal), data, 4)->value(x), before,
              1e-7 * std::abs(before));
}

TEST(WearGuess, IsExactForExactData) {
  Inspections data = example();
  for (std::size_t i = 0; i < data.depth.size(); ++i) {
    data.depth[i] = depth_functions({data.duty[i]}, 3e-15).front().depth(std::log(3e-15));
  }
  const WearGuess start = guess(data);
  EXPECT_NEAR(start.k / 3e-15, 1, 1e-8);
  EXPECT_NEAR(start.sigma, 0, 1e-13);
  EXPECT_NEAR(start.scatter, 0, 1e-6);
}

}  // namespace
}  // namespace wearwell::bearing
