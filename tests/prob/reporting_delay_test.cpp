#include "wearwell/prob/reporting_delay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace wearwell {
namespace {

const LifeMixture weibull{.families = {ResponseFamily::weibull}};
const LifeMixture defective{.families = {ResponseFamily::weibull}, .limited = true, .dead = true};

std::vector<double> parameters_of(const LifeMixture& life) {
  std::vector<double> x(life.parameters());
  x[0] = 10;
  x[1] = 1.6;
  if (life.limited) x[life.share_defective()] = 0.4;
  if (life.dead) x[life.share_dead()] = 0.03;
  return x;
}

double failed(double life) {
  return life > 0 ? -std::expm1(-std::pow(life / 10, 1.6)) : 0;
}

const std::vector<Response> responses = {
    {.seen = Censoring::right, .at = 7},
    {.seen = Censoring::left, .at = 3},
    {.seen = Censoring::interval, .at = 2, .until = 5},
    {.seen = Censoring::interval, .at = 9, .until = 14},
};

// One delay is a shift of the ages.
TEST(ReportingDelay, OfOneTimeIsAShift) {
  const ReportingDelay delay{{1.25}, {1}};
  for (const LifeMixture& life : {weibull, defective}) {
    const std::vector<double> x = parameters_of(life);
    for (const Response& y : responses) {
      Response shifted = y;
      shifted.at -= 1.25;
      shifted.until -= 1.25;
      std::vector<double> slope(x.size()), expected(x.size());
      EXPECT_NEAR(log_response(life, delay, y, x.data(), slope),
                  life.log_response(shifted, x.data(), expected), 1e-14);
      for (std::size_t s = 0; s < x.size(); ++s) EXPECT_NEAR(slope[s], expected[s], 1e-13);
    }
  }
}

// Two delays and a warranty, from the distribution function.
TEST(ReportingDelay, MixesDelays) {
  const ReportingDelay delay{{0.5, 4}, {0.7, 0.3}, 6};
  const std::vector<double> x = parameters_of(weibull);
  const auto reported = [](double age) {
    return 0.7 * failed(std::min(age - 0.5, 6.0)) + 0.3 * failed(std::min(age - 4, 6.0));
  };
  for (const double age : {0.2, 0.5, 3.0, 6.4, 6.6, 9.9, 20.0}) {
    EXPECT_NEAR(std::exp(log_reported(weibull, delay, age, x.data())), reported(age), 1e-15);
    EXPECT_NEAR(std::exp(log_unreported(weibull, delay, age, x.data())), 1 - reported(age), 1e-15);
  }
  for (const auto& [from, to] : {std::pair(0.0, 1.0), {3.5, 4.5}, {6.0, 7.0}, {9.0, 11.0}})
    EXPECT_NEAR(
        std::exp(log_response(weibull, delay,
                              {.seen = Censoring::interval, .at = from, .until = to}, x.data())),
        reported(to) - reported(from), 1e-15);
  // After the longest delay and the warranty nothing is reported, and before the shortest delay.
  for (const auto& [from, to] : {std::pair(10.0, 12.0), {0.0, 0.5}})
    EXPECT_EQ(log_response(weibull, delay, {.seen = Censoring::interval, .at = from, .until = to},
                           x.data()),
              -INFINITY);
}

// Parts dead on arrival are reported after the delay, not before it.
TEST(ReportingDelay, DeadOnArrival) {
  const ReportingDelay delay{{0, 2}, {0.5, 0.5}};
  const std::vector<double> x = parameters_of(defective);
  const auto reported = [&](double age) { return age > 0 ? 0.03 + 0.97 * 0.4 * failed(age) : 0; };
  for (const double age : {1.0, 2.0, 2.5})
    EXPECT_NEAR(std::exp(log_reported(defective, delay, age, x.data())),
                0.5 * reported(age) + 0.5 * reported(age - 2), 1e-15);
}

TEST(ReportingDelay, GradientIsOfDifferences) {
  const ReportingDelay delay{{0.2, 1, 6, 30}, {0.4, 0.3, 0.2, 0.1}, 8};
  for (const LifeMixture& life : {weibull, defective}) {
    const std::vector<double> x = parameters_of(life);
    for (const Response& y : responses) {
      std::vector<double> slope(x.size());
      log_response(life, delay, y, x.data(), slope);
      for (std::size_t s = 0; s < x.size(); ++s) {
        if (x[s] == 0) continue;
        const double step = 1e-5 * x[s];
        std::vector<double> up = x, down = x;
        up[s] += step;
        down[s] -= step;
        const double difference =
            (log_response(life, delay, y, up.data()) - log_response(life, delay, y, down.data())) /
            (2 * step);
        EXPECT_NEAR(slope[s], difference, 1e-7 * (1 + std::abs(difference))) << s;
      }
    }
  }
}

// Far in the tail, differences of distribution functions have no digits.
TEST(ReportingDelay, KeepsDigitsInTheTail) {
  const ReportingDelay delay{{0, 1}, {0.5, 0.5}};
  std::vector<double> x = parameters_of(weibull);
  x[0] = 1e8;
  const auto hazard = [](double age) { return age > 0 ? std::pow(age / 1e8, 1.6) : 0; };
  const double expected = 0.5 * (hazard(5) - hazard(4)) + 0.5 * (hazard(4) - hazard(3));
  EXPECT_NEAR(std::exp(log_response(weibull, delay,
                                    {.seen = Censoring::interval, .at = 4, .until = 5}, x.data())) /
                  expected,
              1, 1e-10);
}

}  // namespace
}  // namespace wearwell
