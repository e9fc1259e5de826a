#include <gmock/gmock.h>

#include <algorithm>
#include <boost/math/distributions/gamma.hpp>
#include <cmath>

#include "support/messages.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/text_file.h"
#include "wearwell/models/registry.h"
#include "wearwell/study/model.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell::recurrence {
namespace {

using testing::HasSubstr;

class RecurrenceStudyTest : public ScratchTest {
 protected:
  std::unique_ptr<const Study> read(const std::string& process, const std::string& more) {
    write("d.csv",
          "unit,age "
          "[h],event\na,4.3,failure\na,10.2,failure\na,23.5,failure\na,26.4,failure\na,74,"
          "failure\na,92.1,"
          "failure\na,197.2,failure\na,200,end\n");
    const std::string head =
        "model = \"repairable\"\nprocess = \"" + process + "\"\n[data]\nfile = \"d.csv\"\n";
    write("study.toml",
          head + "[data.columns]\nunit = \"unit\"\nage = \"age\"\nevent = \"event\"\n" + more);
    return read_study(source_of(folder() / "study.toml"), all_models());
  }
  Result run(const std::string& process, const std::string& more) {
    return read(process, more)->run({.sampler = {}, .report = false}, {});
  }
  std::string refusal(const std::string& process, const std::string& more) {
    return message_of<InputError>([&] { read(process, more); });
  }
};

// Flat priors of the logarithms and one system that was observed for a fixed time: beta and M_T are independent, gamma
// distributed with the shape n, the scale 1/sum ln(T/t) and 1.
TEST_F(RecurrenceStudyTest, QuadratureHasTheClosedForm) {
  const Result result =
      run("power_law",
          "[prior]\nbeta = { distribution = \"jeffreys\" }\nM_T = { distribution = \"jeffreys\" }\n"
          "[predict]\nage = [\"200 h\"]\nnext = [\"100 h\"]\n");
  const double ages[] = {4.3, 10.2, 23.5, 26.4, 74, 92.1, 197.2};
  double logs = 0;
  for (const double age : ages) logs += std::log(200 / age);
  const boost::math::gamma_distribution<> beta(7, 1 / logs), number(7, 1);
  const auto& parameters = result.posterior->parameters;
  ASSERT_TRUE(parameters[0].exact && parameters[1].exact);
  EXPECT_NEAR(parameters[0].exact->mean, 7 / logs, 1e-4 * 7 / logs);
  EXPECT_NEAR(parameters[1].exact->mean, 7, 1e-3);
  for (const auto& [of, with] :
       {std::pair{*parameters[0].exact, beta}, std::pair{*parameters[1].exact, number}}) {
    EXPECT_NEAR(of.q05 / quantile(with, 0.05), 1, 2e-3);
    EXPECT_NEAR(of.q95 / quantile(with, 0.95), 1, 2e-3);
  }
  const auto& json = result.body["repairable"];
  EXPECT_NEAR(json["probability_beta_above_1"].get<double>(), cdf(complement(beta, 1)), 1e-3);
  // E[M_T (1.5^beta - 1)] = 7 ((1 - ln 1.5/sum)^-7 - 1).
  EXPECT_NEAR(json["forecast"][0]["expected"].get<double>(),
              7 * (std::pow(1 - std::log(1.5) / logs, -7) - 1), 0.02);
}

// With the prior 1/MTBF the intensity of a phase is gamma distributed, with the number of its failures and its time.
TEST_F(RecurrenceStudyTest, PhasesHaveTheClosedForm) {
  const Result result = run("phases",
                            "[conditions]\nphase_ends = [\"50 h\"]\n[prior]\nMTBF_1 = { "
                            "distribution = \"jeffreys\", unit = "
                            "\"h\" }\nMTBF_2 = { distribution = \"jeffreys\", unit = \"h\" }\n");
  const boost::math::gamma_distribution<> first(4, 1 / 50.0), second(3, 1 / 150.0);
  const auto& parameters = result.posterior->parameters;
  ASSERT_EQ(parameters.size(), 2U);
  EXPECT_NEAR(parameters[0].exact->q95 * quantile(first, 0.05), 1, 2e-3);
  EXPECT_NEAR(parameters[0].exact->q05 * quantile(first, 0.95), 1, 2e-3);
  EXPECT_NEAR(parameters[1].exact->q50 * quantile(second, 0.5), 1, 2e-3);
  EXPECT_FALSE(result.body["repairable"].contains("probability_beta_above_1"));
}

// Both processes have the same data and comparable factors.
TEST_F(RecurrenceStudyTest, ProcessesAreComparable) {
  const Result power = run("power_law", ""),
               renewal = run("renewal", "[predict]\nnext = [\"100 h\"]\n");
  EXPECT_EQ(power.header.data.fingerprint, renewal.header.data.fingerprint);
  ASSERT_TRUE(power.posterior->loo && renewal.posterior->loo);
  EXPECT_EQ(power.posterior->loo->loo.terms.size(), renewal.posterior->loo->loo.terms.size());
  EXPECT_EQ(power.posterior->density_unit, "h");
  EXPECT_EQ(renewal.body["repairable"]["forecast"].size(), 2U);
}

// predict.level and sides: quantiles of the same posterior, of the mean cumulative function and of forecasts.
TEST_F(RecurrenceStudyTest, BoundsHaveTheLevelThatTheStudyStates) {
  const std::string jeffreys =
      "[prior]\nbeta = { distribution = \"jeffreys\" }\nM_T = { distribution = \"jeffreys\" }\n"
      "[predict]\nage = [\"200 h\"]\nnext = [\"100 h\"]\n";
  const Result plain = run("power_law", jeffreys),
               both = run("power_law", jeffreys + "level = 0.9\nsides = \"both\"\n"),
               lower = run("power_law", jeffreys + "level = \"95 %\"\n"),
               upper = run("power_law", jeffreys + "level = 0.99\nsides = \"upper\"\n");
  const auto mtbf = [](const Result& result) {
    return result.posterior->quantities.front().best();
  };
  EXPECT_FALSE(mtbf(plain).bound || mtbf(plain).upper_bound);
  EXPECT_NEAR(*mtbf(both).bound / mtbf(plain).q05, 1, 1e-9);
  EXPECT_NEAR(*mtbf(both).upper_bound / mtbf(plain).q95, 1, 1e-9);
  EXPECT_NEAR(*mtbf(lower).bound / mtbf(plain).q05, 1, 1e-9);  // one-sided 95 %
  EXPECT_FALSE(mtbf(lower).upper_bound);
  EXPECT_FALSE(mtbf(upper).bound);
  EXPECT_GT(*mtbf(upper).upper_bound, mtbf(plain).q95);
  EXPECT_FALSE(plain.body["repairable"].contains("level"));
  EXPECT_EQ(upper.body["repairable"]["sides"], "upper");
  const auto& row = both.body["repairable"]["forecast"][0];
  EXPECT_NEAR(row["bounds"]["expected_lower"].get<double>(), row["expected_q05"].get<double>(),
              1e-9);
  EXPECT_EQ(row["bounds"]["number_upper"], row["number_q95"]);
  EXPECT_FALSE(lower.body["repairable"]["forecast"][0]["bounds"].contains("number_upper"));
  // One unit shows no variance, so the bounds of the mean cumulative function are those of two.
  const auto steps = [&](const std::string& more) {
    read("power_law", more);
    write("d.csv", "unit,age [h],event\na,10,failure\na,50,end\nb,20,failure\nb,50,end\n");
    return read_study(source_of(folder() / "study.toml"), all_models())
        ->run({.sampler = {}, .report = false}, {})
        .body["repairable"]["mcf"];
  };
  const auto wide = steps("[predict]\nlevel = 0.95\nsides = \"both\"\n");
  EXPECT_NEAR(std::log(wide[0]["high"].get<double>() / wide[0]["mean"].get<double>()),
              1.959964 * wide[0]["se"].get<double>() / wide[0]["mean"].get<double>(), 1e-6);
}

// ReliaSoft's development test (tests/golden/crow_bounds.R): published are beta 0.6142, lambda 0.4239, an MTBF of 45.883 h, and
// Fisher bounds of 90 % of the cumulative intensity of 0.02499/h and 0.05039/h.
TEST_F(RecurrenceStudyTest, ClassicalEstimatesAreThoseOfReliaSoft) {
  read("power_law",
       "[predict]\nage = [\"620 h\"]\nlevel = 0.9\nsides = \"both\"\nclassical = true\n");
  std::string table = "unit,age [h],event\n";
  for (const char* age : {"2.7",   "10.3",  "12.5",  "30.6",  "57.0",  "61.3",  "80.0",  "109.5",
                          "125.0", "128.6", "143.8", "167.9", "229.2", "296.7", "320.6", "328.2",
                          "366.2", "396.7", "421.1", "438.2", "501.2", "620.0"})
    table += std::string("a,") + age + ",failure\n";
  write("d.csv", table);
  std::string text = read_text_file(folder() / "study.toml").text;
  text.insert(text.find("[data.columns]"), "end = \"last failure\"\n");
  write("study.toml", text);
  const Result result = read_study(source_of(folder() / "study.toml"), all_models())
                            ->run({.sampler = {}, .report = false}, {});
  const auto& classical = result.body["classical"];
  const auto& maximum = classical["maximum_likelihood"];
  const auto& beta = maximum["parameters"][0];
  const auto number = [](const auto& json) { return json.template get<double>(); };
  EXPECT_NEAR(number(beta["value"]), 0.6142104, 1e-6);
  EXPECT_NEAR(number(beta["standard_error"]), 0.6142104 / std::sqrt(22.0), 1e-5);
  // The published covariances rest on rounded estimates.
  EXPECT_NEAR(number(beta["standard_error"]), std::sqrt(0.017105343), 2e-4);
  EXPECT_NEAR(number(beta["exact"]["lower"]), 0.392872, 1e-5);
  EXPECT_NEAR(number(beta["exact"]["upper"]), 0.8113725, 1e-5);
  EXPECT_NEAR(number(maximum["parameters"][1]["value"]), 22, 1e-4);
  const auto& lambda = maximum["quantities"][0];
  EXPECT_NEAR(number(lambda["value"]), 0.4239422, 1e-6);
  EXPECT_NEAR(number(lambda["standard_error"]), std::sqrt(0.13519969), 1e-3);
  const auto& mtbf = maximum["quantities"][2];
  EXPECT_EQ(mtbf["at"], "at age 620 h");
  EXPECT_NEAR(number(mtbf["value"]), 45.883, 5e-4);
  EXPECT_NEAR(number(mtbf["exact"]["lower"]), 30.74451, 1e-3);
  EXPECT_NEAR(number(mtbf["exact"]["upper"]), 84.79723, 1e-3);
  const auto& per_failure = maximum["quantities"][3];
  EXPECT_NEAR(1 / number(per_failure["normal"]["upper"]), 0.02499, 5e-6);
  EXPECT_NEAR(1 / number(per_failure["normal"]["lower"]), 0.05039, 5e-6);
  EXPECT_NEAR(number(classical["unbiased"][0]["value"]), 0.6142104 * 20 / 22, 1e-6);
  // Crow's bounds of lambda (RGA): quantiles of chi-square with 44 degrees of freedom over 2 T^beta.
  const auto& given = classical["lambda_given_beta"];
  EXPECT_EQ(given["name"], "lambda, t in h");
  EXPECT_NEAR(number(given["lower"]), 29.78748 / 2 * 0.4239422 / 22, 1e-5);
  EXPECT_NEAR(number(given["upper"]), 60.48089 / 2 * 0.4239422 / 22, 1e-5);
}

// With phases the maximum is time over failures; likelihood-ratio and exact bounds enclose it.
TEST_F(RecurrenceStudyTest, ClassicalEstimatesOfPhases) {
  const Result result =
      run("phases", "[conditions]\nphase_ends = [\"50 h\"]\n[predict]\nclassical = true\n");
  const auto& classical = result.body["classical"];
  EXPECT_EQ(classical["sides"], "two");
  const auto& phase = classical["maximum_likelihood"]["parameters"][1];
  EXPECT_NEAR(phase["value"].get<double>(), 50, 1e-4);
  using boost::math::gamma_distribution;
  EXPECT_NEAR(phase["exact"]["lower"].get<double>(), 150 / quantile(gamma_distribution<>(4), 0.95),
              1e-6);
  EXPECT_NEAR(phase["exact"]["upper"].get<double>(), 150 / quantile(gamma_distribution<>(3), 0.05),
              1e-6);
  EXPECT_FALSE(classical.contains("unbiased"));
  EXPECT_FALSE(classical.contains("lambda_given_beta"));
}

// Failures that are counted by interval. RGA's grouped example: beta 0.6315, lambda 0.0701. MIL-HDBK-189: beta 0.753, lambda
// 1.53, chi-square 5.5 with three degrees of freedom.
TEST_F(RecurrenceStudyTest, GroupedFailuresAreThoseOfReliaSoftAndTheHandbook) {
  const auto fit = [&](const std::string& rows) {
    write("d.csv", "unit,age [h],count\n" + rows);
    write("study.toml",
          "model = \"repairable\"\nprocess = \"power_law\"\n[data]\nfile = \"d.csv\"\ngrouped = "
          "true\n[data.columns]\nunit = \"unit\"\nage = \"age\"\ncount = \"count\"\n[predict]\n"
          "level = 0.9\nsides = \"both\"\nclassical = true\n");
    return read_study(source_of(folder() / "study.toml"), all_models())
        ->run({.sampler = {}, .report = false}, {})
        .body;
  };
  const auto number = [](const auto& json) { return json.template get<double>(); };
  const auto runs = fit("a,200,2\na,400,1\na,600,1\na,3000,7\n");
  const auto& maximum = runs["classical"]["maximum_likelihood"];
  EXPECT_NEAR(number(maximum["parameters"][0]["value"]), 0.6315, 5e-5);
  EXPECT_NEAR(number(maximum["quantities"][0]["value"]), 0.0701, 5e-5);
  EXPECT_FALSE(maximum["parameters"][0].contains("exact"));
  EXPECT_TRUE(maximum["parameters"][1].contains("exact"));
  EXPECT_FALSE(runs["classical"].contains("unbiased"));
  EXPECT_TRUE(runs["repairable"]["tests"]["laplace"].contains("problem"));
  EXPECT_TRUE(runs["repairable"]["tests"]["chi_square"].contains("problem"));
  const auto handbook = fit("a,20,13\na,40,16\na,60,5\na,80,8\na,100,7\n");
  const auto& estimates = handbook["classical"]["maximum_likelihood"];
  EXPECT_NEAR(number(estimates["parameters"][0]["value"]), 0.753, 5e-4);
  EXPECT_NEAR(number(estimates["quantities"][0]["value"]), 1.53, 5e-3);
  const auto& test = handbook["repairable"]["tests"]["chi_square"];
  EXPECT_NEAR(number(test["statistic"]), 5.45, 5e-3);
  EXPECT_NEAR(number(test["p"]), 0.1416, 1e-3);  // R: pchisq(5.450432, 3, lower.tail = FALSE)
  EXPECT_FALSE(handbook["repairable"]["tests"].contains("cramer_von_mises"));
}

// What needs the ages of the failures is refused, and phases that divide an interval.
TEST_F(RecurrenceStudyTest, WhatCountsByIntervalDoNotAnswer) {
  const auto refused = [&](const std::string& process, const std::string& more) {
    write("d.csv", "unit,age [h],count\na,20,13\na,40,16\n");
    write("study.toml", "model = \"repairable\"\nprocess = \"" + process +
                            "\"\n[data]\nfile = \"d.csv\"\ngrouped = true\n[data.columns]\nunit = "
                            "\"unit\"\nage = \"age\"\ncount = \"count\"\n" +
                            more);
    return message_of<InputError>(
        [&] { read_study(source_of(folder() / "study.toml"), all_models()); });
  };
  EXPECT_THAT(refused("renewal", ""), HasSubstr("the age of each failure"));
  EXPECT_THAT(refused("phases", "[conditions]\nphase_ends = [\"30 h\"]\n"),
              HasSubstr("within the interval from 20 h to 40 h of unit 'a'"));
}

// A growth test of one unit with modes; `fixes` follows the columns.
class GrowthTestStudyTest : public RecurrenceStudyTest {
 protected:
  std::unique_ptr<const Study> read_modes(const std::string& rows, const std::string& fixes,
                                          const std::string& process = "power_law") {
    write("d.csv", "unit,age [h],event,mode\n" + rows);
    write("study.toml", "model = \"repairable\"\nprocess = \"" + process +
                            "\"\n[data]\nfile = \"d.csv\"\n[data.columns]\nunit = \"unit\"\nage = "
                            "\"age\"\nevent = \"event\"\nmode = \"mode\"\n" +
                            fixes);
    return read_study(source_of(folder() / "study.toml"), all_models());
  }
  std::string refusal_of(const std::string& rows, const std::string& fixes,
                         const std::string& process = "power_law") {
    return message_of<InputError>([&] { read_modes(rows, fixes, process); });
  }
  const std::string rows = "a,10,failure,seal\na,30,failure,pump\na,70,failure,seal\na,100,end,\n";
  const std::string good = "[fixes]\nnone = \"pump\"\n[fixes.effectiveness]\nseal = 0.7\n";
};

// The example has the published estimates, beside the posterior, in summary.json and in the text.
TEST_F(GrowthTestStudyTest, ExampleHasThePublishedProjection) {
  const Result result =
      read_study(source_of(PROJECT_SOURCE_DIR "/examples/repairable/delayed_fixes.toml"),
                 all_models())
          ->run({.sampler = {}, .report = false}, {});
  const auto& projection = result.body["repairable"]["projection"];
  EXPECT_NEAR(projection["beta"]["crow"].get<double>(), 0.7472, 1e-4);
  EXPECT_NEAR(projection["demonstrated"]["crow"].get<double>(), 7.84708, 1e-5);
  EXPECT_NEAR(projection["projected"]["crow"].get<double>(), 11.29418, 1e-5);
  EXPECT_NEAR(projection["growth_potential"]["crow"].get<double>(), 14.92852, 1e-5);
  EXPECT_NEAR(projection["projected"]["q05"].get<double>(), 9.0615, 0.1);
  EXPECT_EQ(projection["projected"]["unit"], "h");
  EXPECT_EQ(projection["failures"]["delayed"], 32);
  EXPECT_EQ(projection["modes"].size(), 29U);
  const auto& groups = result.posterior->quantities;
  const auto after = std::find_if(groups.begin(), groups.end(), [](const auto& each) {
    return each.at == "after the delayed fixes";
  });
  ASSERT_NE(after, groups.end());
  EXPECT_NEAR(after->best().q50, projection["projected"]["q50"].get<double>(), 1e-9);
}

TEST_F(GrowthTestStudyTest, UnitsOfAgesAndDistributionsOfFactorsAreRead) {
  const Result hours = read_modes(rows, good)->run({.sampler = {}, .report = false}, {});
  const Result spread =
      read_modes(rows,
                 "[fixes]\nnone = \"pump\"\n[fixes.effectiveness]\nseal = { distribution = "
                 "\"beta\", alpha = 7, beta = 3 }\n")
          ->run({.sampler = {}, .report = false}, {});
  const auto& mode = spread.body["repairable"]["projection"]["modes"][0];
  EXPECT_EQ(mode["stated"], "beta");
  EXPECT_NEAR(mode["effectiveness"].get<double>(), 0.7, 1e-3);
  EXPECT_FALSE(hours.body["repairable"]["projection"]["projected"].contains("crow"));
  EXPECT_GT(hours.body["repairable"]["projection"]["projected"]["q50"].get<double>(), 20);
}

TEST_F(GrowthTestStudyTest, Refusals) {
  const std::string factors = "[fixes.effectiveness]\nseal = 0.7\n";
  EXPECT_THAT(refusal_of(rows, ""), HasSubstr("the study has no [fixes]"));
  EXPECT_THAT(refusal_of(rows, "[fixes]\n" + factors),
              HasSubstr("does not name mode 'pump' (1 failure, the first at 30 h)"));
  EXPECT_THAT(refusal_of(rows, "[fixes]\nnone = [\"pump\", \"valve\"]\n" + factors),
              HasSubstr("names mode 'valve', but no failure has this mode"));
  EXPECT_THAT(refusal_of(rows, "[fixes]\nnone = [\"pump\", \"seal\"]\n" + factors),
              HasSubstr("names mode 'seal', which is in fixes.none"));
  EXPECT_THAT(refusal_of(rows, "[fixes]\nnone = \"pump\"\n[fixes.effectiveness]\nseal = 70\n"),
              HasSubstr("seal: is 70; the effectiveness of a fix is between 0"));
  EXPECT_THAT(refusal_of(rows, "[fixes]\nnone = [\"pump\", \"seal\"]\n"),
              HasSubstr("effectiveness"));
  EXPECT_THAT(refusal_of(rows, good, "renewal"), HasSubstr("process"));
  EXPECT_THAT(refusal_of("a,10,failure,\na,100,end,\n", good), HasSubstr("row 1, column 'mode'"));
  EXPECT_THAT(refusal_of("a,10,failure,seal\na,100,end,pump\n", good),
              HasSubstr("'pump' is a failure mode in the row of an end of observation"));
  EXPECT_THAT(refusal_of(rows + "b,20,failure,seal\nb,90,end,\n", good),
              HasSubstr("unit 'a' is 100 h and that of unit 'b' is 90 h"));
  EXPECT_THAT(refusal("power_law", "[fixes]\nnone = \"pump\"\n" + factors),
              HasSubstr("data.columns.mode"));
}

TEST_F(RecurrenceStudyTest, Refusals) {
  EXPECT_THAT(refusal("power_law", "[predict]\nb_lives = [10]\n"), HasSubstr("fail once"));
  EXPECT_THAT(refusal("power_law", "[predict]\nlevel = 0.4\n"), HasSubstr("must exceed 50 %"));
  EXPECT_THAT(refusal("power_law", "[predict]\nlevel = 95\n"), HasSubstr("between 0 and 1"));
  EXPECT_THAT(refusal("power_law", "[predict]\nsides = \"left\"\n"), HasSubstr("sides"));
  EXPECT_THAT(refusal("repair", ""), HasSubstr("power_law"));
  EXPECT_THAT(refusal("renewal", "[predict]\nage = [\"100 h\"]\n"), HasSubstr("does not matter"));
  EXPECT_THAT(refusal("renewal", "[conditions]\nreference_age = \"100 h\"\n"),
              HasSubstr("renewal process has none"));
  EXPECT_THAT(refusal("power_law", "[conditions]\nphase_ends = [\"100 h\"]\n"),
              HasSubstr("belongs to process"));
  EXPECT_THAT(refusal("phases", "[conditions]\nphase_ends = [\"100 h\", \"90 h\"]\n"),
              HasSubstr("ascending"));
  EXPECT_THAT(refusal("phases", "[conditions]\nphase_ends = [\"200 h\"]\n"),
              HasSubstr("no unit was observed beyond 200 h"));
  EXPECT_THAT(refusal("power_law", "[predict]\nnext = [\"0 h\"]\n"), HasSubstr("must be positive"));
  EXPECT_THAT(refusal("power_law", "[predict]\nnext = [\"5 km\"]\n"), HasSubstr("next"));
  EXPECT_THAT(refusal("power_law", "[update]\nstages = \"row\"\n"), HasSubstr("not possible"));
}

}  // namespace
}  // namespace wearwell::recurrence
