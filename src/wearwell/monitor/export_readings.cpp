#include "wearwell/monitor/export_readings.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "wearwell/input/csv_reader.h"
#include "wearwell/input/parquet_writer.h"
#include "wearwell/monitor/stored_units.h"
#include "wearwell/monitor/time_text.h"

namespace wearwell::monitor {
namespace {

/// Readings that count, under the name of their part.
void for_each_reading(Store& store, const prognosis::Tracker& tracker,
                      const std::function<void(const StoredReading&)>& visit) {
  const EventsOfUnits events = events_of_units(store, tracker);
  PartNames names(store, events);
  for_each_counted(store, events, [&](const std::string& unit, CountedReading& seen) {
    if (seen.state != CountedReading::State::counts) return;
    seen.reading.unit = names.exported(unit, seen.part);
    visit(seen.reading);
  });
}

/// Whether it is of a part in doubt.
bool count_reading(const StoredReading& reading, const DoubtedParts& doubted,
                   ExportCounts& counts) {
  const bool in_doubt = doubted.contains(reading.unit);
  ++counts.readings;
  counts.doubted += in_doubt;
  return in_doubt;
}

}  // namespace

DoubtedParts doubted_parts(Store& store, const Population& population) {
  DoubtedParts parts;
  const PartNames names(store, events_of_units(store, *population.tracker));
  for (const auto& [unit, record] : stored_units(store, population))
    if (record.watch.in_doubt()) parts.insert(names.name(unit, record.events->part().number));
  return parts;
}

void for_each_counted(
    Store& store, const EventsOfUnits& events,
    const std::function<void(const std::string& unit, CountedReading& seen)>& visit) {
  constexpr std::size_t at_once = 10'000;
  std::int64_t place = 0;
  for (;;) {
    const std::vector<StoredReading> readings = store.after(place, at_once);
    if (readings.empty()) return;
    for (const StoredReading& each : readings) {
      CountedReading seen = events_of(events, each.unit)->counted(each);
      visit(each.unit, seen);
    }
    place = readings.back().place;
  }
}

std::string column_heading(const prognosis::ReadingColumn& column) {
  return column.unit.text == "1" ? column.name
                                 : fmt::format("{} [{}]", column.name, column.unit.text);
}

std::string readings_as_parquet(Store& store, const prognosis::Tracker& tracker,
                                const DoubtedParts& doubted, ExportCounts& counts) {
  WordColumn unit{tracker.noun().empty() ? "unit" : tracker.noun(), {}};
  std::vector<WordColumn> labels;
  for (const std::string& each : tracker.labels()) labels.push_back({each, {}});
  const auto columns = tracker.columns();
  std::vector<NumberColumn> numbers = {{"key", {}}, {"time_ms", {}}, {"received_ms", {}}};
  const std::size_t first = numbers.size();
  for (const auto& each : columns) numbers.push_back({column_heading(each), {}});
  numbers.push_back({"doubt", {}});
  counts = {};
  for_each_reading(store, tracker, [&](const StoredReading& reading) {
    const bool in_doubt = count_reading(reading, doubted, counts);
    unit.values.push_back(reading.unit);
    for (std::size_t i = 0; i < labels.size(); ++i) labels[i].values.push_back(reading.labels[i]);
    numbers[0].values.push_back(static_cast<double>(reading.key));
    numbers[1].values.push_back(reading.time_ms ? static_cast<double>(reading.time_ms)
                                                : std::nan(""));
    numbers[2].values.push_back(static_cast<double>(reading.received_ms));
    for (std::size_t i = 0; i < columns.size(); ++i)
      numbers[first + i].values.push_back(from_si(columns[i].unit, reading.numbers[i]));
    numbers.back().values.push_back(in_doubt ? 1 : 0);
  });
  std::vector<WordColumn> texts = {std::move(unit)};
  texts.insert(texts.end(), labels.begin(), labels.end());
  return parquet_of(texts, numbers);
}

std::string readings_as_csv(Store& store, const prognosis::Tracker& tracker,
                            const DoubtedParts& doubted, ExportCounts& counts) {
  const auto columns = tracker.columns();
  std::string text = printable_csv_cell(tracker.noun().empty() ? "unit" : tracker.noun());
  for (const std::string& each : tracker.labels()) text += "," + printable_csv_cell(each);
  text += ",key,time,received";
  for (const auto& each : columns) text += "," + printable_csv_cell(column_heading(each));
  text += ",doubt\n";
  counts = {};
  for_each_reading(store, tracker, [&](const StoredReading& reading) {
    const bool in_doubt = count_reading(reading, doubted, counts);
    text += printable_csv_cell(reading.unit);
    for (const std::string& each : reading.labels) text += "," + printable_csv_cell(each);
    text += fmt::format(",{},{},{}", reading.key,
                        reading.time_ms ? iso_of_unix_ms(reading.time_ms) : "",
                        iso_of_unix_ms(reading.received_ms));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const double value = from_si(columns[i].unit, reading.numbers[i]);
      text += std::isnan(value) ? std::string(",") : fmt::format(",{}", value);
    }
    text += in_doubt ? ",1\n" : ",0\n";
  });
  return text;
}

}  // namespace wearwell::monitor
