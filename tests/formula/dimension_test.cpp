// The algebra of dimensions, and units of any dimension.
#include "wearwell/formula/dimension.h"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::formula {
namespace {

using testing::HasSubstr;

Powers random_powers() {
  static const char* names[] = {"kilogram", "meter", "second", "kelvin", "cycle", "radian", "mole"};
  Powers powers;
  for (const char* name : names) {
    const int above = *rc::gen::inRange(-3, 4), below = *rc::gen::inRange(1, 4);
    if (above != 0) powers[name] = Power(above, below);
  }
  return powers;
}

RC_GTEST_PROP(Dimension, IsAGroup, ()) {
  const Powers a = random_powers(), b = random_powers(), c = random_powers();
  RC_ASSERT(product(a, b) == product(b, a));
  RC_ASSERT(product(product(a, b), c) == product(a, product(b, c)));
  RC_ASSERT(quotient(product(a, b), b) == a);
  RC_ASSERT(quotient(a, a) == Powers{});
  RC_ASSERT(raised(product(a, b), Power(2, 3)) ==
            product(raised(a, Power(2, 3)), raised(b, Power(2, 3))));
  RC_ASSERT(raised(raised(a, Power(1, 2)), Power(2)) == a);
  RC_ASSERT(raised(a, 0) == Powers{});
  RC_ASSERT(quotient(a, b) == product(a, raised(b, -1)));
}

RC_GTEST_PROP(Dimension, IsReadAgainAsItIsWritten, ()) {
  Powers powers = random_powers();
  for (auto& [base, power] : powers) power = Power(power.numerator());
  const AnyUnit read = read_any_unit(si_text(powers));
  RC_ASSERT(read.powers == powers);
  RC_ASSERT(read.unit.scale == 1);
  const std::string words = description(powers);
  if (!powers.empty()) {
    const AnyUnit again = read_any_unit(words);
    RC_ASSERT(again.powers == powers);
    RC_ASSERT(std::abs(again.unit.scale - 1) < 1e-12);
  }
}

TEST(Dimension, IsNamedAsEngineersDo) {
  const auto words = [](const char* unit) { return description(read_any_unit(unit).powers); };
  EXPECT_EQ(words("kN"), "N");
  EXPECT_EQ(words("MPa"), "Pa");
  EXPECT_EQ(words("m/s^2"), "m/s^2");
  EXPECT_EQ(words("1"), "a pure number");
  EXPECT_EQ(words("J/(mol K)"), "J/(mol K)");
  EXPECT_EQ(words("MPa sqrt(m)"), "Pa sqrt(m)");
  EXPECT_EQ(words("mm/cycle"), "m/cycle");
  EXPECT_EQ(words("kg/m^3"), "kg/m^3");
  EXPECT_EQ(words("N^2"), "N^2");
  EXPECT_EQ(words("1/h"), "1/s");
  EXPECT_EQ(words("rpm"), "cycle/s");
}

TEST(AnyUnit, IsReadWithItsSizeAndZero) {
  EXPECT_DOUBLE_EQ(read_any_unit("mm^3/(N m)").unit.scale, 1e-9);
  EXPECT_DOUBLE_EQ(read_any_unit("degC").unit.offset, 273.15);
  EXPECT_DOUBLE_EQ(read_any_unit("MPa sqrt(mm)").unit.scale, 1e6 * std::sqrt(1e-3));
  EXPECT_DOUBLE_EQ(read_any_unit("MPa mm^0.5").unit.scale, 1e6 * std::sqrt(1e-3));
  EXPECT_DOUBLE_EQ(read_any_unit("MPa mm^(1/2)").unit.scale, 1e6 * std::sqrt(1e-3));
  EXPECT_DOUBLE_EQ(read_any_unit("sqrt(mm)").unit.scale, std::sqrt(1e-3));
  EXPECT_DOUBLE_EQ(read_any_unit("mm/sqrt(h)").unit.scale, 1e-3 / 60);
  EXPECT_EQ(read_any_unit("1/sqrt(s)").powers, (Powers{{"second", Power(-1, 2)}}));
  EXPECT_EQ(read_any_unit("cycles").powers, (Powers{{"cycle", 1}}));
  EXPECT_DOUBLE_EQ(read_any_quantity("20 degC").quantity.si(), 293.15);
  EXPECT_DOUBLE_EQ(read_any_quantity("1e-6 mm^3/(N m)").quantity.si(), 1e-15);
  EXPECT_DOUBLE_EQ(read_any_quantity("30 MPa sqrt(m)").quantity.si(), 3e7);
  EXPECT_EQ(read_any_quantity("2.5").powers, Powers{});
}

TEST(AnyUnit, RefusesWhatIsNone) {
  const auto refused = [](const char* text) {
    return message_of<InputError>([&] { read_any_unit(text); });
  };
  EXPECT_EQ(refused("mmm"), "'mmm' is not a unit");
  EXPECT_THAT(refused("ton"), HasSubstr("two sizes"));
  EXPECT_THAT(refused("mm 3"), HasSubstr("a factor or a power"));
  EXPECT_THAT(refused("m^0.3"), HasSubstr("a whole number, or write sqrt(m)"));
  EXPECT_THAT(refused("m^0.55"), HasSubstr("a whole number, or write sqrt(m)"));
  EXPECT_THAT(message_of<InputError>([] { read_any_quantity("35 200 m"); }),
              HasSubstr("is ambiguous"));
  EXPECT_THAT(message_of<InputError>([] { read_any_quantity("-300 degC"); }),
              HasSubstr("absolute zero"));
  EXPECT_THAT(message_of<InputError>([] { read_any_quantity("m"); }), HasSubstr("not a number"));
}

}  // namespace
}  // namespace wearwell::formula
