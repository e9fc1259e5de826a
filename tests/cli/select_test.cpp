#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string wear = PROJECT_SOURCE_DIR "/examples/select/wear.csv";

class Select : public ScratchTest {
 protected:
  /// The one sentence on standard error of a refused request.
  static std::string refusal(const std::string& arguments) {
    const CommandResult run = run_wearwell("select " + arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.err;
    EXPECT_EQ(run.out, "");
    return run.err;
  }
};

TEST_F(Select, PrintsTheContractAsJson) {
  const CommandResult run =
      run_wearwell("select " + wear + " --response w --inputs Td,n,Mz --degree 2 --keep 3 --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  const json result = json::parse(run.out);
  EXPECT_TRUE(result["certified"]);
  EXPECT_EQ(result["lower_bound"], result["best"]["value"]);
  EXPECT_NEAR(result["best"]["press"], result["best"]["value"], 1e-9);
  EXPECT_EQ(result["models"].size(), 3);
  EXPECT_EQ(result["models"][0]["terms"], result["best"]["terms"]);
  EXPECT_EQ(result["by_size"].size(), 10);
  EXPECT_EQ(result["candidates"],
            json({"1", "Td", "n", "Mz", "Td*Td", "Td*n", "Td*Mz", "n*n", "n*Mz", "Mz*Mz"}));
  EXPECT_EQ(result["submodels"], 1023);
  for (const char* key : {"size", "press", "r2", "r2p", "rmse", "rmsep"})
    EXPECT_TRUE(result["best"][key].is_number()) << key;
  EXPECT_TRUE(result["nodes"].is_number());
  EXPECT_TRUE(result["seconds"].is_number());
  // In order from the best, none above the best of its size.
  double before = 0;
  for (const auto& model : result["models"]) {
    EXPECT_GE(model["press"], before);
    before = model["press"];
    EXPECT_LE(result["by_size"][model["size"].get<int>() - 1]["press"], model["press"]);
  }
  // Leave-one-out RMSE and R2p say the same as PRESS.
  const double rows = result["data"]["rows"];
  const double rmsep = result["best"]["rmsep"];
  EXPECT_NEAR(rmsep * rmsep * rows, result["best"]["press"], 1e-9 * before);
}

// y = 3 + 2 a - b but for 0.001 in two rows.
TEST_F(Select, CoefficientsAreInTheUnitsOfTheTable) {
  const auto file =
      write("plane.csv", "a,b,y\n1,2,3\n2,5,2.001\n4,1,10\n3,3,5.999\n5,9,4\n6,4,11\n");
  const CommandResult run =
      run_wearwell("select " + file.string() + " --response y --inputs a,b --force 1,a,b --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json best = json::parse(run.out)["best"];
  EXPECT_NEAR(best["coefficients"]["1"]["value"], 3, 3e-3);
  EXPECT_NEAR(best["coefficients"]["a"]["value"], 2, 1e-3);
  EXPECT_NEAR(best["coefficients"]["b"]["value"], -1, 1e-3);
  // The range of a is 5.
  EXPECT_NEAR(best["coefficients"]["a"]["scaled"], 10, 5e-3);
}

TEST_F(Select, TermsMayBeNamedOneByOne) {
  const CommandResult run = run_wearwell("select " + wear +
                                         " --response w --terms Td,Td*Td*Mz,n*n*t,Td*n "
                                         "--weights cycles --force n*t*n --criterion bic --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json result = json::parse(run.out);
  EXPECT_EQ(result["candidates"], json({"1", "Td", "Td*Td*Mz", "n*n*t", "Td*n"}));
  EXPECT_EQ(result["forced"], json({"n*n*t"}));
  EXPECT_EQ(result["submodels"], 16);
  EXPECT_EQ(result["criterion"], "bic");
  EXPECT_NEAR(result["best"]["value"], result["best"]["bic"], 1e-9);
}

TEST_F(Select, QueriesChooseRows) {
  const CommandResult run = run_wearwell(
      "select " + wear +
      " --sql 'select *, n * t as slip from data where Td < 200' --response w --inputs slip,Mz "
      "--degree 2 --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LT(json::parse(run.out)["data"]["rows"], 101);
}

TEST_F(Select, AnswersDoNotDependOnThreadsOrTheCloud) {
  const std::string request =
      "select " + wear + " --response w --inputs Td,n,Mz,t --degree 2 --near 0.05 --folds 5 --json";
  json first;
  for (const char* how : {" --threads 1", " --threads 2", " --cloud", " --prove-sizes"}) {
    const CommandResult run = run_wearwell(request + how);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    json result = json::parse(run.out);
    result.erase("seconds");
    result.erase("nodes");
    if (first.is_null()) first = result;
    EXPECT_EQ(result, first) << how;
  }
  EXPECT_GT(first["models"].size(), 10);
  EXPECT_TRUE(first["models"][0]["k_fold_press"].is_number());
}

// 61 terms of pure noise, by leave-one-out: beyond any time limit here, so the search must say how
// far it came.
class HardSelect : public Select {
 protected:
  std::string file() const {
    std::string text;
    for (int t = 1; t <= 60; ++t) text += fmt::format("x{},", t);
    text += "y\n";
    std::uint64_t state = 1;
    for (int row = 0; row < 100; ++row) {
      for (int column = 0; column <= 60; ++column) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        text += fmt::format("{}{}", state >> 40, column < 60 ? "," : "\n");
      }
    }
    return write("noise.csv", text).string();
  }
  static std::string terms() {
    std::string names = "x1";
    for (int t = 2; t <= 60; ++t) names += fmt::format(",x{}", t);
    return names;
  }
};

void expect_honest_gap(const CommandResult& run) {
  EXPECT_EQ(run.exit_code, 1) << run.err;
  const json result = json::parse(run.out);
  EXPECT_FALSE(result["certified"]);
  EXPECT_GT(result["lower_bound"], 0);
  EXPECT_LT(result["lower_bound"], result["best"]["press"]);
}

TEST_F(HardSelect, TimeIsUp) {
  expect_honest_gap(run_wearwell("select " + file() + " --response y --inputs " + terms() +
                                 " --time 0.5 --json"));
  const CommandResult text =
      run_wearwell("select " + file() + " --response y --inputs " + terms() + " --time 0.2");
  EXPECT_EQ(text.exit_code, 1);
  EXPECT_THAT(text.out, HasSubstr("NOT PROVEN"));
  EXPECT_THAT(text.out, HasSubstr("a gap of"));
}

// A signal that comes before the search has begun ends the program (130); a slow machine gets more
// time until then.
TEST_F(HardSelect, CtrlCStopsWithTheBestSoFar) {
  const std::string out = (folder() / "out").string();
  CommandResult run;
  for (const int seconds : {1, 4, 16, 60}) {
    run = run_command(fmt::format("timeout --preserve-status --signal=INT {} '" WEARWELL_BINARY
                                  "' select {} --response y --inputs {} --json -o {}",
                                  seconds, file(), terms(), out));
    if (run.exit_code != 130) break;
    EXPECT_FALSE(std::filesystem::exists(out));
  }
  expect_honest_gap(run);
  // Stopped, and yet whole.
  EXPECT_TRUE(std::filesystem::exists(out + "/summary.json"));
  EXPECT_TRUE(std::filesystem::exists(out + "/report.html"));
}

TEST_F(Select, WritesAFolderOfResults) {
  const std::string out = (folder() / "out").string();
  const CommandResult run =
      run_wearwell("select " + wear + " --response w --inputs Td,Mz --degree 2 -o " + out);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Results are in " + out));
  const CommandResult json_run = run_command("cat " + out + "/summary.json");
  EXPECT_TRUE(json::parse(json_run.out)["certified"]);
  EXPECT_THAT(run_command("head -1 " + out + "/models.csv").out,
              "rank,size,loo,press,r2,r2p,weight,terms\n");
  const std::string page = run_command("cat " + out + "/report.html").out;
  EXPECT_THAT(page, HasSubstr("None of the 63 submodels of 6 terms has a better PRESS."));
  EXPECT_LT(page.size(), 2'000'000);
  // Again over the first, without a report.
  ASSERT_EQ(
      run_wearwell("select " + wear + " --response w --inputs Td --quiet --no-report -o " + out)
          .exit_code,
      0);
  EXPECT_FALSE(std::filesystem::exists(out + "/report.html"));
}

TEST_F(Select, NamesWhatIsWrongInOneSentence) {
  const std::string data = "'" + wear + "'";
  EXPECT_EQ(refusal(data + " --response v --inputs Td"),
            "wearwell: " + wear + " has no column 'v' (nearest: 'n')\n");
  EXPECT_THAT(refusal(data + " --response w --inputs Td,Mx"),
              HasSubstr("has no column 'Mx' (nearest: 'Mz')"));
  EXPECT_THAT(refusal(data + " --inputs Td"), HasSubstr("--response is missing"));
  EXPECT_THAT(refusal(data + " --response w"), HasSubstr("--inputs (with --degree) or --terms"));
  EXPECT_THAT(refusal(data + " --response w --inputs Td --terms Td"), HasSubstr("give one"));
  EXPECT_THAT(refusal(data + " --response w --terms Td --degree 2"), HasSubstr("--degree applies"));
  EXPECT_THAT(refusal(data + " --response w --inputs Td,w"),
              HasSubstr("'w' is the response; it cannot be a term"));
  EXPECT_THAT(refusal(data + " --response w --inputs Td,Td"), HasSubstr("'Td' is given twice"));
  EXPECT_THAT(refusal(data + " --response w --terms Td*n,n*Td"), HasSubstr("are the same"));
  EXPECT_THAT(refusal(data + " --response w --inputs Td --degree 0"),
              HasSubstr("--degree is 0; it must be at least 1"));
  EXPECT_THAT(refusal(data + " --response w --inputs Td,n,Mz,t --degree 5"),
              HasSubstr("--degree 5 in 4 inputs makes 126 terms; a search takes at most 64"));
  EXPECT_THAT(refusal(data + " --response w --inputs Td --criterion aik"),
              HasSubstr("criterion 'aik' is unknown"));
  EXPECT_THAT(refusal(data + " --response w --inputs Td --force Mz"),
              HasSubstr("--force: 'Mz' is not a candidate term"));
  EXPECT_THAT(refusal(data + " --response w --inputs Td --keep 0"), HasSubstr("--keep"));
  EXPECT_THAT(refusal(data + " --response w --inputs Td --near -1"),
              HasSubstr("--near: '-1' must be 0 or more"));
  EXPECT_THAT(refusal(data + " --response w --inputs Td --folds 200"),
              HasSubstr("200 folds; must be 2 to 101"));
  EXPECT_THAT(refusal("nowhere.csv --response w --inputs Td"), HasSubstr("nowhere.csv"));
  EXPECT_THAT(refusal(data + " --sql 'select * from data limit 2' --response w --inputs Td"),
              HasSubstr("has 2 rows; a selection needs at least 3"));

  const std::string odd =
      write("odd.csv", "a,b,c,y,w\n1,x,7,1,1\n2,y,7,2,1\n3,z,7,4,0\n4,u,7,,1\n5,v,7,6,1\n")
          .string();
  EXPECT_EQ(refusal(odd + " --response a --inputs b"),
            "wearwell: " + odd + ", row 1, column 'b': 'x' is not a number\n");
  EXPECT_THAT(refusal(odd + " --response y --inputs a"),
              AllOf(HasSubstr(odd + ", row 4, column 'y': no value (empty or NaN)"),
                    HasSubstr("--sql"), HasSubstr("where \"y\" is not null")));
  EXPECT_THAT(refusal(odd + " --response a --inputs c"), HasSubstr("column 'c' is 7 in every row"));
  EXPECT_THAT(refusal(odd + " --response c --inputs a"), HasSubstr("column 'c' is 7 in every row"));
  EXPECT_THAT(refusal(odd + " --sql 'select * from data where y is not null' --response y --inputs "
                            "a --weights w"),
              HasSubstr("row 3, column 'w': the weight is 0; it must be positive"));
}

TEST_F(Select, SaysWhichTermsAreDependent) {
  const std::string file =
      write("dependent.csv", "a,b,y\n1,2,1.1\n2,4,2\n3,6,2.8\n4,8,4.2\n5,10,5\n").string();
  const CommandResult run = run_wearwell("select " + file + " --response y --inputs a,b");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("b is a combination of a: models with all of them were skipped"));
}

}  // namespace
}  // namespace wearwell
