// Step-stress tests (step_stress.h): the likelihood against cumulative exposure by hand, identities, messages.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/exposure_lives.h"
#include "wearwell/models/formula_model/formula_fit_data.h"
#include "wearwell/models/formula_model/formula_life.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/life_groups.h"

namespace wearwell::formula_model {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string columns_of_steps =
    "[data.columns]\nlife = { column = \"h\", unit = \"h\" }\nvoltage = { column = "
    "\"kV\", unit = "
    "\"kV\" }\nspecimen = \"specimen\"\nstatus = \"status\"\n";
const std::string weibull_by_voltage =
    "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta * inverse_power(voltage, 10 [kV], "
    "n)\"\nshape = \"beta\"\n";
const std::string priors_of_steps =
    "[prior]\neta = { distribution = \"lognormal\", median = \"900 h\", log_sd = 1 }\nn = { "
    "distribution = \"normal\", mean = 8, sd = 3 }\nbeta = { distribution = \"lognormal\", median "
    "= "
    "1.5, log_sd = 0.7 }\n";
const std::string by_specimen = "steps = \"specimen\"\n";

// Rows out of order: A fails in its third step, B in its first, C survives, D fails by 30 h of its second.
const std::string table_of_steps =
    "h,kV,specimen,status,lower,upper\n"
    "25.5,14,A,failed,,\n10,10,A,runout,,\n20,12,A,runout,,\n4.5,10,B,failed,,\n"
    "10,10,C,runout,,\n31,12,C,runout,,\n"
    "12,11,D,runout,,\n40,13,D,interval,20,40\n";

class StepStressTest : public ScratchTest {
 protected:
  std::shared_ptr<const FormulaModel> model(const std::string& data, const std::string& text) {
    write("d.csv", data);
    const Source source =
        source_of(write("study.toml", "model = \"formula\"\n[data]\nfile = \"d.csv\"\n" + text));
    return read_formula_model(TomlReader::parse(source.study), source);
  }
  double log_likelihood(const std::string& data, const std::string& text,
                        const std::vector<double>& x, std::vector<double>* gradient = nullptr) {
    const auto own = model(data, text);
    const auto all =
        formula_likelihood(std::make_shared<const FormulaRows>(own, own->data.table.rows));
    if (!gradient) return all->value(x);
    gradient->assign(x.size(), 0);
    return all->value_and_gradient(x, *gradient);
  }
  std::string refusal(const std::string& data, const std::string& text) {
    return message_of<InputError>([&] { model(data, text); });
  }
};

const std::string with_interval = [] {
  std::string text = columns_of_steps;
  return text +
         "lower = { column = \"lower\", unit = \"h\" }\nupper = { column = \"upper\", unit = \"h\" "
         "}\n" +
         weibull_by_voltage + by_specimen + priors_of_steps;
}();

// In hours: the share of life used up by duration t at voltage v is t / (eta (v/10)^-n).
double by_hand(double eta, double n, double beta) {
  const auto scale = [&](double v) { return eta * std::pow(v / 10, -n); };
  const auto log_density = [&](double w, double v) {
    return std::log(beta) + (beta - 1) * std::log(w) - std::pow(w, beta) - std::log(scale(v));
  };
  const double a = 10 / scale(10) + 10 / scale(12) + 5.5 / scale(14);
  const double c = 10 / scale(10) + 21 / scale(12);
  const double before = 12 / scale(11) + 8 / scale(13), after = 12 / scale(11) + 28 / scale(13);
  return log_density(a, 14) + log_density(4.5 / scale(10), 10) - std::pow(c, beta) +
         std::log(std::exp(-std::pow(before, beta)) - std::exp(-std::pow(after, beta)));
}

TEST_F(StepStressTest, LikelihoodIsThatOfCumulativeExposure) {
  for (const auto& [eta, n, beta] :
       {std::tuple{100.0, 5.0, 1.7}, std::tuple{40.0, 8.0, 0.8}, std::tuple{1000.0, 12.0, 3.0}}) {
    // Densities per second.
    const double expected = by_hand(eta, n, beta) - 2 * std::log(3600.0);
    EXPECT_NEAR(log_likelihood(table_of_steps, with_interval, {3600 * eta, n, beta}), expected,
                1e-10 * std::abs(expected));
  }
}

// Equivalent ages use up the same share of life at the stress in the middle of those at failure (10, 13 and 14 kV).
TEST_F(StepStressTest, EquivalentAgesAreThoseOfOneStress) {
  const auto own = model(table_of_steps, with_interval);
  const auto reference = exposure_reference(*own);
  ASSERT_TRUE(reference);
  EXPECT_EQ(reference->conditions.words, "voltage = 13 kV");
  const FormulaRows rows(own, own->data.table.rows);
  const double eta = 100, n = 5;
  const std::vector<double> x = {3600 * eta, n, 1.7};
  const std::vector<Response> lives = exposure_lives(rows, *reference, x.data());
  const auto hours = [&](double share) { return share * std::pow(13 / 10., -n) * eta; };
  const auto used = [&](double h, double kv) { return h / (eta * std::pow(kv / 10, -n)); };
  std::vector<double> at, until;
  for (const Response& each : lives) {
    at.push_back(each.at / 3600);
    if (each.seen == Censoring::interval) until.push_back(each.until / 3600);
  }
  const auto near = [](double h) { return ::testing::DoubleNear(h, 1e-9 * h); };
  EXPECT_THAT(
      at, ::testing::UnorderedElementsAre(
              near(hours(used(10, 10) + used(10, 12) + used(5.5, 14))), near(hours(used(4.5, 10))),
              near(hours(used(10, 10) + used(21, 12))), near(hours(used(12, 11) + used(8, 13)))));
  EXPECT_THAT(until, ::testing::ElementsAre(near(hours(used(12, 11) + used(28, 13)))));
}

TEST_F(StepStressTest, GradientIsThatOfDifferences) {
  const std::vector<double> x = {3600 * 100.0, 5, 1.7};
  std::vector<double> gradient;
  log_likelihood(table_of_steps, with_interval, x, &gradient);
  for (std::size_t i = 0; i < x.size(); ++i) {
    std::vector<double> up = x, down = x;
    const double step = 1e-5 * x[i];
    up[i] += step, down[i] -= step;
    const double slope = (log_likelihood(table_of_steps, with_interval, up) -
                          log_likelihood(table_of_steps, with_interval, down)) /
                         (2 * step);
    EXPECT_NEAR(gradient[i], slope, 1e-6 * std::abs(slope)) << i;
  }
}

// Steps at one stress are one life, for every family with a scale.
TEST_F(StepStressTest, EqualStepsAreOneLife) {
  const std::string steps =
      "h,kV,specimen,status\n3,12,A,runout\n7,12,A,runout\n25.5,12,A,failed\n4,14,B,runout\n9,14,B,"
      "runout\n";
  const std::string whole = "h,kV,specimen,status\n25.5,12,A,failed\n9,14,B,runout\n";
  const std::string scale = "\"eta * inverse_power(voltage, 10 [kV], n)\"\n";
  const std::pair<const char*, const char*> families[] = {
      {"weibull", "scale = SCALE shape = \"beta\"\n"},
      {"lognormal", "median = SCALE log_sd = \"beta\"\n"},
      {"loglogistic", "scale = SCALE shape = \"beta\"\n"},
      {"gamma", "scale = SCALE shape = \"beta\"\n"},
      {"birnbaum-saunders", "scale = SCALE shape = \"beta\"\n"},
      {"exponentiated-weibull", "scale = SCALE shape = \"beta\"\nexponent = 1.4\n"},
      {"generalized-gamma", "scale = SCALE sigma = \"beta\"\nlambda = 0.4\n"}};
  for (const auto& [family, parameters] : families) {
    std::string text = parameters;
    text.replace(text.find("SCALE "), 6, scale);
    const std::string plain =
        columns_of_steps + "[likelihood.life]\nfamily = \"" + family + "\"\n" + text;
    const std::vector<double> x = {3600 * 60.0, 4, 1.3};
    const double expected = log_likelihood(whole, plain + priors_of_steps, x);
    EXPECT_NEAR(log_likelihood(steps, plain + by_specimen + priors_of_steps, x), expected,
                1e-10 * std::abs(expected))
        << family;
  }
}

// Short steps of a ramp against the Weibull distribution of lives under it.
TEST_F(StepStressTest, ShortStepsAreARamp) {
  const double rate = 0.5, end = 24.3;  // kV/h, h
  constexpr int steps = 2000;
  std::string ramp = "h,kV,specimen,status\n";
  for (int i = 1; i <= steps; ++i)
    ramp += fmt::format("{:.12g},{:.12g},A,{}\n", end * i / steps, rate * end * (i - 0.5) / steps,
                        i == steps ? "failed" : "runout");
  const std::string once = fmt::format("h,rate,status\n{},{},failed\n", end, rate);
  const std::string by_ramp =
      "[data.columns]\nlife = { column = \"h\", unit = \"h\" }\nrate = { column = \"rate\", unit = "
      "\"kV/h\" }\nstatus = \"status\"\n[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta * "
      "((n + 1) * (10 [kV]/(rate*eta))^n)^(1/(n + 1))\"\nshape = \"beta*(n + 1)\"\n";
  const std::vector<double> x = {3600 * 60.0, 5, 1.7};
  EXPECT_NEAR(log_likelihood(
                  ramp, columns_of_steps + weibull_by_voltage + by_specimen + priors_of_steps, x),
              log_likelihood(once, by_ramp + priors_of_steps, x), 2e-3);
}

// A new item has used up nothing.
TEST_F(StepStressTest, LivesBeginAtZero) {
  const std::string text = with_interval + "[predict]\ngiven = { voltage = \"10 kV\" }\n";
  const auto own = model(table_of_steps, text);
  const TomlReader root = TomlReader::parse(source_of(folder() / "study.toml").study);
  Conditions given;
  given.numbers["voltage"] = 1e4;
  const auto life = life_distribution(root.required_table("predict"), "given", own, given, ~0U);
  WeightedDraws draws;
  draws.values.resize(1, 3);
  draws.values << 3600 * 100.0, 5, 1.7;
  draws.weights = Eigen::VectorXd::Ones(1);
  const double expected = 3600 * 100 * std::pow(-std::log(0.9), 1 / 1.7);
  EXPECT_NEAR(life->next(draws).quantile(0.1), expected, 1e-6 * expected);
}

// Weak specimens fail at low stress; that is no misfit.
TEST_F(StepStressTest, StressAtFailureIsNoDriver) {
  const auto own = model(table_of_steps, with_interval);
  const auto checked = fit_data(std::make_shared<const FormulaRows>(own, own->data.table.rows));
  ASSERT_TRUE(checked);
  EXPECT_TRUE(checked->drivers.empty());
  EXPECT_TRUE(checked->labels.empty());
}

TEST_F(StepStressTest, RefusesRowsThatAreNoSteps) {
  const std::string study = columns_of_steps + weibull_by_voltage + by_specimen + priors_of_steps;
  const std::string head = "h,kV,specimen,status\n";
  EXPECT_THAT(refusal(head + "10,10,A,failed\n20,12,A,failed\n", study),
              AllOf(HasSubstr("row 1, column 'h'"), HasSubstr("the specimen has a later step")));
  EXPECT_THAT(
      refusal(head + "10,10,A,runout\n10,12,A,failed\n", study),
      AllOf(HasSubstr("row 2"), HasSubstr("10 h must be greater than the end of the step")));
  EXPECT_THAT(refusal(head + ",10,A,runout\n10,12,A,failed\n", study), HasSubstr("row 1"));
  const std::string one = head + "10,10,A,runout\n20,12,A,failed\n";
  EXPECT_THAT(refusal(one, columns_of_steps + weibull_by_voltage + "steps = \"machine\"\n" +
                               priors_of_steps),
              HasSubstr("steps: must name the column of the specimens"));
  EXPECT_THAT(
      refusal(one, columns_of_steps +
                       "[likelihood.life]\nfamily = \"normal\"\nmean = \"eta\"\nsd = \"eta\"\n" +
                       by_specimen + priors_of_steps),
      HasSubstr("normal has none"));
  EXPECT_THAT(refusal(one, columns_of_steps + weibull_by_voltage + by_specimen +
                               "threshold = \"eta/100\"\n" + priors_of_steps),
              HasSubstr("threshold"));
  EXPECT_THAT(refusal("h,kV,specimen,status,lower,upper\n10,10,A,runout,,\n20,12,A,interval,5,20\n",
                      with_interval),
              HasSubstr("begins before the last step"));
}

// A shape that changes between the steps has no equivalent age: refused as in a ramp. One that differs between
// specimens has.
TEST_F(StepStressTest, OnlyTheScaleChangesBetweenSteps) {
  const std::string head = "h,kV,mm,specimen,status,oven\n";
  const std::string rows = head + "10,10,1,A,runout,x\n20,12,1,A,failed,y\n15,10,2,B,failed,x\n";
  const std::string columns =
      columns_of_steps + "thickness = { column = \"mm\", unit = \"mm\" }\noven = \"oven\"\n";
  const auto shaped = [&](const std::string& shape) {
    return columns +
           "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta * inverse_power(voltage, 10 "
           "[kV], n)\"\nshape = \"" +
           shape + "\"\n" + by_specimen + priors_of_steps;
  };
  EXPECT_THAT(refusal(rows, shaped("beta * voltage/10 [kV]")),
              AllOf(HasSubstr("steps"), HasSubstr("shape depends on 'voltage'; cumulative exposure "
                                                  "needs a distribution of which only the scale "
                                                  "does")));
  EXPECT_THAT(refusal(rows, shaped("beta[oven]")), HasSubstr("shape depends on 'oven'"));
  EXPECT_NO_THROW(model(rows, shaped("beta * thickness/1 [mm]")));
}

}  // namespace
}  // namespace wearwell::formula_model
