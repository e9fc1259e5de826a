// Nonparametric survival with standard errors and bounds, against R's survival package (tests/golden/classical_estimates.R), closed forms and
// the curvature of the likelihood by differences.
#include "wearwell/prob/survival_estimate.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "support/golden.h"
#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

constexpr double deviate_90 = 1.6448536269514722;

std::vector<Response> tied_lives(const std::vector<double>& entry) {
  const double t[] = {2, 3, 3, 5, 6, 6, 8, 11, 12, 15};
  const bool failed[] = {true, true, false, true, false, true, true, false, true, false};
  std::vector<Response> all;
  for (std::size_t i = 0; i < 10; ++i) {
    all.push_back({.seen = failed[i] ? Censoring::none : Censoring::right, .at = t[i]});
    if (!entry.empty()) all.back().entry = entry[i];
  }
  return all;
}

void expect_bands(const std::string& name, const SurvivalEstimate& found) {
  EXPECT_EQ(found.method, SurvivalMethod::kaplan_meier);
  std::size_t i = 0;
  for (const auto& row : read_golden("survival_bands.csv")) {
    if (row[0] != name) continue;
    ASSERT_LT(i, found.steps.size());
    const SurvivalStep& step = found.steps[i++];
    const SurvivalBand band = log_log_band(step, deviate_90);
    const double values[] = {step.at,    step.at_risk, step.failed, step.survival,
                             step.error, band.lower,   band.upper};
    for (std::size_t k = 0; k < std::size(values); ++k)
      EXPECT_NEAR(values[k], std::stod(row[k + 1]), 1e-10 * std::max(1.0, values[k]))
          << name << " " << row[1] << " " << k;
  }
  EXPECT_EQ(i, found.steps.size());
}

TEST(SurvivalEstimate, HasGreenwoodsErrorsAndTheBandsOfR) {
  const std::vector<int> counts = {1, 2, 1, 1, 3, 1, 1, 4, 1, 2};
  expect_bands("runouts", survival_estimate(tied_lives({}), counts));
  expect_bands("entries", survival_estimate(tied_lives({0, 0, 1, 2, 0, 4, 5, 0, 7, 3}), counts));
}

TEST(SurvivalEstimate, HasNoBandWhereNoItemIsLeft) {
  const std::vector<Response> all = {{.at = 1}, {.at = 2}};
  const SurvivalEstimate found = survival_estimate(all, std::vector<int>{1, 1});
  ASSERT_EQ(found.steps.size(), 2u);
  EXPECT_EQ(found.steps[1].survival, 0);
  EXPECT_TRUE(std::isnan(found.steps[1].error));
  EXPECT_TRUE(std::isnan(log_log_band(found.steps[1], deviate_90).lower));
  EXPECT_NEAR(found.steps[0].error, std::sqrt(0.125), 1e-15);
}

// Heat-exchanger tubes, inspected each year (Meeker and Escobar 1998, table 3.2): 300 tubes of three plants. For intervals that do not
// overlap the estimate is a product over years, and its error Greenwood's.
TEST(SurvivalEstimate, OfInspectionsIsTheLifeTable) {
  const double infinity_ = infinity;
  const std::vector<Response> all = {{.seen = Censoring::left, .at = 1},
                                     {.seen = Censoring::interval, .at = 1, .until = 2},
                                     {.seen = Censoring::interval, .at = 2, .until = 3},
                                     {.seen = Censoring::right, .at = 1},
                                     {.seen = Censoring::right, .at = 2},
                                     {.seen = Censoring::right, .at = 3}};
  const std::vector<int> counts = {4, 5, 2, 99, 95, 95};
  const SurvivalEstimate found = survival_estimate(all, counts);
  EXPECT_EQ(found.method, SurvivalMethod::turnbull);
  ASSERT_EQ(found.steps.size(), 3u);
  EXPECT_EQ(found.steps[0].from, -infinity_);
  const double failed[] = {4, 5, 2}, at_risk[] = {300, 197, 97};
  double survival = 1, sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    survival *= 1 - failed[i] / at_risk[i];
    sum += failed[i] / (at_risk[i] * (at_risk[i] - failed[i]));
    EXPECT_NEAR(found.steps[i].survival, survival, 1e-7);
    EXPECT_NEAR(found.steps[i].error, survival * std::sqrt(sum), 1e-6);
  }
}

// Intervals that overlap: the curvature of the log-likelihood in the shares failed by 1, 2 and 3.
TEST(SurvivalEstimate, OfIntervalsHasTheErrorsOfTheLikelihood) {
  struct Seen {
    int from, to, count;  // failed within (from, to]; 9: later
  };
  const Seen seen[] = {{0, 1, 3}, {0, 2, 4}, {1, 2, 5}, {1, 3, 6}, {2, 3, 2}, {2, 9, 7}, {3, 9, 4}};
  std::vector<Response> all;
  std::vector<int> counts;
  for (const Seen& each : seen) {
    const Censoring how = each.to == 9     ? Censoring::right
                          : each.from == 0 ? Censoring::left
                                           : Censoring::interval;
    all.push_back({.seen = how,
                   .at = static_cast<double>(how == Censoring::left ? each.to : each.from),
                   .until = static_cast<double>(each.to)});
    counts.push_back(each.count);
  }
  const SurvivalEstimate found = survival_estimate(all, counts);
  ASSERT_EQ(found.steps.size(), 3u);
  Eigen::Vector3d failed;
  for (int i = 0; i < 3; ++i) failed[i] = 1 - found.steps[static_cast<std::size_t>(i)].survival;
  const auto log_likelihood = [&](const Eigen::Vector3d& f) {
    const auto by = [&](int t) { return t == 0 ? 0.0 : t == 9 ? 1.0 : f[t - 1]; };
    double sum = 0;
    for (const Seen& each : seen) sum += each.count * std::log(by(each.to) - by(each.from));
    return sum;
  };
  constexpr double step = 1e-4;
  Eigen::Matrix3d curvature;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const auto at = [&](double a, double b) {
        Eigen::Vector3d f = failed;
        f[i] += a * step;
        f[j] += b * step;
        return log_likelihood(f);
      };
      curvature(i, j) = -(at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * step * step);
    }
  }
  const Eigen::Matrix3d covariance = curvature.inverse();
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(found.steps[static_cast<std::size_t>(i)].error, std::sqrt(covariance(i, i)), 1e-5);
}

}  // namespace
}  // namespace wearwell
