// Each check is shown one posterior that it must refuse and one that it must let pass.
#include "wearwell/infer/trust.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "infer/test_posteriors.h"
#include "support/formula.h"
#include "wearwell/base/error.h"
#include "wearwell/infer/agreement.h"
#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

std::vector<Check> checks_of(const Posterior& posterior, FitSettings settings = {}) {
  return trust_checks(posterior, fit(posterior, settings));
}

Check check(const std::vector<Check>& checks, const std::string& name) {
  for (const Check& each : checks) {
    if (each.name == name) return each;
  }
  ADD_FAILURE() << "no check " << name;
  return {};
}

// With the paper's normal likelihood and flat priors the marginal densities of k and sigma fall
// like x^-(n-1).
TEST(Tails, IndicesOfTheNormalJointPosterior) {
  for (std::size_t n = 2; n <= 6; ++n) {
    const Posterior posterior = joint_posterior(false, false, INFINITY, n);
    const auto found = tails(posterior, find_mode(posterior, posterior.start()));
    ASSERT_EQ(found.size(), 4u);
    for (const Tail& tail : found) {
      if (!tail.upward) {
        EXPECT_TRUE(tail.integrable()) << n;
        continue;
      }
      EXPECT_NEAR(tail.index, static_cast<double>(n) - 1, 0.01) << n;
      EXPECT_EQ(tail.integrable(), n >= 3) << n;
      EXPECT_EQ(tail.has_moment(1), n >= 4) << n;
      EXPECT_EQ(tail.has_moment(2), n >= 5) << n;
    }
  }
}

TEST(Tails, StudentAndNormalOnAWholeLine) {
  for (const double df : {1.0, 2.0, 5.0}) {
    Parameter parameter = flat_parameter("x", 0.5, 1);
    parameter.prior = make_distribution(StudentT{df, 0, 1}, -INFINITY, INFINITY);
    class Nothing final : public LogDensity {
     public:
      int dimension() const override { return 1; }
      double value(std::span<const double>) const override { return 0; }
      double value_and_gradient(std::span<const double>,
                                std::span<double> gradient) const override {
        gradient[0] = 0;
        return 0;
      }
    };
    const Posterior posterior({parameter}, std::make_shared<Nothing>());
    for (const Tail& tail : tails(posterior, find_mode(posterior, posterior.start()))) {
      EXPECT_NEAR(tail.index, df + 1, 0.01);
    }
  }
}

Parameter positive_parameter(const std::string& name, const Family& prior) {
  Parameter parameter = flat_parameter(name, 1, 1);
  parameter.prior = make_distribution(prior, 0, infinity);
  parameter.natural_lower = 0;
  return parameter;
}

// Machines j with means y_j ~ N(mu, s^2 + tau^2), mu flat.
Posterior machines(const std::vector<double>& y, double s, const Family& prior_of_tau) {
  Parameter mu = flat_parameter("mu", y.front(), 1), tau = positive_parameter("tau", prior_of_tau);
  tau.start = std::max(s, std::abs(y.back() - y.front()) / 3);
  return {{mu, tau}, std::make_shared<Formula>(2, [=](auto x, std::span<double> gradient) {
            const double variance = s * s + x[1] * x[1];
            double sum = 0;
            gradient[0] = gradient[1] = 0;
            for (const double each : y) {
              const double off = each - x[0];
              sum -= 0.5 * std::log(variance) + 0.5 * off * off / variance;
              gradient[0] += off / variance;
              gradient[1] += x[1] * (off * off / variance - 1) / variance;
            }
            return sum;
          })};
}

Tail lower_tail(const Posterior& posterior, int parameter) {
  for (const Tail& tail : tails(posterior, find_mode(posterior, posterior.start()))) {
    if (tail.parameter == parameter && !tail.upward) return tail;
  }
  return {};
}

