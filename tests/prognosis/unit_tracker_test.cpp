// Rows that an interruption stops in the middle: none of them is taken (unit_tracker.h).
#include "wearwell/prognosis/unit_tracker.h"

#include <gtest/gtest.h>

#include "monitor/growth_tracker.h"
#include "wearwell/base/monitor.h"

namespace wearwell::prognosis {
namespace {

// Throws once, when the countdown is at 0: before a reading is taken, or after.
struct Interruption {
  int countdown = -1;
  bool after = false;
  void reached(bool now_after) {
    if (now_after == after && countdown-- == 0) throw Cancelled();
  }
};

class InterruptedUnit : public TrackedUnit {
 public:
  InterruptedUnit(std::unique_ptr<TrackedUnit> unit, std::shared_ptr<Interruption> interruption)
      : unit_(std::move(unit)), interruption_(std::move(interruption)) {}
  UpdateResult update(const Reading& reading, const History& history) override {
    interruption_->reached(false);
    UpdateResult result = unit_->update(reading, history);
    interruption_->reached(true);
    return result;
  }
  Forecast forecast() const override { return unit_->forecast(); }
  std::vector<PredictiveTails> predictive(const Reading& reading) const override {
    return unit_->predictive(reading);
  }
  std::vector<ForecastBand> ahead(std::span<const double> places) const override {
    return unit_->ahead(places);
  }
  std::size_t readings() const override { return unit_->readings(); }
  std::string save() const override { return unit_->save(); }

 private:
  std::unique_ptr<TrackedUnit> unit_;
  std::shared_ptr<Interruption> interruption_;
};

class InterruptedTracker : public GrowthTracker {
 public:
  explicit InterruptedTracker(std::shared_ptr<Interruption> interruption)
      : interruption_(std::move(interruption)) {}
  std::unique_ptr<TrackedUnit> begin(const std::string& unit) const override {
    return std::make_unique<InterruptedUnit>(GrowthTracker::begin(unit), interruption_);
  }
  std::unique_ptr<TrackedUnit> restore(const std::string& bytes) const override {
    return std::make_unique<InterruptedUnit>(GrowthTracker::restore(bytes), interruption_);
  }

 private:
  std::shared_ptr<Interruption> interruption_;
};

// The last ones contradict the first, so that the watch has much to remember.
Table rows(std::size_t from, std::size_t to) {
  Table table{"rows", {{"wear [m]", true, {}, {}}, {"time [h]", true, {}, {}}}};
  for (std::size_t i = from; i < to; ++i) {
    const auto hours = static_cast<double>(10 * (i + 1));
    table.columns[0].numbers.push_back(i < 6 ? hours : 4 * hours);
    table.columns[1].numbers.push_back(hours);
  }
  table.rows = to - from;
  return table;
}

TEST(UnitTracker, RowsAreTakenWholeOrNotAtAll) {
  UnitTracker whole(std::make_shared<GrowthTracker>(), "m1", true);
  whole.update(rows(0, 3));
  const auto early = whole.json();
  whole.update(rows(3, 12));
  for (const bool after : {false, true}) {
    for (const int at : {0, 4, 8}) {
      const auto interruption = std::make_shared<Interruption>();
      UnitTracker unit(std::make_shared<InterruptedTracker>(interruption), "m1", true);
      unit.update(rows(0, 3));
      EXPECT_EQ(unit.json(), early);
      *interruption = {at, after};
      EXPECT_THROW(unit.update(rows(3, 12)), Cancelled) << at;
      EXPECT_EQ(unit.json(), early) << at;
      for (const RowOutcome& each : unit.update(rows(3, 12))) EXPECT_FALSE(each.repeated) << at;
      EXPECT_EQ(unit.json(), whole.json()) << at;
      for (const RowOutcome& each : unit.update(rows(0, 12))) EXPECT_TRUE(each.repeated) << at;
    }
  }
}

}  // namespace
}  // namespace wearwell::prognosis
