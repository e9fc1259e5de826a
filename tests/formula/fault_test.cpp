// What is told of numbers that are none.
#include <gtest/gtest.h>

#include <cmath>

#include "formula/laboratory.h"

namespace wearwell::formula {
namespace {

std::optional<Fault> fault_of(const Laboratory& laboratory, const std::vector<std::string>& texts) {
  const Program program = laboratory.program(texts);
  const Data data = program.bind(laboratory.rows());
  const auto at = laboratory.pointers();
  return program.first_fault(data, 0, laboratory.rows().count, {laboratory.parameters, at});
}

TEST(Fault, NamesRowAndTheSmallestExpression) {
  Laboratory laboratory;
  laboratory.lines = {{"inner", "a * x / (y - 0.75)"}, {"outer", "exp(inner) + b"}};
  const auto fault = fault_of(laboratory, {"outer", "inner^2"});
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->row, 1u);
  EXPECT_EQ(fault->expression, "a * x / (y - 0.75)");
  EXPECT_EQ(fault->why, "division by 0");
  EXPECT_EQ(fault->where, "[formula] inner");
  EXPECT_FALSE(fault->uniform);
}

TEST(Fault, SaysWhatALogarithmIsOf) {
  const Laboratory laboratory;
  const auto fault = fault_of(laboratory, {"log(y*b)"});
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->row, 0u);
  EXPECT_EQ(fault->why, "log of -0.95");
  EXPECT_EQ(fault->where, "output 1");
  const auto power = fault_of(laboratory, {"y^a"});
  ASSERT_TRUE(power);
  EXPECT_EQ(power->why, "-0.5 to the power 0.7");
  const auto uniform = fault_of(laboratory, {"x*log(c)"});
  ASSERT_TRUE(uniform);
  EXPECT_TRUE(uniform->uniform);
  EXPECT_EQ(uniform->expression, "log(c)");
}

TEST(Fault, IsNotInABranchThatWasNotTaken) {
  Laboratory laboratory;
  EXPECT_FALSE(fault_of(laboratory, {"where(y > 0, log(y), 0)", "force/1 [N]", "q[material]*u"}));
  const auto fault = fault_of(laboratory, {"where(y > 0, log(y), 0) + sqrt(x - 2)"});
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->expression, "sqrt(x - 2)");
  EXPECT_EQ(fault->why, "sqrt of -0.5");
}

TEST(Fault, FindsBrokenDataAndStates) {
  Laboratory laboratory;
  laboratory.columns[0][2] = NAN;
  auto fault = fault_of(laboratory, {"cum(a*x)"});
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->row, 2u);
  EXPECT_EQ(fault->expression, "x");
  laboratory.lines = {{"d(size)/d(n)", "a/1 [cycle] * size^2"}, {"size(0)", "1"}};
  fault = fault_of(laboratory, {"size*2"});
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->expression, "size");
  EXPECT_EQ(fault->why, "it becomes infinite before this row");
}

}  // namespace
}  // namespace wearwell::formula
