// What the form of an expression says of how it depends on a parameter by row.
#include "wearwell/formula/by_row_degree.h"

#include <gtest/gtest.h>

#include "formula/laboratory.h"

namespace wearwell::formula {
namespace {

ByRowDegree degree(const std::string& text) {
  return Laboratory().program({text}).by_row_degree(0);
}

TEST(ByRowDegree, SumsAndMultiplesAreLinear) {
  for (const char* text :
       {"u", "a + b*u", "-u*x", "a*(1 - exp(-x/b)) + u*y", "(u + a)*exp(b)/x - u",
        "u*max(x - a, 0)", "where(x > a, u*x, b)", "abs(y)*u"}) {
    EXPECT_EQ(degree(text), ByRowDegree::linear) << text;
  }
}

TEST(ByRowDegree, WithoutThemIsNone) {
  for (const char* text : {"a", "x*exp(a)", "where(x > a, y, b)", "2"}) {
    EXPECT_EQ(degree(text), ByRowDegree::none) << text;
  }
}

// Cases that turn with the parameter are not linear, whatever their branches.
TEST(ByRowDegree, TheRestIsOther) {
  for (const char* text : {"u*u", "u^2", "exp(u)", "x/u", "max(u*x, a)", "where(u > a, u, x)",
                           "abs(u)", "u*(a + u)", "x^u", "cum(u*x)"}) {
    EXPECT_EQ(degree(text), ByRowDegree::other) << text;
  }
}

}  // namespace
}  // namespace wearwell::formula
