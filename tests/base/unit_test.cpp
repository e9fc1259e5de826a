#include "wearwell/base/unit.h"

#include <gtest/gtest.h>

#include "wearwell/base/error.h"

namespace wearwell {
namespace {

TEST(Unit, ConvertsToSi) {
  EXPECT_DOUBLE_EQ(read_unit("mm^3", "m^3").scale, 1e-9);
  EXPECT_DOUBLE_EQ(read_unit("mm^3/(N m)", "m^3/(N m)").scale, 1e-9);
  EXPECT_DOUBLE_EQ(read_unit("mm3/MJ", "m^3/(N m)").scale, 1e-15);
  EXPECT_DOUBLE_EQ(read_unit("N mm", "N m").scale, 1e-3);
  EXPECT_DOUBLE_EQ(to_si(read_unit("degC", "K"), 20), 293.15);
  EXPECT_DOUBLE_EQ(from_si(read_unit("degC", "K"), 293.15), 20);
}

TEST(Unit, RefusesNonsenseAndWrongDimension) {
  EXPECT_THROW(read_unit("mmm^3", "m^3"), InputError);
  EXPECT_THROW(read_unit("mm^2", "m^3"), InputError);
  EXPECT_THROW(read_unit("", "m^3"), InputError);
}

TEST(Quantity, ReadsNumberAndUnit) {
  EXPECT_DOUBLE_EQ(read_quantity("5.966 N m", "J").si(), 5.966);
  EXPECT_DOUBLE_EQ(read_quantity(" -1.5e2 mm ", "m").si(), -0.15);
  EXPECT_DOUBLE_EQ(read_quantity("3", "1").si(), 3);
  EXPECT_DOUBLE_EQ(read_quantity("5 %", "1").si(), 0.05);
}

TEST(Quantity, NamesWhatIsMissing) {
  EXPECT_THROW(read_quantity("5.966", "N m"), InputError);
  EXPECT_THROW(read_quantity("mm", "m"), InputError);
  EXPECT_THROW(read_quantity("nan mm", "m"), InputError);
  EXPECT_THROW(read_quantity("", "1"), InputError);
  try {
    read_quantity("5 mm", "m^3");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "unit 'mm' has the wrong dimension (expected one like 'm^3')");
  }
}

}  // namespace
}  // namespace wearwell
