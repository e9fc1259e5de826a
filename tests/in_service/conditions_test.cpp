// The conditions of units in service, written into a study.
#include "wearwell/in_service/conditions.h"

#include <gmock/gmock.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell::in_service {
namespace {

using testing::HasSubstr;

// The conditions of a text, as TOML has them.
std::map<std::string, std::string> given(const std::string& study,
                                         const std::map<std::string, std::string>& values) {
  const TextFile edited = with_conditions({"study.toml", study}, values);
  const TomlReader predict = TomlReader::parse(edited).required_table("predict");
  EXPECT_TRUE(predict.has("b_lives"));
  std::map<std::string, std::string> found;
  const TomlReader table = predict.required_table("given");
  for (const std::string& each : table.keys())
    found[each] = table.is_text(each) ? table.required_text(each) : "number";
  return found;
}

TEST(Conditions, TakeTheirPlaceInEveryFormOfAStudy) {
  const std::map<std::string, std::string> hot = {{"temperature", "\"80 degC\""}};
  const std::map<std::string, std::string> alone = {{"temperature", "80 degC"}};
  const std::map<std::string, std::string> both = {{"temperature", "80 degC"}, {"supplier", "B"}};
  EXPECT_EQ(given("a = 1\n[predict]\nb_lives = [1]\n", hot), alone);
  EXPECT_EQ(given("[predict]\ngiven = { temperature = \"10 degC\" } # °\nb_lives = [1]\n", hot),
            alone);
  EXPECT_EQ(given("[predict]\ngiven = { supplier = \"B\", temperature = \"10 degC\" }\n"
                  "b_lives = [1]\n",
                  hot),
            both);
  EXPECT_EQ(given("[predict]\nb_lives = [1]\n[predict.given]\ntemperature = \"10 degC\"\n"
                  "supplier = \"B\"\n\n[sampler]\nmethod = \"exact\"\n",
                  hot),
            both);
  EXPECT_THAT(message_of<InputError>([&] {
                with_conditions({"s", "[predict]\ngiven.supplier = \"B\"\n"}, hot);
              }),
              HasSubstr("given = { ... }"));
  const auto numbers = given(
      "[predict]\ngiven = { load = 3.5, temperature = \"1 K\" }\n"
      "b_lives = [1]\n",
      hot);
  EXPECT_EQ(numbers.at("load"), "number");
  EXPECT_EQ(with_conditions({"s", "x = 1\n"}, {}).text, "x = 1\n");
}

TEST(Conditions, OneThatDiffersBetweenUnitsNeedsAColumn) {
  const std::string study =
      "[predict]\ngiven = { temperature = { distribution = \"normal\", mean = \"25 degC\", sd = "
      "\"6 K\" } }\n";
  EXPECT_THAT(message_of<InputError>([&] {
                with_conditions({"study.toml", study}, {{"load", "3"}});
              }),
              HasSubstr("predict.given.temperature differs between units"));
  EXPECT_THAT(with_conditions({"study.toml", study}, {{"temperature", "\"3 degC\""}}).text,
              HasSubstr("given = { temperature = \"3 degC\" }"));
}

}  // namespace
}  // namespace wearwell::in_service
