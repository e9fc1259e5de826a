#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class PlanAccelerate : public ScratchTest {
 protected:
  static json plan(const std::string& arguments) {
    const CommandResult run = run_wearwell("plan accelerate " + arguments + " --json");
    EXPECT_EQ(run.exit_code, 0) << arguments << "\n" << run.err;
    return json::parse(run.out);
  }
  static std::string refusal(const std::string& arguments) {
    const CommandResult run = run_wearwell("plan accelerate " + arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.err;
    EXPECT_EQ(run.out, "");
    return run.err;
  }
};

const std::string test = "--use '50 degC' --highest '120 degC' --until '183 d' --specimens 300 ";
const std::string shares = "--failing-at-use '0.1 %' --failing-at-highest '90 %' ";

// Meeker and Escobar (1998), ch. 20, adhesive bond.
TEST_F(PlanAccelerate, ReproducesMeekerAndEscobar) {
  const json found = plan(test + shares + "--sigma 0.6 --low '78 degC'");
  const json& optimum = found["plans"][0];
  EXPECT_EQ(optimum["plan"], "optimum");
  EXPECT_NEAR(optimum["levels"][0]["stress"].get<double>(), 95, 0.5);
  EXPECT_EQ(optimum["levels"][0]["specimens"], 212);
  EXPECT_EQ(optimum["levels"][1]["specimens"], 88);
  EXPECT_NEAR(optimum["standard_error"].get<double>(), 0.3794, 1e-4);
  const json& compromise = found["plans"][1];
  EXPECT_NEAR(compromise["levels"][1]["stress"].get<double>(), 98, 0.5);
  EXPECT_NEAR(compromise["levels"][0]["specimens"].get<double>(), 155.5, 0.6);
  EXPECT_EQ(compromise["levels"][1]["specimens"], 60);
  EXPECT_EQ(compromise["levels"][2]["specimens"], 84);
  EXPECT_NEAR(compromise["standard_error"].get<double>(), 0.4375, 1e-4);
}

// Twice the stop time in the table is the plan of a test that is twice as long; its whole numbers of specimens change little.
TEST_F(PlanAccelerate, OtherStopTimesAreThoseOfOtherTests) {
  const std::string rest =
      "--use '50 degC' --highest '120 degC' --specimens 300 --sigma 0.6 --life-at-highest '90 d' "
      "--activation-energy '0.7 eV' --until ";
  const json found = plan(rest + "'183 d'"), longer = plan(rest + "'366 d'");
  const json& times = found["stop_times"];
  ASSERT_EQ(times.size(), 5u);
  EXPECT_DOUBLE_EQ(times[3]["until"], 366);
  for (const auto& [key, kind] : {std::pair{"optimum", 0}, {"compromise", 1}}) {
    EXPECT_NEAR(times[3][key].get<double>(), longer["plans"][kind]["standard_error"].get<double>(),
                2e-4);
    EXPECT_NEAR(times[2][key].get<double>(), found["plans"][kind]["standard_error"].get<double>(),
                2e-4);
  }
  EXPECT_EQ(times[2]["specimens"], 300);
  for (std::size_t i = 1; i < times.size(); ++i)
    EXPECT_LT(times[i]["specimens"], times[i - 1]["specimens"]);
}

// The same planning values in other words.
TEST_F(PlanAccelerate, ReadsPlanningValuesInSeveralWays) {
  const json known = plan(test + shares + "--sigma 0.6");
  // 0.7265 eV: the slope through both shares; B63.2 at the highest from 90 % by 183 d at shape 1/0.6.
  const json slope =
      plan(test + "--failing-at-use '0.1 %' --activation-energy '0.7265 eV' --shape 1.6667");
  EXPECT_NEAR(slope["plans"][0]["standard_error"].get<double>(),
              known["plans"][0]["standard_error"].get<double>(), 1e-3);
  const double median = 183 * std::pow(std::log(2) / std::log(10), 0.6);
  const json life = plan(test + "--failing-at-use '0.1 %' --life-at-highest '" +
                         std::to_string(median) + " d' --sigma 0.6");
  EXPECT_NEAR(life["plans"][1]["standard_error"].get<double>(),
              known["plans"][1]["standard_error"].get<double>(), 1e-5);
  const json kelvin =
      plan("--use '323.15 K' --highest '393.15 K' --until '4392 h' --specimens 300 " + shares +
           "--sigma 0.6");
  EXPECT_NEAR(kelvin["plans"][2]["standard_error"].get<double>(),
              known["plans"][2]["standard_error"].get<double>(), 1e-9);
}

