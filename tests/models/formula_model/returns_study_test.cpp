// From the file of a study with a returns triangle to its forecast.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <fstream>

#include "models/formula_model/formula_models.h"
#include "models/formula_model/simulated_returns.h"
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

std::string content(const std::string& file) {
  std::ifstream in(PROJECT_SOURCE_DIR "/" + file);
  return {std::istreambuf_iterator<char>(in), {}};
}

class ReturnsStudyTest : public ScratchTest {
 protected:
  std::unique_ptr<const Study> read(const std::string& table, const std::string& study) {
    write("d.csv", table);
    write("study.toml", study);
    return read_study(source_of(folder() / "study.toml"), formula_models());
  }
  Result run(const std::string& table, const std::string& study) {
    RunOptions options;
    options.sampler.method = Method::exact;
    options.sampler.draws = 100;
    options.report = false;
    return read(table, study)->run(options, {});
  }
  std::string refusal(const std::string& table, const std::string& study) {
    return message_of<InputError>([&] { read(table, study); });
  }
};

std::string study(const std::string& returns, const std::string& predict,
                  const std::string& scale_prior, const std::string& shape_prior) {
  return fmt::format(
      "model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.returns]\n{}\n[likelihood.life]\n"
      "family = \"weibull\"\nscale = \"scale\"\nshape = \"shape\"\n[prior]\nscale = {}\nshape = "
      "{}\n[predict]\n{}\n",
      returns, scale_prior, shape_prior, predict);
}

// Known parameters, up to a millionth.
std::string known(const std::string& returns, const std::string& predict, double scale,
                  const std::string& unit, double shape) {
  return study(
      returns, predict,
      fmt::format("{{ distribution = \"normal\", mean = \"{0} {1}\", sd = \"{2} {1}\" }}", scale,
                  unit, 1e-6 * scale),
      fmt::format("{{ distribution = \"normal\", mean = {}, sd = {} }}", shape, 1e-6 * shape));
}

constexpr const char* wide_scale =
    "{ distribution = \"uniform\", lower = \"1 month\", upper = \"300 month\" }";
constexpr const char* wide_shape = "{ distribution = \"uniform\", lower = 0.2, upper = 8 }";

// ReliaSoft's example of the Nevada format (reliawiki.com, "Warranty Data Analysis"), with the estimates of
// tests/golden/warranty_returns.R: the published beta 2.49 and eta 6.70.
TEST_F(ReturnsStudyTest, ReliaSoftsNevadaTable) {
  const std::string table = content("examples/warranty/nevada.csv"), returns = "ages = \"whole\"\n";
  const Result result = run(table, study(returns, "", wide_scale, wide_shape));
  const ModeSummary& mode = *result.posterior->mode;
  EXPECT_NEAR(mode.parameters[0].value, 6.69505307, 1e-4);
  EXPECT_NEAR(mode.parameters[1].value, 2.49277538, 1e-4);
  EXPECT_NEAR(mode.log_likelihood, -85.90916961, 1e-5);
  // At these estimates, the forecast of October by month of sale.
  const Json json =
      run(table, known(returns, "next = \"1 month\"\n", 6.69505307, "month", 2.49277538))
          .body["returns"];
  const double october[] = {11.76235780, 11.04062723, 5.78930852};
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(json["by_sale"][i]["ahead"]["expected"].get<double>(), october[i], 1e-3);
  EXPECT_NEAR(json["forecast"][0]["expected"].get<double>(), october[0] + october[1] + october[2],
              1e-3);
  EXPECT_EQ(json["forecast"][0]["period"], "2010-10");
}

// Intervals: R's maximum likelihood estimates of the example.
TEST_F(ReturnsStudyTest, IntervalsAsInR) {
  const std::string table = content("examples/warranty/returns.csv");
  const struct {
    const char* ages;
    double shape, scale, log_likelihood;
  } all[] = {{"start", 1.63350931, 78.12986443, -3480.66035014},
             {"middle", 1.51601911, 85.37555764, -3479.99360196}};
  for (const auto& each : all) {
    const Result result =
        run(table, study(fmt::format("ages = \"{}\"\n", each.ages), "", wide_scale, wide_shape));
    const ModeSummary& mode = *result.posterior->mode;
    EXPECT_NEAR(mode.parameters[0].value, each.scale, 2e-3);
    EXPECT_NEAR(mode.parameters[1].value, each.shape, 2e-5);
    EXPECT_NEAR(mode.log_likelihood, each.log_likelihood, 1e-5);
  }
}

