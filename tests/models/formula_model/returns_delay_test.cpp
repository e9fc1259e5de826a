// Returns triangles with delays that vary: the distribution of a sum of delays, fits and forecasts.
#include "wearwell/models/formula_model/returns_delay.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "models/formula_model/formula_models.h"
#include "support/messages.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/study/model.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell::formula_model {
namespace {

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

constexpr double scale = 60, shape = 1.5;  // of the lives

// Months from the sale of a part to the report of its failure, within the warranty.
double reported_after(double warranty, Rng& rng) {
  const double to_use = -1.5 * std::log(rng.uniform()),
               of_report = std::exp(0.6 * rng.normal() - 0.2),
               life = scale * std::pow(-std::log(rng.uniform()), 1 / shape);
  return life <= warranty ? to_use + life + of_report : INFINITY;
}

constexpr const char* delays =
    "ages = \"middle\"\n"
    "delay_to_use = { distribution = \"exponential\", mean = \"1.5 month\" }\n"
    "delay_of_report = { distribution = \"lognormal\", median = \"0.8187307531 month\", log_sd = "
    "0.6 }\n";

class ReturnsDelayTest : public ScratchTest {
 protected:
  std::unique_ptr<const Study> read(const std::string& table, const std::string& returns,
                                    const std::string& predict, double known = 0) {
    const std::string prior =
        known > 0 ? fmt::format(
                        "scale = {{ distribution = \"normal\", mean = \"{} month\", sd = "
                        "\"{} month\" }}\nshape = {{ distribution = \"normal\", mean = {}, "
                        "sd = {} }}\n",
                        scale, known * scale, shape, known * shape)
                  : "scale = { distribution = \"uniform\", lower = \"1 month\", upper = \"300 "
                    "month\" }\nshape = { distribution = \"uniform\", lower = 0.2, upper = 8 }\n";
    write("d.csv", table);
    write("study.toml",
          fmt::format("model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.returns]\nperiod = "
                      "\"month\"\n{}\n[likelihood.life]\nfamily = \"weibull\"\nscale = "
                      "\"scale\"\nshape = \"shape\"\n[prior]\n{}[predict]\n{}\n",
                      returns, prior, predict));
    return read_study(source_of(folder() / "study.toml"), formula_models());
  }
  Result run(const std::string& table, const std::string& returns, const std::string& predict = "",
             double known = 0) {
    RunOptions options;
    options.sampler.method = Method::exact;
    options.sampler.draws = 100;
    options.report = false;
    return read(table, returns, predict, known)->run(options, {});
  }
};

// As many months of sale as of return, `units` each.
std::string simulated_table(int months, int units, double warranty) {
  Rng rng(20261126, 39);
  std::string table = "sold,units";
  for (int month = 1; month <= months; ++month) table += fmt::format(",{}", month);
  for (int sale = 1; sale <= months; ++sale) {
    std::vector<int> returns(static_cast<std::size_t>(months) + 1);
    for (int unit = 0; unit < units; ++unit) {
      const double at = sale + std::floor(0.5 + reported_after(warranty, rng));
      if (at <= months) ++returns[static_cast<std::size_t>(at)];
    }
    table += fmt::format("\n{},{}", sale, units);
    for (int month = 1; month <= months; ++month)
      table += month < sale ? "," : fmt::format(",{}", returns[static_cast<std::size_t>(month)]);
  }
  return table + "\n";
}

// At known parameters, so that the quadratures have the same points.
TEST_F(ReturnsDelayTest, OneTimeIsAFixedDelay) {
  const std::string table = simulated_table(5, 2000, INFINITY), next = "next = \"3 month\"\n",
                    warranty = "warranty = \"3 month\"\n";
  write("one.csv", "delay [month],share\n0.4,1\n");
  const Result fixed = run(table, "delay_of_report = \"0.4 month\"\n" + warranty, next, 1e-7),
               varying = run(table,
                             "delay_of_report = { file = \"one.csv\", delay = \"delay [month]\", "
                             "share = \"share\" }\n" +
                                 warranty,
                             next, 1e-7);
  const double log_likelihood = fixed.posterior->mode->log_likelihood;
  EXPECT_NEAR(varying.posterior->mode->log_likelihood / log_likelihood, 1, 1e-9);
  for (std::size_t k = 0; k < 3; ++k) {
    const Json &f = fixed.body["returns"]["forecast"][k],
               &v = varying.body["returns"]["forecast"][k];
    EXPECT_NEAR(f["expected"].get<double>() / v["expected"].get<double>(), 1, 1e-9);
    EXPECT_EQ(f["number_q95"], v["number_q95"]);
  }
}

// The points of a sum of two distributions against the integral over both.
TEST_F(ReturnsDelayTest, PointsHaveTheProbabilitiesOfTheDistribution) {
  const TomlReader root = TomlReader::parse({"", std::string("[data]\n") + delays});
  const TomlReader keys = root.required_table("data");
  const Unit month = read_unit("month", "s");
  const Source none;
  const ReportingDelay sum =
      sum_of_delays(read_returns_delay(keys, "delay_to_use", none, month),
                    read_returns_delay(keys, "delay_of_report", none, month), month);
  EXPECT_LT(sum.time.size(), 120U);
  const LifeMixture life{.families = {ResponseFamily::weibull}};
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  for (const double form : {0.7, 1.5, 3.0}) {
    const double x[] = {to_si(month, scale), form, 0};
    // P(to_use + life <= u) is an integral; another one over the lognormal delay.
    const auto in_use = [&](double u) {
      return u > 0 ? Rule::integrate(
                         [&](double z) {
                           return std::exp(-(u - z) / 1.5) / 1.5 *
                                  -std::expm1(-std::pow(z / scale, form));
                         },
                         0.0, u, 10, 1e-12)
                   : 0;
    };
    const auto reported = [&](double age) {
      return Rule::integrate(
          [&](double z) {
            return std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI) *
                   in_use(age - std::exp(0.6 * z - 0.2));
          },
          -8.0, 8.0, 12, 1e-11);
    };
    for (const double age : {1.5, 6.5}) {
      const double expected = reported(age) - reported(age - 1);
      const Response cell{
          .seen = Censoring::interval, .at = to_si(month, age - 1), .until = to_si(month, age)};
      // Shapes below 1 have a vertical tangent at age 0.
      EXPECT_NEAR(std::exp(log_response(life, sum, cell, x)) / expected, 1, form < 1 ? 2e-3 : 1e-3)
          << form << " " << age;
    }
  }
}