TEST_F(PlanAccelerate, AveragesOverIntervals) {
  const json known = plan(test + shares + "--sigma 0.6");
  const json wide = plan(test +
                         "--failing-at-use '0.05 % to 0.2 %' --failing-at-highest '80 % to 95 "
                         "%' --sigma '0.5 to 0.72'");
  EXPECT_EQ(known["points"], 1);
  EXPECT_EQ(wide["points"], 343);
  EXPECT_GT(wide["plans"][0]["standard_error"], known["plans"][0]["standard_error"]);
  EXPECT_EQ(wide["planning_values"][0]["known"], false);
  EXPECT_THAT(run_wearwell("plan accelerate " + test + shares + "--shape '1.4 to 2'").out,
              HasSubstr("The prior's part"));
}

TEST_F(PlanAccelerate, PlansOtherRelationsAndWritesAFolder) {
  const std::string results = (folder() / "plan").string();
  const CommandResult run = run_wearwell(
      "plan accelerate --relation inverse-power --family lognormal --use '100 MPa' --highest '200 "
      "MPa' --lowest '130 MPa' --until '1e7 cycles' --specimens 30 --sigma 0.5 --life-at-highest "
      "'1e5 cycles' --exponent 8 --json -o " +
      results);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json found = json::parse(run.out);
  for (const auto& each : found["plans"]) {
    EXPECT_GE(each["levels"][0]["stress"], 129.999);
    int sum = 0;
    for (const auto& level : each["levels"]) sum += level["specimens"].get<int>();
    EXPECT_EQ(sum, 30);
    EXPECT_GE(each["standard_error"].get<double>(),
              found["plans"][0]["standard_error"].get<double>() * 0.999);
  }
  for (const char* name : {"report.html", "plan.json", "tables/plans.csv", "tables/levels.csv",
                           "tables/sensitivity.csv", "tables/planning-values.csv"})
    EXPECT_TRUE(std::filesystem::exists(results + "/" + name)) << name;
}

// A time at the lower level that is longer than at the others: the same plan as by hand, in all tables.
TEST_F(PlanAccelerate, HasStopTimesByLevel) {
  const std::string stops = "--stop '366 d, 183 d, 92 d' --low '78 degC' ";
  const json one = plan(test + shares + "--sigma 0.6 --low '78 degC'"),
             found = plan(test + shares + "--sigma 0.6 " + stops),
             same =
                 plan(test + shares + "--sigma 0.6 --low '78 degC' --stop '183 d, 183 d, 4392 h'");
  for (int kind = 0; kind < 4; ++kind) {
    EXPECT_NEAR(same["plans"][kind]["standard_error"].get<double>(),
                one["plans"][kind]["standard_error"].get<double>(), 1e-12);
    EXPECT_LT(found["plans"][kind]["standard_error"], one["plans"][kind]["standard_error"]);
    const json &levels = found["plans"][kind]["levels"], &before = one["plans"][kind]["levels"];
    EXPECT_DOUBLE_EQ(levels.front()["until"], 366);
    EXPECT_DOUBLE_EQ(levels.back()["until"], 92);
    EXPECT_LT(levels.back()["failing"], before.back()["failing"]);
  }
  // Twice the time at shape 1/0.6.
  const double failing = one["plans"][1]["levels"][0]["failing"];
  EXPECT_NEAR(found["plans"][1]["levels"][0]["failing"].get<double>(),
              1 - std::pow(1 - failing, std::pow(2, 1 / 0.6)), 1e-9);
  EXPECT_TRUE(found["optimum_gain"].is_null());
  const std::string text =
      run_wearwell("plan accelerate " + test + shares + "--sigma 0.6 " + stops).out;
  EXPECT_THAT(text, HasSubstr("366, 183, 92 d (lower, middle, highest level)"));
  EXPECT_THAT(text, HasSubstr("times the stop times"));
}

