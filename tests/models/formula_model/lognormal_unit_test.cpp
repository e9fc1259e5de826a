// The integral over a lognormal effect of a unit whose log likelihood is a parabola, by brute force.
#include "wearwell/models/formula_model/lognormal_unit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "wearwell/base/rng.h"

namespace wearwell::formula_model {
namespace {

// By steps of a five-hundredth of the width at the mode, all over where there is anything.
double brute_force(const LognormalUnit& unit) {
  double top = -INFINITY, at = 0;
  for (double z = -14; z <= 14; z += 1e-5) {
    if (const double here = unit.at(z); here > top) {
      top = here;
      at = z;
    }
  }
  const double e = std::exp(unit.s * at);
  const double width = 1 / std::sqrt(1 + unit.s * unit.s * e * e * unit.h);
  double sum = 0;
  for (const double way : {1.0, -1.0}) {
    const double step = 0.002 * width;
    for (int i = way > 0 ? 0 : 1; i < 20'000'000; ++i) {
      const double f = unit.at(at + way * i * step) - top;
      if (f < -50) break;
      sum += std::exp(f) * step;
    }
  }
  return top + std::log(sum);
}

// Effects that the rows hardly know and such that they know to a thousandth; scatters from a fiftieth to three.
TEST(LognormalUnit, IsWhatBruteForceSays) {
  Rng rng(20261122, 0);
  for (int i = 0; i < 12; ++i) {
    const double h = std::exp(-3 + 17 * rng.uniform()), s = std::exp(-4 + 5.1 * rng.uniform());
    const double best = std::exp(s * rng.normal()) - 1 + rng.normal() / std::sqrt(h);
    const LognormalUnit unit{best, h, s};
    std::vector<LognormalUnit::Node> nodes;
    const auto integral = unit.log_integral(&nodes);
    ASSERT_TRUE(integral) << h << " " << s << " " << best;
    EXPECT_NEAR(*integral, brute_force(unit), 1e-8) << h << " " << s << " " << best;
    double all = 0;
    for (const auto& node : nodes) {
      all += node.weight;
      EXPECT_NEAR(node.step, std::exp(s * node.z) - 1, 1e-14 * (2 + std::abs(node.step)));
    }
    EXPECT_NEAR(all, 1, 1e-10);
  }
}

// Rows that contradict the population, far on either side, and none below what no effect can be.
TEST(LognormalUnit, HoldsFarFromThePopulation) {
  for (const LognormalUnit unit :
       {LognormalUnit{8, 400, 0.3}, {-0.9, 400, 0.3}, {-3, 2, 0.5}, {0.2, 1e-6, 2.5}}) {
    const auto integral = unit.log_integral(nullptr);
    ASSERT_TRUE(integral) << unit.best;
    EXPECT_NEAR(*integral, brute_force(unit), 1e-8) << unit.best;
  }
}

}  // namespace
}  // namespace wearwell::formula_model
