// `wearwell bearing` as its user meets it.
#include <gmock/gmock.h>

#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "support/run_command.h"

namespace wearwell {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

double relative(double value, double expected) {
  return std::abs(value - expected) / std::abs(expected);
}

ordered_json answer(const std::string& arguments) {
  const CommandResult run = run_wearwell("bearing " + arguments + " --json");
  EXPECT_EQ(run.exit_code, 0) << arguments << "\n" << run.err;
  return ordered_json::parse(run.out);
}

const std::string first_example =
    " --contact stationary --radius '20 mm' --clearance '20 um' --pressure '1 MPa' --revolutions "
    "1e5";

// The paper's examples; digits from tests/golden/bearing_examples.py.
TEST(BearingCommand, WorkedExamples) {
  const auto rate = answer("rate --depth '0.1 mm'" + first_example);
  EXPECT_LT(relative(rate["wear_number"], 7.185812700472977e-4), 1e-14);
  EXPECT_LT(relative(rate["value"], 7.185812700472977e-15), 1e-14);
  EXPECT_EQ(rate["unit"], "m^3/(N m)");
  const auto depth = answer(
      "depth --contact stationary --radius '10 mm' --clearance '20 um' --rate '1e-16 m^3/(N m)' "
      "--pressure '2 MPa' --revolutions 1e6");
  EXPECT_LT(relative(depth["delta"], 18.67228112810098e-4), 1e-14);
  EXPECT_LT(relative(depth["value"], 18.67228112810098e-3), 1e-14);
  EXPECT_EQ(depth["unit"], "mm");
}

TEST(BearingCommand, JsonHasItsKeysInOrder) {
  const auto keys = [](const ordered_json& object) {
    std::vector<std::string> list;
    for (const auto& [key, value] : object.items()) list.push_back(key);
    return list;
  };
  const std::vector<std::string> expected = {"quantity", "contact",     "value",
                                             "unit",     "wear_number", "sigma",
                                             "delta",    "scar_width",  "interval"};
  const auto certain = answer("rate --depth '0.1 mm'" + first_example);
  EXPECT_EQ(keys(certain), expected);
  EXPECT_EQ(certain["quantity"], "rate");
  EXPECT_EQ(certain["contact"], "stationary");
  EXPECT_DOUBLE_EQ(certain["sigma"], 0.001);
  EXPECT_DOUBLE_EQ(certain["delta"], 0.005);
  EXPECT_EQ(keys(certain["scar_width"]), (std::vector<std::string>{"value", "unit"}));
  EXPECT_TRUE(certain["interval"].is_null());
  const auto even = answer(
      "rate --contact journal --radius '20 mm' --clearance '20 um' --pressure '1 MPa' "
      "--revolutions "
      "1e5 --depth '0.1 +- 0.01 mm'");
  EXPECT_EQ(keys(even), expected);
  EXPECT_TRUE(even["scar_width"].is_null());
  EXPECT_EQ(keys(even["interval"]), (std::vector<std::string>{"q05", "q50", "q95"}));
}

// Each quantity from the others, beginning with a depth of 0.0625 mm, in every contact.
TEST(BearingCommand, InverseSolvesAgreeWithForwardOne) {
  for (const std::string contact : {"stationary", "journal", "bushing"}) {
    const std::string bearing =
        " --contact " + contact + " --radius '10 mm' --clearance '0.015 mm' ";
    const std::string force = " --force '640 N' --length '16 mm' ";  // 2 MPa
    const std::string turns = " --speed '150 rpm' --time '80 h' ";   // 720000 revolutions
    const double k = answer("rate --depth '62.5 um'" + bearing + force + turns)["value"];
    std::ostringstream rate;
    rate.precision(17);
    rate << " --rate '" << k << " m^3/(N m)' ";
    const std::string known = " --depth '62.5 um'" + bearing + rate.str();
    const auto agrees = [](const ordered_json& json, double expected, const std::string& unit) {
      EXPECT_LT(relative(json["value"], expected), 1e-12) << json;
      EXPECT_EQ(json["unit"], unit);
    };
    agrees(answer("depth" + bearing + rate.str() + force + turns), 0.0625, "mm");
    agrees(answer("depth" + bearing + rate.str() + " --pressure '2 MPa' --revolutions 720000"),
           0.0625, "mm");
    agrees(answer("pressure" + known + turns), 2, "MPa");
    agrees(answer("length --force '640 N'" + known + turns), 16, "mm");
    agrees(answer("life" + known + force), 720000, "revolutions");
    agrees(answer("life --speed '150 rpm'" + known + force), 80, "h");
    agrees(answer("life --speed '150 rpm' --unit min" + known + force), 4800, "min");
    agrees(answer("pressure --unit 'N/cm^2'" + known + turns), 200, "N/cm^2");
  }
}

// 150 rpm, 150 revolutions a minute, 2.5 Hz and 5 pi rad/s are one speed.
TEST(BearingCommand, ADiameterIsTwiceTheRadius) {
  const std::string rest =
      " --contact stationary --clearance '20 um' --depth '0.1 mm' --pressure '1 MPa' --revolutions "
      "1e5 --json";
  const auto radius = run_wearwell("bearing rate --radius '20 +- 0.1 mm'" + rest);
  const auto diameter = run_wearwell("bearing rate --diameter '40 +- 0.2 mm'" + rest);
  ASSERT_EQ(diameter.exit_code, 0) << diameter.err;
  const auto a = ordered_json::parse(radius.out), b = ordered_json::parse(diameter.out);
  EXPECT_EQ(a["value"], b["value"]);
  EXPECT_NEAR(double(b["interval"]["q95"]) / double(a["interval"]["q95"]), 1, 2e-4);
  const auto both = run_wearwell("bearing rate --diameter '40 mm' --radius '20 mm'" + rest);
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_THAT(both.err, testing::HasSubstr("--diameter and --radius are both given; keep one"));
}

// A life is one over a lognormal rate: B10 is that of the 90 % rate, factor^1.2816 above the median.
TEST(BearingCommand, LifeHasAB10WhenInputsAreUncertain) {
  const std::string life =
      "bearing life --contact journal --radius '10 mm' --clearance '20 um' --depth '50 um' "
      "--pressure '2 MPa' --speed '60 rpm' --rate '1e-16 m^3/(N m) x/ 2'";
  const auto run = run_wearwell(life + " --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "") << "no draw of a lognormal is impossible";
  const auto result = ordered_json::parse(run.out);
  EXPECT_NEAR(double(result["interval"]["b10"]) / double(result["value"]), std::pow(2, -1.2815516),
              0.01);
  EXPECT_NEAR(double(result["interval"]["q50"]) / double(result["value"]), 1, 0.01);
  EXPECT_THAT(run_wearwell(life).out,
              testing::ContainsRegex("\nB10 life: 1\u202f4[23][0-9] h: one in ten reaches"));
}

// A normal law of +- 200 % is three draws in ten below zero.
TEST(BearingCommand, TellsOfALognormalWhereANormalLawIsTooWide) {
  const auto run = run_wearwell(
      "bearing depth --contact journal --radius '10 mm' --clearance '20 um' --pressure '2 MPa' "
      "--revolutions 1e6 --rate '1e-16 m^3/(N m) +- 200 %'");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, testing::HasSubstr("31 % of all"));
  EXPECT_THAT(run.err, testing::HasSubstr("use a lognormal for --rate"));
  EXPECT_THAT(run.err, testing::HasSubstr("'1e-16 m^3/(N m) x/ 3.6'"));
}

TEST(BearingCommand, CountsTurnsWhateverTheUnit) {
  const std::string bearing =
      "pressure --contact bushing --radius '10 mm' --clearance '20 um' --depth '50 um' "
      "--rate '1e-16 m^3/(N m)' ";
  const double expected = answer(bearing + "--revolutions 9000")["value"];
  for (const std::string speed : {"150 rpm", "150 1/min", "2.5 Hz", "150 U/min",
                                  "150 revolution/min", "15.707963267948966 rad/s"})
    EXPECT_LT(relative(answer(bearing + "--time '1 h' --speed '" + speed + "'")["value"], expected),
              1e-14)
        << speed;
  for (const std::string count : {"9000 turns", "9 krev", "0.009 Mcycles", "9e3"})
    EXPECT_LT(relative(answer(bearing + "--revolutions '" + count + "'")["value"], expected), 1e-14)
        << count;
}

TEST(BearingCommand, RefusesWhatHasTwoReadings) {
  const std::string bearing =
      "life --contact journal --radius '9 mm' --clearance '25 um' --depth '40 um' --rate '2e-16 "
      "m^3/(N m)' --pressure '3 MPa' ";
  const auto refusal = [&](const std::string& arguments) {
    const CommandResult run = run_wearwell("bearing " + bearing + arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments;
    EXPECT_EQ(run.out, "");
    return run.err;
  };
  EXPECT_THAT(refusal("--speed '40 1/s'"),
              testing::AllOf(HasSubstr("--speed: '40 1/s'"), HasSubstr("40 rev/s = 251.3 rad/s"),
                             HasSubstr("40 rad/s = 6.366 rev/s")));
  EXPECT_THAT(refusal("--speed 40"), testing::Not(HasSubstr("1/s")));
  EXPECT_THAT(refusal("--speed '40 rpm' --unit 1/min"), HasSubstr("reciprocal"));
  EXPECT_THAT(refusal("--unit rad"), HasSubstr("--unit: unit 'rad' contains an angle"));
  EXPECT_THAT(refusal("--revolutions '5 krev +- 30'"), HasSubstr("--revolutions"));
}

// Even wear has a rate that grows with depth, so the quantiles of the rate are those of the depth:
// k = (2 d/r + (d/r)^2)/(4 p n), d = 0.1 mm +- 1.6449 x 0.01 mm. A quantile of 10^6 draws at 5 %
// has a standard error of 0.0021 sd; five are allowed.
TEST(BearingCommand, IntervalOfNormalDepth) {
  const auto json = answer(
      "rate --contact journal --radius '20 mm' --clearance '20 um' --pressure '1 MPa' "
      "--revolutions "
      "1e5 --draws 1000000 --depth '0.1 +- 0.01 mm'");
  const auto rate = [](double z) {
    const double delta = (0.1 + z * 0.01) / 20;
    return delta * (2 + delta) / 4 / 1e11;
  };
  const double allowed = 5 * 0.0021 * (rate(1) - rate(0));
  EXPECT_NEAR(json["interval"]["q05"], rate(-1.6448536), allowed);
  EXPECT_NEAR(json["interval"]["q50"], rate(0), allowed);
  EXPECT_NEAR(json["interval"]["q95"], rate(1.6448536), allowed);
  EXPECT_LT(relative(json["value"], rate(0)), 1e-14);
}

// p = w/(k n) with k lognormal of mean m and standard deviation s: log p is normal, its median
// w sqrt(1 + s^2/m^2)/(m n), its standard deviation sqrt(log(1 + s^2/m^2)).
TEST(BearingCommand, IntervalOfLognormalRate) {
  const auto json = answer(
      "pressure --contact bushing --radius '10 mm' --clearance '20 um' --depth '50 um' "
      "--revolutions "
      "1e6 --rate '~ lognormal(1e-16 m^3/(N m), 3e-17 m^3/(N m))' --draws 1000000");
  const double zeta = std::sqrt(std::log(1.09));
  const double median = 0.00251125 * std::sqrt(1.09) / 1e-10 / 1e6;  // MPa
  EXPECT_NEAR(std::log(json["interval"]["q50"].get<double>() / median), 0, 0.01 * zeta);
  EXPECT_NEAR(std::log(json["interval"]["q05"].get<double>() / median), -1.6448536 * zeta,
              0.01 * zeta);
  EXPECT_NEAR(std::log(json["interval"]["q95"].get<double>() / median), 1.6448536 * zeta,
              0.01 * zeta);
}

TEST(BearingCommand, SameSeedSameInterval) {
  const std::string rate = "rate --depth '0.1 +- 0.01 mm'" + first_example;
  EXPECT_EQ(answer(rate + " --seed 7"), answer(rate + " --seed 7"));
  EXPECT_NE(answer(rate + " --seed 7")["interval"], answer(rate + " --seed 8")["interval"]);
}

TEST(BearingCommand, SaysThatMarginIsSmall) {
  const std::string depth =
      "bearing depth --contact stationary --radius '10 mm' --clearance '20 um' --pressure '2 MPa' "
      "--revolutions 1e6 --rate '1e-16 m^3/(N m)' --limit ";
  // 1 - 18.672281/20 = 6.64 %; the wear number at 20e-4 is 2.1821328e-4 by
  // tests/golden/circle_area.py.
  EXPECT_NE(run_wearwell(depth + "'20 um'")
                .out.find("The depth is 6.64 % below the limit of 20 um, a small margin; a rate, "
                          "pressure or number of revolutions 9.11 % higher would reach it."),
            std::string::npos);
  EXPECT_EQ(run_wearwell(depth + "'40 um'").out.find("small"), std::string::npos);
  EXPECT_NE(run_wearwell(depth + "'15 um'").out.find("24.5 % above the limit"), std::string::npos);
  const CommandResult json = run_wearwell(depth + "'20 um' --json");
  EXPECT_TRUE(ordered_json::accept(json.out));
  EXPECT_NE(json.err.find("a small margin"), std::string::npos);
}

// By the paper's formulas the scar of the first example has cos(alpha) = 0.16375; for small
// clearance the amplification is (1 + cos(alpha))/cos(alpha)^2 = 43.4, and 42.0 at this one (the
// slope of a 120-digit evaluation).
TEST(BearingCommand, WarnsOfScarWidth) {
  const CommandResult run =
      run_wearwell("bearing rate --scar-width '39.46007475917905 mm' --json" + first_example);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_LT(relative(ordered_json::parse(run.out)["delta"], 0.005), 1e-13);
  EXPECT_NE(run.err.find("warning: the scar width is a poor measure of the depth"),
            std::string::npos);
  EXPECT_NE(run.err.find("amplification factor 42.01"), std::string::npos);
}

TEST(BearingCommand, WarnsOfSlot) {
  EXPECT_NE(run_wearwell("bearing rate --depth '5 mm'" + first_example).err.find("cuts a slot"),
            std::string::npos);
  EXPECT_EQ(run_wearwell("bearing rate --depth '0.1 mm'" + first_example).err, "");
}

TEST(BearingCommand, ImpossibleRequestsExitWithTwoAndOneSentence) {
  const std::string rest = " --radius '20 mm' --pressure '1 MPa' --revolutions 1e5 ";
  const std::string stationary = "--contact stationary" + rest;
  struct Case {
    std::string arguments, message;
  };
  const std::vector<Case> cases = {
      {"rate " + stationary + "--clearance '-20 um' --depth '0.1 mm'",
       "--clearance: '-20 um' must be positive"},
      {"rate " + stationary + "--clearance '0 um' --depth '0.1 mm'",
       "--clearance: '0 um' must be positive"},
      {"rate " + stationary + "--clearance '20 um' --depth '41 mm'",
       "depth/radius is 2.05; at 2 and above the whole journal is outside the bushing's bore"},
      {"rate --contact journal" + rest + "--clearance '20 um' --depth '21 mm'",
       "depth/radius is 1.05; a journal cannot wear by more than 1"},
      {"rate " + stationary + "--clearance '20 um'",
       "depth is missing: the rate needs depth (or scar width)"},
      {"rate " + stationary + "--clearance '20 um' --depth '0.1 mm' --scar-width '1 mm'",
       "both depth and scar width are given; give one or the other"},
      {"rate " + stationary + "--clearance '20 um' --depth '0.1 mm' --force '10 N'",
       "both pressure and force and length are given; give one or the other"},
      {"rate " + stationary + "--clearance '20 um' --depth '0.1 mm' --rate '1e-16 m^3/(N m)'",
       "rate is given, but the rate does not depend on it"},
      {"rate " + stationary + "--clearance '20 um' --depth '0.1 N'",
       "--depth: unit 'N' has the wrong dimension (expected one like 'm')"},
      {"rate " + stationary + "--clearance '20 um' --depth 0.1",
       "--depth: '0.1' has no unit (write one like '0.1 m')"},
      {"rate " + stationary + "--clearance '20 um' --depth '0.1 mm' --unit mm",
       "--unit: unit 'mm' has the wrong dimension (expected one like 'm^3/(N m)')"},
      {"rate " + stationary + "--clearance '20 um' --depth '0.1 mm' --draws 10",
       "--draws is 10; it must be 100 to 10000000"},
      {"rate " + stationary + "--clearance '20 um' --depth '0.1 +- 30 mm'",
       "the uncertainties are too wide: most draws are impossible"},
      {"rate --contact bushing" + rest + "--clearance '20 um' --scar-width '1 mm'",
       "scar width is given, but only a stationary contact leaves a scar"},
      {"rate " + stationary + "--clearance '20 um' --scar-width '41 mm'",
       "scar width/radius is 2.05; it must be above 0 and below 2"},
      {"depth " + stationary + "--clearance '20 um' --rate '1e-11 m^3/(N m)'",
       "wear number p_a k n is "},
      {"depth " + stationary + "--clearance '20 um' --rate '1e-15 m^3/(N m)' --limit '50 mm'",
       "--limit: depth/radius is 2.5"},
      {"rate --contact radial", "--contact: 'radial' is not one of"},
      {"rate", "--contact is missing"},
      {"chart --sigma 0,1e-3", "clearance/radius is 0; a bearing needs a clearance above 0"},
      {"chart -o chart.pdf", "--output: chart.pdf must end in .html or .csv"},
      {"chart -o /proc/nowhere/chart.html", "cannot write to /proc/nowhere"},
      {"chart --delta 1e-3:1e-4:5", "--delta: '1e-3:1e-4:5' is not FROM:TO:COUNT"},
      {"chart --radius '20 mm' --clearance '20 um'", "depth is missing"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.arguments);
    const CommandResult run = run_wearwell("bearing " + c.arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(run.err.find("wearwell: " + c.message), 0u) << run.err;
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << run.err;
  }
  EXPECT_EQ(run_wearwell("bearing").exit_code, 2);
  EXPECT_EQ(run_wearwell("bearing rate --colour red").exit_code, 2);
}

TEST(BearingCommand, HelpShowsItsExamplesAndHidesTheAnswer) {
  for (const std::string command : {"rate", "depth", "pressure", "length", "life"}) {
    const CommandResult run = run_wearwell("bearing " + command + " --help");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.out.find("\n  --" + command + " "), std::string::npos);
    // The example runs as it stands.
    const auto at = run.out.find("Example:\n  wearwell ");
    ASSERT_NE(at, std::string::npos);
    const CommandResult example = run_wearwell(run.out.substr(at + 20));
    EXPECT_EQ(example.exit_code, 0) << example.err;
  }
}

std::vector<std::vector<std::string>> rows(const std::string& csv) {
  std::vector<std::vector<std::string>> result;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    result.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) result.back().push_back(cell);
  }
  return result;
}