// The Eyring relation is Arrhenius' with an activation energy that is higher by k_B T, up to its change
// over the range; the shares that fail are as given.
TEST_F(PlanAccelerate, HasTheEyringRelation) {
  const std::string life = "--sigma 0.6 --failing-at-use '0.1 %' --activation-energy ";
  const json arrhenius = plan(test + life + "'0.73 eV'");
  const json eyring = plan(test + "--relation eyring " + life + "'0.6994 eV'");
  for (int kind = 0; kind < 4; ++kind)
    EXPECT_NEAR(eyring["plans"][kind]["standard_error"].get<double>(),
                arrhenius["plans"][kind]["standard_error"].get<double>(), 2e-3);
  const json given = plan(test + "--relation eyring --sigma 0.6 " + shares);
  EXPECT_NEAR(given["plans"][0]["levels"].back()["failing"].get<double>(), 0.9, 1e-9);
  EXPECT_NEAR(given["plans"][0]["standard_error"].get<double>(), 0.3794, 2e-3);
  EXPECT_THAT(
      run_wearwell("plan accelerate " + test + "--relation eyring --sigma 0.6 " + shares).out,
      HasSubstr("Eyring relation"));
}

TEST_F(PlanAccelerate, RefusesWhatItCannotPlan) {
  EXPECT_THAT(refusal(test + shares + "--sigma 0.6 --stop '366 d, 183 d'"),
              HasSubstr("--stop: '366 d, 183 d' has 2 times; it has three"));
  EXPECT_THAT(refusal(test + shares + "--sigma 0.6 --stop '366 d, 183 d, -1 d'"),
              HasSubstr("--stop: '-1 d' must be positive"));
  EXPECT_THAT(refusal(test + shares + "--sigma 0.6 --stop '366 d, 183 d, 4 km'"),
              HasSubstr("--stop"));
  EXPECT_THAT(refusal("--relation eyring --use '50 MPa' --highest '120 MPa' --until '183 d' "
                      "--specimens 300 --sigma 0.6 " +
                      shares),
              HasSubstr("--highest"));

  EXPECT_THAT(refusal("--use '130 degC' --highest '120 degC' --until '183 d' --specimens 300 " +
                      shares + "--sigma 0.6"),
              HasSubstr("--use: '130 degC' must be below --highest"));
  EXPECT_THAT(refusal("--use '50 MPa' --highest '120 degC' --until '183 d' --specimens 300 " +
                      shares + "--sigma 0.6"),
              HasSubstr("--use"));
  EXPECT_THAT(refusal(test + shares + "--sigma 0.6 --goal MTTF"), HasSubstr("--goal: 'MTTF'"));
  EXPECT_THAT(refusal(test + shares), HasSubstr("--shape, --sigma"));
  EXPECT_THAT(refusal(test + shares + "--sigma 0.6 --shape 2"), HasSubstr("give one of them"));
  EXPECT_THAT(refusal(test + shares + "--sigma -0.6"), HasSubstr("must be positive"));
  EXPECT_THAT(refusal(test + "--sigma 0.6 --failing-at-use '0.1 %' --failing-at-highest '120 %'"),
              HasSubstr("below 100 %"));
  EXPECT_THAT(refusal(test + "--sigma 0.6 --failing-at-use '95 %' --failing-at-highest '90 %'"),
              HasSubstr("life must fall with stress"));
  EXPECT_THAT(refusal(test + "--sigma 0.6 --failing-at-use '0.1 %'"), HasSubstr("not 1"));
  EXPECT_THAT(refusal(test + shares + "--sigma 0.6 --activation-energy '0.7 eV'"),
              HasSubstr("not 3"));
  EXPECT_THAT(refusal(test + "--sigma 0.6 --failing-at-use '0.1 %' --exponent 4"),
              HasSubstr("--exponent: belongs to --relation inverse-power"));
  EXPECT_THAT(refusal(test + "--sigma 0.6 --failing-at-highest '90 %' --life-at-highest '60 d'"),
              HasSubstr("give one"));
  EXPECT_THAT(refusal(test + "--sigma 0.6 --failing-at-use '0.1 %' --life-at-highest '60 km'"),
              HasSubstr("dimension of --until"));
  EXPECT_THAT(refusal("--use '50 degC' --highest '120 degC' --until 'soon' --specimens 300 " +
                      shares + "--sigma 0.6"),
              HasSubstr("--until"));
  EXPECT_THAT(refusal("--use '50 degC' --highest '120 degC' --until '183 d' --specimens 3 " +
                      shares + "--sigma 0.6"),
              HasSubstr("--specimens"));
  EXPECT_THAT(refusal(test + shares + "--sigma 0.6 --low '40 degC'"), HasSubstr("--low"));
  EXPECT_THAT(refusal(test + shares + "--sigma 0.6 --middle-share '95 %'"),
              HasSubstr("--middle-share"));
  EXPECT_THAT(refusal(test + shares + "--sigma 0.6 --relation arhenius"), HasSubstr("arrhenius"));
}

}  // namespace
}  // namespace wearwell
