// Lives that a result is asked for (wearwell life), and one posterior written in two ways, against what follows from
// the nodes of the quadrature by hand and against closed forms.
#include <gtest/gtest.h>

#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/registry.h"
#include "wearwell/prognosis/unit_life.h"
#include "wearwell/study/inference_data.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

class LifeAnswers : public ScratchTest {
 protected:
  PosteriorSummary run(const std::string& text) const {
    return run_study(wearwell::read_posterior_study(write("study.toml", text)),
                     {Method::exact, 1, {}, 50, {}}, {}, false);
  }
  prognosis::UnitLife ask(const std::string& text, const PosteriorSummary& result,
                          const prognosis::LifeQuestion& question) const {
    return prognosis::unit_life(
        source_of(write("study.toml", text)),
        [](const Source& source) { return read_study(source, all_models()); },
        result.fit->exact->nodes, question);
  }
};

const char* const lives = R"toml(
model = "formula"
[data]
file = "lives.csv"
[data.columns]
life = "life"
status = "status"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
[prior]
eta = { distribution = "lognormal", median = "1000 h", log_sd = 1 }
beta = { distribution = "lognormal", median = 2, log_sd = 0.5 }
[predict]
survival_to = ["300 h", "900 h"]
)toml";

// Exponential modes under flat priors: the share of a mode in the failures is beta distributed (r - 1 failures), independent of the life of
// the part.
TEST_F(LifeAnswers, SharesFailedByAModeHaveTheBoundsThatAreAsked) {
  std::string rows = "life [h],mode\n";
  double total = 0;
  for (int i = 1; i <= 12; ++i) {
    rows += fmt::format("{},{}\n", 50 * i, i % 3 == 0 ? "runout" : i % 4 == 1 ? "wear" : "leak");
    total += 50 * i;
  }
  write("lives.csv", rows);
  const std::string text = R"toml(
model = "formula"
[data]
file = "lives.csv"
[data.columns]
life = "life"
mode = "mode"
[failure_modes]
column = "mode"
[likelihood.life]
family = "exponential"
mean = "m[mode]"
[prior]
m = { distribution = "flat", unit = "h" }
[predict]
survival_to = "100 h"
)toml";
  const auto failed = [&](const std::string& keys, const std::string& mode) {
    const PosteriorSummary result = run(text + keys);
    for (const QuantitySummary& each : result.quantities)
      if (each.name == "failed by " + mode + " to 100 h") return each;
    ADD_FAILURE() << mode;
    return result.quantities.front();
  };
  const double leaks = 6 - 1, wears = 2 - 1, both = leaks + wears;
  const double predictive = 100 * (1 - std::pow(1 + 100 / total, -both)) * leaks / both;
  const QuantitySummary lower = failed("", "leak"),
                        two = failed("level = 0.9\nsides = \"both\"\n", "leak"),
                        upper = failed("level = 0.8\nsides = \"upper\"\n", "wear");
  ASSERT_TRUE(lower.best().predictive && lower.best().bound);
  EXPECT_NEAR(*lower.best().predictive / predictive, 1, 1e-3);
  EXPECT_FALSE(lower.best().upper_bound);
  EXPECT_EQ(*two.best().bound, two.best().q05);
  EXPECT_EQ(*two.best().upper_bound, two.best().q95);
  EXPECT_EQ(two.credible_level, 0.9);
  EXPECT_FALSE(upper.best().bound);
  EXPECT_GT(*upper.best().upper_bound, upper.best().q50);
  EXPECT_LT(*upper.best().upper_bound, upper.best().q95);
}

