// Lives in use of units whose use is not always known (use_rate_model.h): rows by hand, gradients, scores, messages.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/models/formula_model/formula_fit_data.h"
#include "wearwell/models/formula_model/formula_life.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/life_groups.h"
#include "wearwell/prob/use_rate.h"

namespace wearwell::formula_model {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string columns_of_use = R"toml(
[data.columns]
km = { column = "km", unit = "km" }
age = { column = "age", unit = "h" }
status = "status"
count = "n"
)toml";
const std::string life_of_use = R"toml(
[likelihood.km]
family = "weibull"
scale = "eta"
shape = "beta"
)toml";
const std::string rate_of_use = R"toml(
[use_rate]
age = "age"
family = "lognormal"
median = "rate"
log_sd = "spread"
)toml";
const std::string priors_of_use = R"toml(
[prior]
eta = { distribution = "lognormal", median = "100 km", log_sd = 1 }
beta = { distribution = "lognormal", median = 1.5, log_sd = 0.5 }
rate = { distribution = "lognormal", median = "2 km/h", log_sd = 1 }
spread = { distribution = "half-normal", scale = 1 }
)toml";
const std::string study_of_use = columns_of_use + life_of_use + rate_of_use + priors_of_use;

// Of known use a failure and a run-out; of unknown use run-outs, a failure, one that failed before its age.
const std::string table_of_use =
    "km,age,status,n\n60,40,failed,1\n20,25,runout,3\n,30,runout,5\n,55,failed,2\n,80,left,1\n";

class UseRateTest : public ScratchTest {
 protected:
  std::shared_ptr<const FormulaModel> model(const std::string& table, const std::string& text) {
    write("d.csv", table);
    const Source source =
        source_of(write("study.toml", "model = \"formula\"\n[data]\nfile = \"d.csv\"\n" + text));
    return read_formula_model(TomlReader::parse(source.study), source);
  }
  std::shared_ptr<const LogDensity> likelihood(const std::string& table, const std::string& text) {
    const auto own = model(table, text);
    return formula_likelihood(std::make_shared<const FormulaRows>(own, own->data.table.rows));
  }
  std::string refusal(const std::string& table, const std::string& text) {
    return message_of<InputError>([&] { model(table, text); });
  }
};

// SI: m, s, m/s.
const std::vector<double> truth = {90e3, 1.7, 2.2e3 / 3600, 0.6};

TEST_F(UseRateTest, RowsByHand) {
  const auto all = likelihood(table_of_use, study_of_use);
  const double life[] = {truth[0], truth[1], 0, 0}, rate[] = {truth[2], truth[3], 0, 0};
  using enum ResponseFamily;
  const auto of_use = [&](Censoring seen, double km) {
    return log_response_value(weibull, {seen, 1e3 * km}, life);
  };
  const auto of_rate = [&](double km_h) {
    return log_response_value(lognormal, {.at = km_h * 1e3 / 3600}, rate);
  };
  const auto of_age = [&](Censoring seen, double h) {
    return log_response({weibull, lognormal, life, rate}, {seen, 3600 * h});
  };
  const double expected = of_use(Censoring::none, 60) + of_rate(60.0 / 40) +
                          3 * (of_use(Censoring::right, 20) + of_rate(20.0 / 25)) +
                          5 * of_age(Censoring::right, 30) + 2 * of_age(Censoring::none, 55) +
                          of_age(Censoring::left, 80);
  EXPECT_NEAR(all->value(truth), expected, 1e-9 * std::abs(expected));
  // By observation: lives in use, rates, ages.
  EXPECT_EQ(all->pointwise(truth).size(), 2U + 2U + 3U);
  EXPECT_EQ(all->pointwise_counts(), (std::vector<int>{1, 3, 1, 3, 5, 2, 1}));
}

TEST_F(UseRateTest, GradientIsThatOfDifferences) {
  const auto all = likelihood(table_of_use, study_of_use);
  std::vector<double> gradient(truth.size());
  all->value_and_gradient(truth, gradient);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    std::vector<double> up = truth, down = truth;
    up[i] *= 1 + 1e-5, down[i] *= 1 - 1e-5;
    const double slope = (all->value(up) - all->value(down)) / (2e-5 * truth[i]);
    EXPECT_NEAR(gradient[i], slope, 1e-5 * (std::abs(slope) + 1 / truth[i])) << i;
  }
}

// Where all uses are known, life and rate are two samples; the study has no third column.
TEST_F(UseRateTest, KnownUsesAreTwoSamples) {
  const std::string table = "km,age,status,n\n60,40,failed,1\n20,25,runout,3\n";
  EXPECT_EQ(model(table, study_of_use)->measured.size(), 2U);
  const double life[] = {truth[0], truth[1], 0, 0};
  using enum ResponseFamily;
  const double of_use = log_response_value(weibull, {.at = 60e3}, life) +
                        3 * log_response_value(weibull, {Censoring::right, 20e3}, life);
  const double rate[] = {truth[2], truth[3], 0, 0};
  const double of_rate = log_response_value(lognormal, {.at = 60e3 / (40 * 3600)}, rate) +
                         3 * log_response_value(lognormal, {.at = 20e3 / (25 * 3600)}, rate);
  EXPECT_NEAR(likelihood(table, study_of_use)->value(truth), of_use + of_rate, 1e-10);
}

