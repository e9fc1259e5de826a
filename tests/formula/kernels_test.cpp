// The loops behind the language: the same bits whatever the vectors, and slopes of what no expression reaches by itself.
#include "wearwell/formula/kernels.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <thread>
#include <vector>

#include "formula/laboratory.h"

namespace wearwell::formula {
namespace {

// value_of runs the loops for every machine's vectors, kernels_of the widest that this one has.
TEST(Kernels, GiveTheSameBitsOneByOneAndInVectors) {
  std::vector<double> a, b, c;
  for (int i = 0; i < 1003; ++i) {
    a.push_back(std::ldexp(std::sin(1.0 + i), i % 40 - 20));
    b.push_back(3 * std::cos(0.7 * i));
    c.push_back(i % 3 == 0 ? 0 : std::log(1.5 + i));
  }
  for (const double odd :
       std::initializer_list<double>{0.0, -0.0, 1.0, INFINITY, -INFINITY, NAN, 1e308, 5e-324})
    a.push_back(odd);
  b.resize(a.size(), 0.5);
  c.resize(a.size(), -1);
  for (int op = static_cast<int>(Op::add); op <= static_cast<int>(Op::where); ++op) {
    const double extra = static_cast<Op>(op) == Op::whole_power ? -3 : 0;
    std::vector<double> y(a.size());
    kernels_of(static_cast<Op>(op), 0)
        .forward(a.data(), b.data(), c.data(), y.data(), y.size(), extra);
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double one = value_of(static_cast<Op>(op), a[i], b[i], c[i], extra);
      EXPECT_TRUE(std::bit_cast<std::uint64_t>(one) == std::bit_cast<std::uint64_t>(y[i]) ||
                  (std::isnan(one) && std::isnan(y[i])))
          << "operation " << op << " of " << a[i] << ": " << one << " and " << y[i];
    }
  }
}

// expm1(x)/x and its slope, (x exp(x) - expm1(x))/x^2, in long double where that does not cancel and by series where it does.
TEST(Kernels, GrowthIsSmoothThroughZero) {
  for (const double x : {-700.0, -30.0, -2.0, -0.5, -0.49, -1e-3, -1e-9, 0.0, 1e-300, 1e-5, 0.3,
                         0.499, 0.501, 5.0, 300.0}) {
    const long double wide = x;
    const double value = value_of(Op::growth, x, 0, 0, 0), one = 1;
    double slope = 0;
    kernels_of(Op::growth, 1)
        .reverse(&x, nullptr, nullptr, &value, &one, &slope, nullptr, nullptr, 1, 0, 0);
    const bool small = std::abs(x) < 0.01;
    const long double expected =
        small ? 1 + wide / 2 + wide * wide / 6 + wide * wide * wide / 24 : std::expm1(wide) / wide;
    const long double slope_expected =
        small ? 0.5L + wide / 3 + wide * wide / 8 + wide * wide * wide / 30
              : (wide * std::exp(wide) - std::expm1(wide)) / (wide * wide);
    EXPECT_NEAR(value / static_cast<double>(expected), 1, 1e-9 * small + 1e-15) << x;
    EXPECT_NEAR(slope / static_cast<double>(slope_expected), 1, 1e-9 * small + 5e-15) << x;
  }
}

TEST(Program, IsSharedByThreadsWithAWorkspaceEach) {
  const Laboratory laboratory;
  const Program program = laboratory.program({"exp(a*x) + q[material]*log(b*x + 4)"});
  const Data data = program.bind(laboratory.rows());
  std::vector<std::vector<double>> found(8);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < found.size(); ++t) {
    threads.emplace_back([&, t] {
      Workspace work = program.workspace(3);
      for (int i = 0; i < 200; ++i) {
        std::vector<double> gradient(laboratory.parameters.size());
        program.forward(data, 0, 3, {laboratory.parameters}, work);
        for (double& each : work.adjoints(0)) each = 1;
        program.reverse(data, 0, 3, {laboratory.parameters}, work, gradient);
        found[t] = gradient;
      }
    });
  }
  for (std::thread& each : threads) each.join();
  for (const auto& each : found) EXPECT_EQ(each, found[0]);
}

}  // namespace
}  // namespace wearwell::formula
