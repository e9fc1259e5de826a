// Every stage of a fit that falls short says so to the verdict, and posteriors on which stages once fell short in silence.
#include "wearwell/infer/stage.h"

#include <gmock/gmock.h>

#include "infer/test_posteriors.h"
#include "support/formula.h"
#include "wearwell/infer/constrained_mode.h"
#include "wearwell/infer/psis_loo.h"
#include "wearwell/infer/trust.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/view.h"
#include "wearwell/models/fatigue/sn_likelihood.h"
#include "wearwell/models/joint/archard.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

FitSettings exact_settings() {
  FitSettings settings;
  settings.method = Method::exact;
  settings.run.warmup = 200;  // where quadrature fails and NUTS takes its place
  settings.run.draws = 200;
  return settings;
}

struct Verdicts {
  Fit fit;
  std::vector<Check> checks;

  bool trusted() const { return wearwell::trusted(checks); }
  std::string failing() const {
    std::string all;
    for (const Check& each : checks) {
      if (each.verdict == Verdict::fail) all += each.name + ": " + each.detail + "\n";
    }
    return all;
  }
};

// All stages, as a study runs them.
Verdicts judge(const Posterior& posterior) {
  Verdicts verdicts{fit(posterior, exact_settings()), {}};
  const NaturalMode mode = constrained_mode(posterior, verdicts.fit);
  const Loo loo = leave_one_out(posterior, verdicts.fit);
  for (StageDiagnostic& each : later_stage_diagnostics(posterior, verdicts.fit, mode)) {
    verdicts.fit.stage_diagnostics.push_back(std::move(each));
  }
  verdicts.checks = trust_checks(posterior, verdicts.fit);
  if (!loo.terms.empty()) verdicts.checks.push_back(loo_check(loo, "row", posterior.dimension()));
  return verdicts;
}

Parameter parameter(const std::string& name, double lower, double upper, double start,
                    const Family& family = Flat{}) {
  return {name,
          "1",
          Unit{"1", 1, 0},
          "",
          make_distribution(family, lower, upper),
          start,
          1,
          lower == 0 ? 0 : -infinity,
          infinity};
}

// y = a + b x with normal scatter; a, b and sigma are flat. Searches start far from the data.
Posterior line(const std::vector<double>& x, const std::vector<double>& y, double sigma_start,
               const Family& sigma_prior = Flat{}, double sigma_upper = infinity) {
  return {{parameter("a", -infinity, infinity, 1), parameter("b", -infinity, infinity, 0.5),
           parameter("sigma", 0, sigma_upper, sigma_start, sigma_prior)},
          std::make_shared<Formula>(3, [=](std::span<const double> p, std::span<double> gradient) {
            double sum = 0, of_a = 0, of_b = 0, of_sigma = 0;
            for (std::size_t i = 0; i < x.size(); ++i) {
              const double z = (y[i] - p[0] - p[1] * x[i]) / p[2];
              sum -= 0.5 * z * z + std::log(p[2]);
              of_a += z / p[2];
              of_b += z * x[i] / p[2];
              of_sigma += (z * z - 1) / p[2];
            }
            gradient[0] = of_a;
            gradient[1] = of_b;
            gradient[2] = of_sigma;
            return sum;
          })};
}

const std::vector<double> abscissae = {1, 2, 3, 4, 5, 6, 7, 8};

std::vector<double> ordinates(double deviation) {
  const double pattern[] = {1, -1, 0.5, -0.2, 0.7, -1.3, 0.4, -0.1};
  std::vector<double> y;
  for (std::size_t i = 0; i < abscissae.size(); ++i) {
    y.push_back(3 - 0.25 * abscissae[i] + deviation * pattern[i]);
  }
  return y;
}

