#include "wearwell/plan/size.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <boost/math/distributions/gamma.hpp>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/models/registry.h"
#include "wearwell/plan/assurance.h"
#include "wearwell/plan/planning_study.h"
#include "wearwell/study/model.h"

namespace wearwell::plan {
namespace {

using testing::HasSubstr;

TEST(Allocation, TakesTheFirstOfALongerOne) {
  const std::vector<double> shares = {0.5, 0.3, 0.2};
  const std::vector<std::size_t> all = allocation(shares, 100);
  for (const std::size_t n : {1, 7, 10, 40, 100}) {
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const auto placed = std::count(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n), k);
      EXPECT_NEAR(static_cast<double>(placed), shares[k] * static_cast<double>(n), 1) << n;
    }
  }
}

// Shares that follow a probit line are solved for.
TEST(SearchAssurance, FindsTheSizeOfAProbitLine) {
  const auto share = [](double n) {
    return 0.5 * std::erfc(-(-4 + 1.2 * std::log(n)) / std::sqrt(2.0));
  };
  const AssuranceSearch search = search_assurance(
      [&](std::size_t n) {
        return AssurancePoint{
            n, static_cast<std::size_t>(std::lround(1e6 * share(static_cast<double>(n)))),
            1'000'000};
      },
      4, 1000, 0.8);
  ASSERT_TRUE(search.reached);
  const double exact = std::exp((4 + 0.8416212) / 1.2);
  EXPECT_TRUE(search.smallest.smoothed);
  EXPECT_EQ(search.smallest.size, static_cast<std::size_t>(std::ceil(exact)));
  EXPECT_LT(search.smallest.low, exact);
  EXPECT_GT(search.smallest.high, exact);
}

TEST(SearchAssurance, FindsAJump) {
  for (const std::size_t jump : {1, 2, 5, 37, 1000}) {
    const AssuranceSearch search = search_assurance(
        [&](std::size_t n) {
          return AssurancePoint{n, n >= jump ? 50U : 0U, 50};
        },
        4, 1000, 0.8);
    ASSERT_TRUE(search.reached);
    EXPECT_EQ(search.smallest.size, jump);
  }
  EXPECT_FALSE(search_assurance(
                   [](std::size_t n) {
                     return AssurancePoint{n, 0, 50};
                   },
                   4, 100, 0.8)
                   .reached);
}

Table table(const std::vector<std::pair<std::string, double>>& cells) {
  Table rows{"tests.csv", {}, 1};
  for (const auto& [name, value] : cells) rows.columns.push_back({name, true, {value}, {}});
  return rows;
}

Source study(const std::string& text) {
  return {TextFile{"study.toml", text}};
}

Answer asked(const std::string& text, const Table& tests, const SizeQuestion& question) {
  return size(question, study(text), tests,
              [](const Source& source) { return read_study(source, all_models()); });
}

const std::string normal_mean = R"toml(
title = "Mean"
model = "formula"
[data]
file = "there-is-none.csv"
[data.columns]
depth = { column = "h_um", unit = "um" }
[constants]
s = "3 um"
[likelihood.depth]
family = "normal"
mean = "mu"
sd = "s"
[prior]
mu = { distribution = "normal", mean = "10 um", sd = "5 um" }
)toml";

// The width of a normal mean with known sd is 2 z / sqrt(1/5^2 + n/3^2) um, whatever is measured.
TEST(Size, OfANormalMeanIsExact) {
  SizeQuestion question{"mu", "4 um"};
  question.simulations = 20;
  const Answer answer = asked(normal_mean, table({{"specimens", 1}}), question);
  const double z = 1.6448536;
  const double exact = 9 * (std::pow(2 * z / 4, 2) - 1.0 / 25);
  EXPECT_EQ(answer.json["specimens"], std::ceil(exact));
  for (const auto& each : answer.json["sizes"]) {
    const double n = each["specimens"];
    EXPECT_NEAR(each["median_width"].get<double>(), 2 * z / std::sqrt(1.0 / 25 + n / 9), 0.01);
    EXPECT_EQ(each["unresolved"], 0);
  }
}

