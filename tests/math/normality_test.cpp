#include "wearwell/math/normality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "support/golden.h"
#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

// tests/golden/normality.R: distances to all digits, exact p values to seven, those of Lilliefors
// within four standard errors of both simulations.
TEST(Normality, AgreesWithR) {
  std::map<std::string, std::vector<double>> samples;
  for (const auto& row : read_golden("normality.csv")) samples[row[0]].push_back(std::stod(row[1]));
  const auto expected = read_golden("normality_expected.csv");
  ASSERT_EQ(expected.size(), 9u);
  for (const auto& row : expected) {
    const std::vector<double>& sample = samples.at(row[0]);
    const KolmogorovTest ks = kolmogorov_test(sample);
    EXPECT_NEAR(ks.distance, std::stod(row[1]), 1e-10) << row[0];
    EXPECT_NEAR(ks.p, std::stod(row[2]), 1e-7) << row[0];
    const KolmogorovTest lilliefors = lilliefors_test(sample);
    EXPECT_NEAR(lilliefors.distance, std::stod(row[3]), 1e-10) << row[0];
    const double p = std::stod(row[4]);
    const double error = std::sqrt(std::max(p * (1 - p), 1e-4) * (1 / 1e4 + 1 / 2e5));
    EXPECT_NEAR(lilliefors.p, p, 4 * error) << row[0];
  }
}

// P(D_n < d) of one value is 2d - 1 between 1/2 and 1.
TEST(Normality, ClosedFormOfOneValue) {
  for (const double d : {0.5, 0.6, 0.75, 0.99}) EXPECT_NEAR(kolmogorov_cdf(1, d), 2 * d - 1, 1e-14);
  EXPECT_EQ(kolmogorov_cdf(1, 0.4), 0);
  EXPECT_EQ(kolmogorov_cdf(10, 0), 0);
  EXPECT_EQ(kolmogorov_cdf(10, 1), 1);
}

// Where the exact matrix gives way to the tail's formula the two meet.
TEST(Normality, TailMeetsTheExactValues) {
  for (const int n : {10, 100, 1000}) {
    const double s = n > 99 ? 3.76 : 7.24;
    const double below = kolmogorov_cdf(n, std::sqrt((s - 1e-9) / n)),
                 above = kolmogorov_cdf(n, std::sqrt((s + 1e-9) / n));
    EXPECT_NEAR(below, above, 1e-6) << n;
    EXPECT_LE(below, 1);
  }
}

// p values of normal samples are even: 400 samples, each tenth holds 40 on average.
TEST(Normality, PValuesAreEven) {
  constexpr int runs = 400, bins = 10;
  int ks[bins] = {}, lilliefors[bins] = {};
  for (std::uint64_t run = 0; run < runs; ++run) {
    Rng rng(9, run);
    std::vector<double> sample(25);
    for (double& x : sample) x = rng.normal();
    const auto count = [](int* counts, double p) {
      ++counts[std::min(bins - 1, static_cast<int>(bins * p))];
    };
    count(ks, kolmogorov_test(sample).p);
    if (run < 200) count(lilliefors, lilliefors_test(sample, run).p);
  }
  double chi2_ks = 0, chi2_lilliefors = 0;
  for (int b = 0; b < bins; ++b) {
    chi2_ks += std::pow(ks[b] - 40, 2) / 40;
    chi2_lilliefors += std::pow(lilliefors[b] - 20, 2) / 20;
  }
  EXPECT_LT(chi2_ks, 27.9);  // R: qchisq(0.999, 9) = 27.88
  EXPECT_LT(chi2_lilliefors, 27.9);
}

// R 4.2.2: qnorm((1:3 - 0.5)/3)
TEST(Normality, PlotHasNormalQuantiles) {
  const NormalPlot plot = normal_plot({5, -1, 2});
  EXPECT_EQ(plot.value, (std::vector<double>{-1, 2, 5}));
  EXPECT_NEAR(plot.quantile[0], -0.967421566101701, 1e-12);
  EXPECT_NEAR(plot.quantile[1], 0, 1e-12);
  EXPECT_NEAR(plot.quantile[2], 0.967421566101701, 1e-12);
}

