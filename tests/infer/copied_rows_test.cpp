#include "wearwell/infer/copied_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

// Lognormal lives about 1000 with log sd 0.5, rounded by `round`.
template <class Round>
std::vector<double> lives(std::size_t n, std::uint64_t stream, const Round& round) {
  Rng rng(20261124, stream);
  std::vector<double> all(n);
  for (double& each : all) each = round(1000 * std::exp(0.5 * rng.normal()));
  return all;
}

FitData data_of(const std::vector<double>& value) {
  FitData data;
  data.measured.value = value;
  data.measured.unit.assign(value.size(), 3600);  // hours
  return data;
}

std::vector<double> densities(const std::vector<double>& value) {
  std::vector<double> all;
  for (const double y : value) {
    const double z = std::log(y / 1000) / 0.5;
    all.push_back(-0.5 * z * z - std::log(0.5 * std::sqrt(2 * M_PI) * y * 3600));
  }
  return all;
}

double chance(const FitData& data) {
  const auto found = copied_rows(data, densities(data.measured.value));
  return found ? found->p : 1;
}

std::vector<double> times(const std::vector<double>& value, int copies) {
  std::vector<double> all;
  for (int i = 0; i < copies; ++i) all.insert(all.end(), value.begin(), value.end());
  return all;
}

TEST(CopiedRows, EightLivesCopiedFourTimes) {
  const std::vector<double> value = times(lives(8, 1, [](double y) { return std::round(y); }), 4);
  const FitData data = data_of(value);
  const auto found = copied_rows(data, densities(value));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->rows, 24u);
  EXPECT_EQ(found->of, 32u);
  // By hand: each of 496 pairs agrees with about 1 h times a density of 1/(2 sqrt(pi) 0.5 x 1000 h).
  EXPECT_NEAR(found->expected, 496 / (2 * std::sqrt(M_PI) * 0.5 * 1000), 0.3);
  EXPECT_LT(found->p, 1e-12);
}

TEST(CopiedRows, AllTwice) {
  EXPECT_LT(chance(data_of(times(lives(30, 2, [](double y) { return std::round(y); }), 2))), 1e-8);
}

// Whatever numbers are rounded to, equal ones are then to be expected.
TEST(CopiedRows, RoundingIsNoCopying) {
  int accused = 0;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const auto accuse = [&](const auto& round, std::size_t n) {
      accused += chance(data_of(lives(n, 100 + i, round))) < 1e-4;
    };
    accuse([](double y) { return std::round(y); }, 200);
    accuse([](double y) { return std::max(24.0, 24 * std::round(y / 24)); }, 60);
    accuse([](double y) { return std::max(168.0, 168 * std::round(y / 168)); }, 40);
    // Two significant digits.
    accuse(
        [](double y) {
          const double digit = std::pow(10, std::floor(std::log10(y)) - 1);
          return digit * std::round(y / digit);
        },
        60);
  }
  EXPECT_EQ(accused, 0);
}

// Nor are run-outs at one time, zeros, and rows that differ in a driver or a label.
TEST(CopiedRows, OtherConditionsAreNoCopies) {
  const std::vector<double> once = lives(10, 3, [](double y) { return std::round(y); });
  FitData data = data_of(times(once, 2));
  data.labels = {{"machine", std::vector<std::size_t>(20, 0)}};
  EXPECT_LT(chance(data), 1e-6);
  for (std::size_t i = 10; i < 20; ++i) data.labels[0].level[i] = 1;
  EXPECT_EQ(chance(data), 1);
  FitData censored = data_of(once);
  for (std::size_t i = 3; i < 10; ++i) censored.measured.value[i] = NAN;
  EXPECT_EQ(chance(censored), 1);
  EXPECT_FALSE(copied_rows(data_of(std::vector<double>(20, 0)), std::vector<double>(20, 0)));
}

}  // namespace
}  // namespace wearwell
