#include "wearwell/embed/plan_arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "wearwell/base/error.h"
#include "wearwell/embed/question.h"

namespace wearwell::embed {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Json = nlohmann::ordered_json;

TEST(PlanArguments, TextsMayBeNumbersThatReadBackToTheSame) {
  const Json json = {{"a", "1e6 cycles"}, {"b", 0.1}, {"c", 3}, {"d", nullptr}};
  PlanArguments arguments("demonstrate", json);
  std::string a, b, c, d = "default";
  arguments.text("a", a);
  arguments.text("b", b);
  arguments.text("c", c);
  arguments.text("d", d);
  EXPECT_EQ(a, "1e6 cycles");
  EXPECT_EQ(b, "0.1");
  EXPECT_EQ(c, "3");
  EXPECT_EQ(d, "default");
}

TEST(PlanArguments, SeveralAreAListOrNamed) {
  const Json json = {{"one", "force = 20 N"},
                     {"list", {"a = 1", 2}},
                     {"named", {{"force", "20 N"}, {"speed", 3}}},
                     {"counts", {1, 3, 5}},
                     {"grid", {{"stress", "200 to 500 by 25 MPa"}, {"stop", {1e6, 5e6}}}}};
  PlanArguments arguments("next", json);
  std::vector<std::string> one, list, named;
  std::string counts, grid;
  arguments.texts("one", one);
  arguments.texts("list", list);
  arguments.texts("named", named);
  arguments.list("counts", counts);
  arguments.clauses("grid", grid);
  EXPECT_THAT(one, ElementsAre("force = 20 N"));
  EXPECT_THAT(list, ElementsAre("a = 1", "2"));
  EXPECT_THAT(named, ElementsAre("force = 20 N", "speed = 3"));
  EXPECT_EQ(counts, "1, 3, 5");
  EXPECT_EQ(grid, "stress = 200 to 500 by 25 MPa; stop = 1000000, 5000000");
}

TEST(PlanArguments, WrongTypesAreRefusedByName) {
  const Json json = {{"text", {1, 2}}, {"truth", 1}, {"whole", -1}, {"half", 0.5}, {"number", "3"}};
  PlanArguments arguments("next", json);
  std::string text;
  bool truth = false;
  std::size_t whole = 0;
  double number = 0;
  EXPECT_THAT([&] { arguments.text("text", text); },
              ThrowsMessage<InputError>("text is a list; it is a text or a number"));
  EXPECT_THAT([&] { arguments.truth("truth", truth); },
              ThrowsMessage<InputError>("truth is a number; it is true or false"));
  EXPECT_THAT([&] { arguments.whole("whole", whole); },
              ThrowsMessage<InputError>("whole is -1; it is a whole number from 0 to 2147483647"));
  EXPECT_THAT([&] { arguments.whole("half", whole); },
              ThrowsMessage<InputError>("half is 0.5; it is a whole number from 0 to 2147483647"));
  EXPECT_THAT([&] { arguments.number("number", number); },
              ThrowsMessage<InputError>("number is a text; it is a number"));
}

TEST(PlanArguments, SeedsHaveAll64Bits) {
  const Json json = {{"number", 18446744073709551615ULL},
                     {"text", "18446744073709551615"},
                     {"beyond", "18446744073709551616"},
                     {"negative", -1}};
  PlanArguments arguments("next", json);
  std::uint64_t number = 0, text = 0;
  arguments.seed("number", number);
  arguments.seed("text", text);
  EXPECT_EQ(number, 18446744073709551615ULL);
  EXPECT_EQ(text, number);
  EXPECT_THAT([&] { arguments.seed("beyond", text); },
              ThrowsMessage<InputError>(HasSubstr("it is a whole number from 0 to 2^64 - 1")));
  EXPECT_THAT([&] { arguments.seed("negative", text); },
              ThrowsMessage<InputError>("negative is -1; it is a whole number from 0 to 2^64 - 1"));
}

TEST(PlanArguments, UnknownOnesAreRefusedWithTheNearest) {
  const Json json = {{"total_rsk", 0.1}};
  PlanArguments arguments("inspect", json);
  std::string risk;
  arguments.text("risk", risk);
  arguments.text("total_risk", risk);
  EXPECT_THAT([&] { arguments.finish(); },
              ThrowsMessage<InputError>("inspect has no argument 'total_rsk'; did you mean "
                                        "'total_risk'? (arguments: risk, total_risk)"));
}

TEST(PlanArguments, OptionsInMessagesBecomeArguments) {
  const Json json = Json::object();
  PlanArguments arguments("inspect", json);
  std::string text;
  arguments.text("risk", text);
  arguments.text("total_risk", text);
  arguments.call_option("GOAL", "goal");
  EXPECT_EQ(arguments.in_arguments("--total-risk: needs --risk, not --risky or x--risk"),
            "total_risk: needs risk, not --risky or x--risk");
  EXPECT_EQ(arguments.in_arguments("GOAL: is missing; GOALS"), "goal: is missing; GOALS");
}

TEST(Plan, KindsAndArgumentsAreChecked) {
  EXPECT_THAT([&] { answer("guess", "{}", {}, {}); },
              ThrowsMessage<InputError>(HasSubstr("there is no question of kind 'guess'")));
  EXPECT_THAT([&] { answer("demonstrate", "[]", {}, {}); },
              ThrowsMessage<InputError>("demonstrate: arguments have names"));
  EXPECT_THAT([&] { answer("demonstrate", "{\"goal\": \"\xff\"}", {}, {}); },
              ThrowsMessage<InputError>("demonstrate: an argument is not Unicode"));
  EXPECT_THAT([&] { answer("demonstrate", R"({"gaol": "B10 >= 1"})", {}, {}); },
              ThrowsMessage<InputError>(HasSubstr("did you mean 'goal'?")));
}

TEST(Plan, TextsAndMessagesNameArguments) {
  const Answer found =
      answer("demonstrate", R"({"goal": "B10 >= 1e6 cycles", "time": "2e6 cycles"})", {}, {});
  EXPECT_EQ(found.text.find("--"), std::string::npos);
  EXPECT_TRUE(found.trusted);
  EXPECT_THAT(
      [&] { answer("demonstrate", R"({"goal": "B10 >= 1e6 cycles", "sigma": 1})", {}, {}); },
      ThrowsMessage<InputError>("sigma: a Weibull distribution has a shape"));
}

}  // namespace
}  // namespace wearwell::embed
