#include "wearwell/in_service/study_readings.h"

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/prognosis/change_watch.h"
#include "wearwell/prognosis/new_data.h"
#include "wearwell/prognosis/reading_table.h"

namespace wearwell::in_service {
namespace {

// A text file has the digits of a number, in another unit.
constexpr double reading_accuracy = 1e-9;

bool is_close(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::abs(a - b) <= reading_accuracy * std::max(std::abs(a), std::abs(b));
}

bool is_same(const prognosis::Reading& a, const prognosis::Reading& b) {
  return a.labels == b.labels && std::equal(a.numbers.begin(), a.numbers.end(), b.numbers.begin(),
                                            b.numbers.end(), is_close);
}

}  // namespace

StudyReadings::StudyReadings(const prognosis::Tracker& tracker, const Source& source)
    : axis_(prognosis::watched_columns(tracker).axis) {
  for (const std::string& each : tracker.seen())
    units_[each].last = tracker.begin(each)->forecast().now;
  try {
    const wearwell::Table table =
        prognosis::in_study_names(prognosis::data_table(source), tracker.columns(), source);
    const Column& names = table.column(tracker.noun());
    const prognosis::ReadingTable rows(tracker, table);
    for (std::size_t row = 0; row < table.rows; ++row) {
      const auto unit = units_.find(prognosis::unit_name(names, row));
      if (unit != units_.end()) unit->second.readings.push_back(rows.reading(row));
    }
  } catch (const InputError&) {
    // Readings of another form than the table's, such as computed ones: none can be recognized.
    for (auto& [_, unit] : units_) unit.readings.clear();
  }
}

StudyReadings::Place StudyReadings::place(const std::string& unit,
                                          const prognosis::Reading& reading) const {
  const OfUnit& known = units_.at(unit);
  for (const prognosis::Reading& each : known.readings)
    if (is_same(each, reading)) return Place::same;
  const double at = reading.numbers[axis_];
  return at > known.last && !is_close(at, known.last) ? Place::beyond : Place::unclear;
}

}  // namespace wearwell::in_service
