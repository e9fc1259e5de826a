#include "wearwell/input/labelled.h"

#include <gmock/gmock.h>

#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// As the tables of a campaign are read.
std::vector<double> labelled_numbers(const Table& table, const char* name, const std::string& si) {
  const ColumnChoice found = find_labelled(table, name, si);
  return si == "K" ? kelvins(table, found) : si_numbers(table, found);
}

class LabelledTest : public ScratchTest {
 protected:
  Table table(const std::string& content) const { return read_table(write("a.csv", content)); }
};

TEST_F(LabelledTest, TakesAnyUnitOfTheDimension) {
  const Table t =
      table("plate,torque [kN m],slip [rpm],temp [degC]\n1,0.05,60,20\n2,0.02,120,-10\n");
  EXPECT_THAT(labelled_numbers(t, "plate", "1"), ElementsAre(1, 2));
  EXPECT_THAT(labelled_numbers(t, "torque", "N m"),
              ElementsAre(testing::DoubleEq(50), testing::DoubleEq(20)));
  EXPECT_THAT(labelled_numbers(t, "slip", "rad/s"),
              ElementsAre(testing::DoubleNear(6.283185307179586, 1e-12),
                          testing::DoubleNear(12.566370614359172, 1e-12)));
  EXPECT_THAT(labelled_numbers(t, "temp", "K"),
              ElementsAre(testing::DoubleNear(293.15, 1e-9), testing::DoubleNear(263.15, 1e-9)));
}

TEST_F(LabelledTest, CountsInAnyMultiple) {
  const Table t = table("cycle [kcycles],stroke,n [1e5]\n2,7,0.5\n3,8,4\n");
  EXPECT_THAT(labelled_numbers(t, "cycle", "cycle"), ElementsAre(2000, 3000));
  EXPECT_THAT(labelled_numbers(t, "stroke", "cycle"), ElementsAre(7, 8));
  EXPECT_THAT(labelled_numbers(t, "n", "rev"), ElementsAre(5e4, 4e5));
}

TEST_F(LabelledTest, RefusesByColumn) {
  const auto refused = [&](const std::string& content, const char* name, const char* si) {
    const Table t = table(content);
    return message_of<InputError>([&] { labelled_numbers(t, name, si); });
  };
  EXPECT_THAT(refused("torque\n1\n", "torque", "N m"),
              HasSubstr("column 'torque' has no unit: name it 'torque [N m]'"));
  EXPECT_THAT(refused("torque [s]\n1\n", "torque", "N m"),
              testing::AllOf(HasSubstr("column 'torque [s]'"), HasSubstr("wrong dimension")));
  EXPECT_THAT(refused("slip [1/s]\n1\n", "slip", "rad/s"),
              testing::AllOf(HasSubstr("column 'slip [1/s]'"),
                             HasSubstr("write rev/s (rpm, Hz) or rad/s")));
  EXPECT_THAT(refused("slip\n1\n", "slip", "rad/s"), HasSubstr("name it 'slip [rad/s]'"));
  EXPECT_THAT(refused("n [deg]\n1\n", "n", "cycle"), HasSubstr("contains an angle"));
  EXPECT_THAT(refused("T [degC]\n20\n-300\n", "T", "K"),
              HasSubstr("row 2, column 'T [degC]': -300 is below absolute zero"));
  EXPECT_THAT(refused("torque [foo]\n1\n", "torque", "N m"), HasSubstr("'foo'"));
  EXPECT_THAT(refused("torqe [N m]\n1\n", "torque", "N m"),
              HasSubstr("has no column 'torque [N m]' (nearest: 'torqe [N m]')"));
  EXPECT_THAT(refused("torque [N m]\n1\nx\n", "torque", "N m"),
              HasSubstr("row 2, column 'torque [N m]': 'x' is not a number"));
}

}  // namespace
}  // namespace wearwell
