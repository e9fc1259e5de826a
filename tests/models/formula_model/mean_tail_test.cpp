// How much of a mean comes from the upper tail: closed forms, sums over the nodes of the quadrature, and what a reader gets.
#include "wearwell/study/mean_tail.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "models/formula_model/formula_models.h"
#include "support/scratch.h"
#include "wearwell/present/plain.h"
#include "wearwell/study/posterior_result.h"
#include "wearwell/study/run_study.h"
#include "wearwell/study/terminal.h"

namespace wearwell {
namespace {

using testing::HasSubstr;
using testing::Not;

double normal_cdf_of(double z) {
  return boost::math::cdf(boost::math::normal(), z);
}

// Points at equal steps of the normal score, out to 8, weighted by its density.
WeightedDraws normal_scores() {
  constexpr int n = 32'001;
  WeightedDraws scores;
  scores.values = Points::Zero(n, 1);
  scores.weights = Eigen::VectorXd::Zero(n);
  for (int i = 0; i < n; ++i) {
    const double z = -8 + 16.0 * i / (n - 1);
    scores.values(i, 0) = z;
    scores.weights[i] = std::exp(-0.5 * z * z);
  }
  scores.weights /= scores.weights.sum();
  return scores;
}

TEST(ShareOfHighest, OfDistributionsWithClosedForms) {
  const WeightedDraws scores = normal_scores();
  const auto share = [&](auto value) {
    return share_of_highest(QuantityDistribution(scores, value)).value();
  };
  const double z99 = 2.3263478740408408;
  for (const double s : {0.01, 0.5, 1.5, 2.5})  // lognormal
    EXPECT_NEAR(share([s](const double* z) { return std::exp(s * z[0]); }), normal_cdf_of(s - z99),
                2e-3)
        << s;
  // The limit is that of a standard deviation of the logarithm of 1.5.
  EXPECT_NEAR(most_of_highest, normal_cdf_of(1.5 - z99), 0.01);
  EXPECT_NEAR(most_of_finite, normal_cdf_of(2.3 - z99), 0.02);
  const auto above = [](const double* z) { return normal_cdf_of(-z[0]); };
  EXPECT_NEAR(share([&](const double* z) { return 1 - above(z); }), 0.01 * (2 - 0.01), 1e-4);
  EXPECT_NEAR(share([&](const double* z) { return -std::log(above(z)); }),
              0.01 * (1 + std::log(100)), 2e-4);  // exponential
  EXPECT_NEAR(share([&](const double* z) { return std::pow(above(z), -0.5); }), 0.1,
              1e-3);  // Pareto
  // Of both signs: of |z| beyond its 99 % quantile.
  EXPECT_NEAR(share([](const double* z) { return z[0]; }), std::exp(-0.5 * 2.5758293 * 2.5758293),
              1e-4);
  EXPECT_EQ(share([](const double* z) { return z[0] > 7 ? INFINITY : 1.0; }), 1);
  EXPECT_FALSE(share_of_highest(QuantityDistribution(scores, [](const double*) { return 0.0; })));
}

TEST(ShareOfHighest, OfCells) {
  CellMixture exponential, endless;
  const int n = 20'000;
  for (int i = 0; i + 1 < n; ++i)
    exponential.add(1.0 / n, -std::log1p(-i / double{n}), -std::log1p(-(i + 1) / double{n}));
  EXPECT_NEAR(share_of_highest(exponential), 0.01 * (1 + std::log(100)), 5e-4);
  endless.add(0.5, 1, 2);
  endless.add(0.5, INFINITY, INFINITY);
  EXPECT_EQ(share_of_highest(endless), 1);
}

class MeanTailTest : public ScratchTest {
 protected:
  PosteriorSummary run(const std::string& text) const {
    const auto study = read_study(source_of(write("study.toml", text)), formula_models());
    return run_study(dynamic_cast<const PosteriorStudy&>(*study), {Method::exact, 1, {}, 50, {}},
                     {}, true);
  }
  static const QuantityQuantiles& named(const PosteriorSummary& result, const std::string& name) {
    for (const QuantitySummary& each : result.quantities)
      if (each.name == name) return each.best();
    ADD_FAILURE() << name;
    return result.quantities.front().best();
  }
  static Check check_of(const PosteriorSummary& result) {
    for (const Check& each : result.checks)
      if (each.name == "mean-life") return each;
    return {};
  }
};

std::string weibull_study(const std::string& predict, const std::string& slope = "1.5") {
  return R"toml(
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
beta = { distribution = "lognormal", median = )toml" +
         slope + ", log_sd = 0.5 }\n[predict]\n" + predict;
}

constexpr const char* six_lives =
    "life [h],status\n310,failure\n540,failure\n700,failure\n820,failure\n900,runout\n900,runout\n";

TEST_F(MeanTailTest, ShareBeyondTheLongestLifeIsThatOfTheNodes) {
  write("lives.csv", six_lives);
  const PosteriorSummary result = run(weibull_study("mean_life = true\nsurvived = \"400 h\"\n"));
  ASSERT_TRUE(result.fit->exact);
  const WeightedDraws& nodes = result.fit->exact->nodes;
  double beyond = 0, beyond_of_survivors = 0, left = 0;
  for (Eigen::Index i = 0; i < nodes.values.rows(); ++i) {
    const double eta = nodes.values(i, 0) / 3600, beta = nodes.values(i, 1), w = nodes.weights[i];
    const auto hazard = [&](double t) { return std::pow(t / eta, beta); };
    const auto rest = [&](double t) {  // the integral of the survival function beyond t
      return eta / beta * boost::math::tgamma(1 / beta, hazard(t));
    };
    beyond += w * boost::math::gamma_q(1 + 1 / beta, hazard(900));
    const double survive = std::exp(-hazard(400));
    left += w * survive;
    if (survive > 1e-12)
      beyond_of_survivors += w * survive * (std::exp(-hazard(900)) * 500 + rest(900)) / rest(400);
  }
  const auto& mean = named(result, "mean life").mean_tail;
  ASSERT_TRUE(mean && mean->beyond);
  EXPECT_NEAR(*mean->longest, 900, 1e-9);
  EXPECT_NEAR(*mean->beyond, beyond, 5e-3);
  const auto& remaining = named(result, "mean remaining useful life").mean_tail;
  ASSERT_TRUE(remaining && remaining->beyond);
  EXPECT_NEAR(*remaining->beyond, beyond_of_survivors / left, 5e-3);
}

// A slope near 0.3 and few failures: the average is one of few points of the posterior. Terminal, page and JSON say so, and
// give no number for it; quantiles stay.
TEST_F(MeanTailTest, AMeanOfTheTailIsNotFinite) {
  write("lives.csv",
        "life [h],status\n0.2,failure\n9,failure\n700,failure\n1000,runout\n1000,runout\n"
        "1000,runout\n");
  const PosteriorSummary result = run(weibull_study("mean_life = true\n", "0.4"));
  const MeanTail tail = named(result, "mean life").mean_tail.value();
  EXPECT_GT(*tail.beyond, 0.9);
  EXPECT_GT(tail.highest, most_of_finite);
  const QuantityQuantiles& mean = named(result, "mean life");
  EXPECT_EQ(mean.predictive, INFINITY);
  EXPECT_TRUE(std::isfinite(mean.q50) && std::isfinite(mean.q95) && std::isfinite(*mean.bound));
  EXPECT_EQ(check_of(result).verdict, Verdict::warn);
  const std::string
      beyond = " of the mean life of unit comes from lives beyond 1000 h, as far as the",
      highest =
          "The posterior mean of the mean life of unit is not finite: the highest 1 % of "
          "the posterior carries ";
  EXPECT_THAT(check_of(result).detail, HasSubstr(beyond));
  const std::vector<std::string> remarks = mean_tail_remarks(result.quantities, true);
  ASSERT_EQ(remarks.size(), 2u);
  EXPECT_THAT(remarks[0], HasSubstr(beyond + " data reach. This mean rests on"));
  EXPECT_THAT(remarks[1], HasSubstr(highest));
  const auto one_line = [](std::string text) {
    std::string out;
    for (const char each : text) {
      const bool space = each == ' ' || each == '\n';
      if (!space || (!out.empty() && out.back() != ' ')) out += space ? ' ' : each;
    }
    return out;
  };
  const std::string terminal = one_line(terminal_summary(result, {}));
  EXPECT_THAT(terminal, HasSubstr("mean life of unit comes from"));
  EXPECT_THAT(terminal, HasSubstr(fmt::format("{} not finite", plain_number(mean.q95))));
  const Result shown = posterior_result(result);
  EXPECT_THAT(report_html(shown.header, shown.sections), HasSubstr("mean life of unit comes from"));
  const auto json = summary_json(shown);
  const auto& quantities = json.at("quantities");
  const auto found = std::find_if(quantities.begin(), quantities.end(),
                                  [](const auto& q) { return q.at("name") == "mean life"; });
  ASSERT_NE(found, quantities.end());
  EXPECT_EQ(found->at("mean_tail").at("highest"), tail.highest);
  EXPECT_EQ(found->at("predictive").dump(), "null");
  EXPECT_EQ(found->at("q50"), mean.q50);
  EXPECT_THAT(found->at("mean_tail").at("not_finite").get<std::string>(),
              HasSubstr("the highest 1 % of the posterior carries"));
  EXPECT_EQ(found->at("mean_tail").at("observed_to"), 1000);
  EXPECT_EQ(found->at("mean_tail").at("beyond"), *tail.beyond);
  EXPECT_TRUE(found->at("draws").contains("mean_tail"));
}

// Of wear that slows down some machines never reach the threshold: their mean life is not finite, and the reason is beside it.
TEST_F(MeanTailTest, AThresholdThatSomeNeverReach) {
  std::string rows = "wear [mm],time [h],machine\n";
  for (int machine = 0; machine < 6; ++machine) {
    const double last = 0.6 + 0.12 * machine;
    for (const double t : {50, 150, 400, 900})
      rows += fmt::format("{:.4f},{},m{}\n",
                          last * (1 - std::exp(-t / 300.0)) + 0.004 * std::sin(t + machine), t,
                          machine);
  }
  write("wear.csv", rows);
  const PosteriorSummary result = run(R"toml(
model = "formula"
[data]
file = "wear.csv"
[data.columns]
wear = "wear"
time = "time"
machine = "machine"
[likelihood.wear]
family = "normal"
mean = "last * (1 - exp(-time / pace))"
sd = "sigma"
[prior]
last = { distribution = "lognormal", median = "0.8 mm", log_sd = 0.5 }
pace = { distribution = "lognormal", median = "300 h", log_sd = 0.3 }
scatter = { distribution = "half-normal", scale = 0.3 }
sigma = { distribution = "half-normal", scale = "0.02 mm" }
[random_effects.machine]
last = { distribution = "lognormal", log_sd = "scatter" }
[formula]
path = "last * (1 - exp(-time / pace))"
[predict]
along = "time"
limit = { path = "0.9 mm" }
lives_of = []
mean_life = true
)toml");
  const QuantityQuantiles& mean = named(result, "mean life");
  EXPECT_EQ(mean.predictive, INFINITY);
  ASSERT_TRUE(mean.mean_tail);
  EXPECT_THAT(reason_of_endless_mean(mean), HasSubstr("never reach the threshold"));
  const std::vector<std::string> remarks = mean_tail_remarks(result.quantities, true);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_THAT(remarks[0], HasSubstr("is not finite: at a part of the posterior it is infinite"));
  EXPECT_THAT(check_of(result).detail, HasSubstr("not finite"));
  const std::string terminal = terminal_summary(result, {});
  EXPECT_THAT(terminal, HasSubstr("not finite"));
  EXPECT_THAT(terminal, Not(testing::ContainsRegex(" inf[ \n]")));
}

// Where all have failed and the slope is well above 1, nothing is said.
TEST_F(MeanTailTest, AMeanOfTheDataIsNot) {
  std::string rows = "life [h],status\n";
  for (int i = 0; i < 40; ++i)
    rows += fmt::format("{:.6g},failure\n", 1000 * std::sqrt(-std::log1p(-(i + 0.5) / 40)));
  write("lives.csv", rows);
  const PosteriorSummary result = run(weibull_study("mean_life = true\n"));
  EXPECT_LT(*named(result, "mean life").mean_tail->beyond, 0.05);
  EXPECT_LT(named(result, "mean life").mean_tail->highest, 0.02);
  EXPECT_TRUE(mean_tail_remarks(result.quantities, true).empty());
  EXPECT_EQ(check_of(result).verdict, Verdict::pass);
  EXPECT_THAT(check_of(result).detail,
              HasSubstr("of a mean life comes from lives beyond the data"));
  EXPECT_THAT(terminal_summary(result, {}), Not(HasSubstr("Read the quantiles")));
}

// Lognormal lives under a stress: the life that corresponds to one under another stress is in proportion to the medians.
TEST_F(MeanTailTest, DataReachToCorrespondingLivesUnderOtherConditions) {
  write("lives.csv",
        "life [h],load,status\n100,2,failure\n180,2,failure\n300,2,runout\n400,1,failure\n"
        "700,1,failure\n1000,1,runout\n");
  const PosteriorSummary result = run(R"toml(
model = "formula"
[data]
file = "lives.csv"
[data.columns]
life = "life"
load = "load"
status = "status"
[formula]
middle = "c * load^-n"
[likelihood.life]
family = "lognormal"
median = "middle"
log_sd = "s"
[prior]
c = { distribution = "lognormal", median = "700 h", log_sd = 1 }
n = { distribution = "normal", mean = 2, sd = 0.5 }
s = { distribution = "half-normal", scale = 1 }
[predict]
given = { load = 0.5 }
mean_life = true
)toml");
  ASSERT_TRUE(result.fit->exact);
  const WeightedDraws& nodes = result.fit->exact->nodes;
  const double n = (nodes.weights.transpose() * nodes.values)[1];
  const MeanTail tail = named(result, "mean life").mean_tail.value();
  EXPECT_NEAR(*tail.longest, std::max(300 * std::pow(4, n), 1000 * std::pow(2, n)), 1e-3);
  double beyond = 0;
  for (Eigen::Index i = 0; i < nodes.values.rows(); ++i) {
    const double s = nodes.values(i, 2),
                 median = nodes.values(i, 0) / 3600 * std::pow(2, nodes.values(i, 1));
    beyond += nodes.weights[i] * normal_cdf_of(s - std::log(*tail.longest / median) / s);
  }
  EXPECT_NEAR(*tail.beyond, beyond, 5e-3);
}

TEST_F(MeanTailTest, MeansOfDerivedQuantities) {
  write("lives.csv", six_lives);
  const PosteriorSummary result = run(weibull_study(
      "[predict.quantities]\n"
      "scale = { value = \"eta\", unit = \"h\" }\n"
      "wild = { value = \"eta * exp(8 * beta)\", unit = \"h\" }\n"
      "late = { value = \"weibull_survival(90000 [h], eta, beta)\", unit = \"%\" }\n"));
  EXPECT_LT(named(result, "scale").mean_tail->highest, 0.1);
  EXPECT_GT(named(result, "wild").mean_tail->highest, most_of_highest);
  EXPECT_FALSE(named(result, "late").mean_tail);
  const std::vector<std::string> remarks = mean_tail_remarks(result.quantities, false);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_THAT(remarks[0], HasSubstr("posterior mean of wild"));
  EXPECT_EQ(check_of(result).verdict, Verdict::warn);
}

// Hours, as the lives are; and an indicator has a probability but no quantiles.
TEST_F(MeanTailTest, QuantitiesWithoutAUnitAndIndicators) {
  write("lives.csv", six_lives);
  const PosteriorSummary result =
      run(weibull_study("[predict.quantities]\n"
                        "scale = \"eta\"\n"
                        "square = \"eta^2\"\n"
                        "wears_out = \"where(beta > 1.5, 1, 0)\"\n"));
  const auto unit = [&](const std::string& name) {
    for (const QuantitySummary& each : result.quantities)
      if (each.name == name) return each.unit;
    return std::string("none");
  };
  EXPECT_EQ(unit("scale"), "h");
  EXPECT_NE(unit("square"), "h");
  EXPECT_GT(named(result, "scale").q50, 100);
  EXPECT_LT(named(result, "scale").q50, 10'000);
  const WeightedDraws& nodes = result.fit->exact->nodes;
  double above = 0;
  for (Eigen::Index i = 0; i < nodes.values.rows(); ++i)
    above += nodes.values(i, 1) > 1.5 ? nodes.weights[i] : 0;
  const QuantityQuantiles& indicator = named(result, "wears_out");
  EXPECT_TRUE(std::isnan(indicator.q05) && std::isnan(indicator.q50) && std::isnan(indicator.q95));
  EXPECT_NEAR(indicator.mean.value(), above, 0.01);
  EXPECT_NEAR(named(result, "scale").mean.value() * 3600, nodes.weights.dot(nodes.values.col(0)),
              5e3);
}

}  // namespace
}  // namespace wearwell