// Sums over all nodes of the quadrature share nothing with the mixture that the program solves.
TEST_F(LifeAnswers, SurvivalAndHorizonArePredictive) {
  write("lives.csv",
        "life [h],status\n310,failure\n540,failure\n700,failure\n820,failure\n900,runout\n"
        "900,runout\n");
  const PosteriorSummary result = run(lives);
  ASSERT_TRUE(result.fit->exact);
  const WeightedDraws& nodes = result.fit->exact->nodes;
  const auto failed = [&](double hours) {
    double sum = 0;
    for (Eigen::Index i = 0; i < nodes.values.rows(); ++i)
      sum += nodes.weights[i] *
             -std::expm1(-std::pow(hours * 3600 / nodes.values(i, 0), nodes.values(i, 1)));
    return sum;
  };
  const auto life = ask(lives, result, {.survived = "300 h", .horizon = "100 h"});
  ASSERT_TRUE(life.passed && life.reached);
  EXPECT_NEAR(*life.passed, failed(300), 1e-4 * failed(300));
  const double reached = (failed(400) - failed(300)) / (1 - failed(300));
  EXPECT_NEAR(*life.reached, reached, 1e-4 * reached);
  // Less than the smallest share of any table.
  const auto early = ask(lives, result, {.horizon = "0.1 h"});
  EXPECT_LT(failed(0.1), 5e-5);
  EXPECT_NEAR(*early.reached, failed(0.1), 1e-3 * failed(0.1));
  // The posterior's median of that share is another number.
  for (const QuantitySummary& each : result.quantities) {
    if (each.name != "survival to 300 h") continue;
    EXPECT_GT(std::abs(100 - each.best().q50 - 100 * failed(300)), 0.5);
    EXPECT_NEAR(100 - *each.best().predictive, 100 * failed(300), 1e-2 * failed(300));
  }
}

// The mean life is that of the closed form, and the mean remaining useful life an average over survivors.
TEST_F(LifeAnswers, MeanLivesAreThoseOfClosedForms) {
  write("lives.csv",
        "life [h],status\n310,failure\n540,failure\n700,failure\n820,failure\n900,runout\n"
        "900,runout\n");
  const PosteriorSummary result = run(
      lives +
      std::string("mean_life = true\nsurvived = \"400 h\"\n[predict.quantities]\n"
                  "closed = { value = \"eta * gamma(1 + 1/beta)\", unit = \"h\" }\n"
                  "later = { value = \"weibull_survival(900 [h], eta, beta)\", unit = \"%\" }\n"));
  ASSERT_TRUE(result.fit->exact);
  const WeightedDraws& nodes = result.fit->exact->nodes;
  double left = 0, remaining = 0, mean = 0;
  for (Eigen::Index i = 0; i < nodes.values.rows(); ++i) {
    const double eta = nodes.values(i, 0) / 3600, beta = nodes.values(i, 1);
    const double at = std::pow(400 / eta, beta);
    left += nodes.weights[i] * std::exp(-at);
    // The integral of the survival function beyond 400 h.
    remaining += nodes.weights[i] * eta / beta * boost::math::tgamma(1 / beta, at);
    mean += nodes.weights[i] * eta * std::tgamma(1 + 1 / beta);
  }
  const auto named = [&](const std::string& name) -> const QuantityQuantiles& {
    for (const QuantitySummary& each : result.quantities)
      if (each.name == name) return each.best();
    ADD_FAILURE() << name;
    return result.quantities.front().best();
  };
  for (const auto& [of, as] : {std::pair{"mean life", "closed"}, {"survival to 900 h", "later"}}) {
    EXPECT_NEAR(named(of).q05 / named(as).q05, 1, 1e-7) << of;
    EXPECT_NEAR(named(of).q50 / named(as).q50, 1, 1e-7) << of;
    EXPECT_NEAR(named(of).q95 / named(as).q95, 1, 1e-7) << of;
  }
  EXPECT_NEAR(*named("mean life").predictive / mean, 1, 1e-4);
  EXPECT_NEAR(*named("mean remaining useful life").predictive / (remaining / left), 1, 1e-3);
  EXPECT_LT(*named("mean life").bound, named("mean life").q50);
}

