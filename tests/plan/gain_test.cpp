#include "wearwell/plan/gain.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/error.h"
#include "wearwell/plan/goal_target.h"
#include "wearwell/plan/linear_gain.h"

namespace wearwell::plan {
namespace {

// A straight line y = t0 + t1 x with known error: the parameters are normal, so is every posterior.
struct Line {
  double sd0 = 1, sd1 = 0.8, correlation = 0.5, error = 0.7;
  double c0 = 1, c1 = 2;  // the goal is c0 t0 + c1 t1

  double covariance(double a0, double a1, double b0, double b1) const {
    const double both = correlation * sd0 * sd1;
    return a0 * b0 * sd0 * sd0 + a1 * b1 * sd1 * sd1 + (a0 * b1 + a1 * b0) * both;
  }
  double variance() const { return covariance(c0, c1, c0, c1); }
  // After n readings at x: the closed form of Bayesian linear regression.
  double variance_after(double x, int n) const {
    const double shared = covariance(c0, c1, 1, x);
    return variance() - shared * shared / (covariance(1, x, 1, x) + error * error / n);
  }
  double information(double x, int n) const {
    return 0.5 * std::log1p(n * covariance(1, x, 1, x) / (error * error));
  }
};

struct LineNodes {
  GoalNodes goal;
  std::vector<double> t0, t1;

  explicit LineNodes(const Line& line) {
    constexpr int count = 45;
    struct Node {
      double t0, t1, goal, weight;
    };
    std::vector<Node> nodes;
    double sum = 0;
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        const double z0 = -5 + 10.0 * i / (count - 1), z1 = -5 + 10.0 * j / (count - 1);
        const double t0 = line.sd0 * z0;
        const double t1 = line.sd1 * (line.correlation * z0 +
                                      std::sqrt(1 - line.correlation * line.correlation) * z1);
        nodes.push_back(
            {t0, t1, line.c0 * t0 + line.c1 * t1, std::exp(-0.5 * (z0 * z0 + z1 * z1))});
        sum += nodes.back().weight;
      }
    }
    std::sort(nodes.begin(), nodes.end(),
              [](const Node& a, const Node& b) { return a.goal < b.goal; });
    for (const Node& each : nodes) {
      goal.goal.push_back(each.goal);
      goal.weight.push_back(each.weight / sum);
      t0.push_back(each.t0), t1.push_back(each.t1);
    }
  }

  // One reading at x, on an even grid: the trapezoidal rule converges geometrically.
  Outcomes reading(const Line& line, double x) const {
    Outcomes outcomes;
    const double step = 0.4 * line.error, reach = 9 * (1 + std::abs(x)) + 6 * line.error;
    for (double y = -reach; y <= reach; y += step) outcomes.value.push_back(y);
    outcomes.cell_begin = outcomes.cell_end = outcomes.value;
    const auto n = static_cast<Eigen::Index>(t0.size());
    outcomes.log_probability.resize(n, static_cast<Eigen::Index>(outcomes.size()));
    for (Eigen::Index j = 0; j < n; ++j) {
      for (std::size_t m = 0; m < outcomes.size(); ++m) {
        const auto k = static_cast<std::size_t>(j);
        const double z = (outcomes.value[m] - t0[k] - t1[k] * x) / line.error;
        outcomes.log_probability(j, static_cast<Eigen::Index>(m)) =
            static_cast<float>(-0.5 * z * z + std::log(step / line.error) - 0.918938533204672742);
      }
    }
    return outcomes;
  }
};

TEST(Gain, OfOneReadingIsTheClosedFormOfLinearRegression) {
  const Line line;
  const LineNodes nodes(line);
  for (const double x : {-2.0, -0.5, 0.0, 1.0, 3.0}) {
    const Gain gain = gain_of_one(nodes.goal, nodes.reading(line, x));
    EXPECT_NEAR(gain.variance, line.variance_after(x, 1), 0.01 * line.variance_after(x, 1)) << x;
    EXPECT_NEAR(gain.information, line.information(x, 1), 0.01 * line.information(x, 1)) << x;
    // The width of a normal posterior is the same after all outcomes.
    EXPECT_NEAR(gain.width, 3.28970725 * std::sqrt(line.variance_after(x, 1)), 0.02 * gain.width)
        << x;
  }
}

