// Formulas whose posterior has several modes, from file to answer. Right moments: brute force on a grid in the test.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

class FormulaMaxima : public ScratchTest {
 protected:
  PosteriorSummary run(const std::string& rows, const std::string& mean, const std::string& sd,
                       const std::string& priors) const {
    write("d.csv", "x,y\n" + rows);
    const std::string text = fmt::format(
        "model = \"formula\"\n[data]\nfile = \"d.csv\"\n[data.columns]\nx = \"x\"\ny = \"y\"\n"
        "[likelihood.y]\nfamily = \"normal\"\nmean = \"{}\"\nsd = {}\n[prior]\n{}",
        mean, sd, priors);
    return run_study(wearwell::read_posterior_study(write("study.toml", text)), {}, {}, false);
  }
};

std::string of_computation(const PosteriorSummary& result) {
  for (const Check& check : result.checks) {
    if (check.name == "computation") return check.detail;
  }
  return "";
}

struct Moments {
  double mean = 0, sd = 0;
};
template <class LogDensityOf>
Moments brute_force(const LogDensityOf& log_density, double lower, double upper) {
  constexpr int nodes = 400'000;
  double top = -INFINITY, sums[3] = {};
  const auto at = [&](int i) { return lower + (upper - lower) * (i + 0.5) / nodes; };
  for (int i = 0; i < nodes; ++i) top = std::max(top, log_density(at(i)));
  for (int i = 0; i < nodes; ++i) {
    const double f = std::exp(log_density(at(i)) - top);
    sums[0] += f;
    sums[1] += f * at(i);
    sums[2] += f * at(i) * at(i);
  }
  const double mean = sums[1] / sums[0];
  return {mean, std::sqrt(sums[2] / sums[0] - mean * mean)};
}

void expect_moments(const PosteriorSummary& result, const Moments& right) {
  ASSERT_TRUE(result.fit->exact) << result.fit->no_exact;
  EXPECT_NEAR(result.fit->exact->mean[0], right.mean, 1e-4 * right.sd);
  EXPECT_NEAR(result.fit->exact->sd[0], right.sd, 1e-4 * right.sd);
  // The draws are of all modes as well.
  const QuantityDistribution drawn(result.fit->pooled, [](const double* x) { return x[0]; });
  EXPECT_NEAR(drawn.mean(), right.mean, 4 * right.sd / std::sqrt(4000.0));
  EXPECT_THAT(of_computation(result), HasSubstr(" maxima, at "));
}

TEST_F(FormulaMaxima, ASquareHasTwoRoots) {
  const std::vector<double> y = {3.9, 4.1, 4.05};
  const PosteriorSummary result = run("1,3.9\n1,4.1\n1,4.05\n", "th^2*x", "0.2",
                                      "th = { distribution = \"normal\", mean = 0.5, sd = 1 }\n");
  expect_moments(result, brute_force(
                             [&](double th) {
                               double sum = -0.5 * std::pow(th - 0.5, 2);
                               for (const double each : y)
                                 sum -= 0.5 * std::pow((each - th * th) / 0.2, 2);
                               return sum;
                             },
                             -8, 8));
  EXPECT_NEAR(result.fit->exact->mean[0], 1.526, 1e-3);
  EXPECT_THAT(of_computation(result),
              HasSubstr("2 maxima, at th = 2.003 (88 %) and th = -2.002 (12 %)"));
}

TEST_F(FormulaMaxima, AliasesOfAFrequency) {
  std::string rows;
  std::vector<double> time, y;
  for (int i = 1; i <= 8; ++i) {
    time.push_back(0.5 * i + 0.01 * (i % 3));
    y.push_back(std::sin(3 * time.back()) + 0.2 * std::cos(11.0 * i));
    rows += fmt::format("{:.17g},{:.17g}\n", time.back(), y.back());
  }
  const PosteriorSummary result =
      run(rows, "sin(w*x * 1 [rad])", "0.3",
          "w = { distribution = \"uniform\", lower = 0, upper = 30 }\n");
  expect_moments(result, brute_force(
                             [&](double w) {
                               double sum = 0;
                               for (std::size_t i = 0; i < y.size(); ++i)
                                 sum -= 0.5 * std::pow((y[i] - std::sin(w * time[i])) / 0.3, 2);
                               return sum;
                             },
                             0, 30));
}

// An amplitude and a phase: (a, p) and (-a, p + pi) are the same wave; sigma is fitted.
TEST_F(FormulaMaxima, AmplitudeAndPhaseThatMayChangeSigns) {
  std::string rows;
  for (int i = 1; i <= 12; ++i)
    rows += fmt::format("{},{:.6f}\n", 0.4 * i,
                        2 * std::sin(0.4 * i + 0.7) + 0.15 * std::cos(5.0 * i * i));
  const PosteriorSummary result =
      run(rows, "a*sin((x + p) * 1 [rad])", "\"s\"",
          "a = { distribution = \"normal\", mean = 0, sd = 3 }\np = { distribution = "
          "\"uniform\", lower = -3, upper = 3 }\n"
          "s = { distribution = \"half-normal\", scale = 1 }\n");
  ASSERT_TRUE(result.fit->exact) << result.fit->no_exact;
  ASSERT_EQ(result.fit->maxima.found.size(), 2u) << of_computation(result);
  // The prior of a is even and that of p is flat between bounds that both phases keep clear of: one half each.
  EXPECT_NEAR(result.fit->maxima.found[0].share, 0.5, 1e-3);
  EXPECT_NEAR(result.fit->exact->mean[0], 0, 2e-3);
}

}  // namespace
}  // namespace wearwell
