#include "wearwell/infer/diagnostics.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

using Values = std::vector<std::vector<double>>;

Chains view(const Values& values) {
  Chains chains;
  for (const auto& chain : values) chains.draws.push_back(chain);
  return chains;
}

/// Chains of an AR(1) process with standard normal margins.
Values autoregressive(std::size_t chains, std::size_t draws, double rho, std::uint64_t seed) {
  Values values(chains, std::vector<double>(draws));
  for (std::size_t c = 0; c < chains; ++c) {
    Rng rng(seed, c);
    double x = rng.normal();
    for (double& value : values[c]) {
      value = x;
      x = rho * x + std::sqrt(1 - rho * rho) * rng.normal();
    }
  }
  return values;
}

template <typename Function>
Values transformed(Values values, Function f) {
  for (auto& chain : values) {
    for (double& x : chain) x = f(x);
  }
  return values;
}

std::vector<std::vector<std::string>> read_golden(const std::string& name) {
  std::ifstream file(PROJECT_SOURCE_DIR "/tests/golden/" + name);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

void expect_same(double value, double expected, const std::string& what) {
  if (std::isnan(expected)) {
    EXPECT_TRUE(std::isnan(value)) << what << ' ' << value;
  } else {
    EXPECT_NEAR(value, expected, 1e-10 * std::abs(expected)) << what;
  }
}

// tests/golden/diagnostics.R: the R package posterior 1.4.0.
TEST(Diagnostics, AreThoseOfPosterior) {
  std::map<std::string, Values> cases;
  for (const auto& row : read_golden("diagnostics.csv")) {
    auto& chain = cases[row[0]].emplace_back();
    for (std::size_t i = 1; i < row.size(); ++i) chain.push_back(std::stod(row[i]));
  }
  const auto expected = read_golden("diagnostics_expected.csv");
  ASSERT_EQ(expected.size(), cases.size() + 1);
  ASSERT_EQ(cases.size(), 28u);
  for (std::size_t i = 1; i < expected.size(); ++i) {
    const std::string& name = expected[i][0];
    std::map<std::string, double> number;
    for (std::size_t j = 1; j < expected[0].size(); ++j) {
      number[expected[0][j]] = std::stod(expected[i][j]);
    }
    const Chains chains = view(cases.at(name));
    const Diagnostics all = diagnose(chains);
    const auto expect = [&](const std::string& column, double value) {
      expect_same(value, number.at(column), name + ' ' + column);
    };
    expect("rhat", all.rhat);
    expect("ess_bulk", all.ess_bulk);
    expect("ess_tail", all.ess_tail);
    expect("mcse_mean", all.mcse_mean);
    expect("mcse_sd", all.mcse_sd);
    expect("mcse_q05", all.mcse_q05);
    expect("mcse_q50", all.mcse_q50);
    expect("mcse_q95", all.mcse_q95);
    expect("rhat", rhat(chains));
    expect("ess_bulk", ess_bulk(chains));
    expect("ess_tail", ess_tail(chains));
    expect("ess_mean", ess_mean(chains));
    expect("ess_sd", ess_sd(chains));
    expect("ess_q10", ess_quantile(chains, 0.1));
    expect("mcse_mean", mcse_mean(chains));
    expect("mcse_sd", mcse_sd(chains));
    expect("mcse_q05", mcse_quantile(chains, 0.05));
    expect("mcse_q50", mcse_quantile(chains, 0.5));
    expect("mcse_q95", mcse_quantile(chains, 0.95));
  }
}

void expect_unknown(const Diagnostics& d) {
  for (const double value : {d.rhat, d.ess_bulk, d.ess_tail, d.mcse_mean, d.mcse_sd, d.mcse_q05,
                             d.mcse_q50, d.mcse_q95}) {
    EXPECT_TRUE(std::isnan(value)) << value;
  }
}

TEST(Diagnostics, OfDrawsThatAreNotFiniteAreUnknown) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL}) {
    Values values = autoregressive(4, 101, 0, 1);
    values[2][50] = bad;  // the middle, which is in neither half
    expect_unknown(diagnose(view(values)));
  }
}

