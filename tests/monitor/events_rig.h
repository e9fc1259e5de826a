#pragma once

#include <gtest/gtest.h>

#include "monitor/fleet_rig.h"

namespace wearwell::monitor {

/// A fleet whose units report events, by hand.
class Events : public FleetRig {
 protected:
  Events() { source_.mapping = plain(); }
  static ReadingMapping plain() {
    static const GrowthTracker tracker;
    ReadingMapping mapping = plain_mapping(tracker, false);
    mapping.unit = "machine";
    mapping.sequence = "n";
    return mapping;
  }
  Delivery report(const std::string& unit, const std::string& event, const std::string& more) {
    return deliver(fmt::format(R"({{"machine": "{}", "event": "{}", "by": "A. Smith", {}}})", unit,
                               event, more));
  }
  UnitView view(const std::string& unit) {
    catch_up();
    return fleet_->unit(unit).value().view;
  }
  /// Two units with the same state, whatever their readings were.
  void expect_same(const std::string& unit, const std::string& as) {
    const UnitView a = view(unit), b = view(as);
    EXPECT_EQ(a.at, b.at);
    EXPECT_EQ(a.risk, b.risk);
    EXPECT_EQ(a.level.q95, b.level.q95);
    EXPECT_EQ(a.remaining.q05, b.remaining.q05);
    EXPECT_EQ(a.b10, b.b10);
    EXPECT_EQ(a.doubt, b.doubt);
    EXPECT_EQ(a.alarm, b.alarm);
    EXPECT_EQ(a.quality.readings, b.quality.readings);
  }
  /// Wear at 1.2 m/h on a counter that shows 500 h when the part is new.
  void send_two_parts() {
    for (int n = 1; n <= 10; ++n) deliver(message("a", n, 99.0 * n, 50 * n));
    for (int n = 11; n <= 20; ++n) deliver(message("a", n, 60.0 * (n - 10), 50 * n));
    for (int n = 11; n <= 20; ++n) deliver(message("new", n, 60.0 * (n - 10), 50 * (n - 10)));
  }
};

}  // namespace wearwell::monitor
