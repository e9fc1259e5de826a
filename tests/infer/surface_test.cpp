// Polynomials in place of a likelihood of many observations.
#include "wearwell/infer/surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "infer/test_posteriors.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/mode.h"
#include "wearwell/math/view.h"
#include "wearwell/models/fatigue/sn_likelihood.h"

namespace wearwell {
namespace {

// Life tests at five stresses under a Weibull law, stopped at 2e6 cycles.
Posterior life_tests(int count) {
  Rng rng(20261203, 1);
  fatigue::SnLaw law;
  law.correction = fatigue::MeanStress::none;
  law.family = fatigue::LifeFamily::weibull;
  fatigue::LifeTests tests;
  for (int i = 0; i < count; ++i) {
    const double log10_stress = std::log10(250e6) + 0.05 * (i % 5);
    const double z = std::log(-std::log(rng.uniform()));
    const double life = std::pow(10, (log10_stress - 9.3) / -0.15 + 0.2 * z);
    const bool stopped = life > 2e6;
    tests.push_back({{std::pow(10, log10_stress), 0},
                     stopped ? fatigue::Outcome::runout : fatigue::Outcome::failure,
                     std::min(life, 2e6),
                     0,
                     1});
  }
  Parameter b = flat_parameter("b", -0.14, 0.02), sigma = flat_parameter("sigma", 0.25, 0.1);
  b.prior = make_distribution(Flat{}, -INFINITY, 0);
  sigma.prior = make_distribution(Uniform{}, 0, 2);
  return {{flat_parameter("log10_a", 9.2, 1), b, sigma},
          fatigue::sn_likelihood(law, tests, tests.size())};
}

TEST(Surface, IsTheLikelihoodWhereThereIsPosterior) {
  const Posterior posterior = life_tests(2000);
  const Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
  const auto quick = surrogate_posterior(posterior, whitening);
  ASSERT_TRUE(quick.has_value());
  EXPECT_LE(quick->error, 1e-5);
  Rng rng(20261203, 2);
  Eigen::VectorXd slope(3), slope_there(3);
  for (int i = 0; i < 300; ++i) {
    Eigen::VectorXd u(3);
    for (double& each : u) each = rng.normal();
    const Eigen::VectorXd z = whitening(u);
    const double truth = posterior.value_and_gradient(view(z), view(slope));
    EXPECT_NEAR(quick->posterior->value(view(z)), truth, 1e-5);
    EXPECT_NEAR(quick->posterior->value_and_gradient(view(z), view(slope_there)), truth, 1e-5);
    const Eigen::VectorXd off = whitening.scale.transpose() * (slope_there - slope);
    EXPECT_LE(off.cwiseAbs().maxCoeff(), 1e-4);
  }
  // Far out it is lower than where there is any posterior, and farther out the true one.
  const Eigen::VectorXd far = whitening(Eigen::Vector3d(0, 12, 0)),
                        farther = whitening(Eigen::Vector3d(0, 0, 23));
  EXPECT_LT(quick->posterior->value(view(far)), posterior.value(view(whitening.center)) - 18);
  EXPECT_EQ(quick->posterior->value(view(farther)), posterior.value(view(farther)));
}

TEST(Surface, LeavesFewObservationsAlone) {
  const Posterior posterior = life_tests(500);
  const Whitening whitening = whitening_at(find_mode(posterior, posterior.start()));
  EXPECT_FALSE(surrogate_posterior(posterior, whitening).has_value());
}

TEST(Surface, FitsAsTheLikelihoodDoes) {
  const Posterior posterior = life_tests(1500);
  FitSettings settings;
  settings.method = Method::exact;
  settings.run.draws = 100;
  const Fit quick = fit(posterior, settings);
  ASSERT_TRUE(quick.quick && quick.exact);
  const ExactPosterior exact = integrate(posterior, quick.whitening);
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(quick.exact->mean[i], exact.mean[i], 1e-5 * exact.sd[i]);
    EXPECT_NEAR(quick.exact->sd[i], exact.sd[i], 3e-5 * exact.sd[i]);
  }
}

}  // namespace
}  // namespace wearwell