// Gelman (2006), Bayesian Analysis 1, 515-534, section 2.2: with p(tau) ~ 1/tau the posterior of a variance between groups is improper
// for any data, as the likelihood at tau = 0 is not zero, however small. With a flat one it is proper from three groups on.
TEST(Tails, AJeffreysPriorOfTheScatterBetweenMachinesIsImproperForAnyData) {
  for (const double apart : {0.5, 3.0, 10.0, 50.0, 1e3, 1e6}) {
    std::vector<double> y;
    for (int j = 0; j < 8; ++j) y.push_back(apart * (j + 0.3 * std::sin(5.0 * j)));
    const Tail jeffreys = lower_tail(machines(y, 1, Jeffreys{}), 1);
    EXPECT_TRUE(jeffreys.known) << apart;
    EXPECT_FALSE(jeffreys.integrable()) << apart;
    EXPECT_NEAR(jeffreys.index, 1, 0.01) << apart;
    EXPECT_TRUE(lower_tail(machines(y, 1, Flat{}), 1).integrable()) << apart;
  }
}

// Without an error of the single value the likelihood does vanish at zero: there the same prior is harmless.
TEST(Tails, AJeffreysPriorOfTheScatterOfValuesIsProper) {
  for (const double apart : {0.5, 1e3, 1e6}) {
    const Tail tail = lower_tail(machines({0, apart, 0.3 * apart, 0.8 * apart}, 0, Jeffreys{}), 1);
    EXPECT_TRUE(tail.known) << apart;
    EXPECT_TRUE(tail.integrable()) << apart;
  }
}

// Near zero the likelihood is flat and the tail that of the prior, x^(shape - 1): slow, and proper.
TEST(Tails, AProperPriorWithAPoleIsProper) {
  for (const double shape : {0.2, 0.02, 0.002}) {
    for (const bool bound_of_physics : {true, false}) {
      Parameter k = positive_parameter("k", Gamma{shape, 10});
      if (!bound_of_physics) k.natural_lower = -infinity;
      const Posterior posterior({k}, std::make_shared<Formula>(1, [](auto x, std::span<double> g) {
                                  g[0] = 0.7 - x[0];
                                  return -0.5 * std::pow(0.7 - x[0], 2);
                                }));
      const Tail tail = lower_tail(posterior, 0);
      EXPECT_TRUE(tail.known) << shape;
      EXPECT_TRUE(tail.integrable()) << shape;
      EXPECT_NEAR(tail.index, 1 - shape, 1e-3) << shape;
    }
  }
}

// Lives of two groups with one Weibull shape, flat priors: towards a shape of 0 the likelihood is about shape^r exp(-n) for scales up to
// e^(1/shape), so the integral over both scales is infinite. For a given scale there is no mode of the others.
TEST(Tails, FlatPriorsOfTwoWeibullGroupsAreImproper) {
  const std::vector<std::vector<double>> lives = {{312, 480, 510, 640}, {150, 210, 260, 330, 420}};
  const Parameter first = positive_parameter("first", Flat{}),
                  second = positive_parameter("second", Flat{});
  Parameter shape = positive_parameter("shape", Flat{});
  std::vector<Parameter> parameters = {first, second, shape};
  parameters[0].start = 500;
  parameters[1].start = 300;
  parameters[2].start = 2;
  const Posterior posterior(
      parameters, std::make_shared<Formula>(3, [=](auto x, std::span<double> gradient) {
        double sum = 0;
        std::fill(gradient.begin(), gradient.end(), 0.0);
        for (int group = 0; group < 2; ++group) {
          for (const double t : lives[static_cast<std::size_t>(group)]) {
            const double log_ratio = std::log(t / x[group]), power = std::exp(x[2] * log_ratio);
            sum += std::log(x[2]) + x[2] * log_ratio - std::log(t) - power;
            gradient[group] += x[2] / x[group] * (power - 1);
            gradient[2] += 1 / x[2] + log_ratio * (1 - power);
          }
        }
        return sum;
      }));
  const auto found = tails(posterior, find_mode(posterior, posterior.start()));
  EXPECT_FALSE(all_integrable(found));
  for (const Tail& tail : found) {
    EXPECT_TRUE(tail.integrable() || (tail.upward && tail.parameter < 2)) << tail.parameter;
  }
}

