#include "wearwell/workbench/family_papers.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <tuple>

#include "wearwell/prob/standard_distribution.h"

namespace wearwell::workbench {
namespace {

using Numbers = std::vector<double>;

// Lieblein and Zelen (1956), million revolutions.
const Numbers bearings = {17.88, 28.92, 33,     41.52,  42.12,  45.6,   48.48, 51.84,
                          51.96, 54.12, 55.56,  67.8,   68.64,  68.64,  68.88, 84.12,
                          93.12, 98.64, 105.12, 105.84, 127.92, 128.04, 173.4};

std::vector<Response> exact(const Numbers& lives, int repeated = 1) {
  std::vector<Response> all;
  for (int i = 0; i < repeated; ++i)
    for (const double each : lives) all.push_back({Censoring::none, each});
  return all;
}

std::vector<Response> pumps() {
  std::vector<Response> all = exact({212.5, 305, 371, 418.5, 466, 509, 540, 588, 633, 702, 749});
  for (int i = 0; i < 4; ++i) all.push_back({Censoring::right, 1800});
  return all;
}

std::vector<int> ones(const std::vector<Response>& responses) {
  return std::vector<int>(responses.size(), 1);
}

struct Known {
  Numbers parameters;
  double log_likelihood;
};

void expect_fits(const std::vector<Response>& lives, const std::map<std::string, Known>& known) {
  for (const auto& [name, expected] : known) {
    const auto found = fitted_family(form_named(name), lives, ones(lives));
    ASSERT_TRUE(found) << name;
    EXPECT_NEAR(found->log_likelihood, expected.log_likelihood, 2e-6) << name;
    EXPECT_NEAR(found->aic(), 4 - 2 * expected.log_likelihood, 4e-6) << name;
    ASSERT_EQ(found->parameters.size(), expected.parameters.size());
    for (std::size_t i = 0; i < expected.parameters.size(); ++i)
      EXPECT_NEAR(found->parameters[i] / expected.parameters[i], 1, 2e-4) << name << i;
  }
}

// Maximized by R's optim over its own densities and tails.
TEST(FamilyPapers, AgreesWithMaximaOfR) {
  expect_fits(exact(bearings), {{"weibull", {{81.8783335, 2.1020588}, -113.691291}},
                                {"lognormal", {{63.46283686, 0.52164932}, -113.128567}},
                                {"gamma", {{4.025415, 17.942088}, -113.029281}},
                                {"loglogistic", {{64.0003991, 3.3470257}, -113.372259}},
                                {"inverse-gaussian", {{72.224345, 231.68408}, -113.204953}}});
  expect_fits(pumps(), {{"weibull", {{1145.4286173, 1.1505425}, -88.4084131}},
                        {"lognormal", {{762.61953773, 0.88121097}, -86.194364}},
                        {"gamma", {{1.5227404, 693.488893}, -88.0511226}},
                        {"loglogistic", {{688.5277594, 1.9331956}, -86.2320807}},
                        {"inverse-gaussian", {{1270.6504, 1021.9952}, -85.5808222}}});
}

// A third parameter cannot lower the maximum of the family that it contains.
TEST(FamilyPapers, WiderFamiliesContainNarrowerOnes) {
  const auto lives = exact(bearings);
  const auto log_likelihood = [&](const char* name) {
    const auto found = fitted_family(form_named(name), lives, ones(lives));
    EXPECT_TRUE(found) << name;
    return found ? found->log_likelihood : std::nan("");
  };
  const double weibull = log_likelihood("weibull"), lognormal = log_likelihood("lognormal");
  EXPECT_GE(log_likelihood("exponentiated-weibull"), weibull - 1e-6);
  EXPECT_GE(log_likelihood("generalized-gamma"), std::max(weibull, lognormal) - 1e-6);
}

TEST(FamilyPapers, ManyLivesAreFittedAsFewAre) {
  const auto many = exact(bearings, 100);
  for (const char* const name : {"weibull", "lognormal", "frechet", "birnbaum-saunders"}) {
    const auto few = fitted_family(form_named(name), exact(bearings), ones(exact(bearings)));
    const auto found = fitted_family(form_named(name), many, ones(many));
    ASSERT_TRUE(few && found) << name;
    EXPECT_NEAR(found->log_likelihood, 100 * few->log_likelihood, 1e-3) << name;
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(found->parameters[i] / few->parameters[i], 1, 1e-3) << name;
  }
}

// A slope in proportion to the number of lives once ended each search at its first step.
TEST(FamilyPapers, MillionsOfLivesHaveTheMaximumOfTheirShares) {
  const auto lives = pumps();
  for (const char* name : {"weibull", "lognormal", "gamma", "generalized-gamma"}) {
    const auto one = fitted_family(form_named(name), lives, ones(lives));
    const auto many =
        fitted_family(form_named(name), lives, std::vector<int>(lives.size(), 1000000));
    ASSERT_TRUE(one && many) << name;
    EXPECT_NEAR(many->log_likelihood / one->log_likelihood / 1e6, 1, 1e-9) << name;
  }
}

TEST(FamilyPapers, EqualLivesHaveNoMaximum) {
  const auto equal = exact(Numbers(5, 100.0));
  EXPECT_FALSE(fitted_family(form_named("weibull"), equal, ones(equal)));
  EXPECT_FALSE(fitted_family(form_named("lognormal"), equal, ones(equal)));
}

// A distribution is straight on its own paper, and curved on another.
TEST(FamilyPapers, LinesAreStraightOnTheirPaper) {
  const auto bend = [](const std::vector<PlottingPosition>& line) {
    const auto& [a, m, b] = std::tuple(line.front(), line[line.size() / 2], line.back());
    const double share = std::log(m.at / a.at) / std::log(b.at / a.at);
    return std::abs(m.p - std::lerp(a.p, b.p, share));
  };
  const auto lives = exact(bearings);
  for (const char* const name : {"weibull", "lognormal", "loglogistic"}) {
    const auto found = fitted_family(form_named(name), lives, ones(lives));
    EXPECT_LT(bend(line_on_paper(*found, 0.01, 0.99)), 1e-9) << name;
  }
  const auto gamma = fitted_family(form_named("gamma"), lives, ones(lives));
  EXPECT_GT(bend(line_on_paper(*gamma, 0.01, 0.99)), 0.05);
}

TEST(FamilyPapers, PointsAreThinnedEvenlyAndStayOnThePaper) {
  std::vector<PlottingPosition> positions;
  for (int i = 0; i <= 1000; ++i) positions.push_back({1.0 + i, i / 1000.0});
  const Paper& paper = form_named("weibull").paper;
  const auto shown = on_paper(paper, positions, 100);
  ASSERT_EQ(shown.size(), 100u);
  EXPECT_EQ(shown.front().at, 2);  // the share 0 has no place
  EXPECT_EQ(shown.back().at, 1000);
  EXPECT_NEAR(cdf(paper.distribution, shown[50].p), (shown[50].at - 1) / 1000, 1e-12);
}

}  // namespace
}  // namespace wearwell::workbench