TEST(Diagnostics, OfTooFewDrawsAreUnknown) {
  expect_unknown(diagnose(Chains{}));
  for (std::size_t draws = 0; draws < 4; ++draws) {
    expect_unknown(diagnose(view(autoregressive(4, draws, 0, 1))));
  }
}

TEST(Diagnostics, OfConstantsThatDifferInTheLastDigitAreUnknown) {
  Values values(4, std::vector<double>(100, 293.15));
  values[1][20] = std::nextafter(293.15, 300);
  expect_unknown(diagnose(view(values)));
}

TEST(Diagnostics, RefuseChainsOfDifferentLengths) {
  EXPECT_THROW(diagnose(view({{1, 2, 3, 4}, {1, 2, 3}})), std::invalid_argument);
}

// Chains that each stand still at their own value: no variance within, and every lag up to the last
// of a half of 50 correlates by 1, so tau = -1 + 2*46 + 1 = 92 (Geyer's sum stops five lags before
// the end).
TEST(Diagnostics, SeeChainsThatStandStill) {
  Values values;
  for (const double place : {1.1, 2.1, 3.1, 4.1}) values.emplace_back(100, place);
  EXPECT_EQ(rhat_bulk(view(values)), HUGE_VAL);
  EXPECT_NEAR(ess_bulk(view(values)), 400. / 92, 1e-12);
}

