#include "wearwell/prognosis/population_test.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <memory>

#include "wearwell/present/number.h"
#include "wearwell/prognosis/change_cause.h"

namespace wearwell::prognosis {
namespace {

constexpr double false_alarms = 1e-4;
constexpr double fits = 0.05;  // two-sided p-value of a reading in another unit

// The first readings, and then ever fewer of them.
bool is_compared(std::uint64_t n) {
  return std::has_single_bit(n) || (n % 3 == 0 && std::has_single_bit(n / 3));
}

// "after multiplication by 1000 it fits: ...", or what else it may be.
std::string explanation(const TrackedUnit& fresh, const Reading& reading, std::size_t column,
                        double added, const std::string& noun) {
  double best = fits, found = 0;
  for (const double factor : unit_factors()) {
    Reading other = reading;
    other.numbers[column] = factor * (other.numbers[column] - added) + added;
    const double p = two_sided(fresh.predictive(other));
    if (p > best) best = p, found = factor;
  }
  if (found == 0)
    return fmt::format(
        "the sensor, its unit or the counter of use is not that of the study, or the {} is not one "
        "of its population",
        noun);
  // One reading fits one of many factors easily.
  return fmt::format(
      "after multiplication by {} it fits: {}, or the counter of use is not that of the study",
      factor_text(found), wrong_unit(found));
}

}  // namespace

void PopulationTest::add(const Tracker& tracker, const WatchedColumns& columns,
                         const std::string& unit, const Reading& reading, double added) {
  if (!columns.measured || std::isnan(reading.numbers[*columns.measured])) return;
  if (!is_compared(++readings_)) return;
  ++comparisons_;
  const std::unique_ptr<TrackedUnit> fresh = tracker.begin(unit);
  const Reading watched = alone(tracker, columns, reading);
  const double p = two_sided(fresh->predictive(watched));
  if (std::isnan(p)) return;
  const auto k = static_cast<double>(comparisons_);
  reason_.clear();
  if (p >= false_alarms / (k * (k + 1))) return;
  const ReadingColumn& measured = tracker.columns()[*columns.measured];
  const double value = reading.numbers[*columns.measured];
  ReadingSince values{reading.numbers[columns.axis], value, 0, 0};
  const bool known =
      predict(*fresh, watched, columns, scale_of_reading(tracker, columns, value), values);
  reason_ =
      fmt::format("{} of {} at {} is outside what such a {} can have there{}; {}", measured.name,
                  reading_text(value - added, measured.unit),
                  reading_text(values.at, tracker.axis().unit), tracker.noun(),
                  known ? fmt::format(", about {} {}",
                                      shown_number(from_si(measured.unit, values.expected - added),
                                                   3, Script::terminal),
                                      measured.unit.text)
                        : "",
                  explanation(*fresh, watched, *columns.measured, added, tracker.noun()));
}

void PopulationTest::save(ByteWriter& to) const {
  to.u64(readings_);
  to.u64(comparisons_);
  to.text(reason_);
}

void PopulationTest::load(ByteReader& from) {
  readings_ = from.u64();
  comparisons_ = from.u64();
  reason_ = from.text();
}

}  // namespace wearwell::prognosis