// Numbers of tests/golden/score_tests.R.
TEST(AndersonDarling, StatisticAndP) {
  const AndersonDarlingTest test =
      anderson_darling_test({2.1, 3.4, 1.9, 5.6, 4.4, 3.8, 9.7, 2.8, 4.1, 3.3});
  EXPECT_NEAR(test.statistic, 0.7253291580945, 1e-11);
  EXPECT_NEAR(test.p, 0.0391969783412, 1e-11);
}

struct OfShapiroWilk {
  double statistic, p;
  std::vector<double> values;
};

// Numbers of tests/golden/score_tests.R (base R's shapiro.test).
TEST(ShapiroWilk, StatisticAndP) {
  std::vector<OfShapiroWilk> expected = {
      {0.948793179210289, 0.728564125950698, {2.5, 3.1, 0.4, 7.7, 4}},
      {0.814322510860584, 0.0216334323524242, {2.1, 3.4, 1.9, 5.6, 4.4, 3.8, 9.7, 2.8, 4.1, 3.3}},
      {0.872533491534324,
       0.0835495154259859,
       {2.1, 3.4, 1.9, 5.6, 4.4, 3.8, 9.7, 2.8, 4.1, 3.3, 6.2}},
      {0.93409260375726,
       0.425515277594914,
       {2.1, 3.4, 1.9, 5.6, 4.4, 3.8, 9.7, 2.8, 4.1, 3.3, 6.2, 0.3}},
      {0.858253847848531,
       0.000927631263166012,
       {0.0443, 0.2942, 0.3134, 1.7679, 0.1685, 0.6605, 0.3037, 4.2387, 2.6994, 0.7678,
        1.5266, 0.1332, 1.1666, 0.7269, 1.5665, 0.6301, 1.6742, 2.2059, 1.8217, 0.334,
        1.1656, 0.5653, 0.0266, 1.5098, 3.3692, 0.4757, 1.3736, 0.3688, 0.4646, 0.0069}},
  };
  OfShapiroWilk many{0.946752124843436, 8.3502753405766e-11, {}};
  for (int i = 1; i <= 400; ++i) many.values.push_back(std::pow(i, 1.2));
  expected.push_back(many);
  for (const OfShapiroWilk& each : expected) {
    const ShapiroWilkTest test = shapiro_wilk_test(each.values);
    EXPECT_NEAR(test.statistic, each.statistic, 1e-8) << each.values.size();
    EXPECT_NEAR(test.p, each.p, 1e-6 * each.p + 1e-15) << each.values.size();
    EXPECT_NEAR(0.5 * std::erfc(test.score / std::sqrt(2.0)), test.p, 1e-12);
  }
}

// Neither a constant nor four values say anything; values on a line of normal quantiles fit.
TEST(ShapiroWilk, Extremes) {
  EXPECT_EQ(shapiro_wilk_test(std::vector<double>(20, 1.5)).p, 1);
  EXPECT_EQ(shapiro_wilk_test({1, 2, 3, 9}).p, 1);
  EXPECT_GT(shapiro_wilk_test(normal_plot(std::vector<double>(50)).quantile).p, 0.999);
  std::vector<double> far(6, 0.0);
  for (std::size_t i = 0; i < far.size(); ++i) far[i] = 1e-9 * static_cast<double>(i);
  far.back() = 1e9;
  const ShapiroWilkTest test = shapiro_wilk_test(far);
  EXPECT_LT(test.p, 1e-4);
  EXPECT_GT(test.statistic, 0);
}

// Rounded values, most of which are equal, are spread: they have the shape that they had.
TEST(Normality, RoundingIsNoShape) {
  Rng rng(3, 0);
  std::vector<double> fine(2000), rounded, coarse;
  for (double& each : fine) each = rng.normal();
  for (const double each : fine) {
    rounded.push_back(0.05 * std::round(each / 0.05));
    coarse.push_back(0.25 * std::round(each / 0.25));
  }
  const double p = anderson_darling_test(fine).p;
  EXPECT_NEAR(anderson_darling_test(rounded).p, p, 0.1);
  EXPECT_GT(anderson_darling_test(coarse).p, 0.05);
  EXPECT_NEAR(shapiro_wilk_test(rounded).p, shapiro_wilk_test(fine).p, 0.1);
  EXPECT_GT(shapiro_wilk_test(coarse).p, 0.05);
}

}  // namespace
}  // namespace wearwell