// One pair of keys for all bounds: the ends of the 90 % interval are one-sided bounds at 95 %.
TEST_F(LifeAnswers, LevelAndSidesGovernEveryBound) {
  write("lives.csv",
        "life [h],status\n310,failure\n540,failure\n700,failure\n820,failure\n900,runout\n");
  const std::string asked = lives + std::string("mean_life = true\nb_lives = [10]\n");
  WeightedDraws draws;
  draws.values = Points(61, 2);
  draws.weights = Eigen::VectorXd::Constant(61, 1.0 / 61);
  for (Eigen::Index i = 0; i < 61; ++i)
    draws.values.row(i) << 3600 * (700 + 5.0 * static_cast<double>(i)),
        1.5 + 0.02 * static_cast<double>(i * 7 % 61);
  const auto bounds = [&](const std::string& keys) {
    const PosteriorStudy study = wearwell::read_posterior_study(write("study.toml", asked + keys));
    return study.quantity_groups.front().from_draws(draws);
  };
  const auto lower = bounds("credible_level = 0.95\n"),
             both = bounds("level = \"90 %\"\nsides = \"both\"\n"),
             upper = bounds("level = 0.95\nsides = \"upper\"\n");
  int bounded = 0;
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const QuantityQuantiles &one = lower[i], &two = both[i], &other = upper[i];
    if (!one.bound) continue;
    ++bounded;
    EXPECT_NEAR(*one.bound / one.q05, 1, 1e-12) << i;
    EXPECT_FALSE(one.upper_bound);
    EXPECT_NEAR(*two.bound / two.q05, 1, 1e-12);
    EXPECT_NEAR(*two.upper_bound / two.q95, 1, 1e-12);
    EXPECT_NEAR(*other.upper_bound / other.q95, 1, 1e-12);
    EXPECT_FALSE(other.bound);
  }
  EXPECT_EQ(bounded, 4);  // B10, the mean life, two of survival
  const auto refused = [&](const std::string& keys) {
    try {
      bounds(keys);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refused("level = 0.9\ncredible_level = 0.9\n").find("are the same"), std::string::npos);
  EXPECT_NE(refused("level = 90\n").find("predict.level"), std::string::npos);
  EXPECT_NE(refused("sides = \"left\"\n").find("\"lower\""), std::string::npos);
}

// Two groups of one shape: P(A outlives B) = u/(1 + u), u = (eta_A/eta_B)^beta; B-lives have the ratio of the scales.
TEST_F(LifeAnswers, OneGroupComparedWithAnother) {
  write("lives.csv",
        "life [h],status,maker\n310,failure,new\n540,failure,new\n700,failure,new\n900,runout,new\n"
        "120,failure,old\n260,failure,old\n405,failure,old\n510,failure,old\n");
  std::string text = lives;
  text.replace(text.find("status = \"status\""), 17, "status = \"status\"\nmaker = \"maker\"");
  text.replace(text.find("scale = \"eta\""), 13, "scale = \"eta[maker]\"");
  const PosteriorSummary result = run(
      text +
      "given = { maker = \"new\" }\ncompared_with = { maker = \"old\" }\nb_lives = [10]\n"
      "[predict.quantities]\n"
      "outlives = { value = \"1/(1 + (eta[\\\"old\\\"]/eta[\\\"new\\\"])^beta)\", unit = \"%\" }\n"
      "ratio = \"eta[\\\"new\\\"]/eta[\\\"old\\\"]\"\n"
      "difference = { value = \"weibull_cdf(300 [h], eta[\\\"old\\\"], beta) - "
      "weibull_cdf(300 [h], eta[\\\"new\\\"], beta)\", unit = \"%\" }\n");
  const auto named = [&](const std::string& name) -> const QuantitySummary& {
    for (const QuantitySummary& each : result.quantities)
      if (each.name == name) return each;
    ADD_FAILURE() << name;
    return result.quantities.front();
  };
  for (const auto& [of, as] : {std::pair{"probability to outlive", "outlives"},
                               {"B10 life ratio", "ratio"},
                               {"difference of survival to 300 h", "difference"}}) {
    const QuantityQuantiles &found = named(of).best(), &closed = named(as).best();
    EXPECT_NEAR(found.q05, closed.q05, 1e-6 * std::abs(closed.q05)) << of;
    EXPECT_NEAR(found.q50, closed.q50, 1e-6 * std::abs(closed.q50)) << of;
    EXPECT_NEAR(found.q95, closed.q95, 1e-6 * std::abs(closed.q95)) << of;
    EXPECT_EQ(named(of).at, "maker = new against maker = old");
  }
  // Averaged over the posterior: between the quantiles, and above a half.
  const QuantityQuantiles& p = named("probability to outlive").best();
  EXPECT_GT(*p.predictive, 50);
  EXPECT_LT(*p.predictive, p.q95);
  EXPECT_LT(*p.bound, p.q50);
}