// Lives with a known shape: t^2 is exponential with the rate r = 1 / scale^2, and a gamma prior of r
// is conjugate: after n failures r is gamma(a + n, b + sum of t^2). The ratio of its quantiles
// depends on n only, so the assurance jumps.
const std::string known_shape = R"toml(
title = "Known shape"
model = "formula"
[data]
file = "there-is-none.csv"
[data.columns]
life = { column = "t", unit = "h" }
[formula]
scale = "1/sqrt(rate)"
[likelihood.life]
family = "weibull"
scale = "scale"
shape = "2"
[prior]
rate = { distribution = "gamma", shape = 3, scale = "1e-6 1/h^2" }
)toml";

TEST(Size, OfAWeibullLifeWithKnownShapeIsThatOfTheConjugatePrior) {
  SizeQuestion question{"rate", "factor 3"};
  question.simulations = 20;
  const Answer answer = asked(known_shape, table({{"specimens", 1}}), question);
  const auto ratio = [](double n) {
    const boost::math::gamma_distribution<> posterior(3 + n, 1);
    return quantile(posterior, 0.95) / quantile(posterior, 0.05);
  };
  int exact = 1;
  while (ratio(exact) > 3) ++exact;
  EXPECT_EQ(answer.json["specimens"], exact);
  for (const auto& each : answer.json["sizes"]) {
    EXPECT_NEAR(each["median_width"].get<double>(), ratio(each["specimens"]), 0.01);
    EXPECT_EQ(each["failures"], each["specimens"]);
  }
}

// Counts of a Poisson distribution with a gamma prior of the rate: the posterior after Y counts in n
// areas is gamma(2 + Y, ...), whose ratio of quantiles depends on Y only, and Y is a Poisson count
// of a gamma rate.
TEST(Size, OfCountsIsTheConjugatePrior) {
  const std::string counts = R"toml(
title = "Counts"
model = "formula"
[data]
file = "there-is-none.csv"
[data.columns]
pits = "pits"
area = "area"
[likelihood.pits]
family = "poisson"
mean = "rate*area"
[prior]
rate = { distribution = "gamma", shape = 2, scale = 0.5 }
)toml";
  SizeQuestion question{"rate", "factor 3"};
  question.simulations = 30;
  const Answer answer = asked(counts, table({{"area", 5}}), question);
  const auto narrow = [](double y) {
    const boost::math::gamma_distribution<> posterior(2 + y, 1);
    return quantile(posterior, 0.95) / quantile(posterior, 0.05) <= 3;
  };
  for (const auto& each : answer.json["sizes"]) {
    const double area = 5 * each["specimens"].get<double>();
    double wide = 0;
    for (double y = 0; !narrow(y); ++y)
      wide += std::exp(std::lgamma(2 + y) - std::lgamma(y + 1) + 2 * std::log(2 / (2 + area)) +
                       y * std::log(area / (2 + area)));
    EXPECT_NEAR(each["assurance"].get<double>(), 1 - wide, 4 * std::sqrt(wide * (1 - wide) / 30))
        << area;
  }
}

TEST(Size, RefusesWhatItCannotPlan) {
  const auto refusal = [](const std::string& text, const Table& tests,
                          const SizeQuestion& question) -> std::string {
    try {
      asked(text, tests, question);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const Table tests = table({{"specimens", 1}});
  const SizeQuestion good{"mu", "4 um"};
  std::string flat = normal_mean;
  flat.replace(flat.find("{ distribution = \"normal\""), std::string::npos,
               "{ distribution = \"flat\", unit = \"um\" }\n");
  EXPECT_THAT(refusal(flat, tests, good), HasSubstr("the prior of mu is improper"));
  SizeQuestion wrong = good;
  wrong.goal = "B10 at hanger";
  EXPECT_THAT(refusal(normal_mean, tests, wrong), HasSubstr("--goal"));
  wrong = good;
  wrong.width = "factor 0.9";
  EXPECT_THAT(refusal(normal_mean, tests, wrong), HasSubstr("must be above 1"));
  wrong.width = "4 kg";
  EXPECT_THAT(refusal(normal_mean, tests, wrong), HasSubstr("--width"));
  wrong = good;
  wrong.assurance = "120 %";
  EXPECT_THAT(refusal(normal_mean, tests, wrong), HasSubstr("--assurance"));
  EXPECT_THAT(refusal(normal_mean, table({{"stress", 1}}), good), HasSubstr("stress"));
}

}  // namespace
}  // namespace wearwell::plan
