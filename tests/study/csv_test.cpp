#include "wearwell/study/csv.h"

#include <gmock/gmock.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "study/sample.h"

namespace wearwell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  if (!text.empty() && text.back() == ',') parts.emplace_back();
  return parts;
}

// As R's read.csv(comment.char = "#") and posterior's read_cmdstan_csv see it.
std::vector<std::vector<std::string>> rows(const std::string& csv) {
  std::vector<std::vector<std::string>> table;
  for (const std::string& line : split(csv, '\n')) {
    if (line.front() != '#') table.push_back(split(line, ','));
  }
  return table;
}

TEST(DrawsCsv, HasTheColumnsOfCmdStan) {
  const auto table = rows(draws_csv(sample_result(), 0));
  ASSERT_EQ(table.size(), 4u);
  EXPECT_THAT(table[0], ElementsAre("lp__", "accept_stat__", "stepsize__", "treedepth__",
                                    "n_leapfrog__", "divergent__", "energy__", "k", "sigma"));
  EXPECT_THAT(table[2],
              ElementsAre("-0.1", "0.8", "0.625", "2", "3", "1", testing::_, "1e-300", "2.5"));
}

TEST(DrawsCsv, ReadsBackAsTheSameDoubles) {
  const PosteriorSummary result = sample_result();
  for (std::size_t c = 0; c < 2; ++c) {
    const Chain& chain = result.posterior_draws[c];
    const auto table = rows(draws_csv(result, c));
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(table[i + 1].size(), 9u);
      EXPECT_EQ(std::stod(table[i + 1][0]), chain.log_density[i]);
      EXPECT_EQ(std::stod(table[i + 1][6]), chain.nuts[i].energy);
      for (int p = 0; p < 2; ++p) {
        EXPECT_EQ(std::strtod(table[i + 1][7 + static_cast<std::size_t>(p)].c_str(), nullptr),
                  chain.values(static_cast<Eigen::Index>(i), p));
      }
    }
  }
}

TEST(DrawsCsv, CommentsSayHowItWasDrawn) {
  const std::string csv = draws_csv(sample_result(), 1);
  for (const char* line :
       {"# num_samples = 3\n", "# num_warmup = 100\n", "# save_warmup = 0\n", "# id = 2\n",
        "# seed = 18446744073709551615\n", "# unit of k = mm^3/(N m)\n", "# unit of sigma = mm^3\n",
        "# Adaptation terminated\n# Step size = 0.625\n", "# 1, 2\n"}) {
    EXPECT_THAT(csv, HasSubstr(line));
  }
}

TEST(DrawsCsv, OtherMethodsHaveTheDensityAlone) {
  PosteriorSummary result = sample_result();
  for (Chain& chain : result.posterior_draws) chain.nuts.clear();
  const auto table = rows(draws_csv(result, 0));
  EXPECT_THAT(table[0], ElementsAre("lp__", "k", "sigma"));
  EXPECT_EQ(table[1].size(), 3u);
}

TEST(PredictionsCsv, OfStages) {
  const auto table = rows(predictions_csv(sample_result()));
  ASSERT_EQ(table.size(), 2u);
  EXPECT_THAT(table[0], ElementsAre("rows", "cycles", "quantity", "unit", "mean", "ci05", "ci95",
                                    "pi05", "pi95", "measured"));
  EXPECT_THAT(table[1], ElementsAre("1", "20585", "volume", "mm^3", "91.5", "88.5", "94.5", "80.5",
                                    "101.5", "92.73"));
}

// What quadrature gives, as in the report.
TEST(PredictionsCsv, WithoutStagesOfAllRows) {
  PosteriorSummary result = sample_result();
  result.stages.clear();
  const auto table = rows(predictions_csv(result));
  ASSERT_EQ(table.size(), 2u);
  EXPECT_THAT(table[1], ElementsAre("2", "20585", "volume", "mm^3", "91.5", "88.5", "94.5", "80.5",
                                    "101.5", ""));
}

// A study of lives has no measurements at points: its predictions are lives, B-lives and what the next under
// each test's conditions does.
TEST(PredictionsCsv, OfLivesWhatWasAskedThenEachTest) {
  PosteriorSummary result = sample_result();
  result.predictions.clear();
  for (StageSummary& stage : result.stages) stage.predictions.clear();
  result.quantities = {
      {"life", "new type A", "at 5, 6 MPa", "cycles", true, {1, 2, 3, 0.5, 1.5, 2}, {}},
      {"B10 life", "type A", "", "cycles", false, {4, 5, 6}, {}}};
  result.quantities[1].drawn.predictive = 4.5;
  result.quantities[1].drawn.bound = 4.25;
  result.coverage = CoverageTable{"cycles", {{7, "A", "runout", 2.5, {}, 0.6, 1, 3, 1.5}}, 1};
  EXPECT_EQ(predictions_csv(result),
            "rows,quantity,of,at,unit,q05,q50,q95,bound,predictive,b1,b10,measured,outcome\n"
            "2,life,new type A,\"at 5, 6 MPa\",cycles,1,2,3,,,0.5,1.5,,\n"
            "2,B10 life,type A,,cycles,4,5,6,4.25,4.5,,,,\n"
            "2,life,test of type A,row 7,cycles,1,,3,,,,1.5,2.5,runout\n");
}

}  // namespace
}  // namespace wearwell
