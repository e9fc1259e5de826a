// Median rank regression, against published tables and fits.
#include "wearwell/prob/rank_regression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/golden.h"

namespace wearwell {
namespace {

std::vector<Response> with_runouts(const std::vector<std::pair<double, bool>>& lives) {
  std::vector<Response> all;
  for (const auto& [at, failed] : lives)
    all.push_back({.seen = failed ? Censoring::none : Censoring::right, .at = at});
  return all;
}

// 38 shock absorbers; km and "censored" or a mode.
std::vector<Response> shock_absorbers() {
  std::ifstream file(PROJECT_SOURCE_DIR "/examples/life/shock_absorbers.csv");
  std::vector<std::pair<double, bool>> lives;
  std::string line;
  for (std::getline(file, line); std::getline(file, line);)
    lives.emplace_back(std::stod(line), line.find("censored") == line.npos);
  return with_runouts(lives);
}

// Eight items, three of them suspended (Abernethy 2006, table 4-2).
TEST(RankRegression, RanksAreAdjustedForRunouts) {
  const std::vector<Response> lives = with_runouts({{10, false},
                                                    {30, true},
                                                    {45, false},
                                                    {49, true},
                                                    {82, true},
                                                    {90, true},
                                                    {96, true},
                                                    {100, false}});
  const auto ranked = ranked_failures(lives, std::vector<int>(8, 1), MedianRanks::benard);
  const double rank[] = {1.125, 2.4375, 3.75, 5.0625, 6.375};
  ASSERT_EQ(ranked.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(ranked[i].rank, rank[i], 1e-12);
    EXPECT_NEAR(ranked[i].p, (rank[i] - 0.3) / 8.4, 1e-12);
  }
}

// Tables of median ranks have 12.94, 31.38, 50.00, 68.62, 87.06 % for five items. Of the first, 1 - 0.5^(1/n).
TEST(RankRegression, ExactMedianRanksAreThoseOfTables) {
  const std::vector<Response> lives =
      with_runouts({{1, true}, {2, true}, {3, true}, {4, true}, {5, true}});
  const auto ranked = ranked_failures(lives, std::vector<int>(5, 1), MedianRanks::exact);
  const double percent[] = {12.94, 31.38, 50.00, 68.62, 87.06};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(100 * ranked[i].p, percent[i], 0.006);
  EXPECT_NEAR(ranked[0].p, 1 - std::pow(0.5, 0.2), 1e-12);
}

// The fits of R's package weibulltools 2.1 (rank_regression of estimate_cdf(method = "johnson"), its tests' reference output): location and scale
// of log life, r^2.
TEST(RankRegression, ShockAbsorbersAreThoseOfWeibulltools) {
  const auto ranked =
      ranked_failures(shock_absorbers(), std::vector<int>(38, 1), MedianRanks::benard);
  ASSERT_EQ(ranked.size(), 11u);
  const struct {
    StandardDistribution distribution;
    bool logarithmic;
    double location, scale, r2;
  } published[] = {
      {StandardDistribution::smallest_extreme_value, true, 10.2595802, 0.3632051, 0.9901585},
      {StandardDistribution::normal, true, 10.1485956, 0.5817617, 0.9641187},
      {StandardDistribution::logistic, true, 10.1341532, 0.3210509, 0.9820248}};
  for (const auto& each : published) {
    const auto line = rank_regression(ranked, each.distribution, each.logarithmic);
    ASSERT_TRUE(line);
    EXPECT_NEAR(line->location, each.location, 1e-7);
    EXPECT_NEAR(line->scale, each.scale, 1e-7);
    EXPECT_NEAR(line->r * line->r, each.r2, 1e-7);
  }
}

TEST(RankRegression, CountsAreItemsAndTiesHaveARankEach) {
  const std::vector<Response> counted = with_runouts({{1, true}, {2, true}, {2, false}, {3, true}});
  const std::vector<Response> listed =
      with_runouts({{2, true}, {1, true}, {2, false}, {3, true}, {2, true}, {2, false}});
  const auto a = ranked_failures(counted, std::vector<int>{1, 2, 2, 1}, MedianRanks::exact);
  const auto b = ranked_failures(listed, std::vector<int>(6, 1), MedianRanks::exact);
  ASSERT_EQ(a.size(), 4u);
  ASSERT_EQ(b.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(a[i].at, b[i].at);
    EXPECT_EQ(a[i].p, b[i].p);
  }
  // The run-outs at 2 come after the failures there: ranks 1, 2, 3, then 3 + (7 - 3)/(1 + 1).
  EXPECT_NEAR(a[2].rank, 3, 1e-12);
  EXPECT_NEAR(a[3].rank, 5, 1e-12);
}

TEST(RankRegression, NeedsTwoLivesThatDiffer) {
  const auto of = [](const std::vector<std::pair<double, bool>>& lives) {
    return rank_regression(
        ranked_failures(with_runouts(lives), std::vector<int>(lives.size(), 1), MedianRanks::exact),
        StandardDistribution::smallest_extreme_value, true);
  };
  EXPECT_FALSE(of({{5, true}, {9, false}}));
  EXPECT_FALSE(of({{5, true}, {5, true}, {5, true}}));
  EXPECT_FALSE(of({{5, false}}));
  EXPECT_TRUE(of({{5, true}, {6, true}}));
}

TEST(RankRegression, ALineGivesBackItsFamily) {
  for (const ResponseFamily family :
       {ResponseFamily::weibull, ResponseFamily::lognormal, ResponseFamily::log10_normal,
        ResponseFamily::lognormal_by_moments, ResponseFamily::loglogistic, ResponseFamily::normal,
        ResponseFamily::smallest_extreme_value, ResponseFamily::largest_extreme_value}) {
    const ResponseForm& form = form_of(family);
    const double given[] = {120, 3};
    std::vector<RankedFailure> failures;
    for (const double p : {0.1, 0.3, 0.6, 0.9})
      failures.push_back({quantile(family, p, given), 0, p});
    const auto line = rank_regression(failures, form.paper.distribution, form.positive);
    ASSERT_TRUE(line);
    EXPECT_NEAR(line->r, 1, 1e-12) << form.name;
    const auto found = family_parameters_of(family, *line);
    ASSERT_TRUE(found) << form.name;
    EXPECT_NEAR((*found)[0], 120, 1e-8) << form.name;
    EXPECT_NEAR((*found)[1], 3, 1e-9) << form.name;
  }
  EXPECT_FALSE(family_parameters_of(ResponseFamily::gamma, {0, 1, 1}));
}

}  // namespace
}  // namespace wearwell
