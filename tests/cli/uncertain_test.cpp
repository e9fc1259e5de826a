#include "wearwell/models/bearing/uncertain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "wearwell/base/error.h"

namespace wearwell {
namespace {

using Distribution = Uncertain::Distribution;

void expect(const Uncertain& q, Distribution law, double mean, double sd) {
  EXPECT_EQ(q.distribution, law);
  EXPECT_NEAR(q.mean, mean, 1e-15 * std::abs(mean));
  EXPECT_NEAR(q.sd, sd, 1e-14 * sd);
}

TEST(Uncertain, ReadsEveryForm) {
  expect(read_uncertain("0.1 mm", "m"), Distribution::exact, 1e-4, 0);
  expect(read_uncertain("0.100 +- 0.005 mm", "m"), Distribution::normal, 1e-4, 5e-6);
  expect(read_uncertain("0.100±0.005 mm", "m"), Distribution::normal, 1e-4, 5e-6);
  expect(read_uncertain("0.100 +/- 0.005 mm", "m"), Distribution::normal, 1e-4, 5e-6);
  expect(read_uncertain("0.1 mm +- 5 um", "m"), Distribution::normal, 1e-4, 5e-6);
  expect(read_uncertain("2 MPa +- 10 %", "Pa"), Distribution::normal, 2e6, 2e5);
  expect(read_uncertain("1e5 +- 10 %", "1"), Distribution::normal, 1e5, 1e4);
  expect(read_uncertain("1e5 +- 300", "1"), Distribution::normal, 1e5, 300);
  expect(read_uncertain(" ~ lognormal(0.1 mm, 5 um) ", "m"), Distribution::lognormal, 1e-4, 5e-6);
  expect(read_uncertain("~normal( 0.1 mm , 5 um )", "m"), Distribution::normal, 1e-4, 5e-6);
  expect(read_uncertain("~ uniform(2 mm, 8 mm)", "m"), Distribution::uniform, 5e-3,
         6e-3 / std::sqrt(12));
  expect(read_uncertain("0.1 +- 0 mm", "m"), Distribution::exact, 1e-4, 0);
  expect(read_uncertain("20 +- 2 degC", "K"), Distribution::normal, 293.15, 2);
  EXPECT_EQ(read_uncertain(" 0.1 +- 0.01 mm ", "m").text, "0.1 +- 0.01 mm");
}

// A factor is that of one standard deviation of the logarithm: two in three lie between median/2 and
// twice the median. plnorm(2, 0, log(2)) - plnorm(.5, 0, log(2)) = 0.6826895.
TEST(Uncertain, AFactorIsLognormalAboutItsMedian) {
  for (const char* text : {"0.1 mm x/ 2", "0.1 mm ×/ 2", "0.1 mm ×÷2", "100 um x/2"}) {
    const Uncertain q = read_uncertain(text, "m");
    EXPECT_EQ(q.distribution, Distribution::lognormal) << text;
    EXPECT_NEAR(q.centre, 1e-4, 1e-18) << text;
    EXPECT_NEAR(q.mean / 1e-4, std::exp(0.5 * std::log(2) * std::log(2)), 1e-14);
    EXPECT_NEAR(equal_factor(q), 2, 1e-12);
  }
  const Uncertain q = read_uncertain("0.1 mm x/ 2", "m");
  Rng rng(1, 0);
  int below = 0, between = 0;
  constexpr int draws = 100'000;
  for (int i = 0; i < draws; ++i) {
    const double x = draw(q, rng);
    below += x < 1e-4;
    between += x > 0.5e-4 && x < 2e-4;
  }
  EXPECT_NEAR(below, 0.5 * draws, 4 * std::sqrt(0.25 * draws));
  EXPECT_NEAR(between, 0.6826895 * draws, 4 * std::sqrt(0.22 * draws));
  EXPECT_EQ(read_uncertain("0.1 +- 0.005 mm", "m").centre, 1e-4);
  for (const char* text : {"0.1 mm x/ 1", "0.1 mm x/ 0.5", "0.1 mm x/", "x/ 2", "0.1 mm x/ 2 mm",
                           "-0.1 mm x/ 2", "0.1 mm x/ inf"})
    EXPECT_THROW(read_uncertain(text, "m"), InputError) << text;
}

TEST(Uncertain, CountsInAnyMultiple) {
  expect(read_uncertain("40 +- 2 krev", "rev"), Distribution::normal, 4e4, 2e3);
  expect(read_uncertain("4e4 +- 5 %", "rev"), Distribution::normal, 4e4, 2e3);
  expect(read_uncertain("40 krev +- 2000 rev", "rev"), Distribution::normal, 4e4, 2e3);
  expect(read_uncertain("600 +- 30 1/min", "rev/s"), Distribution::normal, 10, 0.5);
  // Is the plain number one of thousands?
  for (const char* text : {"40 krev +- 2", "~ normal(40 krev, 2)", "~ uniform(10, 20 krev)"})
    EXPECT_THROW(read_uncertain(text, "rev"), InputError) << text;
}

TEST(Uncertain, RefusesNonsense) {
  for (const char* text :
       {"", "0.1", "0.1 +- 0.005", "0.1 +- 5 %", "0.1 mm +-", "+- 5 mm", "0.1 mm +- -5 um",
        "0.1 mm +- 5 N", "0.1 N +- 5 mm", "~", "~ lognormal", "~ lognormal(0.1 mm)",
        "~ lognormal(0.1 mm, 5 um", "~ lognormal(-0.1 mm, 5 um)", "~ gamma(0.1 mm, 5 um)",
        "~ normal(0.1 mm, 5 um) mm", "~ uniform(2 mm, 1 mm)", "~ normal(0.1 mm, -5 um)"}) {
    EXPECT_THROW(read_uncertain(text, "m"), InputError) << text;
  }
}

// Mean, standard deviation and median of each law; the median of a lognormal is
// mean/sqrt(1 + (sd/mean)^2). Five standard errors allowed, with a share of the sample outside one
// sd.
TEST(Uncertain, DrawsItsLaw) {
  constexpr int n = 200'000;
  struct Case {
    const char* text;
    double mean, sd, median;
  };
  for (const Case& c :
       {Case{"10 +- 2 m", 10, 2, 10}, Case{"~ lognormal(10 m, 5 m)", 10, 5, 10 / std::sqrt(1.25)},
        Case{"~ uniform(4 m, 16 m)", 10, std::sqrt(12), 10}}) {
    SCOPED_TRACE(c.text);
    const Uncertain q = read_uncertain(c.text, "m");
    Rng rng(3, 14);
    std::vector<double> x(n);
    double sum = 0, squares = 0;
    for (double& value : x) {
      value = draw(q, rng);
      sum += value - c.mean;
      squares += (value - c.mean) * (value - c.mean);
    }
    const double se = c.sd / std::sqrt(n);
    EXPECT_NEAR(sum / n, 0, 5 * se);
    EXPECT_NEAR(std::sqrt(squares / n), c.sd, 10 * se);
    std::nth_element(x.begin(), x.begin() + n / 2, x.end());
    EXPECT_NEAR(x[n / 2], c.median, 10 * se);
  }
  Rng rng(3, 14);
  EXPECT_EQ(draw(read_uncertain("10 m", "m"), rng), 10);
}

}  // namespace
}  // namespace wearwell
