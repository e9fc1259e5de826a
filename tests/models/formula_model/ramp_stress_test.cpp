// Ramp tests (ramp_stress.h): the likelihood against the integral of exposure, identities, messages.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <filesystem>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/formula_fit_data.h"
#include "wearwell/models/formula_model/formula_life.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/life_groups.h"

namespace wearwell::formula_model {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string columns_of_ramps =
    "[data.columns]\nlife = { column = \"h\", unit = \"h\" }\nfrom = { column = \"from\", unit = "
    "\"kV\" }\nrise = { column = \"rise\", unit = \"kV/h\" }\nstatus = \"status\"\n";
const std::string weibull_of_volts =
    "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta * inverse_power(voltage, 10 [kV], "
    "n)\"\nshape = \"beta\"\n";
const std::string of_columns =
    "ramp = { stress = \"voltage\", start = \"from\", rate = \"rise\" }\n";
const std::string priors_of_ramps =
    "[prior]\neta = { distribution = \"lognormal\", median = \"900 h\", log_sd = 1 }\nn = { "
    "distribution = \"normal\", mean = 8, sd = 3 }\nbeta = { distribution = \"lognormal\", median "
    "= 1.5, log_sd = 0.7 }\n";
// From 0, from above 0, falling, constant, and a run-out.
const std::string table_of_ramps =
    "h,from,rise,status\n24.3,0,0.5,failed\n7.5,6,0.8,failed\n9,14,-0.4,failed\n12,9,0,failed\n"
    "20,2,0.5,runout\n";

struct Ramp {
  double end, from, rise;
  bool failed;
};
const std::vector<Ramp> ramps = {{24.3, 0, 0.5, true},
                                 {7.5, 6, 0.8, true},
                                 {9, 14, -0.4, true},
                                 {12, 9, 0, true},
                                 {20, 2, 0.5, false}};

class RampStressTest : public ScratchTest {
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

// In hours: exposure by tanh-sinh quadrature, density f(w) dw/dt of the standard Weibull distribution.
template <class Scale>
double integrated(const Scale& scale, double beta) {
  boost::math::quadrature::tanh_sinh<double> rule;
  double sum = 0;
  for (const Ramp& each : ramps) {
    const auto at = [&](double t) { return scale(each.from + each.rise * t); };
    const double w = rule.integrate([&](double t) { return 1 / at(t); }, 0.0, each.end);
    sum += each.failed ? std::log(beta) + (beta - 1) * std::log(w) - std::pow(w, beta) -
                             std::log(3600 * at(each.end))
                       : -std::pow(w, beta);
  }
  return sum;
}

TEST_F(RampStressTest, LikelihoodIsThatOfTheIntegratedExposure) {
  const std::string study = columns_of_ramps + weibull_of_volts + of_columns + priors_of_ramps;
  for (const auto& [eta, n, beta] : {std::tuple{60.0, 5.0, 1.7}, std::tuple{40.0, 8.3, 0.8},
                                     std::tuple{50.0, 0.4, 3.0}, std::tuple{900.0, 12.5, 1.1}}) {
    const double expected = integrated([&](double v) { return eta * std::pow(v / 10, -n); }, beta);
    EXPECT_NEAR(log_likelihood(table_of_ramps, study, {3600 * eta, n, beta}), expected,
                1e-11 * std::abs(expected))
        << n;
  }
}

// A power law as a line of [formula] and otherwise: also in closed form, and by quadrature equal to it.
TEST_F(RampStressTest, QuadratureAndClosedFormAgree) {
  const auto with = [&](const std::string& lines, const std::string& scale) {
    return lines + columns_of_ramps + "[likelihood.life]\nfamily = \"weibull\"\nscale = \"" +
           scale + "\"\nshape = \"beta\"\n" + of_columns + priors_of_ramps;
  };
  const std::string by_line = with("", "eta / severity") +
                              "[formula]\nratio = \"voltage / 10 [kV]\"\nseverity = \"ratio^n\"\n";
  const std::string smooth = with("", "eta * exp(-n * log(voltage / 10 [kV]))");
  EXPECT_TRUE(model(table_of_ramps, by_line)->ramp->closed);
  EXPECT_FALSE(model(table_of_ramps, smooth)->ramp->closed);
  const std::string plain = columns_of_ramps + weibull_of_volts + of_columns + priors_of_ramps;
  EXPECT_TRUE(model(table_of_ramps, plain)->ramp->closed);
  for (const double n : {0.7, 3.3, 8.0, 30.5}) {
    const std::vector<double> x = {3600 * 60.0, n, 1.7};
    const double closed = log_likelihood(table_of_ramps, plain, x);
    EXPECT_NEAR(log_likelihood(table_of_ramps, by_line, x), closed, 1e-12 * std::abs(closed)) << n;
    EXPECT_NEAR(log_likelihood(table_of_ramps, smooth, x), closed, 1e-8 * std::abs(closed)) << n;
  }
}

// A ramp of temperature under Arrhenius' law, from a constant in degrees Celsius.
TEST_F(RampStressTest, TemperatureRisesUnderArrhenius) {
  const std::string study =
      "[data.columns]\nlife = { column = \"h\", unit = \"h\" }\nstatus = \"status\"\n"
      "[likelihood.life]\nfamily = \"lognormal\"\nmedian = \"eta * arrhenius(temperature, 400 [K], "
      "n * 0.1 [eV])\"\nlog_sd = \"beta\"\nramp = { stress = \"temperature\", start = \"20 degC\", "
      "rate = \"5 K/h\" }\n" +
      priors_of_ramps;
  const double eta = 3, n = 9, beta = 0.6, k = 8.617333262e-5;
  const auto median = [&](double kelvin) {
    return eta * std::exp(0.1 * n / k * (1 / kelvin - 1 / 400.0));
  };
  boost::math::quadrature::tanh_sinh<double> rule;
  const double end = 23;
  const double w = rule.integrate([&](double t) { return 1 / median(293.15 + 5 * t); }, 0.0, end);
  const double z = std::log(w) / beta;
  const double expected = -0.5 * z * z - std::log(beta * std::sqrt(2 * M_PI) * w) -
                          std::log(3600 * median(293.15 + 5 * end));
  EXPECT_NEAR(log_likelihood("h,status\n23,failed\n", study, {3600 * eta, n, beta}), expected,
              1e-11 * std::abs(expected));
}

TEST_F(RampStressTest, GradientIsThatOfDifferences) {
  for (const std::string scale :
       {"eta * inverse_power(voltage, 10 [kV], n)", "eta * exp(-n * voltage / 10 [kV])"}) {
    const std::string study = columns_of_ramps +
                              "[likelihood.life]\nfamily = \"weibull\"\nscale = \"" + scale +
                              "\"\nshape = \"beta\"\n" + of_columns + priors_of_ramps;
    const std::vector<double> x = {3600 * 60.0, 2.5, 1.7};
    std::vector<double> gradient;
    log_likelihood(table_of_ramps, study, x, &gradient);
    for (std::size_t i = 0; i < x.size(); ++i) {
      std::vector<double> up = x, down = x;
      const double step = 1e-5 * x[i];
      up[i] += step, down[i] -= step;
      const double slope = (log_likelihood(table_of_ramps, study, up) -
                            log_likelihood(table_of_ramps, study, down)) /
                           (2 * step);
      EXPECT_NEAR(gradient[i], slope, 1e-6 * std::abs(slope)) << scale << i;
    }
  }
}

// Weibull lives under a ramp from 0 are Weibull lives (Nelson 1990, sec. 10.3).
TEST_F(RampStressTest, RampsFromZeroAreWeibullAgain) {
  const std::string once = "h,rate,status\n24.3,0.5,failed\n11,1.3,failed\n20,0.4,runout\n";
  const std::string again =
      "[data.columns]\nlife = { column = \"h\", unit = \"h\" }\nrate = { column = \"rate\", unit = "
      "\"kV/h\" }\nstatus = \"status\"\n[likelihood.life]\nfamily = \"weibull\"\n";
  const std::string closed =
      "scale = \"eta * ((n + 1) * (10 [kV]/(rate*eta))^n)^(1/(n + 1))\"\nshape "
      "= \"beta*(n + 1)\"\n";
  const std::string ramp =
      "scale = \"eta * inverse_power(voltage, 10 [kV], n)\"\nshape = \"beta\"\nramp = { stress = "
      "\"voltage\", start = \"0 kV\", rate = \"rate\" }\n";
  const std::vector<double> x = {3600 * 60.0, 5, 1.7};
  const double expected = log_likelihood(once, again + closed + priors_of_ramps, x);
  EXPECT_NEAR(log_likelihood(once, again + ramp + priors_of_ramps, x), expected,
              1e-12 * std::abs(expected));
}

// tests/golden/ramp.R: the maximum of the likelihood of the example, and its value with densities per hour.
TEST_F(RampStressTest, MaximumLikelihoodIsThatOfR) {
  const Source source =
      source_of(std::filesystem::path(PROJECT_SOURCE_DIR) / "examples/accelerated/ramp.toml");
  const auto own = read_formula_model(TomlReader::parse(source.study), source);
  const auto all =
      formula_likelihood(std::make_shared<const FormulaRows>(own, own->data.table.rows));
  const std::vector<double> x = {3600 * 6156.571236, 12.68059827, 1.738381018};
  std::vector<double> gradient(3);
  const double failures = 22;
  EXPECT_NEAR(all->value_and_gradient(x, gradient) + failures * std::log(3600.0), -7.761135222,
              1e-8);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(gradient[i] * x[i], 0, 2e-3) << i;
}

// The stress at failure is a result; the rate is a condition.
TEST_F(RampStressTest, StressAtFailureIsNoDriver) {
  const auto own =
      model(table_of_ramps, columns_of_ramps + weibull_of_volts + of_columns + priors_of_ramps);
  const auto checked = fit_data(std::make_shared<const FormulaRows>(own, own->data.table.rows));
  ASSERT_TRUE(checked);
  std::vector<std::string> drivers;
  for (const auto& each : checked->drivers) drivers.push_back(each.name);
  EXPECT_THAT(drivers, ::testing::UnorderedElementsAre("rise", RampStress::begin));
}

TEST_F(RampStressTest, LivesOfUseBeginAtZero) {
  const std::string text = columns_of_ramps + weibull_of_volts + of_columns + priors_of_ramps +
                           "[predict]\ngiven = { voltage = \"10 kV\" }\n";
  const auto own = model(table_of_ramps, text);
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

TEST_F(RampStressTest, RefusesWhatIsNoRamp) {
  const auto with = [&](const std::string& ramp, const std::string& likelihood = weibull_of_volts) {
    return columns_of_ramps + likelihood + ramp + priors_of_ramps;
  };
  const auto refused = [&](const std::string& study) { return refusal(table_of_ramps, study); };
  EXPECT_THAT(refused(with("ramp = { stress = \"voltage\", start = \"fro\", rate = \"rise\" }\n")),
              AllOf(HasSubstr("'fro' is neither a numeric column"), HasSubstr("ramp.start")));
  EXPECT_THAT(refused(with("ramp = { stress = \"voltage\", start = \"from\", rate = \"2 kV\" }\n")),
              AllOf(HasSubstr("ramp.rate"), HasSubstr("but the start of the stress is")));
  EXPECT_THAT(refused(with("ramp = { stress = \"from\", start = \"from\", rate = \"rise\" }\n")),
              HasSubstr("'from' follows from start, rate and life"));
  EXPECT_THAT(refused(with("steps = \"status\"\n" + of_columns)), HasSubstr("give one of them"));
  EXPECT_THAT(refused(with(of_columns,
                           "[likelihood.life]\nfamily = \"weibull\"\nscale = "
                           "\"eta*from/1 [kV]*n\"\nshape = \"beta\"\n")),
              HasSubstr("does not depend on 'voltage'"));
  EXPECT_THAT(refused(with(of_columns,
                           "[likelihood.life]\nfamily = \"weibull\"\nscale = \"eta * "
                           "inverse_power(voltage, 10 [kV], n)\"\nshape = \"beta * "
                           "voltage/10 [kV]\"\n")),
              HasSubstr("shape depends on 'voltage'"));
  EXPECT_THAT(refused(with("threshold = \"eta\"\n" + of_columns)), HasSubstr("threshold"));
  EXPECT_THAT(refusal("h,from,rise,status\n24.3,0,,failed\n", with(of_columns)),
              AllOf(HasSubstr("row 1"), HasSubstr("no value")));
  EXPECT_THAT(
      refusal("h,from,rise,status,lower,upper\n24.3,0,0.5,failed,,\n30,0,0.5,interval,20,30\n",
              "[data.columns]\nlower = { column = \"lower\", unit = \"h\" }\nupper = { column = "
              "\"upper\", unit = \"h\" }\n" +
                  with(of_columns).substr(std::string("[data.columns]\n").size())),
      AllOf(HasSubstr("row 2"), HasSubstr("stress at failure")));
}

}  // namespace
}  // namespace wearwell::formula_model
