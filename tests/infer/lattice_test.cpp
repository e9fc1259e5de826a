// Quantiles of four parameters on the lattice, where they are known; moments are compared in
// exact_test.cpp, NUTS in sampler_test.cpp.
#include "wearwell/infer/lattice.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "infer/test_posteriors.h"
#include "wearwell/infer/mode.h"
#include "wearwell/math/view.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell {
namespace {

constexpr double probabilities[] = {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};

KnownPosterior known(const std::string& name) {
  for (const KnownPosterior& each : known_posteriors()) {
    if (each.name == name) return each;
  }
  throw std::logic_error("no posterior " + name);
}

ExactPosterior integrated(const Posterior& posterior) {
  return integrate_on_lattice(posterior, whitening_at(find_mode(posterior, posterior.start())), {});
}

double quantile(const ExactPosterior& exact, std::size_t parameter, double p) {
  return QuantityDistribution(exact.nodes, [=](const double* x) { return x[parameter]; })
      .quantile(p);
}

TEST(Lattice, QuantilesOfNormals) {
  for (const char* name : {"Correlated4", "Scaled4"}) {
    const KnownPosterior normal = known(name);
    const ExactPosterior exact = integrated(normal.make());
    ASSERT_EQ(exact.failure, "");
    for (std::size_t i = 0; i < 4; ++i) {
      for (const double p : probabilities) {
        const double z = (quantile(exact, i, p) - normal.mean[i]) / normal.sd[i];
        EXPECT_NEAR(z, quantile(StandardDistribution::normal, p), 3e-3) << name << i << " " << p;
      }
    }
  }
}

// Most nodes hold next to nothing, and few of them have cells, which stand for the others: nothing is to be seen of it.
TEST(Lattice, FewNodesHaveCells) {
  for (const char* name : {"Correlated4", "Regression4"}) {
    const KnownPosterior posterior = known(name);
    const ExactPosterior exact = integrated(posterior.make());
    const WeightedDraws& nodes = exact.nodes;
    EXPECT_LT(nodes.cells.mass.size(), 0.6 * static_cast<double>(nodes.values.rows())) << name;
    for (std::size_t i = 0; i < 3; ++i) {
      const QuantityDistribution cells(nodes, [=](const double* x) { return x[i]; });
      const auto at = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(cells.mean(), exact.mean[at], 2e-4 * exact.sd[at]) << name << i;
      EXPECT_NEAR(cells.sd(), exact.sd[at], 5e-4 * exact.sd[at]) << name << i;
    }
  }
  const KnownPosterior normal = known("Correlated4");
  const ExactPosterior exact = integrated(normal.make());
  for (const auto& [p, tolerance] : {std::pair(1e-4, 2e-2), {1e-3, 5e-3}, {0.999, 5e-3}}) {
    for (std::size_t i = 0; i < 4; ++i) {
      const double z = (quantile(exact, i, p) - normal.mean[i]) / normal.sd[i];
      EXPECT_NEAR(z, quantile(StandardDistribution::normal, p), tolerance) << i << " " << p;
    }
  }
}

TEST(Lattice, QuantilesOfTruncatedNormals) {
  const ExactPosterior exact = integrated(known("Truncated4").make());
  ASSERT_EQ(exact.failure, "");
  const Distribution law = make_distribution(Normal{0, 1}, 0.5, 2);
  for (std::size_t i = 0; i < 4; ++i) {
    for (const double p : probabilities) {
      EXPECT_NEAR(quantile(exact, i, p), quantile(law, p), 1e-2 * 0.388) << i << " " << p;
    }
  }
}

// x2 = x1^2/2 + 0.25 z: its distribution is an integral over x1, here by the midpoint rule.
TEST(Lattice, QuantilesOfABentRidge) {
  const ExactPosterior exact = integrated(known("BentRidge4").make());
  ASSERT_EQ(exact.failure, "");
  for (const double p : probabilities) {
    EXPECT_NEAR(quantile(exact, 0, p), quantile(StandardDistribution::normal, p), 2.5e-2) << p;
    const double x2 = quantile(exact, 1, p);
    double below = 0;
    constexpr double step = 1e-3;
    for (double x1 = -9 + step / 2; x1 < 9; x1 += step) {
      below += step * std::exp(log_density_and_slope(StandardDistribution::normal, x1).value) *
               cdf(StandardDistribution::normal, (x2 - 0.5 * x1 * x1) / 0.25);
    }
    EXPECT_NEAR(below, p, 1e-2) << p;
  }
}

// A funnel, with heavy tails along it.
TEST(Lattice, QuantilesOfARegression) {
  const KnownPosterior regression = known("Regression4");
  const ExactPosterior exact = integrated(regression.make());
  ASSERT_EQ(exact.failure, "");
  EXPECT_LT(exact.nodes.values.rows(), 500'000);
  const boost::math::students_t student(6);
  const boost::math::chi_squared squares(6);
  for (const double p : probabilities) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(quantile(exact, i, p), regression.mean[i] + 2 * boost::math::quantile(student, p),
                  5e-3 * regression.sd[i])
          << i << " " << p;
    }
    EXPECT_NEAR(quantile(exact, 3, p), 2 * std::sqrt(6 / boost::math::quantile(squares, 1 - p)),
                5e-3 * regression.sd[3])
        << p;
  }
}

TEST(Lattice, SumsNeedNoCells) {
  const Posterior posterior = known("Correlated4").make();
  const Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
  const ExactPosterior whole = integrate(posterior, whitening),
                       sums = integrate(posterior, whitening, {.cells = false});
  EXPECT_EQ(sums.mean, whole.mean);
  EXPECT_EQ(sums.covariance, whole.covariance);
  // The same nodes; those that have cells come first.
  const auto sorted = [](Eigen::VectorXd weights) {
    std::sort(weights.begin(), weights.end());
    return weights;
  };
  EXPECT_EQ(sums.nodes.values.rows(), whole.nodes.values.rows());
  EXPECT_TRUE(sorted(sums.nodes.weights).isApprox(sorted(whole.nodes.weights), 1e-12));
  EXPECT_FALSE(sums.nodes.has_cells());
  EXPECT_TRUE(whole.nodes.has_cells());
}

// A center 40 standard deviations from the mode, where the density is e^-800 of the highest.
TEST(Lattice, FindsTheMassFromFarAway) {
  const KnownPosterior normal = known("Correlated4");
  const Posterior posterior = normal.make();
  Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
  whitening.center += 40 * whitening.scale.col(1);
  const ExactPosterior exact = integrate_on_lattice(posterior, whitening, {});
  ASSERT_EQ(exact.failure, "");
  for (int i = 0; i < 4; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_NEAR(exact.mean[i], normal.mean[at], 1e-5 * normal.sd[at]);
    EXPECT_NEAR(exact.sd[i], normal.sd[at], 1e-4 * normal.sd[at]);
  }
}

}  // namespace
}  // namespace wearwell
