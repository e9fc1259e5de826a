#include "wearwell/bayes/weighted_draws.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "cells.h"
#include "support/between.h"
#include "wearwell/bayes/cell_shares.h"
#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

WeightedDraws draws_of(const std::vector<double>& x) {
  const auto n = static_cast<Eigen::Index>(x.size());
  WeightedDraws draws{
      Points(n, 1), Eigen::VectorXd::Constant(n, 1 / static_cast<double>(n)), {}, {}};
  for (Eigen::Index i = 0; i < n; ++i) draws.values(i, 0) = x[static_cast<std::size_t>(i)];
  return draws;
}

// R 4.2.2: x <- c(1, 2, 4, 8, 16, 32); mean(x); sd(x); quantile(x, c(.05, .3, .95)); ecdf(x)(c(0,
// 3, 4, 32))
TEST(QuantityDistribution, OfDrawsIsRs) {
  const QuantityDistribution d(draws_of({8, 1, 32, 2, 16, 4}), itself);
  EXPECT_DOUBLE_EQ(d.mean(), 10.5);
  EXPECT_DOUBLE_EQ(d.sd(), 11.861703081766969);
  EXPECT_DOUBLE_EQ(d.quantile(0.05), 1.25);
  EXPECT_DOUBLE_EQ(d.quantile(0.3), 3);
  EXPECT_DOUBLE_EQ(d.quantile(0.95), 28);
  EXPECT_EQ(d.cdf(0), 0);
  EXPECT_DOUBLE_EQ(d.cdf(3), 1. / 3);
  EXPECT_DOUBLE_EQ(d.cdf(4), 0.5);
  EXPECT_DOUBLE_EQ(d.cdf(32), 1);
}

// Points of few regions of a posterior, or nodes without their cells: of 1, 2 .. 1000, each with its value for a weight, half the
// weight lies below 1000/sqrt(2). A last one without end holds a thousandth.
TEST(QuantityDistribution, UnevenPointsCountByTheirWeight) {
  constexpr Eigen::Index n = 1001;
  WeightedDraws draws{Points(n, 1), Eigen::VectorXd(n), {}, {}};
  for (Eigen::Index i = 0; i < n; ++i) {
    draws.values(i, 0) = i == n - 1 ? infinity : double(i + 1);
    draws.weights[i] = i == n - 1 ? 0.001 : 0.999 * double(i + 1) / 500500;
  }
  const QuantityDistribution d(draws, itself);
  for (const double p : {0.05, 0.5, 0.9})
    EXPECT_NEAR(d.quantile(p), 1000 * std::sqrt(p / 0.999), 1.5) << p;
  EXPECT_NEAR(d.cdf(500), 0.25 * 0.999, 1e-3);
  EXPECT_EQ(d.quantile(0.9999), infinity);
}

TEST(QuantityDistribution, InfiniteDraws) {
  const QuantityDistribution d(draws_of({2, infinity, 1, infinity, 3}), itself);
  EXPECT_DOUBLE_EQ(d.quantile(0.125), 1.5);
  EXPECT_DOUBLE_EQ(d.quantile(0.5), 3);
  EXPECT_EQ(d.quantile(0.6), infinity);
  EXPECT_EQ(d.quantile(0.9), infinity);
  EXPECT_EQ(d.mean(), infinity);
  EXPECT_DOUBLE_EQ(d.cdf(1e300), 0.6);
  EXPECT_DOUBLE_EQ(d.cdf(infinity), 1);
}

// By hand: [-1, 0] holds 1/4 and [0, 1] holds 3/4, wherever in them the nodes lie.
TEST(QuantityDistribution, OfCellsIsPiecewiseUniform) {
  const QuantityDistribution d(cells_of({{0, 0.2, 1, 0.75}, {-1, -0.9, 0, 0.25}}), itself);
  EXPECT_DOUBLE_EQ(d.mean(), 0.25);
  EXPECT_DOUBLE_EQ(d.sd(), std::sqrt(1. / 3 - 1. / 16));
  EXPECT_DOUBLE_EQ(d.cdf(-0.5), 0.125);
  EXPECT_DOUBLE_EQ(d.cdf(0.5), 0.625);
  EXPECT_NEAR(d.quantile(0.625), 0.5, 1e-11);
  EXPECT_NEAR(d.quantile(0.25), 0, 1e-11);
  EXPECT_NEAR(d.quantile(0.125), -0.5, 1e-11);
}

