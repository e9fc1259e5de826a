// Each check is shown one posterior that it must refuse and one that it must let pass.
#include "wearwell/infer/trust.h"

#include <gmock/gmock.h>

#include "infer/test_posteriors.h"
#include "wearwell/base/error.h"

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
    parameter.prior = make_law(StudentT{df, 0, 1}, -INFINITY, INFINITY);
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
  parameters[1].prior = make_law(Normal{0, 5e-9}, 0, INFINITY);
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
  parameters[1].prior = make_law(Flat{}, 0, 7e-9);
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

TEST(Trust, StepsThatAreTooLongDiverge) {
  FitSettings settings;
  settings.run.warmup = 0;
  settings.nuts.target_accept = 0.1;
  const auto checks = checks_of(joint_posterior(true, false, 7, 2), settings);
  EXPECT_NE(check(checks, "divergences").verdict, Verdict::pass);
}

}  // namespace
}  // namespace wearwell
