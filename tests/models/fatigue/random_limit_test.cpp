#include "wearwell/models/fatigue/random_limit.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

namespace wearwell::fatigue {
namespace {

// tests/golden/random_limit.py: the law as printed, integrated over the limit with 25 digits.
TEST(RandomLimit, TenDigitsOfTheIntegral) {
  const std::map<std::string, StandardLaw> laws = {{"normal", StandardLaw::normal},
                                                   {"sev", StandardLaw::smallest_extreme_value}};
  const std::map<std::string, Outcome> outcomes = {{"failure", Outcome::failure},
                                                   {"runout", Outcome::runout},
                                                   {"left", Outcome::left},
                                                   {"interval", Outcome::interval}};
  std::ifstream file(PROJECT_SOURCE_DIR "/tests/golden/random_limit.csv");
  std::string line;
  std::getline(file, line);
  int compared = 0;
  while (std::getline(file, line)) {
    std::vector<std::string> c;
    std::stringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) c.push_back(cell);
    const auto x = [&](std::size_t i) { return std::stod(c[i]); };
    const LimitedLife<double> item{laws.at(c[1]), laws.at(c[2]), x(4), x(5),
                                   x(6),          x(7),          x(8), x(9)};
    const double value = log_probability(item, outcomes.at(c[3]), x(10), x(11));
    // Of a logarithm the absolute error is the integral's relative one; far out the logarithm's own
    // digits end.
    EXPECT_NEAR(value, x(12), 1e-10 * std::max(1.0, 0.01 * std::abs(x(12)))) << line;
    ++compared;
  }
  EXPECT_EQ(compared, 80);
}

}  // namespace
}  // namespace wearwell::fatigue