// Two axes: a node moves by either, and the variances of the two add.
TEST(QuantityDistribution, AxesAddTheirVariances) {
  WeightedDraws one{Points(1, 2), Eigen::VectorXd::Ones(1), {}, {}};
  one.values << 5, 7;
  for (const auto& [a, b] : {std::pair(3., 0.), std::pair(0., 4.)}) {
    one.lower.push_back(one.values - Eigen::RowVector2d(a, b));
    one.upper.push_back(one.values + Eigen::RowVector2d(a, b));
  }
  const QuantityDistribution d(one, [](const double* x) { return x[0] + x[1]; });
  EXPECT_DOUBLE_EQ(d.mean(), 12);
  EXPECT_DOUBLE_EQ(d.sd(), std::sqrt((3 * 3 + 4 * 4) / 3.));
}

std::vector<Cell> any_cells() {
  const auto n = *rc::gen::inRange<std::size_t>(1, 30);
  std::vector<Cell> cells;
  double total = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double lower = *between(1e-3, 10) - 5, upper = lower + *between(1e-3, 3);
    cells.push_back(
        {lower, lower + (upper - lower) * *between(0.1, 0.9), upper, *between(1e-6, 1)});
    total += cells.back().weight;
  }
  for (Cell& cell : cells) cell.weight /= total;
  return cells;
}

RC_GTEST_PROP(QuantityDistribution, QuantileInvertsCdf, ()) {
  const std::vector<Cell> cells = any_cells();
  const QuantityDistribution d(cells_of(cells), itself);
  const double p = *between(1e-6, 1 - 1e-6);
  RC_ASSERT(std::abs(d.cdf(d.quantile(p)) - p) < 1e-7);
}

RC_GTEST_PROP(QuantityDistribution, QuantileOfOneIsTheUpperEnd, ()) {
  const std::vector<Cell> cells = any_cells();
  double upper = -infinity;
  for (const Cell& cell : cells) upper = std::max(upper, cell.upper);
  const QuantityDistribution d(cells_of(cells), itself);
  RC_ASSERT(std::abs(d.quantile(1) - upper) < 1e-7);
}

// A limit that some nodes have passed already has a life of 0 there: an atom.
TEST(QuantityDistribution, AtomAtZero) {
  const auto life = [](const double* x) { return std::max(0.0, x[0]); };
  const QuantityDistribution d(
      cells_of({{-2, -1.5, -1, 0.5}, {-1, -0.5, 0, 0.25}, {0, 0.5, 1, 0.25}}), life);
  EXPECT_NEAR(d.quantile(0.5), 0, 1e-12);
  EXPECT_NEAR(d.quantile(0.7), 0, 1e-12);
  EXPECT_NEAR(d.quantile(0.875), 0.5, 1e-12);
  const QuantityDistribution all(cells_of({{-2, -1.5, -1, 1}}), life);
  EXPECT_EQ(all.quantile(0.1), 0);
  EXPECT_EQ(all.quantile(0.99), 0);
}

TEST(QuantityDistribution, CellsThatAreInfinite) {
  const auto life = [](const double* x) { return x[0] <= 1 ? infinity : x[0]; };
  const QuantityDistribution d(cells_of({{0, 0.5, 1, 0.25}, {2, 3, 4, 0.5}, {4, 5, 6, 0.25}}),
                               life);
  EXPECT_NEAR(d.quantile(0.25), 3, 1e-11);
  EXPECT_NEAR(d.quantile(0.7499), 6, 1e-2);
  EXPECT_EQ(d.quantile(0.76), infinity);
  EXPECT_DOUBLE_EQ(d.cdf(1e9), 0.75);
  EXPECT_DOUBLE_EQ(d.cdf(infinity), 1);
}

// The quantity may be infinite at the node alone.
TEST(QuantityDistribution, InfiniteNodeBetweenFiniteEnds) {
  const auto pole = [](const double* x) { return x[0] == 0.5 ? infinity : 1 / (x[0] - 0.5); };
  const QuantityDistribution d(cells_of({{0, 0.5, 1, 0.25}, {2, 3, 4, 0.75}}), pole);
  EXPECT_EQ(d.quantile(0.9), infinity);
  EXPECT_DOUBLE_EQ(d.cdf(1), 0.75);
}

// A node without weight does not count, whatever the quantity is there.
TEST(QuantityDistribution, WeightlessNodes) {
  const auto life = [](const double* x) { return x[0] < 1 ? infinity : x[0]; };
  const QuantityDistribution d(cells_of({{0, 0.5, 1, 0}, {2, 3, 4, 1}}), life);
  EXPECT_DOUBLE_EQ(d.mean(), 3);
  EXPECT_DOUBLE_EQ(d.sd(), std::sqrt(1. / 3));
  EXPECT_NEAR(d.quantile(0.75), 3.5, 1e-11);
}