// Meeker and Escobar (1998), section 12.7: Product-A, 80 of 10 000 units failed in 48 months; with their estimates 1.518 and 1152,
// 32.07 are expected in the next 12 months; 23 and 42 are quantiles of the binomial distribution.
TEST_F(ReturnsStudyTest, MeekerAndEscobarsProductA) {
  std::string heading = "sold,units", row = "\n0,10000";
  for (int month = 0; month <= 48; ++month) {
    heading += fmt::format(",{}", month);
    row += month == 48 ? ",80" : ",0";
  }
  const Json json = run(heading + row + "\n", known("ages = \"end\"\nperiod = \"month\"\n",
                                                    "next = \"12 month\"\n", 1152, "month", 1.518))
                        .body["returns"]["forecast"][11]["until_then"];
  EXPECT_NEAR(json["expected"].get<double>(), 32.07, 0.01);
  EXPECT_EQ(json["number_q05"], 23);
  EXPECT_EQ(json["number_q95"], 42);
}

// The same section, staggered entry: 1703 bearing cages of ages 50, 150 ... 2050 h; 5.057 failures are expected in the next 300 h.
// The exact distribution of this sum (convolution in R) has the quantiles 2 and 9.
TEST_F(ReturnsStudyTest, MeekerAndEscobarsBearingCages) {
  const int cages[] = {288, 148, 124, 111, 106, 99, 110, 114, 119, 127, 123,
                       93,  47,  41,  27,  11,  6,  0,   1,   0,   2};
  constexpr int periods = 21;
  std::string table = "sold,units";
  for (int p = 1; p <= periods; ++p) table += fmt::format(",{}", p);
  for (int p = 1; p <= periods; ++p) {
    table += fmt::format("\n{},{}", p, cages[periods - p]);
    for (int at = 1; at <= periods; ++at) table += at < p ? "," : ",0";
  }
  const Json json = run(table + "\n", known("period = \"1e2 h\"\n", "next = \"300 h\"\n", 11792.18,
                                            "h", 2.035319))
                        .body["returns"]["forecast"][2]["until_then"];
  EXPECT_NEAR(json["expected"].get<double>(), 5.058, 0.001);
  EXPECT_EQ(json["number_q05"], 2);
  EXPECT_EQ(json["number_q95"], 9);
}

// Sums over months of sale and over months agree, and planned sales add what their own ages give.
TEST_F(ReturnsStudyTest, SumsAgree) {
  write("planned.csv", "month,units\n2026-02,1000\n");
  const Json json =
      run(content("examples/warranty/returns.csv"),
          known("warranty = \"20 month\"\n",
                "next = \"3 month\"\ncost_per_return = \"10 EUR\"\nplanned_sales = { file = "
                "\"planned.csv\" }\n",
                80, "month", 1.5))
          .body["returns"];
  double by_sale = 0, by_month = 0;
  for (const Json& each : json["by_sale"]) by_sale += each["ahead"]["expected"].get<double>();
  for (const Json& each : json["forecast"]) by_month += each["of_units_in_use"].get<double>();
  EXPECT_NEAR(by_sale, by_month, 1e-6);
  const auto failed = [](double age) { return -std::expm1(-std::pow(age / 80, 1.5)); };
  const Json& last = json["forecast"][2];
  EXPECT_EQ(json["forecast"][0]["of_later_sales"], 0);
  EXPECT_NEAR(json["forecast"][1]["of_later_sales"].get<double>(), 1000 * failed(0.5), 1e-3);
  EXPECT_NEAR(last["of_later_sales"].get<double>(), 1000 * (failed(1.5) - failed(0.5)), 1e-3);
  EXPECT_NEAR(last["until_then"]["expected"].get<double>(), by_month + 1000 * failed(1.5), 1e-3);
  EXPECT_NEAR(last["cost_until_then"].get<double>(),
              10 * last["until_then"]["expected"].get<double>(), 1e-9);
  EXPECT_EQ(json["currency"], "EUR");
  // Units above the age of the warranty are not claimed.
  EXPECT_EQ(json["by_sale"][0]["ahead"]["expected"], 0);
  // 553 returns; those after 20 months in use are no claims.
  double observed = 0;
  for (const Json& each : json["fitted"]) observed += each["observed"].get<double>();
  EXPECT_LT(observed, 553);
  EXPECT_GT(observed, 530);
}

TEST_F(ReturnsStudyTest, HeldOutMonths) {
  const Json json = run(content("examples/warranty/returns.csv"),
                        study("hold_out = \"6 month\"\n", "", wide_scale, wide_shape))
                        .body["returns"];
  EXPECT_EQ(json["last"], "2025-06");
  EXPECT_EQ(json["held_out"]["periods"], 6);
  EXPECT_GE(json["held_out"]["inside"], 4);
  EXPECT_EQ(json["forecast"].size(), 6U);
  double later = 0;  // of the sales of the held-out months
  for (const Json& each : json["forecast"]) later += each["of_later_sales"].get<double>();
  EXPECT_GT(later, 0);
  EXPECT_GE(json["held_out"]["returned"], json["held_out"]["forecast"]["number_q05"]);
  EXPECT_LE(json["held_out"]["returned"], json["held_out"]["forecast"]["number_q95"]);
}

