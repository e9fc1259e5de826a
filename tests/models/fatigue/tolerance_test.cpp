#include "wearwell/models/fatigue/tolerance.h"

#include <gtest/gtest.h>

#include <string>

#include "support/golden.h"

namespace wearwell::fatigue {
namespace {

const std::vector<double> x = {2.78, 2.78, 2.70, 2.70, 2.63, 2.63, 2.58, 2.58, 2.54};
const std::vector<double> y = {4.31, 4.52, 4.98, 5.21, 5.40, 5.77, 5.93, 6.02, 6.41};

// tests/golden/tolerance.R: by R's lm and noncentral t.
TEST(Tolerance, FactorsAndLimitsAsInR) {
  const FittedLine line = fit_line(x, y);
  int compared = 0;
  for (const std::vector<std::string>& c : read_golden("tolerance.csv")) {
    const auto at = [&](std::size_t i) { return std::stod(c[i]); };
    const double value = c[0] == "factor"      ? owen_factor(at(1), at(2), at(3), at(4))
                         : c[0] == "slope"     ? line.slope
                         : c[0] == "intercept" ? line.intercept
                         : c[0] == "sd"        ? line.sd
                         : c[0] == "owen"      ? owen_limit(line, at(5), at(1), at(2))
                         : c[0] == "iso"       ? iso_12107_limit(line, at(5), at(1), at(2))
                                               : astm_e739_band(line, at(5), at(2));
    EXPECT_NEAR(value, at(6), 1e-7 * std::max(1.0, std::abs(at(6)))) << c[0] << ' ' << c[5];
    ++compared;
  }
  EXPECT_EQ(compared, 62);
}

// ISO 12107:2012, Table B.1: k for 90 % with 90 and 95 % confidence, 2 and 14 degrees of freedom.
TEST(Tolerance, PrintedFactors) {
  EXPECT_NEAR(owen_factor(0.9, 0.9, 1.0 / 3, 2), 4.258, 1e-3);
  EXPECT_NEAR(owen_factor(0.9, 0.95, 1.0 / 3, 2), 6.155, 1e-3);
  EXPECT_NEAR(owen_factor(0.9, 0.95, 1.0 / 15, 14), 2.068, 1e-3);
}

}  // namespace
}  // namespace wearwell::fatigue
