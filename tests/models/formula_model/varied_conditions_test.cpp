// Conditions of use that differ between units (varied_conditions.h): lives against closed forms, integrals in R, limits and
// brute force, all at single points of the parameters; and messages.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "support/golden.h"
#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/life_groups.h"
#include "wearwell/prognosis/named_life.h"

namespace wearwell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double hour = 3600;

class VariedConditions : public ScratchTest {
 protected:
  PosteriorStudy study(const std::string& likelihood, const std::string& predict) {
    return read_posterior_study(file(likelihood, predict));
  }
  // The life under predict.given.
  std::shared_ptr<const formula_model::LifeDistribution> given_life(const std::string& likelihood,
                                                                    const std::string& predict) {
    const Source source = source_of(file(likelihood, predict));
    const TomlReader root = TomlReader::parse(source.study);
    const auto model = formula_model::read_formula_model(root, source);
    const TomlReader asked = root.required_table("predict");
    return formula_model::life_distribution(
        asked, "given", model,
        formula_model::common_conditions(
            *model, formula_model::read_conditions(asked.required_table("given"), *model)));
  }
  std::filesystem::path file(const std::string& likelihood, const std::string& predict) {
    write("lives.csv",
          "life [h],temperature [degC],voltage [V],site,mode\n900,80,500,a,x\n1500,60,400,b,y\n"
          "4000,40,600,a,x\n300,90,800,b,y\n2000,20,300,a,x\n");
    return write(
        "study.toml",
        "model = \"formula\"\n[data]\nfile = \"lives.csv\"\n[data.columns]\nlife = \"life\"\n"
        "temperature = \"temperature\"\nvoltage = \"voltage\"\nsite = \"site\"\n" +
            likelihood +
            "\n[prior]\nlife_40 = { distribution = \"lognormal\", median = \"2e4 h\", log_sd = 1 "
            "}\n"
            "energy = { distribution = \"normal\", mean = \"0.7 eV\", sd = \"0.1 eV\" }\n"
            "shape = { distribution = \"lognormal\", median = 2, log_sd = 0.5 }\n[predict]\n"
            "b_lives = [1, 10]\nmean_life = true\nsurvived = \"500 h\"\n"
            "survival_to = [\"2000 h\", \"15000 h\", \"40000 h\"]\nhazard_at = \"15000 h\"\n" +
            predict);
  }
  std::string refusal(const std::string& likelihood, const std::string& predict) {
    try {
      study(likelihood, predict);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
};

// Parameters: life_40, energy, shape.
const std::vector<double> point = {2e4 * hour, to_si(read_unit("eV", "J"), 0.7), 1.5};

const std::string weibull_by_use =
    "[likelihood.life]\nfamily = \"weibull\"\nshape = \"shape\"\n"
    "scale = \"life_40 * exp(energy/(8.617333262e-5 [eV/K]) * (1/temperature - 1/(313.15 [K]))) * "
    "(voltage/(400 [V]))^-4\"\n";
// Linear in the temperature: 0.1 per kelvin at shape 1.
const std::string lognormal_by_use =
    "[likelihood.life]\nfamily = \"lognormal\"\nmedian = \"life_40 * exp(-energy/(7 [eV*K]) * "
    "(temperature - 313.15 [K]))\"\nlog_sd = \"shape\"\n";

// The answers at one point of the parameters, by name.
std::map<std::string, double> answers_at(const PosteriorStudy& study, std::vector<double> x) {
  WeightedDraws one;
  one.values = Eigen::Map<const Points>(x.data(), 1, static_cast<Eigen::Index>(x.size()));
  one.weights = Eigen::VectorXd::Ones(1);
  std::map<std::string, double> found;
  for (const QuantityGroup& group : study.quantity_groups) {
    const auto values = group.from_draws(one);
    for (std::size_t i = 0; i < values.size(); ++i)
      found.emplace(group.requests[i].name, values[i].q50);
  }
  return found;
}

LifeDistribution life_at(const PosteriorStudy& study, const std::vector<double>& x) {
  return prognosis::distribution_at(prognosis::named_lives(study).front(), x);
}

std::vector<double> with_shape(double shape) {
  std::vector<double> x = point;
  x[2] = shape;
  return x;
}

std::string at_voltage(const std::string& temperature) {
  return fmt::format("given = {{ temperature = {}, voltage = \"400 V\" }}\n", temperature);
}
const std::string about_90 = "{ distribution = \"normal\", mean = \"90 degC\", sd = \"5 K\" }";
const std::string about_40 = "{ distribution = \"normal\", mean = \"40 degC\", sd = \"5 K\" }";

// log life is normal about a line in a normal condition: lognormal with sigma^2 + slope^2 sd^2. From lives that scatter more than
// the conditions to lives that scatter thirty times less.
TEST_F(VariedConditions, LognormalLivesHaveTheClosedForm) {
  const PosteriorStudy read = study(lognormal_by_use, at_voltage(about_40));
  const double slope = 0.1 * 5;
  for (const double sigma : {1.0, 0.3, 0.1, 0.0167}) {
    const double whole = std::hypot(sigma, slope);
    const std::vector<double> x = with_shape(sigma);
    const LifeDistribution life = life_at(read, x);
    for (const double z : {-3.0, -1.0, 0.0, 0.5, 2.0}) {
      const double at = point[0] * std::exp(whole * z);
      EXPECT_NEAR(life.cdf(at) / normal_cdf(z), 1, 1e-5) << sigma << " " << z;
      EXPECT_NEAR(life.quantile(normal_cdf(z)) / at, 1, 1e-5) << sigma << " " << z;
    }
    const auto found = answers_at(read, x);
    EXPECT_NEAR(found.at("B10 life") / (point[0] * std::exp(-1.2815515655446 * whole)), 1, 1e-5);
    EXPECT_NEAR(found.at("mean life") / (point[0] * std::exp(0.5 * whole * whole)), 1, 1e-5);
    const double z = std::log(15000 * hour / point[0]) / whole;
    EXPECT_NEAR(found.at("survival to 15000 h"), normal_cdf(-z), 1e-5);
    const double density = std::exp(-0.5 * z * z) / (std::sqrt(2 * M_PI) * whole * 15000 * hour);
    EXPECT_NEAR(found.at("hazard at 15000 h") / (density / normal_cdf(-z)), 1, 1e-4) << sigma;
    const double from = std::log(500 * hour / point[0]) / whole;
    EXPECT_NEAR(
        found.at("mean remaining useful life") / (point[0] * std::exp(0.5 * whole * whole) *
                                                      normal_cdf(whole - from) / normal_cdf(-from) -
                                                  500 * hour),
        1, 1e-5);
  }
}

TEST_F(VariedConditions, WeibullLivesAreThoseOfIntegralsInR) {
  const std::map<std::string, std::string> given = {
      {"normal", at_voltage(about_40)},
      {"bounded", at_voltage("{ distribution = \"normal\", mean = \"40 degC\", sd = \"5 degC\", "
                             "lower = \"30 degC\", upper = \"55 degC\" }")},
      {"uniform",
       at_voltage("{ distribution = \"uniform\", lower = \"30 degC\", upper = \"50 degC\" }")},
      {"lognormal",
       "given = { temperature = \"40 degC\", voltage = { distribution = \"lognormal\", "
       "median = \"400 V\", log_sd = 0.2 } }\n"},
      {"both",
       "given = { temperature = " + about_40 +
           ", voltage = { distribution = \"lognormal\", median = \"400 V\", log_sd = 0.2 } }\n"}};
  std::map<std::string, PosteriorStudy> studies;
  for (const auto& [name, text] : given) studies.emplace(name, study(weibull_by_use, text));
  const auto rows = read_golden("varied_conditions.csv");
  ASSERT_EQ(rows.size(), 30u);
  for (const auto& row : rows) {
    const double survival = std::stod(row[3]);
    const LifeDistribution life = life_at(studies.at(row[0]), with_shape(std::stod(row[1])));
    EXPECT_NEAR(1 - life.cdf(std::stod(row[2]) * hour), survival, 2e-6)
        << row[0] << " " << row[1] << " " << row[2];
  }
}

// Values with shares are a finite mixture, and a narrow distribution is a number.
TEST_F(VariedConditions, ValuesAreAMixtureAndNarrowDistributionsANumber) {
  const PosteriorStudy values =
      study(weibull_by_use, at_voltage("{ values = [\"30 degC\", \"45 degC\"], shares = [3, 1] }"));
  const PosteriorStudy cool = study(weibull_by_use, at_voltage("\"30 degC\"")),
                       warm = study(weibull_by_use, at_voltage("\"45 degC\""));
  const PosteriorStudy narrow =
      study(weibull_by_use,
            at_voltage("{ distribution = \"normal\", mean = \"45 degC\", sd = \"1e-6 K\" }"));
  const auto of_values = answers_at(values, point), of_cool = answers_at(cool, point),
             of_warm = answers_at(warm, point), of_narrow = answers_at(narrow, point);
  for (const char* name : {"mean life", "survival to 2000 h", "survival to 40000 h"}) {
    const std::string of = name;
    EXPECT_NEAR(of_values.at(of) / (0.75 * of_cool.at(of) + 0.25 * of_warm.at(of)), 1, 1e-7) << of;
  }
  ASSERT_EQ(of_narrow.size(), of_warm.size());
  for (const auto& [name, value] : of_warm)
    EXPECT_NEAR(of_narrow.at(name) / value, 1, 1e-7) << name;
}

// A share that never fails, and one dead on arrival, stay shares of all units.
TEST_F(VariedConditions, SharesOfALimitedFailurePopulation) {
  const std::string limited = weibull_by_use + "share_defective = \"0.05\"\n";
  std::string asked = at_voltage(about_40);
  const auto plain = life_at(study(weibull_by_use, asked), point);
  std::string text;
  try {
    const PosteriorStudy read = study(limited, asked);
    ADD_FAILURE() << "mean_life of a limited failure population is infinite";
  } catch (const InputError&) {
  }
  write("lives.csv", "life [h],temperature [degC],voltage [V]\n900,80,500\n1500,60,400\n");
  const PosteriorStudy read = read_posterior_study(write(
      "limited.toml",
      "model = \"formula\"\n[data]\nfile = \"lives.csv\"\n[data.columns]\nlife = \"life\"\n"
      "temperature = \"temperature\"\nvoltage = \"voltage\"\n" +
          limited + "share_dead_on_arrival = \"0.01\"\n" +
          "[prior]\nlife_40 = { distribution = \"lognormal\", median = \"2e4 h\", log_sd = 1 }\n"
          "energy = { distribution = \"normal\", mean = \"0.7 eV\", sd = \"0.1 eV\" }\n"
          "shape = { distribution = \"lognormal\", median = 2, log_sd = 0.5 }\n[predict]\n" +
          asked));
  const LifeDistribution life = life_at(read, point);
  for (const double hours : {2000.0, 15000.0, 40000.0})
    EXPECT_NEAR(life.cdf(hours * hour), 0.01 + 0.99 * 0.05 * plain.cdf(hours * hour), 1e-9);
  EXPECT_EQ(life.quantile(0.005), 0);
  EXPECT_EQ(life.quantile(0.2), INFINITY);
  EXPECT_NEAR(life.cdf(life.quantile(0.03)), 0.03, 1e-8);
}

Check use_check(const PosteriorStudy& study, const WeightedDraws& posterior) {
  Fit fit;
  fit.pooled = posterior;
  for (const Check& check : study.checks(fit))
    if (check.name == "use") return check;
  return {};
}

TEST_F(VariedConditions, TheDistributionIsNamedAndComparedWithTheTests) {
  const PosteriorStudy read = study(weibull_by_use, at_voltage(about_40));
  EXPECT_THAT(read.quantity_groups.front().requests.front().at,
              HasSubstr("temperature ~ normal (mean 40, sd 5 degC), voltage = 400 V"));
  const auto verdict = [&](const PosteriorStudy& asked) {
    WeightedDraws one;
    one.values = Eigen::Map<const Points>(point.data(), 1, 3);
    one.weights = Eigen::VectorXd::Ones(1);
    return use_check(asked, one);
  };
  EXPECT_EQ(verdict(read).verdict, Verdict::pass);
  EXPECT_THAT(verdict(read).detail, HasSubstr("28.37 to 51.63 degC, tested were 20 to 90 degC"));
  const PosteriorStudy cold =
      study(weibull_by_use,
            at_voltage("{ distribution = \"normal\", mean = \"20 degC\", sd = \"5 degC\" }"));
  EXPECT_EQ(verdict(cold).verdict, Verdict::warn);
}

// The lightest components of a predictive life are left out, and their weight is put back: it reaches 1.
TEST_F(VariedConditions, ThePredictiveLifeHasAllOfTheUnits) {
  const PosteriorStudy read = study(
      weibull_by_use, "given = { temperature = " + about_40 +
                          ", voltage = { values = [\"300 V\", \"400 V\"], shares = [1, 3] } }\n");
  for (const double shape : {1.5, 8.0, 40.0}) {
    const LifeDistribution life = life_at(read, with_shape(shape));
    EXPECT_NEAR(life.cdf(1e300), 1, 1e-12) << shape;
    const double late = life.quantile(1 - 5e-8), median = life.quantile(0.5);
    EXPECT_GT(late, median) << shape;
    EXPECT_LT(late, 1e3 * median) << shape;
    EXPECT_NEAR((1 - life.cdf(late)) / 5e-8, 1, 1e-2) << shape;
  }
}

const std::string volts_by_unit =
    "{ distribution = \"lognormal\", median = \"400 V\", log_sd = 0.2 }";

// Between values of a list there are no units: lives there need no finer rule, wherever the list stands. Along a
// distribution they do.
TEST_F(VariedConditions, OnlyDistributionsNeedAFinerRule) {
  const auto components = [&](const std::string& temperature, const std::string& voltage) {
    const auto life = given_life(
        weibull_by_use,
        fmt::format("given = {{ temperature = {}, voltage = {} }}\n", temperature, voltage));
    auto at = life->at_point();
    at.move_to(point.data());
    EXPECT_TRUE(at.resolved());
    return at.size();
  };
  const std::string volts = "{ values = [\"100 V\", \"400 V\", \"800 V\"] }",
                    temperatures = "{ values = [\"0 degC\", \"40 degC\", \"120 degC\"] }";
  const std::size_t warm = components(about_40, "\"400 V\""),
                    strong = components("\"40 degC\"", volts_by_unit);
  EXPECT_LE(components(about_40, volts), 3 * warm);
  EXPECT_LE(components(temperatures, volts_by_unit), 3 * strong);
  EXPECT_EQ(components(temperatures, volts), 9u);
  const auto narrow = given_life(weibull_by_use, at_voltage(about_40));
  auto at = narrow->at_point();
  at.move_to(with_shape(40).data());
  EXPECT_GT(at.size(), 4 * warm);
}

WeightedDraws draws_about(double shape, Eigen::Index count) {
  WeightedDraws draws;
  draws.values = Points(count, 3);
  draws.weights = Eigen::VectorXd::Constant(count, 1 / static_cast<double>(count));
  for (Eigen::Index i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count);
    draws.values.row(i) << point[0] * (0.9 + 0.2 * part), point[1] * (1 + 0.01 * std::sin(i)),
        shape * (1 + 0.1 * std::cos(i));
  }
  return draws;
}

// Lives that scatter little need many nodes: a predictive life then has fewer points of the posterior.
TEST_F(VariedConditions, ComponentsOfAPredictiveLifeAreLimited) {
  const auto life = given_life(weibull_by_use, "given = { temperature = " + about_40 +
                                                   ", voltage = " + volts_by_unit + " }\n");
  const auto components = life->next(draws_about(60, 3000)).components();
  EXPECT_LT(components, 2'000'000u);
  EXPECT_GT(components, 200'000u);
}

// A life under a number beside one under a distribution: over few points of the posterior, with the error of that.
TEST_F(VariedConditions, ComparedLivesMayHaveADistributionAlone) {
  const PosteriorStudy read = study(
      weibull_by_use, at_voltage("\"40 degC\"") + "compared_with = { temperature = " + about_40 +
                          ", voltage = \"400 V\" }\naccelerated = { temperature = " + about_90 +
                          ", voltage = \"400 V\" }\n");
  const QuantityGroup& group = read.quantity_groups.front();
  const auto found = group.from_draws(draws_about(1.5, 3000));
  std::size_t compared = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::string& name = group.requests[i].name;
    if (name != "B10 life ratio" && name != "acceleration factor") continue;
    ++compared;
    ASSERT_TRUE(found[i].numerical_error) << name;
    EXPECT_LT(*found[i].numerical_error, 0.05) << name;
    // Those that differ among each other fail earlier.
    EXPECT_GT(found[i].q50, 1) << name;
  }
  EXPECT_EQ(compared, 2u);
  const Check use = use_check(read, draws_about(1.5, 20));
  EXPECT_EQ(use.verdict, Verdict::warn);
  EXPECT_THAT(use.detail, HasSubstr("of 98 % of the units (accelerated) is"));
}

TEST_F(VariedConditions, ASumThatStaysCoarseIsSaid) {
  const PosteriorStudy read = study(weibull_by_use, "given = { temperature = " + about_40 +
                                                        ", voltage = " + volts_by_unit + " }\n");
  EXPECT_THAT(use_check(read, draws_about(1.5, 20)).detail, Not(HasSubstr("coarse")));
  const Check coarse = use_check(read, draws_about(1e4, 20));
  EXPECT_EQ(coarse.verdict, Verdict::warn);
  EXPECT_THAT(coarse.detail, AllOf(HasSubstr("predict.given"), HasSubstr("100 % of the posterior"),
                                   HasSubstr("coarse")));
}

TEST_F(VariedConditions, WrongDistributionsAreRefused) {
  const auto refused = [&](const std::string& temperature) {
    return refusal(weibull_by_use, at_voltage(temperature));
  };
  EXPECT_THAT(refused("{ distribution = \"lognormal\", median = \"40 degC\", log_sd = 0.1 }"),
              AllOf(HasSubstr("predict.given.temperature"), HasSubstr("read two ways")));
  EXPECT_THAT(refused("{ distribution = \"flat\", unit = \"K\" }"),
              AllOf(HasSubstr("predict.given.temperature"), HasSubstr("no distribution of units")));
  EXPECT_THAT(refused("{ distribution = \"normal\", mean = \"40 degC\", sd = \"-5 K\" }"),
              HasSubstr("predict.given.temperature.sd"));
  EXPECT_THAT(refused("{ distribution = \"normal\", mean = \"40 degC\" }"), HasSubstr("sd"));
  EXPECT_THAT(refused("{ distribution = \"normal\", mean = \"40 V\", sd = \"5 K\" }"),
              HasSubstr("mean"));
  EXPECT_THAT(refused("{ values = [\"30 degC\", \"45 degC\"], shares = [1] }"),
              AllOf(HasSubstr("shares"), HasSubstr("1 entries for 2 values")));
  EXPECT_THAT(refused("{ distribution = \"normal\", mean = \"40 degC\", sd = \"60 K\" }"),
              HasSubstr("absolute zero"));
  EXPECT_THAT(refused("{ distribution = \"default\" }"), HasSubstr("no default distribution"));
  std::string of_positive = weibull_by_use;  // an odd root has no value below 0 V
  of_positive.replace(of_positive.find("^-4"), 3, "^-4.5");
  EXPECT_THAT(
      refusal(of_positive,
              "given = { temperature = \"40 degC\", voltage = { distribution = "
              "\"normal\", mean = \"400 V\", sd = \"200 V\" } }\n"),
      AllOf(HasSubstr("predict.given.voltage"), HasSubstr("no finite value"), HasSubstr("lower")));
  EXPECT_THAT(refusal(lognormal_by_use,
                      "given = { temperature = \"40 degC\", voltage = { values = [\"1 V\"] } }\n"),
              AllOf(HasSubstr("predict.given.voltage"), HasSubstr("no life depends on it")));
  EXPECT_THAT(refusal(weibull_by_use, at_voltage(about_40) + "classical = true\n"),
              AllOf(HasSubstr("predict.classical"), HasSubstr("one value")));
}

}  // namespace
}  // namespace wearwell