// Of rows with many units the check of fit judges as large a share of survivors as of failures.
TEST_F(ReturnsStudyTest, ManyUnitsFit) {
  constexpr int months = 8, units = 10000;
  Rng rng(20261129, 1);
  std::string table = "sold,units";
  for (int month = 1; month <= months; ++month) table += fmt::format(",{}", month);
  for (int sale = 1; sale <= months; ++sale) {
    std::vector<int> returns(months + 1);
    for (int unit = 0; unit < units; ++unit) {
      const double at = sale + std::floor(30 * std::pow(-std::log(rng.uniform()), 1 / 1.2) + 0.5);
      if (at <= months) ++returns[static_cast<std::size_t>(at)];
    }
    table += fmt::format("\n{},{}", sale, units);
    for (int month = 1; month <= months; ++month)
      table += month < sale ? "," : fmt::format(",{}", returns[static_cast<std::size_t>(month)]);
  }
  const Result result =
      run(table + "\n", study("period = \"month\"\n", "", wide_scale, wide_shape));
  for (const Check& each : result.posterior->checks)
    EXPECT_NE(each.verdict, Verdict::fail) << each.name << ": " << each.detail;
}

TEST_F(ReturnsStudyTest, Refusals) {
  const std::string table = content("examples/warranty/nevada.csv");
  const auto with = [&](const std::string& returns, const std::string& predict) {
    return refusal(table, study(returns, predict, wide_scale, wide_shape));
  };
  EXPECT_THAT(with("", "next = \"1.5 month\"\n"), HasSubstr("next: must be whole months"));
  EXPECT_THAT(with("", "next = \"0 month\"\n"), HasSubstr("must be whole months"));
  EXPECT_THAT(with("", "next = \"3 km\"\n"), HasSubstr("next"));
  EXPECT_THAT(with("", "next = \"1 month\"\ncost_per_return = \"much\"\n"),
              HasSubstr("cost_per_return"));
  EXPECT_THAT(with("period = \"week\"\n", ""), HasSubstr("the periods are months of the calendar"));
  EXPECT_THAT(with("ages = \"exact\"\n", ""), HasSubstr("middle"));
  EXPECT_THAT(with("warranty = \"0 month\"\n", ""), HasSubstr("warranty: must be positive"));
  EXPECT_THAT(with("delay_to_use = \"-1 month\"\n", ""), HasSubstr("must not be negative"));
  EXPECT_THAT(with("colour = 1\n", ""), HasSubstr("colour"));
  write("planned.csv", "month,units\n2010-10,1000\n");
  EXPECT_THAT(with("", "planned_sales = { file = \"planned.csv\" }\n"),
              HasSubstr("planned_sales: needs predict.next"));
  EXPECT_THAT(refusal(table, study("[data.columns]\nlife = \"x\"\n", "", wide_scale, wide_shape)),
              HasSubstr("data.columns"));
  std::string other = study("", "", wide_scale, wide_shape);
  other += "[random_effects.sold]\nscale = { distribution = \"lognormal\", log_sd = \"s\" }\n";
  EXPECT_THAT(refusal(table, other), HasSubstr("random_effects: is not possible"));
}

// Returns in the month of sale may all be dead on arrival: then the lives have no failure.
TEST_F(ReturnsStudyTest, PartsDeadOnArrivalAreNoFailures) {
  std::string text = study("period = \"month\"\n", "",
                           "{ distribution = \"flat\", unit = \"month\" }", wide_shape);
  text.insert(text.find("[prior]"), "share_dead_on_arrival = 0.02\n");
  EXPECT_THAT(refusal("sold,units,1,2\n1,100,3,0\n2,100,,2\n", text),
              HasSubstr("a failure of a part that was certainly not dead on arrival: then every "
                        "parameter needs a proper prior"));
  read("sold,units,1,2\n1,100,3,1\n2,100,,2\n", text);
}

// The long study is in tests/calibration.
TEST(ReturnsCoverage, HeldOutReturns) {
  constexpr std::size_t count = 40;
  std::vector<int> first(count), all(count);
  std::vector<double> expected(count), returned(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const SimulatedReturns one(60, 3, i);
    first[i] = one.first;
    all[i] = one.all;
    expected[i] = one.expected;
    returned[i] = one.returned;
  });
  int first_held = 0, all_held = 0;
  double sum = 0, square = 0;
  for (std::size_t i = 0; i < count; ++i) {
    first_held += first[i];
    all_held += all[i];
    sum += returned[i] - expected[i];
    square += (returned[i] - expected[i]) * (returned[i] - expected[i]);
  }
  // qbinom(1e-4, 40, 0.9)
  constexpr int least = 28;
  EXPECT_GE(first_held, least);
  EXPECT_GE(all_held, least);
  EXPECT_LT(std::abs(sum), 4 * std::sqrt(square));
}

}  // namespace
}  // namespace wearwell::formula_model
