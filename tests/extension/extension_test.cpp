// A model that the program does not know (examples/extension) goes through every command.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;
namespace fs = std::filesystem;

class Extension : public ScratchTest {
 protected:
  CommandResult run(const std::string& arguments) const {
    return run_command("cd '" + folder().string() + "' && '" WEARWELL_EXTENDED "' " + arguments);
  }
};

TEST_F(Extension, GoesThroughEveryCommand) {
  ASSERT_EQ(run("new drift pin").exit_code, 0);
  const CommandResult check = run("check pin/study.toml");
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("rate   wear rate [um/h]"));
  for (const char* out : {"a", "b"}) {
    const CommandResult fit = run(std::string("fit pin/study.toml --quiet -o ") + out);
    ASSERT_EQ(fit.exit_code, 0) << fit.err;
  }
  std::ifstream stream(folder() / "a/summary.json");
  const Json summary = Json::parse(stream);
  EXPECT_EQ(summary["model"], "linear-drift");
  // Under flat priors the mean of the rate is that of least squares through the origin.
  const std::vector<double> t = {100, 250, 400, 600, 850, 1000, 1200},
                            y = {2.9, 4.1, 9.4, 11.2, 18.3, 19.6, 25.1};
  const double rate = std::inner_product(t.begin(), t.end(), y.begin(), 0.0) /
                      std::inner_product(t.begin(), t.end(), t.begin(), 0.0);
  EXPECT_NEAR(summary["parameters"]["rate"]["mean"].get<double>(), rate, 1e-5 * rate);
  EXPECT_NEAR(summary["predictions"][0]["mean"].get<double>(), 2000 * rate, 0.02 * rate);

  fs::remove(folder() / "a/report.html");
  EXPECT_EQ(run("report a").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder() / "a/report.html"));
  const CommandResult compare = run("compare a b --json");
  EXPECT_EQ(compare.exit_code, 0) << compare.err;
  EXPECT_EQ(Json::parse(compare.out)["comparable"], true);
}

TEST_F(Extension, RefusesAsTheOthersDo) {
  ASSERT_EQ(run("new drift pin").exit_code, 0);
  write("pin/pin.csv", "t,worn\n100,2\n-250,4\n400,6\n");
  const CommandResult fit = run("fit pin/study.toml");
  EXPECT_EQ(fit.exit_code, 2);
  EXPECT_THAT(fit.err, HasSubstr("row 2, column 't': -250 must be positive"));
  EXPECT_FALSE(fs::exists(folder() / "study-results"));
  const CommandResult unknown = run("new drifts x");
  EXPECT_EQ(unknown.exit_code, 2);
}

TEST_F(Extension, IsAmongTheModelsThatAWrongNameIsToldOf) {
  write("s.toml", "model = \"linear-drifts\"\n");
  EXPECT_THAT(run("check s.toml").err, HasSubstr("(nearest: 'linear-drift')"));
}

}  // namespace
}  // namespace wearwell
