// Parts of an S-N study on line: what a message leaves out.
#include <gmock/gmock.h>

#include "models/tracked_preset.h"
#include "monitor/fleet_rig.h"
#include "wearwell/monitor/stored_units.h"

namespace wearwell::monitor {
namespace {

using testing::HasSubstr;

class MonitoredParts : public ScratchTest {
 protected:
  static Population population() {
    static const TrackedPreset preset(
        R"toml(model = "sn"
[data]
file = "data.csv"
[data.columns]
alternating_stress = { column = "S", unit = "MPa" }
life = "N"
status = "status"
part = "name"
[law]
mean_stress = "none"
[likelihood]
family = "weibull"
[prior]
log10_a = { distribution = "normal", mean = "3.3 log10(MPa)", sd = 0.3 }
b = { distribution = "normal", mean = -0.1, sd = 0.04 }
sigma = { distribution = "half-normal", scale = 0.3 }
)toml",
        {"S", "N", "status", "name"},
        {{"500", "45000", "failure", "a"},
         {"430", "240000", "failure", "c"},
         {"430", "330000", "failure", "d"},
         {"380", "610000", "failure", "e"},
         {"380", "1300000", "failure", "f"},
         {"320", "2000000", "runout", "i"}});
    return {{std::shared_ptr<void>(), preset.tracker.get()}, "population", true, 0};
  }
  void SetUp() override {
    const prognosis::Tracker& tracker = *population().tracker;
    StoreColumns columns;
    for (const auto& each : tracker.columns()) columns.numbers.push_back(each.name);
    columns.sequence = true;
    store_ = open_store("fleet.sqlite", folder(), columns);
    source_.name = "test";
    source_.mapping = plain_mapping(tracker, false);
    source_.mapping.unit = "part";
    source_.mapping.sequence = "n";
  }
  Delivery deliver(const std::string& payload) {
    const Message message{"", payload};
    return intake_->deliver(source_, std::span(&message, 1));
  }

  SourceSettings source_;
  std::unique_ptr<Store> store_;
  Tally tally_{100};
  Notices quiet_{nullptr};
  std::unique_ptr<Intake> intake_;
};

// The cycles of a reading without a stress ran under that of the reading before, as the unit says.
TEST_F(MonitoredParts, AStressThatIsLeftOutIsThatBefore) {
  intake_ = std::make_unique<Intake>(*store_, tally_, quiet_, [] {});
  const Delivery given = deliver(
      "part,n,life,alternating_stress\n"
      "empty,1,100000,420\nempty,2,150000,\nempty,3,200000,350\nempty,4,260000,\n"
      "full,1,100000,420\nfull,2,150000,420\nfull,3,200000,350\nfull,4,260000,350\n"
      "other,1,100000,420\nother,2,150000,420\nother,3,200000,350\nother,4,260000,420\n"
      "again,1,100000,420\nagain,2,150000,\nagain,3,200000,350\n");
  EXPECT_EQ(given.problem, "");
  EXPECT_EQ(given.readings, 15U);
  int n = 0;
  for (const char* stress : {R"(, "alternating_stress": null)", ""}) {
    const std::string row =
        fmt::format(R"({{"part": "json", "n": {}, "life": 1e5{}}})", ++n, stress);
    EXPECT_EQ(deliver(row).readings, 1U) << row;
  }
  const auto units = stored_units(*store_, population());
  const auto forecast = [&](const char* unit) {
    return units.at(unit).state->forecast().remaining;
  };
  for (const double p : {0.05, 0.5, 0.95}) {
    EXPECT_EQ(forecast("empty").quantile(p), forecast("full").quantile(p)) << p;
    EXPECT_NE(forecast("other").quantile(p), forecast("full").quantile(p)) << p;
  }
  EXPECT_EQ(units.at("full").last_problem, "");
  EXPECT_EQ(units.at("empty").not_counted, 0U);
  EXPECT_EQ(
      units.at("empty").last_problem,
      "a reading has no alternating_stress; that of the reading before holds for its use, too");
  // Nothing is before these.
  EXPECT_EQ(units.at("json").not_counted, 2U);
  EXPECT_THAT(units.at("json").last_problem, HasSubstr("alternating_stress is missing"));
}

}  // namespace
}  // namespace wearwell::monitor