// A lognormal life over a lognormal rate is a lognormal age: quantiles, mean, and the failures within a warranty.
TEST_F(UseRateTest, LifeInCalendarTimeOfLognormals) {
  std::string text = columns_of_use + rate_of_use + priors_of_use;
  text += "[likelihood.km]\nfamily = \"lognormal\"\nmedian = \"eta\"\nlog_sd = \"beta\"\n";
  const Source source = [&] {
    write("d.csv", table_of_use);
    return source_of(write("study.toml", "model = \"formula\"\n[data]\nfile = \"d.csv\"\n" + text +
                                             "[predict]\nb_lives = [10]\n"));
  }();
  const TomlReader root = TomlReader::parse(source.study);
  const auto own = read_formula_model(root, source);
  const auto life = life_in_calendar_time(root.required_table("predict"), "", own, {});
  LifeAtPoint at = life->at_point();
  const std::vector<double> x = {90e3, 0.5, 2.2e3 / 3600, 0.6};
  at.move_to(x.data());
  const double middle = x[0] / x[2], sd = std::hypot(0.5, 0.6);
  EXPECT_NEAR(at.quantile(0.5), middle, 1e-8 * middle);
  EXPECT_NEAR(at.quantile(0.0227501319481792), middle * std::exp(-2 * sd), 1e-8 * middle);
  EXPECT_NEAR(at.mean_beyond(0), middle * std::exp(0.5 * sd * sd), 1e-6 * middle);
  // Without an end in time it is the share with a life below the use, and the other way round.
  EXPECT_NEAR(at.failing_within(INFINITY, 90e3), 0.5, 1e-12);
  EXPECT_NEAR(at.failing_within(middle, INFINITY), 0.5, 1e-9);
  // Both, by simulation of 10^6 units: four standard errors.
  Rng rng(20261126, 1);
  const double age = 30 * 3600, use = 60e3;
  int within = 0;
  constexpr int units = 1'000'000;
  for (int i = 0; i < units; ++i) {
    const double u = x[0] * std::exp(0.5 * rng.normal()), r = x[2] * std::exp(0.6 * rng.normal());
    within += u < use && u < r * age;
  }
  const double share = at.failing_within(age, use);
  EXPECT_NEAR(share, static_cast<double>(within) / units,
              4 * std::sqrt(share * (1 - share) / units));
}

// Residuals of all units are standard normal at the truth, although failures alone have a known use.
TEST_F(UseRateTest, ScoresAreStandardNormalAtTheTruth) {
  Rng rng(20261126, 2);
  std::string table = "km,age,status,n\n";
  constexpr int units = 4000;
  for (int i = 0; i < units; ++i) {
    const double life = 90 * std::pow(-std::log(rng.uniform()), 1 / 1.7),
                 rate = 2.2 * std::exp(0.6 * rng.normal()), age = 60 * rng.uniform();
    table += life < rate * age ? fmt::format("{:.9g},{:.9g},failed,1\n", life, life / rate)
                               : fmt::format(",{:.9g},runout,1\n", age);
  }
  const auto own = model(table, study_of_use);
  const auto rows = std::make_shared<const FormulaRows>(own, own->data.table.rows);
  const std::vector<NormalScore> scores = fit_data(rows)->scores(truth.data());
  ASSERT_EQ(scores.size(), 2U * units);
  double sum = 0, squares = 0;
  for (int i = 0; i < units; ++i) {
    const double z = scores[static_cast<std::size_t>(units + i)].low;
    sum += z;
    squares += z * z;
  }
  EXPECT_NEAR(sum / units, 0, 4 / std::sqrt(units));
  EXPECT_NEAR(squares / units, 1, 4 * std::sqrt(2.0 / units));
  // Of the lives: the expected number of failures up to their ends, the cumulative hazard, is the number that failed.
  double hazard = 0, failed = 0;
  for (int i = 0; i < units; ++i) {
    const NormalScore& z = scores[static_cast<std::size_t>(i)];
    hazard -= std::log(0.5 * std::erfc(z.low / std::sqrt(2.0)));
    failed += std::isfinite(z.high);
  }
  EXPECT_NEAR(hazard, failed, 4 * std::sqrt(failed));
}

TEST_F(UseRateTest, Messages) {
  const auto refused = [&](const std::string& table, const std::string& text, const auto& parts) {
    EXPECT_THAT(refusal(table, text), parts);
  };
  refused("km,age,status,n\n60,,failed,1\n", study_of_use,
          AllOf(HasSubstr("d.csv"), HasSubstr("age"), HasSubstr("no value")));
  refused("km,age,status,n\n60,0,failed,1\n", study_of_use,
          AllOf(HasSubstr("d.csv"), HasSubstr("must be positive: the age")));
  refused("km,age,status,n\n,40,failed,1\n,3,runout,1\n", study_of_use,
          HasSubstr("needs units with a known use"));
  const std::string no_age = rate_of_use.substr(0, rate_of_use.find("age =")) +
                             rate_of_use.substr(rate_of_use.find("family"));
  refused(table_of_use, columns_of_use + life_of_use + no_age + priors_of_use,
          AllOf(HasSubstr("use_rate"), HasSubstr("age")));
  std::string other = study_of_use;
  other.replace(other.find("age = \"age\""), 11, "age = \"km\"");
  refused(table_of_use, other, HasSubstr("two numeric columns"));
  other = study_of_use;
  other.replace(other.find("\"lognormal\"\nmedian"), 11, "\"loglogistic\"");
  refused(table_of_use, other, HasSubstr("use_rate"));
  refused(table_of_use,
          study_of_use + "[random_effects.status]\neta = { distribution = \"normal\", sd = 1 }\n",
          HasSubstr("not possible with [use_rate]"));
  other = study_of_use;
  other.replace(other.find("shape = \"beta\""), 14, "shape = \"beta\"\nshare_defective = 0.5");
  refused(table_of_use, other, AllOf(HasSubstr("share_defective"), HasSubstr("[use_rate]")));
}

}  // namespace
}  // namespace wearwell::formula_model
