// The bounds that a staircase study reports of its limits.
#include "wearwell/models/fatigue/staircase_study.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

class StaircaseStudyTest : public ScratchTest {
 protected:
  // The limit for half of the items to survive, from 999 equal draws of log10(Pa).
  QuantityQuantiles limit(const std::string& predict) {
    PosteriorStudy study;
    read(predict, study);
    Eigen::Index count = 999;
    WeightedDraws draws{Points(count, 2), Eigen::VectorXd::Constant(count, 1.0 / count), {}, {}};
    for (Eigen::Index i = 0; i < count; ++i) {
      draws.values(i, 0) = 8 + static_cast<double>(i + 1) / 1000;
      draws.values(i, 1) = 0.03;
    }
    return study.quantity_groups.front().from_draws(draws).front();
  }
  void read(const std::string& predict, PosteriorStudy& study) {
    write("d.csv", "stress,status\n300,failed\n290,runout\n");
    const Source source = source_of(
        write("study.toml",
              "model = \"staircase\"\n[data]\nfile = \"d.csv\"\n[data.columns]\nalternating_stress "
              "= { column = \"stress\", unit = \"MPa\" }\nstatus = \"status\"\n[predict]\n"
              "reliability = \"50 %\"\n" +
                  predict));
    read_staircase_study(TomlReader::parse(source.study), source, study);
  }
};

TEST_F(StaircaseStudyTest, BoundsAreOfTheLevelAndTheSides) {
  const auto at = [](double p) { return std::pow(10, 8 + p); };
  const double near = 0.005;  // of the logarithm, of steps between draws
  const QuantityQuantiles lower = limit("");
  ASSERT_TRUE(lower.bound);
  EXPECT_FALSE(lower.upper_bound);
  EXPECT_NEAR(std::log(*lower.bound / at(0.1)), 0, near);
  const QuantityQuantiles upper = limit("level = 0.8\nsides = \"upper\"\n");
  EXPECT_FALSE(upper.bound);
  ASSERT_TRUE(upper.upper_bound);
  EXPECT_NEAR(std::log(*upper.upper_bound / at(0.8)), 0, near);
  const QuantityQuantiles both = limit("level = \"95 %\"\nsides = \"both\"\n");
  ASSERT_TRUE(both.bound && both.upper_bound);
  EXPECT_NEAR(std::log(*both.bound / at(0.025)), 0, near);
  EXPECT_NEAR(std::log(*both.upper_bound / at(0.975)), 0, near);
  EXPECT_NEAR(std::log(*limit("credible_level = 0.75\n").bound / at(0.25)), 0, near);
}

TEST_F(StaircaseStudyTest, RefusesLives) {
  PosteriorStudy study;
  EXPECT_NE(message_of<InputError>([&] { read("b_lives = [10]\n", study); }).find("reliability"),
            std::string::npos);
  EXPECT_NE(message_of<InputError>([&] {
              read("level = 0.9\ncredible_level = 0.9\n", study);
            }).find("write one of the two"),
            std::string::npos);
}

}  // namespace
}  // namespace wearwell