// The two traps: lognormal with unbounded sigma, at any number of data sets, and normal with three.
TEST(Trust, ImproperPosteriorsFail) {
  for (const std::size_t rows : {3, 4, 5, 6}) {
    const auto checks = checks_of(joint_posterior(true, false, INFINITY, rows));
    EXPECT_EQ(check(checks, "proper-posterior").verdict, Verdict::fail) << rows;
    EXPECT_THAT(check(checks, "proper-posterior").detail, HasSubstr("improper")) << rows;
    EXPECT_FALSE(trusted(checks));
  }
  const auto three = checks_of(joint_posterior(false, false, INFINITY, 3));
  EXPECT_EQ(check(three, "proper-posterior").verdict, Verdict::fail);
  EXPECT_THAT(check(three, "proper-posterior").detail, HasSubstr("the mean of k does not exist"));
}

TEST(Trust, ProperPosteriorsPass) {
  for (const bool lognormal : {false, true}) {
    for (const std::size_t rows : {5, 6}) {
      const auto checks = checks_of(joint_posterior(lognormal, false, lognormal ? 7 : 15, rows));
      EXPECT_EQ(check(checks, "proper-posterior").verdict, Verdict::pass);
      EXPECT_EQ(check(checks, "prior-data-conflict").verdict, Verdict::pass);
      EXPECT_TRUE(trusted(checks)) << lognormal << rows;
    }
  }
  EXPECT_EQ(
      check(checks_of(joint_posterior(false, false, INFINITY, 6)), "proper-posterior").verdict,
      Verdict::pass);
}

// The paper's own finding: the tribometer's prior and the joint disagree. With three data sets
// there is nothing to disagree with.
TEST(Trust, TribometerPriorConflictsWithTheJoint) {
  for (const bool lognormal : {false, true}) {
    const double upper = lognormal ? 7 : 15;
    for (const std::size_t rows : {5, 6}) {
      const auto checks = checks_of(joint_posterior(lognormal, true, upper, rows));
      EXPECT_EQ(check(checks, "prior-data-conflict").verdict, Verdict::fail);
      EXPECT_THAT(check(checks, "prior-data-conflict").advice, HasSubstr("about k"));
    }
  }
  EXPECT_NE(check(checks_of(joint_posterior(false, true, 15, 2)), "prior-data-conflict").verdict,
            Verdict::fail);
}

// A half-normal prior that cuts off the long tail of sigma matters, but pulls where the data pull.
TEST(Trust, AWeakPriorOnScatterIsNoConflict) {
  const Posterior flat = joint_posterior(false, false, INFINITY, 4);
  std::vector<Parameter> parameters = flat.parameters();
  parameters[1].prior = make_distribution(Normal{0, 5e-9}, 0, INFINITY);
  EXPECT_NE(
      check(checks_of(Posterior(parameters, flat.likelihood())), "prior-data-conflict").verdict,
      Verdict::fail);
}

// The mean of k with three lognormal data sets is 20 with the bound of sigma at 7 and 27 at 15: a
// flat law that was cut is no knowledge and fails, a uniform law is and warns.
TEST(Trust, DependenceOnTheCut) {
  const Posterior uniform = joint_posterior(true, false, 7, 3);
  const Check warning = check(checks_of(uniform), "prior-bounds");
  EXPECT_EQ(warning.verdict, Verdict::warn);
  EXPECT_THAT(warning.detail, HasSubstr("bounds of sigma"));

  std::vector<Parameter> parameters = uniform.parameters();
  parameters[1].prior = make_distribution(Flat{}, 0, 7e-9);
  const auto cut = checks_of(Posterior(parameters, uniform.likelihood()));
  EXPECT_EQ(check(cut, "prior-bounds").verdict, Verdict::fail);
  EXPECT_EQ(check(cut, "bounds").verdict, Verdict::fail);
  EXPECT_FALSE(trusted(cut));
}

TEST(Trust, TooFewDrawsDoNotConverge) {
  FitSettings settings;
  settings.run.warmup = 20;
  settings.run.draws = 20;
  const auto checks = checks_of(joint_posterior(false, false, 15, 5), settings);
  EXPECT_EQ(check(checks, "convergence").verdict, Verdict::fail);
}

