#include "wearwell/workbench/study_form.h"

#include <gmock/gmock.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/registry.h"

namespace wearwell::workbench {
namespace {

using testing::HasSubstr;

const std::string study = R"(# Lives, äöü.
title = "Pumps \"A\""  # a comment
model = "formula"
[data]
file = "lives.csv"
[data.columns]
life = { column = "hours äö", unit = "h" }   # of operation
[likelihood.life]
family = "weibull"
scale  = "characteristic"
shape  = "slope"
[prior]
characteristic = { distribution = "lognormal", median = "1e3 h", log_sd = 1 }
slope          = { distribution = "lognormal", median = 2, log_sd = 0.7 }
[predict]
b_lives = [
  1,  # one percent
  10,
]
credible_level = 0.9
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(StudyForm, AValueChangesAndNothingElse) {
  EXPECT_EQ(with_value(study, "title", "Pumps, \"B\""),
            replaced(study, R"("Pumps \"A\"")", R"("Pumps, \"B\"")"));
  EXPECT_EQ(with_value(study, "data.columns.life.unit", "d"),
            replaced(study, "unit = \"h\"", "unit = \"d\""));
  EXPECT_EQ(with_value(study, "prior.slope.log_sd", "0.25"), replaced(study, "0.7", "0.25"));
  EXPECT_EQ(with_value(study, "predict.credible_level", "0.95"),
            replaced(study, "0.9\n", "0.95\n"));
  EXPECT_EQ(with_value(study, "predict.b_lives", "[10]"),
            replaced(study, "[\n  1,  # one percent\n  10,\n]", "[10]"));
}

TEST(StudyForm, AValueOfSeveralLinesKeepsThem) {
  const std::string text =
      "title = 1\nnote = \"\"\"\na = \\\"b\\\"\nc\n\"\"\"\nplain = '''\nx\\y\n'''\n";
  EXPECT_EQ(with_value(text, "note", "a = \"b\\\"\nd\n"),
            replaced(text, "a = \\\"b\\\"\nc\n", "a = \\\"b\\\\\\\"\nd\n"));
  EXPECT_EQ(with_value(text, "plain", "x\\z\n\nw\n"), replaced(text, "x\\y\n", "x\\z\n\nw\n"));
  EXPECT_EQ(with_value(text, "plain", "one"), replaced(text, "'''\nx\\y\n'''", "\"one\""));
  EXPECT_EQ(with_value(study, "predict.b_lives", "[\n  1,  # one\n  50,\n]"),
            replaced(study, "  1,  # one percent\n  10,\n", "  1,  # one\n  50,\n"));
}

TEST(StudyForm, AValueCannotBringOtherKeys) {
  for (const char* each : {"0.9\nother = 1", "0.9 } x = {", "", "nonsense", "[0.9"})
    EXPECT_THROW(with_value(study, "predict.credible_level", each), InputError) << each;
  EXPECT_THROW(with_value(study, "prior.slope.log_sd", "0.7, mean = 3"), InputError);
  EXPECT_THROW(with_value(study, "predict.nothing", "1"), InputError);
  // of a text everything is text
  EXPECT_THAT(with_value(study, "title", "a\"\nmodel = \"sn"), HasSubstr(R"("a\"\nmodel = \"sn")"));
}

class CheckedStudy : public ScratchTest {
 protected:
  nlohmann::ordered_json checked(const std::string& text) const {
    return checked_study(folder() / "study.toml", text, all_models());
  }
};

TEST_F(CheckedStudy, GivesTheFormAndTheDescription) {
  write("lives.csv", "hours äö\n100\n200\n300\n");
  const auto found = checked(study);
  ASSERT_FALSE(found.contains("problem")) << found["problem"];
  EXPECT_THAT(found["description"].get<std::string>(), HasSubstr("weibull"));
  ASSERT_EQ(found["keys"].size(), 16u);
  EXPECT_EQ(found["keys"][0]["path"], "title");
  EXPECT_EQ(found["keys"][0]["value"], "Pumps \"A\"");
  for (const auto& key : found["keys"]) {
    EXPECT_TRUE(key.contains("meaning")) << key;
    // each value set to itself leaves the study
    EXPECT_EQ(checked(with_value(study, key["path"], key["value"]))["keys"], found["keys"]) << key;
  }
}

TEST_F(CheckedStudy, NamesLineAndColumnOfAnError) {
  write("lives.csv", "hours äö\n100\n200\n300\n");
  const auto misspelt = checked(replaced(study, "\"weibull\"", "\"weibul\""));
  EXPECT_EQ(misspelt["line"], 9) << misspelt["problem"];
  EXPECT_THAT(misspelt["problem"].get<std::string>(), HasSubstr("weibul"));
  EXPECT_EQ(misspelt["keys"].size(), 16u);
  const auto broken = checked(replaced(study, "[prior]", "[prior"));
  EXPECT_EQ(broken["line"], 12) << broken["problem"];
  EXPECT_TRUE(broken["keys"].empty());
  const auto missing = checked(replaced(study, "lives.csv", "no.csv"));
  EXPECT_THAT(missing["problem"].get<std::string>(), HasSubstr("no.csv"));
  EXPECT_EQ(missing["problem"].get<std::string>().find(folder().string()), std::string::npos);
}

}  // namespace
}  // namespace wearwell::workbench