// Loglogistic lives have no mean where the shape is 1 or less.
TEST_F(LifeAnswers, AMeanThatDoesNotExistIsInfinite) {
  write("lives.csv", "life [h],status\n3,failure\n54,failure\n700,failure\n8200,failure\n");
  std::string text = lives;
  text.replace(text.find("weibull"), 7, "loglogistic");
  text.replace(text.find("median = 2"), 10, "median = 0.3");
  const PosteriorSummary result = run(text + "mean_life = true\n");
  for (const QuantitySummary& each : result.quantities) {
    if (each.name != "mean life") continue;
    EXPECT_TRUE(std::isinf(each.best().q95));
    EXPECT_TRUE(std::isinf(*each.best().predictive));
  }
}

// V = k w n with normal errors, k flat and sigma ~ 1/sigma: k is Student's t about least squares with n - 1 degrees
// of freedom (Gelman et al., Bayesian Data Analysis, section 14.2), its life the limit over it.
TEST_F(LifeAnswers, OnePosteriorHasOneLife) {
  const double cycles[] = {100, 1000, 2500, 5000, 7500, 10000};
  const double volumes[] = {2.5, 6.1, 13.9, 24.2, 37.4, 45.3};
  std::string csv = "cycles,volume [mm^3]\n";
  double xx = 0, xy = 0, yy = 0;
  for (int i = 0; i < 6; ++i) {
    csv += std::to_string(cycles[i]) + "," + std::to_string(volumes[i]) + "\n";
    xx += cycles[i] * cycles[i];
    xy += cycles[i] * volumes[i];
    yy += volumes[i] * volumes[i];
  }
  write("wear.csv", csv);
  const std::string prior =
      "[prior]\nk = { distribution = \"flat\", lower = \"0 mm^3/(N m)\" }\nsigma = { distribution "
      "= \"jeffreys\", "
      "unit = "
      "\"mm^3\" }\n";
  const PosteriorSummary joint = run(
      "model = \"archard-joint\"\n[data]\nfile = \"wear.csv\"\n[data.columns]\ncycles = "
      "\"cycles\"\nvolume = \"volume\"\n[conditions]\nwork_per_cycle = \"6 N m\"\n[likelihood]\n"
      "family = \"normal\"\n" +
      prior + "[predict]\nlimit = \"100 mm^3\"\n");
  const PosteriorSummary model =
      run("model = \"formula\"\n[data]\nfile = \"wear.csv\"\n[data.columns]\nn = { column = "
          "\"cycles\", unit = "
          "\"cycles\" }\nV = \"volume\"\n[formula]\nworn = \"k * 6 [N m/cycle] * "
          "n\"\n[likelihood.V]\nfamily = "
          "\"normal\"\nmean = \"worn\"\nsd = \"sigma\"\n" +
          prior + "[predict]\nalong = \"n\"\nlimit = { worn = \"100 mm^3\" }\n");
  ASSERT_TRUE(joint.life && joint.life->exact && !model.quantities.empty() &&
              model.quantities.front().exact);
  const Life& of_joint = *joint.life->exact;
  const QuantityQuantiles& of_law = *model.quantities.front().exact;
  const double slope = xy / xx, error = std::sqrt((yy - xy * slope) / 5 / xx);
  const boost::math::students_t t(5);
  const auto expected = [&](double p) {
    return 100 / (slope + error * boost::math::quantile(t, 1 - p));
  };
  for (const auto& [p, joints, models] : {std::tuple{0.05, of_joint.q05, of_law.q05},
                                          {0.95, of_joint.q95, of_law.q95},
                                          {0.5, of_joint.b50, of_law.b50},
                                          {0.1, of_joint.b10, of_law.b10},
                                          {0.01, of_joint.b1, of_law.b1}}) {
    EXPECT_NEAR(models / joints, 1, 1e-6) << p;
    EXPECT_NEAR(models / expected(p), 1, 1e-4) << p;
  }
  EXPECT_NEAR(joint.mode->log_likelihood, model.mode->log_likelihood, 1e-9);
}

}  // namespace
}  // namespace wearwell
