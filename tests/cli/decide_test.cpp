#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string lives = PROJECT_SOURCE_DIR "/examples/decide/lives.csv";
const std::string costs = " --failure-cost '12 EUR' --replacement-cost '1 EUR'";

class Decide : public ScratchTest {
 protected:
  static std::string refusal(const std::string& arguments) {
    const CommandResult run = run_wearwell("decide " + arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.err;
    EXPECT_EQ(run.out, "");
    return run.err;
  }
};

TEST_F(Decide, TellsTheSameAsJsonAndInAFolder) {
  const std::string results = (folder() / "decisions").string();
  const CommandResult run =
      run_wearwell("decide " + lives + costs +
                   " --inspection-cost '0.1 EUR' --month '600 h' --json -o " + results);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json reported = json::parse(run.out);
  std::ifstream file(results + "/decisions.json");
  EXPECT_EQ(json::parse(file), reported);
  EXPECT_LT(reported["age"]["cost"], reported["at_failure"]["cost"]);
  EXPECT_LT(reported["inspection"]["cost"], reported["age"]["cost"]);
  EXPECT_LE(reported["age"]["from"], reported["age"]["at"]);
  EXPECT_EQ(reported["units"].size(), 8);
  EXPECT_EQ(reported["units"][0]["unit"], "P2");  // the one with the least left
  EXPECT_EQ(reported["months"].size(), 12);
  double before = 0;
  for (const auto& month : reported["months"]) {
    EXPECT_GE(month["expected"], before);
    EXPECT_LE(month["q05"], month["q95"]);
    before = month["expected"];
  }
  for (const char* name :
       {"report.html", "tables/policies.csv", "tables/units.csv", "results.sha1"})
    EXPECT_TRUE(std::filesystem::exists(results + "/" + name)) << name;
}

// Weibull of shape 2.5 and 1000 h as a table: the example of ReliaSoft, 493 h.
TEST_F(Decide, FindsThePublishedAge) {
  const std::string file = (folder() / "weibull.csv").string();
  {
    std::ofstream out(file);
    out << "life [h]\n";
    for (int i = 0; i < 20000; ++i)
      out << 1000 * std::pow(-std::log(1 - (i + 0.5) / 20000), 1 / 2.5) << "\n";
  }
  const CommandResult run =
      run_wearwell("decide " + file + " --failure-cost 5 --replacement-cost 1 --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NEAR(json::parse(run.out)["age"]["at"].get<double>(), 493.047, 3);
}

TEST_F(Decide, RefusesWhatItCannotTell) {
  EXPECT_THAT(refusal(lives + " --failure-cost '12 EUR' --replacement-cost 1"),
              HasSubstr("another currency"));
  EXPECT_THAT(refusal(lives + " --failure-cost 12 --replacement-cost 0"),
              HasSubstr("must be above 0"));
  EXPECT_THAT(refusal(lives + costs + " --month '600 km'"), HasSubstr("a unit like h"));
  EXPECT_THAT(refusal(lives + costs + " --month 600"), HasSubstr("a unit like h"));
  EXPECT_THAT(refusal(lives + costs + " --downtime-cost '1 EUR/h'"),
              HasSubstr("--inspection-cost"));
  EXPECT_THAT(refusal(lives + costs + " --inspection-cost '1 EUR' --downtime-cost '1 EUR/km'"),
              HasSubstr("'km' is not a unit like h"));
  EXPECT_THAT(refusal(lives + costs + " --inspection-cost '1 EUR' --unit P2 --inspect-after '9 h'"),
              HasSubstr("what a reading would show"));
  EXPECT_THAT(refusal("no-such.csv" + costs), HasSubstr("no-such.csv"));
}

// Failures of repaired units recur: what a decision can rest on is said.
TEST_F(Decide, FailuresOfRepairedUnits) {
  const std::string result = (folder() / "growth").string();
  const CommandResult fit = run_wearwell("fit " PROJECT_SOURCE_DIR
                                         "/examples/repairable/growth.toml --method exact "
                                         "--draws 100 --quiet --no-report -o " +
                                         result);
  ASSERT_LE(fit.exit_code, 1) << fit.err;
  EXPECT_THAT(refusal(result + costs),
              AllOf(HasSubstr("counts the failures of units that are repaired"),
                    HasSubstr("[predict] next"), HasSubstr("a study of these lives")));
}

TEST_F(Decide, NamesTheRowThatIsNoLife) {
  const auto table = [&](const std::string& text) {
    const std::string file = (folder() / "lives.csv").string();
    std::ofstream(file) << text;
    return refusal(file + costs);
  };
  EXPECT_THAT(table("life\n1\n"), HasSubstr("needs its unit"));
  EXPECT_THAT(table("life [h]\n12\n-3\n"), HasSubstr("row 2"));
  EXPECT_THAT(table("life [h],unit\n12,A\n"), HasSubstr("the study has no life of a new"));
  EXPECT_THAT(table("life [h]\n100\n100\n"), HasSubstr("of a new unit are equal"));
  EXPECT_THAT(table("life [h],colour\n12,red\n"), HasSubstr("colour"));
  EXPECT_THAT(table("life [h],unit,population\n9,,A\n12,,A\n20,,B\n30,,B\n5,U,A\n"),
              HasSubstr("the population 'A' has weight 1 for the unit 'U' and 0.5"));
}

// Two populations as likely, in which all units fail within a month or none does: all or nothing. Without it, between.
TEST_F(Decide, CountsUnitsOverThePopulationsThatTheyShare) {
  std::string shared = "life [h],unit,population\n9,,early\n12,,early\n200,,late\n300,,late\n",
              alone = "life [h],unit\n9,\n12,\n200,\n300,\n";
  for (int u = 0; u < 10; ++u) {
    shared += fmt::format("5,U{0},early\n6,U{0},early\n200,U{0},late\n300,U{0},late\n", u);
    alone += fmt::format("5,U{0}\n6,U{0}\n200,U{0}\n300,U{0}\n", u);
  }
  const auto reported = [&](const std::string& text) {
    const std::string file = (folder() / "lives.csv").string();
    std::ofstream(file) << text;
    const CommandResult run =
        run_wearwell("decide " + file + costs + " --month '100 h' --months 1 --json");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(run.out);
  };
  const json together = reported(shared), apart = reported(alone);
  EXPECT_EQ(together["counting"]["populations"], 2);
  EXPECT_EQ(together["counting"]["independent"], false);
  EXPECT_EQ(together["months"][0]["q05"], 0);
  EXPECT_EQ(together["months"][0]["q95"], 10);
  EXPECT_EQ(apart["counting"]["independent"], true);
  EXPECT_GE(apart["months"][0]["q05"], 2);
  EXPECT_LE(apart["months"][0]["q95"], 8);
  EXPECT_NEAR(apart["months"][0]["expected"].get<double>(),
              together["months"][0]["expected"].get<double>(), 0.3);
}

// A study that measures lives, with running units.
TEST_F(Decide, OfMeasuredLives) {
  const std::string result = (folder() / "lives").string();
  const CommandResult fitted = run_wearwell(
      "fit " PROJECT_SOURCE_DIR "/examples/life/study.toml --quiet --no-report -o " + result);
  ASSERT_EQ(fitted.exit_code, 0) << fitted.err;
  write("ages.csv", "unit,age [1e6 cycles]\nP1,20\nP2,60\n");
  const CommandResult run = run_wearwell("decide " + result + costs + " --claims '10 %' --json" +
                                         " --month '5e6 cycles' --months 2 --in-service " +
                                         (folder() / "ages.csv").string());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json decided = json::parse(run.out);
  const CommandResult life = run_wearwell("life " + result + " --json");
  ASSERT_EQ(life.exit_code, 0) << life.err;
  const double b10 = json::parse(life.out)["b10"];
  EXPECT_NEAR(decided["warranty"]["length"], b10, 0.01 * b10);
  EXPECT_LT(decided["warranty"]["sure"], decided["warranty"]["length"]);
  EXPECT_LT(decided["age"]["cost"], decided["at_failure"]["cost"]);
  ASSERT_EQ(decided["units"].size(), 2U);
  EXPECT_EQ(decided["units"][0]["unit"], "P2");  // the older one
  EXPECT_FALSE(decided["counting"]["independent"]);
  EXPECT_THAT(refusal(lives + costs + " --at bearing"), HasSubstr("--at: names a life of a study"));
  EXPECT_THAT(refusal(lives + costs + " --in-service x.csv"),
              HasSubstr("--in-service: a table of lives"));
  EXPECT_THAT(refusal((folder() / "fleet.toml").string() + costs + " --in-service x.csv"),
              HasSubstr("--in-service: the running units of a monitor"));
  EXPECT_THAT(refusal(result + costs + " --at lorry"),
              HasSubstr("--at: the study has no life of 'lorry'; it has those of "));
  EXPECT_THAT(refusal(result + costs + " --claims '200 %'"),
              HasSubstr("--claims: 200 % must lie between 0 and 100 %"));
}

// Six lives of which three ended: the bound of a warranty is that of the B-life that fit reports, whatever [predict] asks.
TEST_F(Decide, TheWarrantyIsTheBLifeOfTheFit) {
  write("lives.csv",
        "life [h],status\n310,failure\n540,failure\n700,failure\n820,runout\n900,runout\n"
        "900,runout\n");
  const auto fitted = [&](const std::string& name, const std::string& predict) {
    write(name + ".toml", R"toml(
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
eta = { distribution = "lognormal", median = "1000 h", log_sd = 2 }
beta = { distribution = "lognormal", median = 1.5, log_sd = 0.7 }
[predict]
)toml" + predict);
    const CommandResult run = run_wearwell("fit " + (folder() / (name + ".toml")).string() +
                                           " --method exact --draws 100 --quiet --no-report -o " +
                                           (folder() / name).string());
    EXPECT_LE(run.exit_code, 1) << run.err;
  };
  fitted("asked", "b_lives = [2, 10]\nlevel = 0.95\n");
  fitted("other", "b_lives = [50]\ncredible_level = 0.8\nsides = \"both\"\nmean_life = true\n");
  std::ifstream file(folder() / "asked" / "summary.json");
  const json summary = json::parse(file);
  const auto warranty = [&](const std::string& name, const std::string& share) {
    const CommandResult run = run_wearwell("decide " + (folder() / name).string() + costs +
                                           " --claims '" + share + "' --json");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(run.out)["warranty"];
  };
  for (const auto& [share, b_life] : {std::pair("2 %", "B2 life"), std::pair("10 %", "B10 life")}) {
    json fit;
    for (const json& each : summary["quantities"])
      if (each["name"] == b_life) fit = each;
    ASSERT_TRUE(fit.is_object()) << b_life;
    const double bound = fit["bound"], next = fit["predictive"];
    for (const char* name : {"asked", "other"}) {
      const json decided = warranty(name, share);
      EXPECT_NEAR(decided["sure"].get<double>() / bound, 1, 1e-3) << name << b_life;
      EXPECT_NEAR(decided["length"].get<double>() / next, 1, 1e-3) << name << b_life;
      EXPECT_FALSE(decided.contains("populations"));
    }
  }
}

}  // namespace
}  // namespace wearwell