TEST(BearingChart, HasTheCurvesOfThePaper) {
  const auto table = rows(run_wearwell("bearing chart").out);
  ASSERT_EQ(table.size(), 1u + 4 * 181);
  EXPECT_EQ(table[0], (std::vector<std::string>{"sigma", "delta", "wear_number", "kind"}));
  EXPECT_EQ(table[1][0], "0.0002");
  EXPECT_EQ(table[1][1], "0.0002");
  EXPECT_EQ(table.back()[0], "0.002");
  EXPECT_EQ(table.back()[1], "0.002");
  // By mpmath, area(0.002, 0.002)/(4 pi) of tests/golden/circle_area.py.
  EXPECT_LT(relative(std::stod(table.back()[2]), 2.1821328226129613e-4), 1e-13);
}

TEST(BearingChart, HasTheUsersPoint) {
  const std::string chart = "bearing chart --sigma 1e-3 --delta 5e-3,6e-3 ";
  const auto by_depth =
      rows(run_wearwell(chart + "--radius '20 mm' --clearance '20 um' --depth '0.1 mm'").out);
  ASSERT_EQ(by_depth.size(), 4u);
  EXPECT_EQ(by_depth[3][3], "point");
  EXPECT_LT(relative(std::stod(by_depth[1][2]), 7.185812700472977e-4), 1e-14);
  EXPECT_LT(relative(std::stod(by_depth[3][2]), 7.185812700472977e-4), 1e-14);
  const auto by_rate =
      rows(run_wearwell(chart + "--radius '10 mm' --clearance '20 um' --rate '1e-16 m^3/(N "
                                "m)' --pressure '2 MPa' --revolutions 1e6")
               .out);
  ASSERT_EQ(by_rate.size(), 4u);
  EXPECT_LT(relative(std::stod(by_rate[3][1]), 18.67228112810098e-4), 1e-14);
}

}  // namespace
}  // namespace wearwell