// An AR(1) chain of S draws is worth S (1 - rho)/(1 + rho) independent ones for its mean, and with
// rho^2 in place of rho for its variance.
TEST(EffectiveSampleSize, OfAutoregressionIsKnown) {
  for (const double rho : {-0.5, 0.0, 0.5, 0.9}) {
    const Values values = autoregressive(4, 20'000, rho, 3);
    const double known = 80'000 * (1 - rho) / (1 + rho);
    EXPECT_NEAR(ess_mean(view(values)), known, 0.1 * known) << rho;
    EXPECT_NEAR(ess_bulk(view(values)), known, 0.1 * known) << rho;
    const double squared = 80'000 * (1 - rho * rho) / (1 + rho * rho);
    const double sd_error = std::sqrt(0.5 / squared);
    EXPECT_NEAR(mcse_sd(view(values)), sd_error, 0.1 * sd_error) << rho;
  }
}

// Of independent standard normal draws: 1/sqrt(S), 1/sqrt(2 S), and sqrt(p (1 - p)/S)/density.
TEST(StandardErrors, OfIndependentNormalDrawsAreKnown) {
  const double size = 80'000;
  const Diagnostics d = diagnose(view(autoregressive(4, 20'000, 0, 5)));
  EXPECT_NEAR(d.mcse_mean * std::sqrt(size), 1, 0.05);
  EXPECT_NEAR(d.mcse_sd * std::sqrt(2 * size), 1, 0.05);
  EXPECT_NEAR(d.mcse_q50 * std::sqrt(size), std::sqrt(std::numbers::pi / 2), 0.1);
  const double density05 = std::exp(-0.5 * 1.6448536 * 1.6448536) / std::sqrt(2 * std::numbers::pi);
  EXPECT_NEAR(d.mcse_q05 * std::sqrt(size), std::sqrt(0.05 * 0.95) / density05, 0.2);
  EXPECT_NEAR(d.mcse_q95 * std::sqrt(size), std::sqrt(0.05 * 0.95) / density05, 0.2);
}

/// Chains of a random process, number and length.
Values any_chains() {
  const auto chains = *rc::gen::inRange<std::size_t>(1, 6);
  const auto draws = *rc::gen::inRange<std::size_t>(6, 120);
  const double rho = *rc::gen::inRange(-90, 96) / 100.0;
  return autoregressive(chains, draws, rho, *rc::gen::inRange<std::uint64_t>(0, 1'000'000));
}

bool close(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::abs(a);
}

RC_GTEST_PROP(BulkDiagnostics, AreInvariantUnderMonotoneTransformations, ()) {
  const Values values = any_chains();
  const double r = rhat_bulk(view(values)), e = ess_bulk(view(values));
  for (double (*f)(double) :
       {+[](double x) { return std::exp(3 * x); }, +[](double x) { return x * x * x; },
        +[](double x) { return std::atan(x) - 7; }}) {
    const Values moved = transformed(values, f);
    RC_ASSERT(rhat_bulk(view(moved)) == r);
    RC_ASSERT(ess_bulk(view(moved)) == e);
  }
  const Values mirrored = transformed(values, [](double x) { return -x; });
  RC_ASSERT(close(rhat_bulk(view(mirrored)), r));
  RC_ASSERT(close(ess_bulk(view(mirrored)), e));
}

std::vector<double> as_list(const Diagnostics& d) {
  return {d.rhat,    d.ess_bulk, d.ess_tail, d.mcse_mean,
          d.mcse_sd, d.mcse_q05, d.mcse_q50, d.mcse_q95};
}

RC_GTEST_PROP(Diagnostics, DoNotDependOnTheOrderOfChains, ()) {
  const Values values = any_chains();
  Values shuffled = values;
  for (std::size_t i = shuffled.size() - 1; i > 0; --i) {
    std::swap(shuffled[i], shuffled[*rc::gen::inRange<std::size_t>(0, i + 1)]);
  }
  const auto a = as_list(diagnose(view(values))), b = as_list(diagnose(view(shuffled)));
  for (std::size_t i = 0; i < a.size(); ++i) {
    RC_ASSERT((std::isnan(a[i]) && std::isnan(b[i])) || close(a[i], b[i]));
  }
}

// A bearing's wear rate is 1e-16 m^3/(N m): the numbers must not depend on the unit. Powers of two
// are exact.
RC_GTEST_PROP(Diagnostics, DoNotDependOnTheUnit, ()) {
  const Values values = any_chains();
  const double unit = std::ldexp(1, *rc::gen::inRange(-80, 80));
  const Values scaled = transformed(values, [&](double x) { return x * unit; });
  const auto a = as_list(diagnose(view(values))), b = as_list(diagnose(view(scaled)));
  for (std::size_t i = 0; i < a.size(); ++i) {
    RC_ASSERT((std::isnan(a[i]) && std::isnan(b[i])) || close(i < 3 ? a[i] : a[i] * unit, b[i]));
  }
}

// The draws' places agree and their spreads do not: only the folded R-hat sees it.
TEST(FoldedRhat, SeesDifferentSpreads) {
  Values values = autoregressive(4, 1000, 0, 8);
  for (double& x : values[0]) x *= 3;
  EXPECT_LT(rhat_bulk(view(values)), 1.01);
  EXPECT_GT(rhat_folded(view(values)), 1.1);
  EXPECT_EQ(rhat(view(values)), rhat_folded(view(values)));
}

// By hand: mean 3, steps 1 + 4 + 9 = 14, spread 4 + 1 + 1 + 4 = 10.
TEST(EnergyBfmi, IsStepsOverSpread) {
  EXPECT_DOUBLE_EQ(e_bfmi(std::vector<double>{1, 2, 4, 5}), 6. / 10);
  EXPECT_DOUBLE_EQ(e_bfmi(std::vector<double>{4, 5, 3, 0}), 14. / 14);
}

// Of an AR(1) chain: 2 (1 - rho).
TEST(EnergyBfmi, OfAutoregressionIsKnown) {
  for (const double rho : {0.0, 0.5, 0.9}) {
    EXPECT_NEAR(e_bfmi(autoregressive(1, 50'000, rho, 2)[0]), 2 * (1 - rho), 0.04) << rho;
  }
}

TEST(EnergyBfmi, OfNothingToMeasureIsUnknown) {
  EXPECT_TRUE(std::isnan(e_bfmi({})));
  EXPECT_TRUE(std::isnan(e_bfmi(std::vector<double>{1})));
  EXPECT_TRUE(std::isnan(e_bfmi(std::vector<double>(10, 0.1))));
}

}  // namespace
}  // namespace wearwell
