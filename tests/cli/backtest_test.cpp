#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Backtest : public ScratchTest {
 protected:
  Backtest() {
    const std::string in = folder().string();
    EXPECT_EQ(run_wearwell("new fleet " + in + "/fleet").exit_code, 0);
    const CommandResult fit =
        run_wearwell("fit " + in + "/fleet/study.toml -o " + in + "/results --quiet");
    EXPECT_EQ(fit.exit_code, 0) << fit.err;
    EXPECT_EQ(
        run_command("head -400 " + in + "/fleet/readings.jsonl > " + in + "/few.jsonl").exit_code,
        0);
  }
  CommandResult test(const std::string& readings, const std::string& lives,
                     const std::string& more = "") const {
    const std::string in = folder().string() + "/";
    return run_wearwell("backtest " + in + "results " + in + readings + " " + in + lives + " " +
                        more);
  }
};

TEST_F(Backtest, CountsWhatHeldAndSaysSoOnce) {
  const CommandResult run = test("few.jsonl", "fleet/truth.csv", "--json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json reported = json::parse(run.out);
  EXPECT_EQ(reported["readings"].get<int>() + reported["repeated"].get<int>(), 400);
  EXPECT_GT(reported["repeated"], 0);
  EXPECT_EQ(reported["refused"], 0);
  const json& all = reported["ages"].back();
  EXPECT_EQ(all["forecasts"], reported["readings"]);
  EXPECT_GT(all["held"].get<double>(), 0.6 * all["forecasts"].get<double>());
  // The longer a machine was watched, the narrower what is said of it.
  EXPECT_LT(reported["ages"][3]["width"], reported["ages"][0]["width"]);
  // Each forecast as a row.
  const std::string file = (folder() / "forecasts.csv").string();
  ASSERT_EQ(test("few.jsonl", "fleet/truth.csv", "-o " + file).exit_code, 0);
  std::ifstream in(file);
  std::string line;
  std::size_t rows = 0;
  while (std::getline(in, line)) ++rows;
  EXPECT_EQ(rows, all["forecasts"].get<std::size_t>() + 1);

  // The same readings in other units are the same.
  EXPECT_EQ(
      run_command(
          "cd " + folder().string() +
          " && python3 - <<'END'\nimport json\nout = open('mm.csv', 'w')\n"
          "out.write('machine,use [min],wear [mm]\\n')\n"
          "for line in open('few.jsonl'):\n"
          "    r = json.loads(line)\n"
          "    out.write('%s,%r,%r\\n' % (r['machine'], r['use_h'] * 60, r['wear_um'] / 1000))\n"
          "END\n")
          .exit_code,
      0);
  const CommandResult other = test("mm.csv", "fleet/truth.csv", "--json");
  ASSERT_EQ(other.exit_code, 0) << other.err;
  EXPECT_EQ(json::parse(other.out)["ages"].back()["held"], all["held"]);
}

TEST_F(Backtest, RefusesWhatItCannotRead) {
  write("bare.csv", "machine,use,wear\nM001,100,2\n");
  EXPECT_THAT(test("bare.csv", "fleet/truth.csv").err, HasSubstr("needs its unit"));
  write("wrong.csv", "machine,use [km],wear [um]\nM001,100,2\n");
  EXPECT_EQ(test("wrong.csv", "fleet/truth.csv").exit_code, 2);
  write("twice.csv", "machine,life [h]\nM001,100\nM001,200\n");
  EXPECT_THAT(test("few.jsonl", "twice.csv").err, HasSubstr("two lives"));
  write("other.csv", "machine,life [h]\nX,100\n");
  EXPECT_THAT(test("few.jsonl", "other.csv").err, HasSubstr("no unit of"));
  EXPECT_EQ(test("few.jsonl", "other.csv").out, "");
}

}  // namespace
}  // namespace wearwell