TEST(WeightedSampler, HasTheMomentsOfItsCells) {
  WeightedDraws draws{Points(3, 2), Eigen::Vector3d(0.2, 0.3, 0.5), {}, {}};
  draws.values << 0, 1, 4, 2, -3, 5;
  const Eigen::RowVector2d first(0.5, 0.25), second(-0.3, 0.9);  // half a cell along each axis
  for (const auto& half : {first, second}) {
    draws.lower.push_back(draws.values.rowwise() - half);
    draws.upper.push_back(draws.values.rowwise() + half);
  }
  const Eigen::Vector2d mean = draws.values.transpose() * draws.weights;
  Eigen::Matrix2d covariance =
      (first.transpose() * first + second.transpose() * second) / 3;  // of a uniform: h^2/3
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Vector2d d = draws.values.row(i).transpose() - mean;
    covariance += draws.weights[i] * d * d.transpose();
  }

  constexpr int n = 400'000;
  Rng rng(11, 3);
  const WeightedSampler sample(draws);
  Eigen::Vector2d sum(0, 0);
  Eigen::Matrix2d products = Eigen::Matrix2d::Zero(), their_squares = products;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2d d = sample(rng) - mean;
    sum += d;
    const Eigen::Matrix2d product = d * d.transpose();
    products += product;
    their_squares += product.cwiseAbs2();
  }
  for (int r = 0; r < 2; ++r) {
    EXPECT_NEAR(sum[r] / n, 0, 5 * std::sqrt(covariance(r, r) / n));
    for (int c = 0; c < 2; ++c) {
      EXPECT_NEAR(products(r, c) / n, covariance(r, c), 5 * std::sqrt(their_squares(r, c)) / n);
    }
  }
}

TEST(WeightedSampler, ChoosesPointsByWeight) {
  WeightedDraws draws = draws_of({0, 1, 2});
  draws.weights << 0, 0.3, 0.7;
  Rng rng(5, 0);
  const WeightedSampler sample(draws);
  constexpr int n = 100'000;
  int count[3] = {};
  for (int i = 0; i < n; ++i) ++count[static_cast<int>(sample(rng)[0])];
  EXPECT_EQ(count[0], 0);
  EXPECT_NEAR(count[1], 0.3 * n, 5 * std::sqrt(0.21 * n));
}

// One cell of even mass along y = x^2 from x = -1 to 1, its node in the middle: the mean of y is
// 1/3, and draws lie on the parabola.
TEST(WeightedDraws, CentredCellsBend) {
  WeightedDraws draws;
  draws.values = Points::Zero(1, 2);
  draws.weights = Eigen::VectorXd::Ones(1);
  draws.cells = {draws.weights, Points::Zero(1, 1), Points::Zero(1, 1),
                 Points::Constant(1, 1, 1. / 12)};
  draws.lower = {Points(1, 2)};
  draws.upper = {Points(1, 2)};
  draws.lower[0] << -1, 1;
  draws.upper[0] << 1, 1;
  EXPECT_DOUBLE_EQ(QuantityDistribution(draws, [](const double* x) { return x[1]; }).mean(),
                   1. / 3);
  EXPECT_DOUBLE_EQ(QuantityDistribution(draws, [](const double* x) { return x[0] * x[0]; }).mean(),
                   1. / 3);
  const WeightedSampler sample(draws);
  Rng rng(1, 0);
  for (int i = 0; i < 100; ++i) {
    const Eigen::VectorXd x = sample(rng);
    EXPECT_LE(std::abs(x[0]), 1);
    EXPECT_NEAR(x[1], x[0] * x[0], 1e-14);
  }
}

// Nodes that hold nothing may lie anywhere, as wide as doubles reach, or be no numbers at all.
TEST(QuantityDistribution, NodesWithoutWeightChangeNothing) {
  constexpr double huge = 1e300;
  std::vector<Cell> cells;
  for (int i = 0; i < 100; ++i) cells.push_back({i + 0., i + 0.5, i + 1., 0.01});
  const QuantityDistribution plain(cells_of(cells), itself);
  for (const Cell& far : {Cell{1, huge, 1.7e308, 1e-13}, Cell{-1.7e308, 3, 1.7e308, 1e-13},
                          Cell{5, infinity, infinity, 1e-13}, Cell{5, std::nan(""), 6, 1e-13}}) {
    std::vector<Cell> with = cells;
    with.push_back(far);
    const QuantityDistribution d(cells_of(with), itself);
    EXPECT_NEAR(d.mean(), plain.mean(), 1e-6);
    EXPECT_NEAR(d.sd(), plain.sd(), 1e-6);
    for (const double p : {0.01, 0.05, 0.5, 0.95, 0.99}) {
      EXPECT_NEAR(d.quantile(p), plain.quantile(p), 1e-6) << far.node << " at " << p;
    }
  }
}

