#include "wearwell/prob/response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "wearwell/math/constants.h"
#include "wearwell/prob/response_block.h"

namespace wearwell {
namespace {

// Of the lognormal family the first, by median.
ResponseFamily family_of(const std::string& name, bool beyond_threshold = false) {
  for (const ResponseForm& form : response_forms()) {
    const bool shifted = form.family_parameters.back().name == "threshold";
    if (form.name == name && shifted == beyond_threshold) return form.family;
  }
  throw std::logic_error("no family " + name);
}

struct Case {
  ResponseFamily family;
  double family_parameters[4];
  double at[3];  // low, middle, high
};

const std::vector<Case>& cases() {
  using enum ResponseFamily;
  static const std::vector<Case> all = {
      {normal, {3, 0.7, 0}, {0.5, 3.2, 6}},
      {lognormal, {2, 0.6, 0}, {0.3, 2.1, 9}},
      {lognormal_by_moments, {2, 0.9, 0}, {0.3, 2.1, 9}},
      {log10_normal, {2, 0.3, 0}, {0.3, 2.1, 9}},
      {student_t, {4.5, 1, 0.5}, {-2, 1.2, 4}},
      {weibull, {82, 2.1, 0}, {10, 70, 200}},
      {family_of("weibull", true), {82, 2.1, 6}, {10, 70, 200}},
      {family_of("lognormal", true), {2, 0.6, 0.1}, {0.3, 2.1, 9}},
      {family_of("gamma", true), {2.5, 1.7, -0.4}, {0.3, 4, 20}},
      {family_of("generalized-gamma"), {2, 0.6, 0.4}, {0.5, 2.1, 6}},
      {family_of("generalized-gamma"), {2, 0.6, -1.3}, {0.8, 2.1, 12}},
      {family_of("generalized-gamma"), {2, 0.6, 0.02}, {0.5, 2.1, 7}},
      {family_of("generalized-gamma", true), {2, 0.6, 1.5, 0.1}, {0.3, 2.1, 6}},
      {family_of("birnbaum-saunders"), {2, 0.6}, {0.5, 2.1, 9}},
      {family_of("birnbaum-saunders", true), {2, 0.6, 0.2}, {0.5, 2.1, 9}},
      {family_of("exponentiated-weibull"), {82, 2.1, 3}, {40, 90, 200}},
      {family_of("exponentiated-weibull"), {82, 2.1, 0.4}, {5, 60, 200}},
      {family_of("frechet"), {5, 3}, {2.5, 5.5, 60}},
      {family_of("frechet", true), {5, 3, 0.4}, {3, 5.5, 60}},
      {smallest_extreme_value, {1, 1.3, 0}, {-5, 1, 3}},
      {largest_extreme_value, {1, 1.3, 0}, {-1, 1, 9}},
      {exponential, {7, 0, 0}, {0.2, 6, 40}},
      {gamma, {2.5, 1.7, 0}, {0.3, 4, 20}},
      {gamma, {0.4, 1.7, 0}, {0.01, 0.4, 9}},
      {loglogistic, {5, 3, 0}, {1, 5.5, 30}},
      {inverse_gaussian, {2, 3, 0}, {0.3, 2, 12}},
  };
  return all;
}

TEST(Response, MatchesR) {
  std::ifstream golden(PROJECT_SOURCE_DIR "/tests/golden/response.csv");
  std::string line;
  ASSERT_TRUE(std::getline(golden, line));
  int rows = 0;
  for (; std::getline(golden, line); ++rows) {
    SCOPED_TRACE(line);
    std::istringstream cells(line);
    std::string name, seen, cell;
    std::getline(cells, name, ',');
    std::getline(cells, seen, ',');
    double v[6];
    for (double& each : v) {
      std::getline(cells, cell, ',');
      each = std::stod(cell);
    }
    Response y{Censoring::none, v[0], v[1]};
    if (seen == "above") y.seen = Censoring::right;
    if (seen == "below") y.seen = Censoring::left;
    if (seen == "between") y.seen = Censoring::interval;
    const ResponseFamily family = family_of(name, name == "weibull" && v[4] != 0);
    const double value = log_response_value(family, y, v + 2);
    EXPECT_NEAR(value, v[5], 2e-12 * std::abs(v[5]) + 1e-14);
    EXPECT_NEAR(log_response(family, y, v + 2).value, value, 1e-12 * std::abs(value) + 1e-15);
  }
  EXPECT_GT(rows, 200);
}

// All outcomes with and without truncation; slopes against central differences.
TEST(Response, SlopesAreTheDerivatives) {
  for (const Case& each : cases()) {
    const double* at = each.at;
    const std::vector<Response> all = {{Censoring::none, at[1]},
                                       {Censoring::right, at[1]},
                                       {Censoring::right, at[2]},
                                       {Censoring::left, at[0]},
                                       {Censoring::left, at[1]},
                                       {Censoring::interval, at[0], at[1]},
                                       {Censoring::interval, at[1], at[2]},
                                       {Censoring::interval, at[1], at[1] * (1 + 1e-7)},
                                       {Censoring::none, at[1], 0, at[0]},
                                       {Censoring::right, at[2], 0, at[1]}};
    for (const Response& y : all) {
      const ResponseTerm term = log_response(each.family, y, each.family_parameters);
      ASSERT_TRUE(std::isfinite(term.value));
      for (int s = 0; s < 4; ++s) {
        if (each.family_parameters[s] == 0) continue;
        double moved[4];
        std::copy(each.family_parameters, each.family_parameters + 4, moved);
        const double step = 1e-5 * std::abs(each.family_parameters[s]);
        moved[s] = each.family_parameters[s] + step;
        const double above = log_response_value(each.family, y, moved);
        moved[s] = each.family_parameters[s] - step;
        const double below = log_response_value(each.family, y, moved);
        EXPECT_NEAR(term.slope[s], (above - below) / (2 * step),
                    2e-6 * (std::abs(term.slope[s]) + std::abs(term.value)) + 1e-8)
            << static_cast<int>(each.family) << " seen " << static_cast<int>(y.seen) << " slot "
            << s << " at " << y.at;
      }
    }
  }
}

// P(Y <= y) + P(Y > y) = 1, the quantile is the inverse, and the density is the slope.
TEST(Response, DistributionFunctionsBelongTogether) {
  for (const Case& each : cases()) {
    for (const double y : each.at) {
      const double below = log_cdf(each.family, y, each.family_parameters);
      EXPECT_NEAR(std::exp(below) + std::exp(log_survival(each.family, y, each.family_parameters)),
                  1, 1e-13);
      EXPECT_NEAR(quantile(each.family, std::exp(below), each.family_parameters), y,
                  1e-8 * std::abs(y))
          << static_cast<int>(each.family);
      const double step = 1e-5 * std::abs(y);
      const double slope = (std::exp(log_cdf(each.family, y + step, each.family_parameters)) -
                            std::exp(log_cdf(each.family, y - step, each.family_parameters))) /
                           (2 * step);
      EXPECT_NEAR(
          std::exp(log_response_value(each.family, {Censoring::none, y}, each.family_parameters)),
          slope, 1e-7 * slope);
    }
  }
}

TEST(Response, OutsideItsSupportHasNoDensity) {
  const double weibull[] = {82, 2.1, 15};
  const ResponseFamily shifted = family_of("weibull", true);
  EXPECT_EQ(log_response_value(shifted, {Censoring::none, 15}, weibull), -infinity);
  EXPECT_EQ(log_response_value(shifted, {Censoring::right, 3}, weibull), 0);
  const double negative[] = {1, -1, 0};
  for (const Censoring seen : {Censoring::none, Censoring::right, Censoring::left}) {
    EXPECT_EQ(log_response_value(ResponseFamily::normal, {seen, 2}, negative), -infinity);
  }
  const double sure[] = {1, 0, 0};
  EXPECT_EQ(log_response_value(ResponseFamily::binomial, {.at = 5, .trials = 5}, sure), 0);
  EXPECT_EQ(log_response_value(ResponseFamily::binomial, {.at = 4, .trials = 5}, sure), -infinity);
}

// A sampler tries them: a zero density and an infinite slope are answers, an exception is none.
TEST(Response, ExtremeParametersAreNoExceptions) {
  constexpr double extremes[] = {5e-324, 1e-310, 1e-300, 1e-9, 1, 1e15, 1e300, 1.7e308};
  for (const Case& each : cases()) {
    for (const double a : extremes) {
      for (const double b : extremes) {
        const double family_parameters[] = {a, b, each.family_parameters[2],
                                            each.family_parameters[3]};
        for (const double y : {1e-300, each.at[1], 1e300}) {
          for (const Censoring seen : {Censoring::none, Censoring::right, Censoring::left}) {
            ASSERT_NO_THROW(log_response(each.family, {seen, y}, family_parameters))
                << static_cast<int>(each.family) << " " << a << " " << b << " " << y;
          }
        }
      }
    }
  }
}

// R: dbinom(7, 20, 0.3, log = TRUE); pbinom(7, 20, 0.3); ppois(7, 5.5).
TEST(Response, Counts) {
  const double p[] = {0.3, 0, 0}, mean[] = {5.5, 0, 0};
  EXPECT_NEAR(log_response_value(ResponseFamily::binomial, {.at = 7, .trials = 20}, p),
              -1.80629265492043, 1e-12);
  EXPECT_NEAR(std::exp(log_cdf(ResponseFamily::binomial, 7, p, 20)), 0.772271797418161, 1e-13);
  EXPECT_NEAR(std::exp(log_cdf(ResponseFamily::poisson, 7, mean)), 0.809485282519508, 1e-12);
  const ResponseTerm term = log_response(ResponseFamily::binomial, {.at = 7, .trials = 20}, p);
  EXPECT_NEAR(term.slope[0], 7 / 0.3 - 13 / 0.7, 1e-12);
}

// The formulas that run over plain rows give what one row at a time gives.
TEST(ResponseBlock, AgreesWithSingleRows) {
  for (const Case& each : cases()) {
    for (const bool censored : {false, true}) {
      std::vector<Response> rows = {{Censoring::none, each.at[0]},
                                    {Censoring::none, each.at[1]},
                                    {Censoring::none, each.at[2]}};
      if (censored) rows[2].seen = Censoring::right;
      const ResponseColumn column(rows);
      EXPECT_EQ(column.plain, !censored);
      const double first[] = {each.family_parameters[0], each.family_parameters[0]};
      const std::vector<ParameterValues> family_parameters = {{first, false},
                                                              {&each.family_parameters[1], true},
                                                              {&each.family_parameters[2], true},
                                                              {&each.family_parameters[3], true}};
      double value[2], slope[8];
      log_responses(each.family, column, 1, family_parameters, value, slope);
      for (std::size_t i = 0; i < 2; ++i) {
        const ResponseTerm term = log_response(each.family, rows[i + 1], each.family_parameters);
        EXPECT_NEAR(value[i], term.value, 1e-13 * std::abs(term.value) + 1e-13);
        for (std::size_t s = 0; s < 2; ++s) {
          EXPECT_NEAR(slope[s * 2 + i], term.slope[s], 1e-11 * std::abs(term.slope[s]) + 1e-13);
        }
      }
    }
  }
}

}  // namespace
}  // namespace wearwell
