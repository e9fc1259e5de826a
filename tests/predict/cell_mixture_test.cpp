// Distributions read off the nodes of a rule, against the laws that they are nodes of.
#include "wearwell/predict/cell_mixture.h"

#include <gtest/gtest.h>

#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace wearwell {
namespace {

double normal_cdf_of(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

struct Nodes {
  std::vector<double> z, share;
  explicit Nodes(double step, double shift = 0) {
    double sum = 0;
    for (double x = -8 + shift; x <= 8; x += step) {
      z.push_back(x);
      share.push_back(std::exp(-0.5 * x * x));
      sum += share.back();
    }
    for (double& each : share) each /= sum;
  }
  std::vector<double> values(double scatter) const {
    std::vector<double> all;
    for (const double each : z) all.push_back(std::exp(scatter * each));
    return all;
  }
};

// The z that the lognormal law gives the quantile for p, less the right one.
double off(const CellMixture& mixture, double scatter, double p) {
  const double z = std::log(mixture.quantile(p)) / scatter;
  return (normal_cdf_of(z) - p) / std::exp(-0.5 * z * z) * std::sqrt(2 * M_PI);
}

TEST(CurveOfNodes, HasTheQuantilesOfItsLaw) {
  for (const double scatter : {0.2, -0.2, 1.0}) {
    for (const double shift : {0.0, 0.1}) {
      const Nodes nodes(0.25, shift);
      CellMixture mixture;
      mixture.add_curve(0.7, nodes.share, nodes.values(scatter));
      EXPECT_NEAR(mixture.mass(), 0.7, 1e-12);
      for (const double p : {0.001, 0.01, 0.05, 0.3, 0.5, 0.95, 0.99}) {
        EXPECT_NEAR(off(mixture, std::abs(scatter), p), 0, scatter == 1 ? 5e-4 : 1.5e-4)
            << scatter << ' ' << shift << ' ' << p;
      }
    }
  }
}

// Also of what lies beyond a point; infinite where a share is never reached.
TEST(CurveOfNodes, HasTheMeanOfItsLaw) {
  for (const double scatter : {0.2, -0.2, 1.0}) {
    const Nodes nodes(0.25, 0.1);
    CellMixture mixture;
    mixture.add_curve(0.7, nodes.share, nodes.values(scatter));
    EXPECT_NEAR(mixture.mean() / std::exp(0.5 * scatter * scatter), 1, scatter == 1 ? 3e-4 : 2e-6);
    const double s = std::abs(scatter), z = std::log(1.2) / s;
    const double beyond = std::exp(0.5 * s * s) * normal_cdf_of(s - z) / normal_cdf_of(-z) - 1.2;
    EXPECT_NEAR(mixture.beyond(1.2).mean() / beyond, 1, scatter == 1 ? 1e-3 : 5e-3) << scatter;
    mixture.add(1e-9, 1, std::numeric_limits<double>::infinity());
    EXPECT_EQ(mixture.mean(), std::numeric_limits<double>::infinity());
  }
  EXPECT_TRUE(std::isnan(CellMixture().mean()));
}

// Cells spread evenly between the nodes are wider by a twelfth of the step's square and more: this test can fail.
TEST(CurveOfNodes, EvenCellsWouldNotHaveThem) {
  const Nodes nodes(0.25);
  const std::vector<double> values = nodes.values(0.2);
  CellMixture even;
  for (std::size_t i = 0; i + 1 < nodes.z.size(); ++i) {
    even.add(normal_cdf_of(nodes.z[i + 1]) - normal_cdf_of(nodes.z[i]), values[i], values[i + 1]);
  }
  EXPECT_LT(off(even, 0.2, 0.01), -2e-3);
}

TEST(CurveOfNodes, WhatLiesBeyondIsTheLawBeyond) {
  const Nodes nodes(0.25);
  const std::vector<double> values = nodes.values(0.2);
  for (const double from : {0.83, 1.02, 1.3}) {
    CellMixture mixture;
    const double beyond = 1 - normal_cdf_of(std::log(from) / 0.2);
    EXPECT_NEAR(mixture.add_curve(1, nodes.share, values, from), beyond, 1e-5);
    EXPECT_NEAR(mixture.mass(), beyond, 1e-5);
    for (const double p : {0.01, 0.05, 0.5, 0.95}) {
      const double cdf = normal_cdf_of(std::log(mixture.quantile(p)) / 0.2);
      EXPECT_NEAR((cdf - (1 - beyond)) / beyond, p, 5e-5) << from << ' ' << p;
    }
  }
}

TEST(CurveOfNodes, WhatNeverComesNeverComes) {
  const Nodes nodes(0.25);
  std::vector<double> values = nodes.values(0.2);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (nodes.z[i] > 1) values[i] = std::numeric_limits<double>::infinity();
  }
  CellMixture mixture;
  mixture.add_curve(1, nodes.share, values);
  EXPECT_NEAR(std::log(mixture.quantile(0.5)) / 0.2, 0, 1e-3);
  EXPECT_EQ(mixture.quantile(0.9), std::numeric_limits<double>::infinity());
  values[3] = std::nan("");
  mixture.add_curve(1, nodes.share, values);
  EXPECT_TRUE(std::isnan(mixture.quantile(0.5)));
}

// Lives of 400 populations: medians and scatters that differ.
CellMixture many_curves(double scatter, bool in_pieces) {
  const Nodes nodes(0.4);
  CellMixture all;
  for (int k = 0; k < 400; ++k) {
    const double median = std::exp(0.3 * std::sin(0.7 * k)), sd = scatter * (1 + 0.3 * std::cos(k));
    std::vector<double> values = nodes.values(sd);
    for (double& each : values) each *= median;
    all.add_curve(1 + 0.5 * std::sin(1.3 * k), nodes.share, values);
    if (in_pieces && k % 20 == 19) all.condense(1000);
  }
  return all;
}

TEST(CondensedMixture, KeepsQuantilesAndMeans) {
  for (const double scatter : {0.05, 0.3, 1.0}) {
    const CellMixture all = many_curves(scatter, false);
    CellMixture condensed = all;
    condensed.condense(1000);
    const CellMixture& few = condensed;
    EXPECT_GT(all.size(), 15000u);
    EXPECT_LE(few.size(), 1002u);
    const CellMixture pieces = many_curves(scatter, true);
    EXPECT_LE(pieces.size(), 1002u);
    for (const CellMixture* each : {&few, &pieces}) {
      EXPECT_NEAR(each->mass() / all.mass(), 1, 1e-12);
      EXPECT_NEAR(each->mean() / all.mean(), 1, 1e-5);
      for (const double p : {1e-6, 1e-4, 0.001, 0.01, 0.1, 0.5, 0.9, 0.99, 0.9999}) {
        const double life = all.quantile(p);
        EXPECT_NEAR(each->cdf(life) / p, 1, p < 1e-4 ? 1e-3 : 1e-4) << scatter << ' ' << p;
        EXPECT_NEAR((1 - each->cdf(life)) / (1 - p), 1, 5e-4) << scatter << ' ' << p;
      }
    }
  }
}

TEST(CondensedMixture, KeepsPointsAndWhatNeverComes) {
  CellMixture mixture;
  for (int k = 0; k < 5000; ++k) {
    mixture.add(1, k % 3, k % 3);  // points at 0, 1 and 2
    mixture.add(1, 3, 4);
    mixture.add(0.5, 5, std::numeric_limits<double>::infinity());
  }
  const double sixth = 5000.0 / 12500 / 3;
  mixture.condense(100);
  EXPECT_LE(mixture.size(), 102u);
  EXPECT_NEAR(mixture.mass(), 12500, 1e-9);
  EXPECT_NEAR(mixture.cdf(0.001), sixth, 1e-4);
  EXPECT_NEAR(mixture.cdf(2), 3 * sixth, 1e-4);
  EXPECT_NEAR(mixture.cdf(3.5), 0.6, 1e-9);
  EXPECT_EQ(mixture.quantile(0.9), std::numeric_limits<double>::infinity());
  mixture.add(1, std::nan(""), 1);
  mixture.condense(2);
  EXPECT_TRUE(std::isnan(mixture.quantile(0.5)));
}

// Points that stand for a density, condensed many times over, do not drift: those of a standard normal quantity in an order that
// mixes them.
TEST(CondensedMixture, DoesNotMovePoints) {
  constexpr int count = 60000;
  CellMixture all, pieces;
  for (int k = 0; k < count; ++k) {
    const double p = (static_cast<double>(k * 7919LL % count) + 0.5) / count;
    const double z = -std::numbers::sqrt2 * boost::math::erfc_inv(2 * p);
    all.add(1, z, z);
    pieces.add(1, z, z);
    pieces.limit_size();
  }
  EXPECT_LE(pieces.size(), 8192u);
  for (const double p : {0.01, 0.05, 0.5, 0.95, 0.99})
    EXPECT_NEAR(pieces.cdf(all.quantile(p)), p, 1e-4) << p;
  EXPECT_NEAR(pieces.mean(), 0, 1e-4);
}

}  // namespace
}  // namespace wearwell