// One stage after the other falls short of a fit in which nothing else is wrong: each ends trust.
TEST(Stages, EachEndsTrust) {
  const Posterior posterior = joint_posterior(false, false, 15, 5);
  const Fit sound = fit(posterior, exact_settings());
  EXPECT_TRUE(trusted(trust_checks(posterior, sound)));
  EXPECT_THAT(sound.stage_diagnostics, testing::IsEmpty());
  for (const Stage stage : all_stages) {
    Fit wrong = sound;
    wrong.stage_diagnostics.push_back({stage, Verdict::fail, "it fell short", "look"});
    const std::vector<Check> checks = trust_checks(posterior, wrong);
    EXPECT_FALSE(trusted(checks)) << stage_name(stage);
    EXPECT_EQ(checks.back().name, "computation");
    EXPECT_THAT(checks.back().detail, HasSubstr(stage_name(stage)));
  }
}

// Integrals within a likelihood that stay open are found at the points of the posterior: a little warns.
TEST(Stages, OpenIntegralsWithinALikelihoodAreSaid) {
  struct Open final : LogDensity {
    explicit Open(double much) : left(much) {}
    double left;
    int dimension() const override { return 1; }
    double value(std::span<const double> x) const override { return -0.5 * x[0] * x[0]; }
    double value_and_gradient(std::span<const double> x, std::span<double> g) const override {
      g[0] = -x[0];
      return value(x);
    }
    double unsettled(std::span<const double> x) const override { return x[0] > 0 ? left : 0; }
  };
  for (const double left : {0.0, 1e-5, 0.1}) {
    const Posterior posterior({parameter("a", -infinity, infinity, 1)},
                              std::make_shared<Open>(left));
    const Fit found = fit(posterior, exact_settings());
    ASSERT_EQ(found.stage_diagnostics.size(), left > 0 ? 1u : 0u);
    if (left == 0) continue;
    EXPECT_EQ(found.stage_diagnostics[0].stage, Stage::effects);
    EXPECT_EQ(found.stage_diagnostics[0].verdict, left > 1e-3 ? Verdict::fail : Verdict::warn);
    EXPECT_THAT(found.stage_diagnostics[0].what, HasSubstr(" of 200 sampled points"));
  }
}

// With S the sum of squares about the line and flat priors sigma^2 has density sigma^-(n-2) exp(-S/2 sigma^2) d sigma.
TEST(Stages, SmallDeviationsFromALineAreFound) {
  for (const double deviation : {1.0, 1e-2, 1e-4, 1e-7, 1e-9}) {
    const std::vector<double> y = ordinates(deviation);
    const auto n = static_cast<double>(y.size());
    // Deviations from the line, whose own squares are free of cancellation.
    const std::vector<double> unit = ordinates(1), straight = ordinates(0);
    double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double e = unit[i] - straight[i];
      sx += abscissae[i];
      sy += e;
      sxx += abscissae[i] * abscissae[i];
      sxy += abscissae[i] * e;
      syy += e * e;
    }
    const double rss = syy - sy * sy / n - std::pow(sxy - sx * sy / n, 2) / (sxx - sx * sx / n);
    const double m = n - 2;
    const double mean = deviation * std::sqrt(rss / 2) *
                        std::exp(std::lgamma((m - 2) / 2) - std::lgamma((m - 1) / 2));
    const Verdicts found = judge(line(abscissae, y, 0.05));
    ASSERT_TRUE(found.fit.exact) << deviation << " " << found.fit.no_exact;
    EXPECT_NEAR(found.fit.exact->mean[2] / mean, 1, 1e-4) << deviation;
    EXPECT_TRUE(found.trusted()) << deviation << " " << found.failing();
  }
}

TEST(Stages, PointsOnALineHaveNoScatter) {
  EXPECT_FALSE(judge(line(abscissae, ordinates(0), 0.05)).trusted());
  EXPECT_FALSE(judge(line(abscissae, std::vector<double>(8, 3.7), 0.05)).trusted());
  EXPECT_FALSE(judge(line(abscissae, ordinates(0), 0.05, Uniform{}, 10)).trusted());
  // Half a millionth of an ulp more or less of each: what is left is rounding.
  EXPECT_FALSE(judge(line(abscissae, ordinates(1e-16), 0.05)).trusted());
}

