// Studentized scores beside the residuals of least squares, whose distribution is known.
#include "wearwell/infer/studentized_scores.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/infer/score_tests.h"

namespace wearwell {
namespace {

// Orthonormal columns that span the powers of x.
Eigen::MatrixXd powers(Eigen::Index rows, Eigen::Index parameters) {
  Eigen::MatrixXd x(rows, parameters);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index p = 0; p < parameters; ++p)
      x(i, p) = std::pow(static_cast<double>(i), static_cast<double>(p));
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(x);
  return qr.householderQ() * Eigen::MatrixXd::Identity(rows, parameters);
}

Eigen::VectorXd normals(Eigen::Index count, Rng& rng) {
  Eigen::VectorXd z(count);
  for (double& each : z) each = rng.normal();
  return z;
}

// Scores of y under draws of the posterior of a linear model: standard deviation 1 and a flat prior.
std::vector<std::vector<double>> drawn_scores(const Eigen::MatrixXd& q, const Eigen::VectorXd& y,
                                              std::size_t draws, Rng& rng) {
  const Eigen::VectorXd residual = y - q * (q.transpose() * y);
  std::vector<std::vector<double>> scores;
  for (std::size_t s = 0; s < draws; ++s) {
    const Eigen::VectorXd z = residual + q * normals(q.cols(), rng);
    scores.emplace_back(z.begin(), z.end());
  }
  return scores;
}

TEST(StudentizedScores, OfALineAreStudentizedResiduals) {
  Rng rng(1, 0);
  const Eigen::MatrixXd q = powers(20, 2);
  const Eigen::VectorXd y = normals(20, rng), residual = y - q * (q.transpose() * y);
  const StudentizedScores found =
      studentized_scores(drawn_scores(q, y, 40'000, rng), std::vector<bool>(20, true));
  ASSERT_EQ(found.scores.size(), 1u);
  // Draws are evened out to one size, which moves all alike by a little.
  double across = 0, along = 0;
  for (Eigen::Index i = 0; i < 20; ++i) {
    const double expected = residual[i] / std::sqrt(1 - q.row(i).squaredNorm());
    across += found.scores[0][static_cast<std::size_t>(i)] * expected;
    along += expected * expected;
  }
  const double factor = across / along;
  EXPECT_NEAR(factor, 1, 0.03);
  for (Eigen::Index i = 0; i < 20; ++i) {
    const double expected = residual[i] / std::sqrt(1 - q.row(i).squaredNorm());
    EXPECT_NEAR(found.scores[0][static_cast<std::size_t>(i)], factor * expected, 0.03) << i;
  }
}

// A parameter for every two rows, and rows of which less than half is known: the variance is 1 at most all the same.
TEST(StudentizedScores, HaveVarianceOneAtMostWhateverIsKnown) {
  for (const Eigen::Index parameters : {5, 8}) {
    const Eigen::MatrixXd q = powers(10, parameters);
    constexpr int samples = 4000;
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(10);
    for (int i = 0; i < samples; ++i) {
      Rng rng(2, static_cast<std::uint64_t>(i));
      const StudentizedScores found = studentized_scores(
          drawn_scores(q, normals(10, rng), 100, rng), std::vector<bool>(10, true));
      for (Eigen::Index r = 0; r < 10; ++r)
        squares[r] += std::pow(found.scores[0][static_cast<std::size_t>(r)], 2) / samples;
    }
    // 4 standard errors of a mean square of 4000, and what 100 draws say of the variance between them. Draws are evened
    // out to one size, which of ten rows takes some of it away; less than 1 accuses less.
    for (Eigen::Index r = 0; r < 10; ++r) {
      EXPECT_LT(squares[r], 1 + 4 * 0.0224 + 0.1) << r;
      EXPECT_GT(squares[r], 0.7) << r;
    }
  }
}

TEST(StudentizedScores, DrawnFromIntervalsAreKept) {
  Rng rng(3, 0);
  const Eigen::MatrixXd q = powers(8, 1);
  const auto scores = drawn_scores(q, normals(8, rng), 50, rng);
  std::vector<bool> exact(8, true);
  exact[3] = false;
  const StudentizedScores found = studentized_scores(scores, exact);
  ASSERT_EQ(found.scores.size(), scores.size());
  for (std::size_t s = 1; s < scores.size(); ++s) {
    EXPECT_EQ(found.scores[s][0], found.scores[0][0]);
    EXPECT_NE(found.scores[s][3], found.scores[0][3]);
    EXPECT_NEAR(found.scores[s][3] / scores[s][3], 1, 0.5);  // but for the size of all
  }
}

// Of a cubic curve through 20 rows residuals near the ends are alike in size: the trend of sizes scatters more than of
// independent ones, by as much as simulated residuals of least squares say.
TEST(StudentizedScores, SizeOfATestUnderARightLaw) {
  const Eigen::MatrixXd q = powers(20, 4);
  std::vector<double> along;
  for (int i = 0; i < 20; ++i) along.push_back(i - 9.5);
  const auto trend = [&](std::span<const double> z) {
    return scatter_trend_score(sizes(z), along);
  };
  Rng rng(4, 0);
  constexpr int samples = 20'000;
  double squares = 0;
  for (int i = 0; i < samples; ++i) {
    const Eigen::VectorXd y = normals(20, rng), residual = y - q * (q.transpose() * y);
    std::vector<double> z;
    for (Eigen::Index r = 0; r < 20; ++r)
      z.push_back(residual[r] / std::sqrt(1 - q.row(r).squaredNorm()));
    squares += std::pow(trend(z), 2) / samples;
  }
  const StudentizedScores found =
      studentized_scores(drawn_scores(q, normals(20, rng), 4000, rng), std::vector<bool>(20, true));
  EXPECT_GT(std::sqrt(squares), 1.03);
  EXPECT_NEAR(null_size(found, trend), std::sqrt(squares), 4 * 0.023);
  const StudentizedScores independent{found.scores, Eigen::MatrixXd::Zero(1, 20)};
  EXPECT_NEAR(null_size(independent, trend), 1, 4 * 0.023);
}

}  // namespace
}  // namespace wearwell