TEST(Gain, RanksDesignsAsTheOptimalOnes) {
  const Line line;
  const LineNodes nodes(line);
  // D-optimal is the reading with the largest predictive variance; c-optimal another one.
  double most = -1, best_information = 0, least = 1e9, best_variance = 0;
  double most_exact = -1, exact_information = 0, least_exact = 1e9, exact_variance = 0;
  for (double x = -1; x <= 2.01; x += 0.25) {
    const Gain gain = gain_of_one(nodes.goal, nodes.reading(line, x));
    if (gain.information > most) most = gain.information, best_information = x;
    if (gain.variance < least) least = gain.variance, best_variance = x;
    const double information = line.information(x, 1), variance = line.variance_after(x, 1);
    if (information > most_exact) most_exact = information, exact_information = x;
    if (variance < least_exact) least_exact = variance, exact_variance = x;
  }
  EXPECT_DOUBLE_EQ(best_information, exact_information);
  EXPECT_DOUBLE_EQ(best_variance, exact_variance);
}

// Two decisions, one of which costs the goal less k: the value of a reading is the unit normal loss
// integral (Raiffa and Schlaifer 1961, section 5.4) of the means that the reading may lead to.
TEST(Gain, SavesTheNormalLossIntegral) {
  const Line line;
  LineNodes nodes(line);
  constexpr double k = 0.5;
  nodes.goal.loss.resize(static_cast<Eigen::Index>(nodes.goal.goal.size()), 2);
  for (std::size_t j = 0; j < nodes.goal.goal.size(); ++j)
    nodes.goal.loss.row(static_cast<Eigen::Index>(j)) << 0, nodes.goal.goal[j] - k;
  nodes.goal.best = 1;
  const auto exact = [&](double x, int n) {
    const double s = std::sqrt(line.variance() - line.variance_after(x, n)), u = k / s;
    return s * (std::exp(-0.5 * u * u) / std::sqrt(2 * std::acos(-1.0)) -
                0.5 * u * std::erfc(u / std::sqrt(2.0)));
  };
  for (const double x : {-2.0, -0.5, 0.0, 1.0, 3.0})
    EXPECT_NEAR(gain_of_one(nodes.goal, nodes.reading(line, x)).saved, exact(x, 1),
                0.01 * exact(x, 1) + 1e-4)
        << x;
  const Outcomes reading = nodes.reading(line, 1);
  const Gain three = gain_of_batch(nodes.goal, {{&reading}, {3}}, {400, 1});
  EXPECT_NEAR(three.saved, exact(1, 3), 3 * three.saved_error);
  EXPECT_LT(three.saved_error, 0.1 * three.saved);
  nodes.goal.loss.resize(0, 0);
  EXPECT_EQ(gain_of_one(nodes.goal, reading).saved, 0);
}

// The same line by the conjugate update, against its closed form.
TEST(LinearGain, IsTheClosedFormOfLinearRegression) {
  const Line line;
  const double both = line.correlation * line.sd0 * line.sd1;
  const Eigen::MatrixXd covariance =
      Eigen::Matrix2d{{line.sd0 * line.sd0, both}, {both, line.sd1 * line.sd1}};
  const Eigen::VectorXd goal = Eigen::Vector2d(line.c0, line.c1);
  const auto reading = [&](double x, int n) {
    return LinearTest{Eigen::Vector2d(1, x), line.error * line.error, n};
  };
  for (const double x : {-2.0, 0.0, 3.0})
    for (const int n : {1, 7}) {
      const LinearTest tests[] = {reading(x, n)};
      const LinearGain gain = linear_gain(covariance, goal, tests);
      EXPECT_NEAR(gain.variance, line.variance_after(x, n), 1e-12);
      EXPECT_NEAR(gain.information, line.information(x, n), 1e-12);
    }
  // In any order, and one by one.
  const LinearTest one[] = {reading(-1, 2), reading(3, 1)},
                   other[] = {reading(3, 1), reading(-1, 1), reading(-1, 1)};
  EXPECT_NEAR(linear_gain(covariance, goal, one).variance,
              linear_gain(covariance, goal, other).variance, 1e-12);
  EXPECT_NEAR(linear_gain(covariance, goal, one).information,
              linear_gain(covariance, goal, other).information, 1e-12);
}

