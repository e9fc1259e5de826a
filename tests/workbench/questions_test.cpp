#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/registry.h"
#include "wearwell/workbench/changed_prediction.h"
#include "wearwell/workbench/question_view.h"
#include "wearwell/workbench/study_form.h"

namespace wearwell::workbench {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string wear_study = R"(model = "formula"
[data]
file = "wear.csv"
[data.columns]
time = { column = "hours [h]", unit = "h" }
depth = { column = "wear [um]", unit = "um" }
liner = "liner"
[formula]
wear = "rate * time"
[likelihood.depth]
family = "normal"
mean = "wear"
sd = "sigma_r"
[prior]
rate = { distribution = "lognormal", median = "0.1 um/h", log_sd = 2 }
sigma_r = { distribution = "half-normal", scale = "20 um" }
scatter = { distribution = "half-normal", scale = 1 }
[random_effects.liner]
rate = { distribution = "lognormal", log_sd = "scatter" }
[predict]
along = "time"
at = ["1400 h"]
limit = { wear = "60 um" }
)";

std::string with_limit(const std::string& limit) {
  std::string text = wear_study;
  return text.replace(text.find("60 um"), 5, limit);
}

class QuestionsTest : public ScratchTest {
 protected:
  QuestionsTest() {
    std::ofstream table(folder() / "wear.csv");
    table << "liner,hours [h],wear [um]\n";
    const double noise[] = {0.6, -1.1, 0.4, -0.2};
    for (int unit : {3, 4, 5, 6}) {
      for (int i = 0; i < 4; ++i) {
        const double hours = 120.0 * (i + 1);
        table << unit << ',' << hours << ',' << 0.01 * (unit + 2) * hours + noise[(i + unit) % 4]
              << '\n';
      }
    }
  }
  std::filesystem::path fitted(const std::string& name, const std::string& study) {
    std::ofstream(folder() / (name + ".toml")) << study;
    const std::filesystem::path out = folder() / name;
    const CommandResult fit =
        run_command(std::string(WEARWELL_BINARY) + " fit " +
                    (folder() / (name + ".toml")).string() + " --quiet -o " + out.string());
    EXPECT_LE(fit.exit_code, 1) << fit.err;
    return out;
  }
  static std::string printed(const std::string& command) {
    return run_command("PATH=" + std::filesystem::path(WEARWELL_BINARY).parent_path().string() +
                       ":$PATH; " + command)
        .out;
  }
};

TEST_F(QuestionsTest, AnotherThresholdGivesWhatAFitOfTheChangedStudyGives) {
  const auto first = fitted("first", wear_study), second = fitted("second", with_limit("48 um"));
  const json changed = life_answer(first, all_models(),
                                   {{"unit", "5"}, {"changes", {{"predict.limit.wear", "48 um"}}}});
  const json own = life_answer(second, all_models(), {{"unit", "5"}});
  EXPECT_EQ(changed["answer"], own["answer"]);
  EXPECT_EQ(changed["text"], own["text"]);
  EXPECT_FALSE(changed.contains("command"));  // no command has the changed study
  EXPECT_EQ(own["text"], printed(own["command"]));
  EXPECT_NE(own["answer"], json(life_answer(first, all_models(), {{"unit", "5"}}))["answer"]);
  EXPECT_THROW(life_answer(first, all_models(), {{"changes", {{"prior.rate.log_sd", "1"}}}}),
               InputError);
  EXPECT_THROW(life_answer(first, all_models(), {{"changes", {{"predict.limit.wear", "48 h"}}}}),
               InputError);

  // The units, and the test to do next, as their commands print them.
  const json units = followed_units(first, all_models());
  EXPECT_EQ(units["names"], json::array({"3", "4", "5", "6"}));
  EXPECT_THAT(
      printed(units["command"]),
      HasSubstr(
          json(life_answer(first, all_models(), {{"unit", "6"}}))["text"].get<std::string>()));
  const json next = next_test_answer(first, all_models(),
                                     {{"goal", "B10"}, {"grid", "hours [h] = 200 to 600 by 200"}});
  EXPECT_EQ(next["answer"]["candidates"].size(), 3U);
  EXPECT_EQ(next["text"], printed(next["command"]));
  EXPECT_THROW(next_test_answer(first, all_models(), {{"grid", "hours [h] = 1"}}), InputError);
}

TEST(ChangedPrediction, OnlyNumbersOfConditionsAndThresholds) {
  const json varied = varied_predictions(wear_study, all_models());
  ASSERT_EQ(varied.size(), 1U);
  EXPECT_EQ(varied[0], (json{{"path", "predict.limit.wear"}, {"number", 60.0}, {"unit", "um"}}));
  for (const char* each : {"60 um +- 2 um", "60 um x/ 1.2", "0 um", "wear"})
    EXPECT_EQ(varied_predictions(with_limit(each), all_models()).size(), 0U) << each;
}

TEST(StudyFormulas, AreTypesetAndErrorsAreNull) {
  const json formulas = json(study_form("a.toml", wear_study, all_models()))["formulas"];
  ASSERT_EQ(formulas.size(), 2U);
  EXPECT_EQ(formulas[0]["path"], "formula.wear");
  EXPECT_EQ(formulas[0]["line"], 9);
  const std::string typeset = formulas[1]["math"].dump();
  EXPECT_THAT(typeset, HasSubstr(R"(["msub","",[["mi","σ",[]],["mi","r",[]]]])"));
  EXPECT_THAT(typeset, HasSubstr(R"(["mtext","normal",[]])"));
  std::string broken = wear_study;
  broken.replace(broken.find("rate * time"), 11, "rate * ");
  EXPECT_TRUE(json(study_form("a.toml", broken, all_models()))["formulas"][0]["math"].is_null());
}

}  // namespace
}  // namespace wearwell::workbench