Posterior joint(const std::vector<double>& work, const std::vector<double>& volume, bool constant,
                double sigma_start) {
  std::vector<Parameter> parameters = {parameter("k", 0, infinity, 1e-13),
                                       parameter("sigma", 0, infinity, sigma_start)};
  if (constant) {
    parameters.push_back(parameter("V0", -infinity, infinity, 0.1 * sigma_start));
    parameters.back().scale = sigma_start;
  }
  joint::Archard law;
  law.has_constant = constant;
  return {parameters,
          joint::archard_likelihood(law, ObservationFamily::normal, {work, volume}, work.size())};
}

// k and V0 are not distinguished by inspections after the same work.
TEST(Stages, ARidgeOfTwoParametersIsImproper) {
  const Verdicts found = judge(joint({1e4, 1e4, 1e4, 1e4, 1e4, 1e4},
                                     {4e-9, 5e-9, 4.5e-9, 5.2e-9, 4.1e-9, 4.7e-9}, true, 1e-9));
  EXPECT_FALSE(found.trusted());
  EXPECT_FALSE(found.fit.exact);
}

TEST(Stages, NoWearAtAllHasNoScatter) {
  EXPECT_FALSE(judge(joint({1e3, 1e4, 5e4, 1e5}, {0, 0, 0, 0}, false, 1e-12)).trusted());
}

Posterior life_tests(const std::vector<double>& stress, const std::vector<double>& life,
                     fatigue::LifeFamily family, double sigma_start, double b = -0.1) {
  fatigue::SnLaw law;
  law.correction = fatigue::MeanStress::none;
  law.family = family;
  fatigue::LifeTests tests;
  double mean = 0;
  for (std::size_t i = 0; i < life.size(); ++i) {
    tests.push_back({{stress[i], 0}, fatigue::Outcome::failure, life[i], 0, 1});
    mean += (std::log10(stress[i]) - b * std::log10(life[i])) / static_cast<double>(life.size());
  }
  return {{parameter("log10_a", -infinity, infinity, mean + 0.1),
           [&] {
             Parameter slope = parameter("b", -infinity, 0, b);
             slope.natural_upper = 0;
             return slope;
           }(),
           parameter("sigma", 0, infinity, sigma_start)},
          fatigue::sn_likelihood(law, tests, tests.size())};
}

// Lives that do not depend on stress: the slope 1/b of log life is 0, b has no end.
TEST(Stages, LivesThatIgnoreStressHoldNoSlope) {
  const Verdicts found = judge(
      life_tests({2e8, 3e8, 4e8}, {1.0e5, 1.1e5, 1.05e5}, fatigue::LifeFamily::log10_normal, 0.2));
  EXPECT_FALSE(found.trusted());
  EXPECT_FALSE(found.fit.exact);
}

// Lives at two stresses that agree to 1e-9 of themselves, the scatter guessed 10^8 times too large: either the truth or no
// trust. Scatter about two free means has density sigma^-(n-2) exp(-S/2 sigma^2), as above.
TEST(Stages, LivesThatAgreeToNineDigits) {
  std::vector<double> stress, life;
  const double tenths[] = {1, 2, 3, 2.5, 1.5, 3, 1, 2};
  for (int i = 0; i < 8; ++i) {
    stress.push_back(i < 4 ? 3e8 : 2e8);
    life.push_back((i < 4 ? 1e8 : 3e8) + 0.1 * tenths[i]);
  }
  const Verdicts found = judge(life_tests(stress, life, fatigue::LifeFamily::normal, 3e7));
  double rss = 0;
  for (const int first : {0, 4}) {
    double mean = 0;
    for (int i = first; i < first + 4; ++i) mean += 0.1 * tenths[i] / 4;
    for (int i = first; i < first + 4; ++i) rss += std::pow(0.1 * tenths[i] - mean, 2);
  }
  const double truth = std::sqrt(rss / 2) * std::exp(std::lgamma(2) - std::lgamma(2.5));
  ASSERT_TRUE(found.fit.exact || !found.trusted());
  if (found.trusted()) {
    EXPECT_NEAR(found.fit.exact->mean[2] / truth, 1, 1e-2);
  }
}

