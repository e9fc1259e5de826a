// Posterior means of whole studies beside rstan's (tests/golden/formula_rstan.R), to its Monte Carlo error.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/golden.h"
#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

class BesideRstan : public ScratchTest {
 protected:
  void expect_means(const std::string& name, const std::filesystem::path& file) const {
    const PosteriorSummary result =
        run_study(wearwell::read_posterior_study(file), {Method::exact, 1, {}, 50, {}}, {}, false);
    std::size_t compared = 0;
    for (const auto& row : read_golden("formula_rstan.csv")) {
      if (row[0] != name) continue;
      const auto at = std::find_if(result.parameters.begin(), result.parameters.end(),
                                   [&](const auto& each) { return each.name == row[1]; });
      ASSERT_NE(at, result.parameters.end()) << row[1];
      ASSERT_TRUE(at->exact) << row[1];
      // Eight means: one of a thousand right ones is farther off than three errors.
      EXPECT_NEAR(at->exact->mean, std::stod(row[2]), 3.3 * std::stod(row[3])) << name << row[1];
      EXPECT_NEAR(at->exact->sd / std::stod(row[4]), 1, 0.03) << name << " " << row[1];
      ++compared;
    }
    EXPECT_EQ(compared, result.parameters.size()) << name;
  }
};

const std::string examples = PROJECT_SOURCE_DIR "/examples/";

TEST_F(BesideRstan, WeibullLives) {
  expect_means("life", examples + "life/study.toml");
}

TEST_F(BesideRstan, ArrheniusLivesWithRunoutsAndCounts) {
  expect_means("accelerated", examples + "accelerated/study.toml");
}

TEST_F(BesideRstan, WearOfMachinesThatDiffer) {
  expect_means("formula", examples + "formula/study.toml");
}

// Machines that differ, read by operators who differ (formula_drawn_test.cpp has the law): by NUTS on both sides.
TEST_F(BesideRstan, TwoLabelsThatCross) {
  const PosteriorSummary result =
      run_study(wearwell::read_posterior_study(std::filesystem::path(PROJECT_SOURCE_DIR) /
                                               "tests/golden/formula_crossed.toml"),
                {Method::nuts, 4, 1000, 5000, 7}, {}, false);
  std::size_t compared = 0;
  for (const auto& row : read_golden("formula_rstan.csv")) {
    if (row[0] != "crossed") continue;
    const auto at = std::find_if(result.parameters.begin(), result.parameters.end(),
                                 [&](const auto& each) { return each.name == row[1]; });
    ASSERT_NE(at, result.parameters.end()) << row[1];
    const double error = std::hypot(std::stod(row[3]), at->mcse);
    EXPECT_NEAR(at->mean, std::stod(row[2]), 3.3 * error) << row[1];
    EXPECT_NEAR(at->sd / std::stod(row[4]), 1, 0.06) << row[1];
    ++compared;
  }
  EXPECT_EQ(compared, 4U);
}

}  // namespace
}  // namespace wearwell