// With weight they count: quantiles in the bulk stay, and where a number is none nothing is known.
TEST(QuantityDistribution, WideNodesWithWeightDoNotMoveTheBulk) {
  std::vector<Cell> cells;
  for (int i = 0; i < 100; ++i) cells.push_back({i + 0., i + 0.5, i + 1., 0.0099});
  cells.push_back({1e200, 1.7e308, 1.7e308, 0.01});
  const QuantityDistribution d(cells_of(cells), itself);
  EXPECT_NEAR(d.quantile(0.5), 50.505, 1e-2);
  EXPECT_NEAR(d.quantile(0.01), 1.0101, 1e-3);
  cells.back().node = std::nan("");
  EXPECT_TRUE(std::isnan(QuantityDistribution(cells_of(cells), itself).quantile(0.5)));
  EXPECT_TRUE(std::isnan(QuantityDistribution(cells_of(cells), itself).mean()));
}

// A normal density of two axes on a grid, of a number that both move: layers along the first, each wider than their distance.
TEST(CellShares, LayersFitTogether) {
  constexpr double step = 0.5, second = 0.3;
  constexpr int reach = 12, side = 2 * reach + 1;
  WeightedDraws draws{Points(side * side, 2), Eigen::VectorXd(side * side), {}, {}};
  draws.lower.assign(2, Points(side * side, 2));
  draws.upper = draws.lower;
  for (int i = 0; i < side * side; ++i) {
    const Eigen::RowVector2d x(step * (i % side - reach), step * (i / side - reach));
    draws.values.row(i) = x;
    draws.weights[i] = std::exp(-0.5 * x.squaredNorm());
    for (int a = 0; a < 2; ++a) {
      const Eigen::RowVector2d half = 0.5 * step * Eigen::RowVector2d::Unit(a);
      draws.lower[static_cast<std::size_t>(a)].row(i) = x - half;
      draws.upper[static_cast<std::size_t>(a)].row(i) = x + half;
    }
  }
  draws.weights /= draws.weights.sum();
  const auto number = [](const double* x) { return x[0] + second * x[1]; };
  std::vector<double> edges;
  for (int i = -60; i <= 60; ++i) edges.push_back(0.05 * i);
  const std::vector<double> shares = cell_shares(draws, number, edges);
  const QuantityDistribution even(draws, number);
  // Cells without a parabola add their own variance.
  const double sd = std::sqrt((1 + second * second) * (1 + step * step / 12));
  const auto normal = [&](double x) { return 0.5 * std::erfc(-x / sd * M_SQRT1_2); };
  double worst = 0, worst_even = 0, sum = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double truth = normal(edges[i + 1]) - normal(edges[i]);
    worst = std::max(worst, std::abs(shares[i] - truth));
    worst_even =
        std::max(worst_even, std::abs(even.cdf(edges[i + 1]) - even.cdf(edges[i]) - truth));
    sum += shares[i];
  }
  const double highest = 0.05 / sd / std::sqrt(2 * M_PI);
  EXPECT_LT(worst, 0.02 * highest);
  EXPECT_LT(worst, 0.5 * worst_even);
  EXPECT_NEAR(sum, even.cdf(edges.back()) - even.cdf(edges.front()), 1e-3);
}

// Of many cells of all widths, some of which reach over nearly all others.
TEST(QuantityDistribution, QuantilesInvertTheSharesBelow) {
  constexpr Eigen::Index n = 3000;
  Rng rng(1, 0);
  WeightedDraws draws{Points(n, 1), Eigen::VectorXd(n), {Points(n, 1)}, {Points(n, 1)}};
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = draws.values(i, 0) = rng.normal(), half = i % 100 == 0 ? 3
                                                               : i % 7 == 0 ? 0
                                                                            : 0.1 * rng.uniform();
    draws.lower[0](i, 0) = x - half;
    draws.upper[0](i, 0) = x + half;
    draws.weights[i] = rng.uniform();
  }
  draws.weights /= draws.weights.sum();
  const QuantityDistribution distribution(draws, itself);
  for (const double p : {1e-3, 0.05, 0.3, 0.5, 0.9, 0.999}) {
    const double x = distribution.quantile(p);
    EXPECT_LE(distribution.cdf(x - 1e-9), p);
    EXPECT_GE(distribution.cdf(x + 1e-9), p);
  }
}

// Draws are points, and cells without width too.
TEST(CellShares, OfDraws) {
  const WeightedDraws draws{
      Points{{1.0}, {2.0}, {2.5}, {9.0}}, Eigen::VectorXd::Constant(4, 0.25), {}, {}};
  const std::vector<double> shares =
      cell_shares(draws, [](const double* x) { return x[0]; }, {0, 1.5, 3});
  EXPECT_EQ(shares, (std::vector<double>{0.25, 0.5}));
}

}  // namespace
}  // namespace wearwell