TEST(Gain, OfSeveralReadingsAgreesWithinItsError) {
  const Line line;
  const LineNodes nodes(line);
  const Outcomes reading = nodes.reading(line, 1);
  double before = gain_of_one(nodes.goal, reading).width;
  for (const int n : {2, 4, 8}) {
    const Gain gain = gain_of_batch(nodes.goal, {{&reading}, {n}}, {600, 3});
    EXPECT_NEAR(gain.information, line.information(1, n), 4 * gain.information_error) << n;
    // All posteriors have one variance, so simulation adds hardly any error to it.
    EXPECT_NEAR(gain.variance, line.variance_after(1, n), 0.01 * line.variance_after(1, n)) << n;
    EXPECT_LT(gain.width, before) << n;
    before = gain.width;
  }
}

TEST(Gain, OfABatchIsThatOfItsParts) {
  const Line line;
  const LineNodes nodes(line);
  const Outcomes low = nodes.reading(line, -1), high = nodes.reading(line, 2);
  const Gain together = gain_of_batch(nodes.goal, {{&low, &high}, {1, 1}}, {400, 1});
  // Two readings: update twice.
  const double a = line.covariance(1, -1, 1, -1), b = line.covariance(1, 2, 1, 2),
               ab = line.covariance(1, -1, 1, 2), e = line.error * line.error;
  const double exact = 0.5 * std::log(((a + e) * (b + e) - ab * ab) / (e * e));
  EXPECT_NEAR(together.information, exact, 4 * together.information_error);
}

TEST(Gain, DoesNotDependOnThreads) {
  const Line line;
  const LineNodes nodes(line);
  const Outcomes reading = nodes.reading(line, 1);
  const auto gain = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return gain_of_batch(nodes.goal, {{&reading}, {3}}, {100, 7});
  };
  const Gain one = gain(1), four = gain(4);
  EXPECT_EQ(one.width, four.width);
  EXPECT_EQ(one.variance, four.variance);
  EXPECT_EQ(one.information, four.information);
}

TEST(Gain, IsNothingWhereAllRunOut) {
  const Line line;
  const LineNodes nodes(line);
  Outcomes outcomes;
  outcomes.value = {1e-9, 1};
  outcomes.runout = true;
  outcomes.log_probability.resize(static_cast<Eigen::Index>(nodes.t0.size()), 2);
  outcomes.log_probability.col(0).setConstant(-1e6F);
  outcomes.log_probability.col(1).setZero();
  const Gain gain = gain_of_one(nodes.goal, outcomes);
  EXPECT_NEAR(gain.variance, line.variance(), 1e-3 * line.variance());
  EXPECT_NEAR(gain.information, 0, 1e-9);
  EXPECT_NEAR(gain.runout, 1, 1e-9);
  EXPECT_NEAR(gain.use, 1, 1e-9);
}

TEST(GoalSpread, IsThatOfANormalDistribution) {
  std::vector<double> goal, weight;
  for (int i = 0; i <= 400; ++i) {
    goal.push_back(-6 + 12.0 * i / 400);
    weight.push_back(std::exp(-0.5 * goal.back() * goal.back()));
  }
  const GoalSpread spread = goal_spread(goal, weight);
  EXPECT_NEAR(spread.sd, 1, 1e-6);
  EXPECT_NEAR(spread.median, 0, 1e-9);
  EXPECT_NEAR(spread.high, 1.6448536, 1e-3);
  EXPECT_NEAR(spread.low, -1.6448536, 1e-3);
}

TEST(GoalTarget, ReadsFactorsAndDifferences) {
  EXPECT_NEAR(target_width("width <= factor 1.5", {"cycles", 1, 0}, true), std::log(1.5), 1e-12);
  EXPECT_NEAR(target_width("width <= 20 MPa", {"MPa", 1e6, 0}, false), 20, 1e-12);
  EXPECT_NEAR(target_width("width <= 2e7 Pa", {"MPa", 1e6, 0}, false), 20, 1e-9);
  EXPECT_THROW(target_width("width <= 20 MPa", {"MPa", 1e6, 0}, true), InputError);
  EXPECT_THROW(target_width("width <= factor 0.9", {"h", 3600, 0}, true), InputError);
  EXPECT_THROW(target_width("narrow", {"h", 3600, 0}, true), InputError);
  EXPECT_THROW(target_width("width <= 20 h", {"MPa", 1e6, 0}, false), InputError);
}

}  // namespace
}  // namespace wearwell::plan
