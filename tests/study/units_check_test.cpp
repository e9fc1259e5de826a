#include "wearwell/study/units_check.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "support/posterior_study.h"

namespace wearwell {
namespace {

using testing::AllOf;
using testing::HasSubstr;

DataColumn column(const char* name, const char* si, const char* unit,
                  const std::vector<double>& written, bool condition = false) {
  DataColumn result{name, si, read_unit(unit, si), {}, condition};
  for (const double value : written) result.values.push_back(to_si(result.unit, value));
  return result;
}

std::string found(const DataColumn& column) {
  const auto check = units_check({column});
  if (!check) return {};
  EXPECT_EQ(check->name, "units");
  EXPECT_EQ(check->verdict, Verdict::warn);
  EXPECT_THAT(check->advice, HasSubstr("docs/reference/units.md"));
  return check->detail;
}

TEST(UnitsCheck, PassesWhatMachinesHave) {
  EXPECT_FALSE(units_check({}));
  EXPECT_EQ(found(column("cycles", "cycle", "1", {0, 1, 10, 1e6})), "");
  EXPECT_EQ(found(column("life", "cycle", "1e6 cycles", {0.02, 0.7, 31})), "");
  EXPECT_EQ(found(column("life", "cycle", "cycles", {0.25, 0.5, 3e6})), "");  // broke at once
  EXPECT_EQ(found(column("volume", "m^3", "mm^3", {-0.3, 0, 12, 900})), "");
  EXPECT_EQ(found(column("force", "N", "kN", {0.2, 4, 50}, true)), "");
  EXPECT_EQ(found(column("alternating_stress", "Pa", "MPa", {90, 900}, true)), "");
  EXPECT_EQ(found(column("time", "s", "h", {0.1, 5000})), "");
  EXPECT_EQ(found(column("temperature", "K", "degC", {-40, 20, 400})), "");
}

TEST(UnitsCheck, ACountBelowOneHasLostItsUnit) {
  EXPECT_THAT(found(column("life", "cycle", "1", {0.031, 0.42, 1.7, 28})),
              AllOf(HasSubstr("life: 2 of 4 counts are below 1"), HasSubstr("0.031")));
}

TEST(UnitsCheck, ASizeThatNoMachineHas) {
  EXPECT_THAT(found(column("volume", "m^3", "m^3", {3, 17})), HasSubstr("largest value is 17 m^3"));
  EXPECT_THAT(found(column("alternating_stress", "Pa", "Pa", {180, 420}, true)),
              HasSubstr("420 Pa"));
  EXPECT_THAT(found(column("alternating_stress", "Pa", "GPa", {180, 420}, true)),
              HasSubstr("420 GPa"));
  EXPECT_THAT(found(column("depth", "m", "m", {12, 31})), HasSubstr("31 m"));
  EXPECT_THAT(found(column("temperature", "K", "K", {85, 120})), HasSubstr("85 K to 120 K"));
}

TEST(UnitsCheck, ConditionsOfTwoUnits) {
  // Two rows in kN among rows in N.
  EXPECT_THAT(
      found(column("force", "N", "N", {800, 950, 1.1, 900, 0.85}, true)),
      AllOf(HasSubstr("0.85 N to 950 N is a factor"), HasSubstr("two units in one column")));
  EXPECT_EQ(found(column("volume", "m^3", "mm^3", {0.01, 90})), "");  // may grow so
}

TEST(UnitsCheck, NoFalseAlarmInTheExamples) {
  int studies = 0;
  for (const std::string folder : {"joint", "bearing", "fatigue", "spring"}) {
    for (const auto& entry : std::filesystem::directory_iterator(
             std::filesystem::path(PROJECT_SOURCE_DIR "/examples") / folder)) {
      if (entry.path().extension() != ".toml") continue;
      const PosteriorStudy study = read_posterior_study(entry.path());
      EXPECT_GE(study.data_columns.size(), 2u) << entry.path();
      const auto check = units_check(study.data_columns);
      EXPECT_FALSE(check) << entry.path() << ": " << check->detail;
      ++studies;
    }
  }
  EXPECT_GE(studies, 12);
}

TEST(UnitsCheck, NamesEveryColumn) {
  const auto check = units_check(
      {column("cycles", "cycle", "1", {0.1, 0.3}), column("volume", "m^3", "m^3", {30, 90})});
  ASSERT_TRUE(check);
  EXPECT_THAT(check->detail, AllOf(HasSubstr("cycles: "), HasSubstr("; volume: ")));
}

}  // namespace
}  // namespace wearwell