TEST_F(ReturnsDelayTest, RecoversTheLives) {
  constexpr double warranty = 9;
  const std::string table = simulated_table(12, 8000, warranty),
                    of_warranty = "warranty = \"9 month\"\n";
  const Result result = run(table, delays + of_warranty);
  const std::vector<ParameterSummary>& found = result.posterior->parameters;
  EXPECT_LT(std::abs(found[0].mean - scale), 3.5 * found[0].sd);
  EXPECT_LT(std::abs(found[1].mean - shape), 3.5 * found[1].sd);
  for (const Check& each : result.posterior->checks)
    EXPECT_NE(each.verdict, Verdict::fail) << each.name << ": " << each.detail;
  // Without the delays the shape is too large by many standard deviations.
  const Result naive = run(table, of_warranty);
  EXPECT_GT(naive.posterior->parameters[1].mean - shape, 6 * naive.posterior->parameters[1].sd);
}

// Units of one month of sale that are not reported by month 10, at known parameters, and planned ones.
TEST_F(ReturnsDelayTest, ForecastIsTheMeanOfSimulations) {
  constexpr int months = 10, ahead = 6, units = 300000;
  constexpr double warranty = 12;
  Rng rng(20261126, 40);
  double left = 0, returned = 0, planned = 0;
  for (int unit = 0; unit < units; ++unit) {
    const double after = std::floor(0.5 + reported_after(warranty, rng));
    left += after > months - 1;
    returned += after > months - 1 && after <= months - 1 + ahead;
    planned += after <= ahead - 1;
  }
  std::string table = "sold,units", row = "\n1,100000";
  for (int month = 1; month <= months; ++month) {
    table += fmt::format(",{}", month);
    row += ",0";
  }
  write("planned.csv", "month,units\n11,1000\n");
  const Json json = run(table + row + "\n", std::string(delays) + "warranty = \"12 month\"\n",
                        "next = \"6 month\"\nplanned_sales = { file = \"planned.csv\" }\n", 1e-6)
                        .body["returns"];
  const auto expect = [](double expected, double of, double simulated, double among) {
    const double share = simulated / among;
    EXPECT_NEAR(expected / of, share, 4 * std::sqrt(share * (1 - share) / among));
  };
  const Json& last = json["forecast"][ahead - 1];
  double of_units = 0, of_planned = 0;
  for (const Json& each : json["forecast"]) {
    of_units += each["of_units_in_use"].get<double>();
    of_planned += each["of_later_sales"].get<double>();
  }
  EXPECT_NEAR(last["until_then"]["expected"].get<double>(), of_units + of_planned, 1e-6);
  expect(of_units, 100000, returned, left);
  expect(of_planned, 1000, planned, units);
}

TEST_F(ReturnsDelayTest, Refusals) {
  const std::string table = simulated_table(6, 100, INFINITY);
  const auto refusal = [&](const std::string& returns) {
    return message_of<InputError>([&] { read(table, returns, ""); });
  };
  EXPECT_THAT(refusal("delay_to_use = { distribution = \"normal\", mean = \"1 month\", sd = \"1 "
                      "month\" }\n"),
              HasSubstr("lognormal"));
  EXPECT_THAT(refusal("delay_to_use = { median = \"1 month\" }\n"),
              testing::AllOf(HasSubstr("distribution: is missing"), HasSubstr("share")));
  EXPECT_THAT(refusal(std::string(delays) + "warranty = \"0 month\"\n"), HasSubstr("positive"));
  EXPECT_THAT(refusal("delay_to_use = \"-1 month\"\n"), HasSubstr("must not be negative"));
  const std::string named =
      "delay_of_report = { file = \"s.csv\", delay = \"d [month]\", share = "
      "\"share\" }\n";
  write("s.csv", "d [month],share\n0,0.5\n1,0.4\n");
  EXPECT_THAT(refusal(named), testing::AllOf(HasSubstr("s.csv"), HasSubstr("add up to 0.9")));
  write("s.csv", "d [month],share\n0,0.5\n-1,0.5\n");
  EXPECT_THAT(refusal(named), HasSubstr("row 2, column 'd [month]': -1 must be 0 or more"));
  write("s.csv", "d [month],share\n0,0.5\n1,0.5\n");
  EXPECT_THAT(refusal("ages = \"whole\"\n" + named), HasSubstr("ages: must be \"middle\""));
  write("s.csv", "d [month],share\n2,0.5\n3,0.5\n");
  EXPECT_THAT(message_of<InputError>([&] { read("sold,units,1,2,3\n1,100,,2,3\n", named, ""); }),
              HasSubstr("with delays of at least 2 months no failure can be reported so early"));
}

}  // namespace
}  // namespace wearwell::formula_model
