// S-N curves with a knee, a limit or a form of their own: identities with each other, and sums by force.
#include <gtest/gtest.h>

#include <cmath>

#include "all_laws.h"
#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/fatigue/damage.h"
#include "wearwell/models/fatigue/life.h"
#include "wearwell/models/fatigue/sn_likelihood.h"

namespace wearwell::fatigue {
namespace {

SnLaw law_of(SnCurve curve, SecondSlope slope = SecondSlope::free) {
  SnLaw law;
  law.correction = MeanStress::none;
  law.curve = curve;
  law.second_slope = slope;
  return law;
}

LifeTests some_tests() {
  return {{{430e6, 0}, Outcome::failure, 1.1e5, 0, 1},
          {{380e6, 0}, Outcome::failure, 2.7e5, 0, 2},
          {{330e6, 0}, Outcome::interval, 4e5, 9e5, 1},
          {{300e6, 0}, Outcome::left, 2e6, 0, 1},
          {{260e6, 0}, Outcome::runout, 1e7, 0, 3}};
}

double likelihood(const SnLaw& law, const std::vector<double>& x, const LifeTests& tests) {
  return sn_likelihood(law, tests, tests.size())->value(x);
}

TEST(SnCurve, AKneeWithoutAChangeOfSlopeIsBasquins) {
  const double k = 7, life = 6.1, stress = 8.45;
  EXPECT_NEAR(likelihood(law_of(SnCurve::knee), {k, life, stress, k, 0.25}, some_tests()),
              likelihood(law_of(SnCurve::basquin), {stress + life / k, -1 / k, 0.25}, some_tests()),
              1e-10);
}

TEST(SnCurve, TheSecondSlopeBeginsAtTheKnee) {
  const SnLaw free = law_of(SnCurve::knee), haibach = law_of(SnCurve::knee, SecondSlope::haibach);
  const double x[] = {5, 6, 8.4, 9};  // 2k - 1 = 9
  for (const double s : {8.0, 8.399, 8.4, 8.401, 8.8}) {
    EXPECT_EQ(free.log10_life(x, s), haibach.log10_life(x, s));
    EXPECT_NEAR(free.log10_life(x, s), 6 - (s < 8.4 ? 9 : 5) * (s - 8.4), 1e-12);
  }
}

// A second slope without bound is a horizontal limit that does not scatter.
TEST(SnCurve, ASteepSecondSlopeIsAHorizontalLimit) {
  SnLaw horizontal = law_of(SnCurve::knee, SecondSlope::infinite);
  horizontal.limit = StandardDistribution::normal;
  EXPECT_NEAR(likelihood(law_of(SnCurve::knee), {6, 5.9, 8.45, 1e7, 0.3}, some_tests()),
              likelihood(horizontal, {6, 5.9, 0.3, 8.45, 1e-6}, some_tests()), 1e-9);
}

// By force: over items whose limits are their own, a life above the limit and none below.
TEST(SnCurve, AScatteringKneeIsTheIntegralOverItems) {
  SnLaw law = law_of(SnCurve::knee, SecondSlope::infinite);
  for (const auto limit :
       {StandardDistribution::normal, StandardDistribution::smallest_extreme_value}) {
    law.limit = limit;
    const std::vector<double> x = {6, 5.9, 0.3, 8.45, 0.06};
    for (const double stress : {230e6, 282e6, 350e6}) {
      const double s = std::log10(stress), life = 8e5;
      double survivors = 0;
      constexpr int items = 200000;
      for (int i = 0; i < items; ++i) {
        const double z = quantile(limit, (i + 0.5) / items);
        const double center = law.log10_life_of_item(x.data(), s, z);
        survivors += std::isinf(center)
                         ? 1
                         : 0.5 * std::erfc((std::log10(life) - center) / 0.3 / std::sqrt(2));
      }
      EXPECT_NEAR(likelihood(law, x, {{{stress, 0}, Outcome::runout, life, 0, 1}}),
                  std::log(survivors / items), 1e-4);
    }
  }
}

// Without a limit Stromeyer's curve is Basquin's; with limits that hardly differ the random limit's, which
// is integrated by other means.
TEST(SnCurve, StromeyersCurveBetweenItsNeighbours) {
  const SnLaw stromeyer = law_of(SnCurve::stromeyer);
  EXPECT_NEAR(likelihood(stromeyer, {9.4, -0.15, -20, 0.3}, some_tests()),
              likelihood(law_of(SnCurve::basquin), {9.4, -0.15, 0.3}, some_tests()), 1e-10);
  SnLaw random = law_of(SnCurve::basquin);
  random.limit = StandardDistribution::normal;
  EXPECT_NEAR(likelihood(stromeyer, {9.6, -0.25, 8.3, 0.3}, some_tests()),
              likelihood(random, {9.6, -0.25, 0.3, 8.3, 1e-7}, some_tests()), 1e-7);
}

TEST(SnCurve, BastenairesFormula) {
  const SnLaw law = law_of(SnCurve::bastenaire);
  const double x[] = {5.8, 8.2, 0.7, 8.35};
  const double stress = 300e6, limit = std::pow(10, 8.35), b = std::pow(10, 8.2);
  const double life =
      std::pow(10, 5.8) * b / (stress - limit) * std::exp(-std::pow((stress - limit) / b, 0.7));
  EXPECT_NEAR(law.log10_life(x, std::log10(stress)), std::log10(life), 1e-10);
  EXPECT_EQ(law.log10_life(x, 8.34), INFINITY);
}

TEST(SnCurve, TheTwoLinesOfAStrainLifeCurveAddUp) {
  const SnLaw law = law_of(SnCurve::strain_life);
  const double x[] = {std::log10(0.0046), -0.09, std::log10(0.6), -0.59};
  for (const double strain : {0.1, 0.02, 0.005, 0.002, 0.0008}) {
    const double reversals = 2 * std::pow(10, law.log10_life(x, std::log10(strain)));
    EXPECT_NEAR((0.0046 * std::pow(reversals, -0.09) + 0.6 * std::pow(reversals, -0.59)) / strain,
                1, 1e-12);
  }
}

TEST(SnCurve, BelowALimitOfAllTestsRunOutAndNoneFails) {
  for (const SnCurve curve : {SnCurve::stromeyer, SnCurve::bastenaire}) {
    const SnLaw law = law_of(curve);
    const std::vector<double> x = curve == SnCurve::stromeyer
                                      ? std::vector<double>{9.6, -0.25, 8.45, 0.3}
                                      : std::vector<double>{5.9, 8.3, 0.8, 8.45, 0.3};
    EXPECT_EQ(likelihood(law, x, {{{260e6, 0}, Outcome::runout, 1e7, 0, 1}}), 0);
    EXPECT_EQ(likelihood(law, x, {{{260e6, 0}, Outcome::failure, 1e7, 0, 1}}), -INFINITY);
    EXPECT_EQ(life_quantile(law, x.data(), {260e6, 0}, 0.1), INFINITY);
  }
}

// Of each law: the life by which a share has failed is outlasted by the others, and the stress that is
// allowed for it is that stress.
TEST(SnCurve, QuantilesSurvivalAndAllowedStressAreOne) {
  for (const SnLaw& law : bent_laws()) {
    const std::vector<double> x = plausible_bent(law, 0);
    const Stress stress{300e6, 0};
    for (const double p : {0.1, 0.5}) {
      const double life = cycles(law, life_quantile(law, x.data(), stress, p));
      EXPECT_NEAR(survival(law, x.data(), stress, life), 1 - p, 1e-9);
      EXPECT_NEAR(log10_reversed_allowed(law, x.data(), life, 1 - p), std::log10(300e6), 1e-7);
    }
  }
}

// The Miner life of a constant amplitude is the S-N life, for every item.
TEST(SnCurve, ConstantAmplitudeIsTheCurve) {
  for (const SnLaw& law : bent_laws()) {
    if (law.limit) continue;  // items have two places there
    const std::vector<double> x = plausible_bent(law, 0);
    for (const double alternating : {220e6, 430e6}) {
      const Stress stress{alternating, 0};
      const BlockDamage damage(law, x.data(), {MinerRule::original, {}}, {{stress, 250.0}});
      for (const double p : {0.01, 0.5, 0.9}) {
        const double blocks = std::pow(10, -damage.log10_damage(quantile(law.standard(), p)));
        const double life = cycles(law, life_quantile(law, x.data(), stress, p));
        EXPECT_NEAR(250 * blocks / life, 1, 1e-12);
      }
    }
  }
}

// Damage of many stresses is the sum over each, one by one; below an item's limit there is none.
TEST(SnCurve, DamageAddsUp) {
  const LoadCycles cycles = {{{300e6, 0}, 3}, {{450e6, 0}, 1}, {{240e6, 0}, 40}, {{200e6, 0}, 1e3}};
  for (const SnLaw& law : bent_laws()) {
    const std::vector<double> x = plausible_bent(law, 0);
    const BlockDamage damage(law, x.data(), {MinerRule::original, {}}, cycles);
    for (const double z : {-1.5, 0.0, 2.0}) {
      double sum = 0;
      for (const LoadCycle& each : cycles) {
        const double s = law.log10_reversed(x.data(), each.stress);
        const double center =
            law.limit ? law.log10_life_of_item(x.data(), s, 0.3) : law.log10_life(x.data(), s);
        if (std::isinf(center)) continue;
        sum += each.count * std::pow(10, -center - law.sigma_at(x.data(), center) * z);
      }
      EXPECT_NEAR(damage.log10_damage(z, 0.3), std::log10(sum), 1e-12);
    }
    double shares = 0;
    for (const double share : damage.shares(cycles)) shares += share;
    EXPECT_NEAR(shares, 1, 1e-12);
  }
}

class CurveStudy : public ScratchTest {
 protected:
  std::string refused(const std::string& law, const std::string& more = "") {
    write("d.csv", "s,n\n400,1e5\n300,8e5\n350,3e5\n");
    const auto study = write("study.toml",
                             "model = \"sn\"\n[data]\nfile = \"d.csv\"\n[data.columns]\n"
                             "alternating_stress = { column = \"s\", unit = \"MPa\" }\n"
                             "life = \"n\"\n[law]\nmean_stress = \"none\"\n" +
                                 law + "\n" + more);
    try {
      read_posterior_study(study);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

// What drives the lives need not be a stress; what is stated beside it must have its dimension.
TEST_F(CurveStudy, DriversOfOtherDimensions) {
  const auto study = [&](const std::string& unit, const std::string& more) {
    write("d.csv", "s,n\n400,1e5\n300,8e5\n350,3e5\n");
    const auto file =
        write("study.toml",
              "model = \"sn\"\n[data]\nfile = \"d.csv\"\n[data.columns]\nalternating_stress "
              "= { column = \"s\", unit = \"" +
                  unit + "\" }\nlife = \"n\"\n[law]\nmean_stress = \"none\"\n" + more);
    try {
      return read_posterior_study(file).parameters[0].unit.text;
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  const std::string asked = "[predict.stress]\np = { alternating_stress = \"";
  EXPECT_EQ(study("MPa", ""), "log10(MPa)");
  EXPECT_EQ(study("kN", asked + "320 N\" }\n"), "log10(kN)");
  EXPECT_EQ(study("um/m", asked + "0.03 %\" }\n"), "1");
  EXPECT_EQ(study("um/m", "curve = \"strain-life\"\n"), "1");
  EXPECT_NE(study("kN", asked + "320 MPa\" }\n").find("MPa"), std::string::npos);
  EXPECT_NE(
      study("um/m",
            "[prior]\nlog10_a = { distribution = \"normal\", mean = \"3 log10(MPa)\", sd = 1 }\n")
          .find("log10(MPa)"),
      std::string::npos);
  EXPECT_NE(study("MPa", "curve = \"strain-life\"\n").find("needs strains"), std::string::npos);
  EXPECT_NE(study("s", "").find("'s'"), std::string::npos);
}

TEST_F(CurveStudy, FormsThatDoNotGoTogetherAreRefusedWithWhatDoes) {
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  EXPECT_EQ(refused("curve = \"knee\""), "");
  EXPECT_EQ(refused("curve = \"knee\"\nsecond_slope = \"infinite\"\nfatigue_limit = \"random\""),
            "");
  EXPECT_EQ(refused("curve = \"bastenaire\"\nscatter = \"grows\""), "");
  has(refused("curve = \"knee\"\nfatigue_limit = \"random\""), "second_slope");
  has(refused("curve = \"knee\"\nsecond_slope = \"infinite\""), "fatigue_limit");
  has(refused("second_slope = \"haibach\""), "needs curve = \"knee\"");
  has(refused("curve = \"bastenaire\"\nfatigue_limit = \"random\""), "one common limit");
  has(refused("fatigue_limit = \"random\"\nscatter = \"grows\""), "use grows with fatigue_limit");
  has(refused("curve = \"knee\"", "[likelihood]\nfamily = \"normal\"\n"), "log10-normal or");
}

}  // namespace
}  // namespace wearwell::fatigue
