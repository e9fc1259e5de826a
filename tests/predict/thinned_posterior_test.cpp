// Rounding errors, which differ between processors and compilers, must not choose other points: numbers made of few points would
// differ in their printed digits.
#include "wearwell/predict/thinned_posterior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "wearwell/predict/prediction.h"

namespace wearwell {
namespace {

// Nodes of a lattice over a correlated normal posterior, many of equal weight by symmetry.
WeightedDraws lattice(int d, int per_axis, double step, double mean = 7) {
  WeightedDraws draws;
  const auto n = static_cast<Eigen::Index>(std::llround(std::pow(per_axis, d)));
  draws.values.resize(n, d);
  draws.weights.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::Index rest = i;
    double square = 0, before = 0;
    for (int a = 0; a < d; ++a, rest /= per_axis) {
      const double z = step * (static_cast<double>(rest % per_axis) - 0.5 * (per_axis - 1));
      square += z * z;
      draws.values(i, a) = std::pow(10, a) * (mean + 0.8 * z + 0.6 * before);
      before = z;
    }
    draws.weights[i] = std::exp(-0.5 * square);
  }
  draws.weights /= draws.weights.sum();
  draws.lower.assign(static_cast<std::size_t>(d), draws.values);
  draws.upper = draws.lower;
  return draws;
}

WeightedDraws sample(int d, Eigen::Index n) {
  std::mt19937_64 generator(42);
  std::normal_distribution<double> normal;
  WeightedDraws draws;
  draws.values.resize(n, d);
  draws.weights = Eigen::VectorXd::Constant(n, 1.0 / static_cast<double>(n));
  for (double& each : draws.values.reshaped()) each = normal(generator);
  for (int a = 1; a < d; ++a) draws.values.col(a) += 0.7 * draws.values.col(a - 1);
  return draws;
}

WeightedDraws with_rounding_errors(WeightedDraws draws, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> error(-4e-16, 4e-16);
  for (double& each : draws.values.reshaped()) each *= 1 + error(generator);
  for (double& each : draws.weights) each *= 1 + error(generator);
  return draws;
}

// Of all points and of the few.
void expect_same_moments(const WeightedDraws& draws, const ThinnedPosterior& few) {
  const Eigen::Map<const Eigen::VectorXd> w(few.weights.data(), few.values.rows());
  const DominantDraws dominant(draws);
  const auto n = static_cast<Eigen::Index>(dominant.rows.size());
  const Points values = draws.values(dominant.rows, Eigen::all);
  const Eigen::Map<const Eigen::VectorXd> v(dominant.weights.data(), n);
  EXPECT_NEAR(w.sum(), 1, 1e-9);
  EXPECT_GT(w.minCoeff(), 0);
  const Eigen::RowVectorXd mean = v.transpose() * values;
  const auto second = [&](const Points& of, const auto& weight) -> Eigen::MatrixXd {
    const Points away = of.rowwise() - mean;
    return away.transpose() * weight.asDiagonal() * away;
  };
  const Eigen::MatrixXd all = second(values, v), thinned = second(few.values, w);
  for (Eigen::Index a = 0; a < mean.size(); ++a) {
    EXPECT_NEAR(w.dot(few.values.col(a)), mean[a],
                1e-4 * std::sqrt(all(a, a)) + 1e-13 * std::abs(mean[a]));
    for (Eigen::Index b = 0; b <= a; ++b)
      EXPECT_NEAR(thinned(a, b), all(a, b), 1e-4 * std::sqrt(all(a, a) * all(b, b)));
  }
}

void expect_same_points(const WeightedDraws& draws, std::size_t most) {
  const ThinnedPosterior few(draws, most);
  ASSERT_LE(few.values.rows(), static_cast<Eigen::Index>(most));
  const int d = static_cast<int>(draws.values.cols());
  const bool by_moments = 8 * (1 + d + d * (d + 1) / 2) <= static_cast<int>(most);
  if (by_moments) expect_same_moments(draws, few);
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const ThinnedPosterior other(with_rounding_errors(draws, seed), most);
    ASSERT_EQ(few.values.rows(), other.values.rows()) << seed;
    for (Eigen::Index i = 0; i < few.values.rows(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      for (Eigen::Index a = 0; a < few.values.cols(); ++a)
        ASSERT_NEAR(few.values(i, a), other.values(i, a), 1e-12 * std::abs(few.values(i, a)))
            << "seed " << seed << ", point " << i << " of " << few.values.rows();
      ASSERT_NEAR(few.weights[at], other.weights[at], 1e-7) << "seed " << seed << ", point " << i;
    }
  }
}

TEST(ThinnedPosterior, HasTheSamePointsOfALattice) {
  expect_same_points(lattice(1, 401, 0.02), 40);
  expect_same_points(lattice(2, 81, 0.1), 64);
  expect_same_points(lattice(2, 81, 0.1), 400);
  expect_same_points(lattice(3, 25, 0.35), 128);
  expect_same_points(lattice(3, 25, 0.35), 1000);
  expect_same_points(lattice(5, 7, 1), 400);
}

TEST(ThinnedPosterior, HasTheSamePointsOfALogarithmOrManyNodes) {
  expect_same_points(lattice(2, 81, 0.1, 1e4), 64);
  expect_same_points(lattice(2, 81, 0.1, 1e6), 64);
  expect_same_points(lattice(3, 51, 0.17), 400);
  expect_same_points(lattice(4, 25, 0.4), 130);
}

// Parameters that are constant, equal, or nearly follow from others.
TEST(ThinnedPosterior, HasTheSamePointsOfDependentParameters) {
  const WeightedDraws plain = lattice(2, 81, 0.1);
  WeightedDraws draws = plain;
  draws.values.conservativeResize(Eigen::NoChange, 3);
  for (const auto& third : std::vector<Eigen::VectorXd>{
           Eigen::VectorXd::Constant(plain.values.rows(), 3.7), plain.values.col(0),
           0.3 * plain.values.col(0) + 0.1 * plain.values.col(1),
           plain.values.col(0) + 0.002 * plain.values.col(0).cwiseAbs2(),
           plain.values.col(0) + 1e-7 * plain.values.col(0).cwiseAbs2()}) {
    draws.values.col(2) = third;
    expect_same_points(draws, 100);
    expect_same_points(draws, 400);
  }
}

TEST(ThinnedPosterior, HasTheSamePointsOfASkewedLattice) {
  WeightedDraws draws = lattice(3, 25, 0.35);
  draws.values.col(1) = (0.05 * (draws.values.col(1).array() - 70)).exp();
  draws.values.col(2) =
      (0.005 * (draws.values.col(2).array() - 700)).exp() / draws.values.col(1).array();
  for (const std::size_t most : {100, 150, 800}) expect_same_points(draws, most);
}

TEST(ThinnedPosterior, HasTheSamePointsOfASample) {
  for (const std::size_t most : {200, 1000}) {
    expect_same_points(sample(2, 4000), most);
    expect_same_points(sample(5, 4000), most);
    expect_same_points(sample(9, 4000), most);
  }
}

}  // namespace
}  // namespace wearwell