TEST(Trust, WrongDrawsDisagreeWithQuadrature) {
  const Posterior posterior = joint_posterior(false, false, 15, 5);
  Fit wrong = fit(posterior, {});
  EXPECT_EQ(check(trust_checks(posterior, wrong), "exact-agreement").verdict, Verdict::pass);
  wrong.pooled.values.col(0).array() += 0.3e-13;  // a third of a standard deviation
  EXPECT_EQ(check(trust_checks(posterior, wrong), "exact-agreement").verdict, Verdict::fail);
}

// A difference that no one would see is none, however small the Monte Carlo error.
TEST(Trust, ADifferenceFarBelowAStandardDeviationIsNoDisagreement) {
  const Posterior posterior = joint_posterior(false, false, 15, 5);
  Fit moved = fit(posterior, {});
  const double sd = moved.exact->sd[0];
  moved.pooled.values.col(0).array() += moved.exact->mean[0] - moved.pooled.values.col(0).mean();
  for (Diagnostics& each : moved.diagnostics) {
    each.mcse_mean *= 1e-6;
    each.mcse_q05 *= 100, each.mcse_q50 *= 100, each.mcse_q95 *= 100;
  }
  const auto of_k = [&] {
    const auto all = disagreements(moved, agreement_level);
    return std::count_if(all.begin(), all.end(),
                         [](const auto& each) { return each.parameter == 0; });
  };
  moved.pooled.values.col(0).array() += 0.003 * sd;
  EXPECT_EQ(of_k(), 0);
  moved.pooled.values.col(0).array() += 0.01 * sd;
  EXPECT_EQ(of_k(), 1);
}

// Right draws that lie far out by chance are drawn again from random numbers of their own.
TEST(Trust, DrawsThatDisagreeByChanceAreDrawnAgain) {
  const Posterior posterior = joint_posterior(false, false, 15, 5);
  FitSettings often;
  often.redraw_level = 0.999;  // half a standard error is enough
  const Fit first = fit(posterior, {}), again = fit(posterior, often);
  EXPECT_FALSE(first.redrawn);
  ASSERT_TRUE(again.redrawn);
  EXPECT_NE(first.pooled.values(0, 0), again.pooled.values(0, 0));
  EXPECT_EQ(check(trust_checks(posterior, again), "exact-agreement").verdict, Verdict::pass);
  EXPECT_THAT(check(trust_checks(posterior, again), "exact-agreement").detail,
              HasSubstr("the first draws disagreed and were repeated"));
}

// x^-2.2 e^(-100/x) from 1 on: nearly half of it lies within a twentieth of its central 90 % from the bound, where its density is
// 1e-39 of its highest.
TEST(Trust, ASkewedDensityThatVanishesAtABoundIsNotAccused) {
  class InverseGamma final : public LogDensity {
   public:
    int dimension() const override { return 1; }
    double value(std::span<const double> x) const override {
      return -2.2 * std::log(x[0]) - 100 / x[0];
    }
    double value_and_gradient(std::span<const double> x,
                              std::span<double> gradient) const override {
      gradient[0] = -2.2 / x[0] + 100 / (x[0] * x[0]);
      return value(x);
    }
  };
  Parameter parameter = flat_parameter("x", 80, 40);
  parameter.natural_lower = 0;
  parameter.prior = make_distribution(Uniform{}, 1, 1e5);
  for (const Method method : {Method::nuts, Method::exact}) {
    FitSettings settings;
    settings.method = method;
    const Posterior vanishing({parameter}, std::make_shared<InverseGamma>());
    EXPECT_EQ(check(checks_of(vanishing, settings), "bounds").verdict, Verdict::pass);
  }
  // The same cut where it is high, and one that rises towards the bound.
  parameter.prior = make_distribution(Uniform{}, 50, 1e5);
  EXPECT_EQ(
      check(checks_of(Posterior({parameter}, std::make_shared<InverseGamma>())), "bounds").verdict,
      Verdict::warn);
}

TEST(Trust, StepsThatAreTooLongDiverge) {
  FitSettings settings;
  settings.run.warmup = 0;
  settings.nuts.target_accept = 0.1;
  const auto checks = checks_of(joint_posterior(true, false, 7, 2), settings);
  EXPECT_NE(check(checks, "divergences").verdict, Verdict::pass);
}

}  // namespace
}  // namespace wearwell