// The mode of a density whose slope is cut to a narrow interval: on a bound, or anywhere between.
TEST(Stages, ModeWithinNarrowBounds) {
  const std::vector<double> y = ordinates(0.1);
  for (const double center : {-1.0, -0.25}) {
    for (int exponent = 0; exponent <= 14; ++exponent) {
      const double width = std::pow(10, -exponent);
      const Posterior wide = line(abscissae, y, 0.5);
      std::vector<Parameter> parameters = wide.parameters();
      parameters[1].prior = make_distribution(Uniform{}, center - width, center + width);
      parameters[1].start = center;
      parameters[1].scale = width;
      const Posterior posterior(parameters, wide.likelihood());
      const Fit found = fit(posterior, exact_settings());
      const NaturalMode mode = constrained_mode(posterior, found);
      ASSERT_EQ(mode.problem, "") << center << " +- " << width;
      // Least squares of a with b at its place.
      double mean = 0, rss = 0;
      for (std::size_t i = 0; i < y.size(); ++i) {
        mean += (y[i] - mode.position[1] * abscissae[i]) / static_cast<double>(y.size());
      }
      for (std::size_t i = 0; i < y.size(); ++i) {
        rss += std::pow(y[i] - mean - mode.position[1] * abscissae[i], 2);
      }
      EXPECT_NEAR(mode.position[0], mean, 1e-5) << width;
      EXPECT_NEAR(mode.position[2], std::sqrt(rss / 8), 1e-5) << width;
      if (center == -1 && exponent > 0) {
        EXPECT_NEAR(mode.position[1], center + width, 0.1 * width) << width;
      }
    }
  }
}

// Proper priors and a bounded likelihood: proper, whatever a search finds where there is no density.
TEST(Stages, ProperPriorsMakeAProperPosterior) {
  for (const double half : {1e-3, 0.1, 0.5, 3.0}) {
    const Posterior wide = line(abscissae, ordinates(0.1), 0.5, Uniform{}, 5);
    std::vector<Parameter> parameters = wide.parameters();
    parameters[0].prior = make_distribution(Uniform{}, -50, 50);
    parameters[1].prior = make_distribution(Uniform{}, -0.25 - half, -0.25 + half);
    parameters[1].start = -0.25 + 0.1 * half;
    const Posterior posterior(parameters, wide.likelihood());
    for (const Tail& tail : tails(posterior, find_mode(posterior, posterior.start()))) {
      EXPECT_TRUE(tail.integrable()) << half << tail.parameter << tail.upward;
      EXPECT_TRUE(tail.known);
    }
  }
}

// On a plateau or at an edge a search for the mode may end little above the draws: no mass is missed. Far above them it is.
TEST(StageDiagnostics, ASearchThatFellShort) {
  const Posterior posterior = line({1, 2, 3, 4}, {1.1, 1.9, 3.2, 3.9}, 1);
  const Fit found = fit(posterior, exact_settings());
  NaturalMode mode;
  mode.problem = "the search did not converge";
  EXPECT_THAT(later_stage_diagnostics(posterior, found, mode), testing::IsEmpty());
  mode.fell_short = true;
  mode.above_draws = 0.3;
  auto stages = later_stage_diagnostics(posterior, found, mode);
  ASSERT_EQ(stages.size(), 1u);
  EXPECT_EQ(stages[0].verdict, Verdict::warn);
  EXPECT_THAT(stages[0].what,
              HasSubstr("the draws do not miss mass: the search reached only e^0.3 times"));
  for (const double above : {40.0, double(NAN)}) {
    mode.above_draws = above;
    stages = later_stage_diagnostics(posterior, found, mode);
    ASSERT_EQ(stages.size(), 1u);
    EXPECT_EQ(stages[0].verdict, Verdict::fail) << above;
  }
}

}  // namespace
}  // namespace wearwell
