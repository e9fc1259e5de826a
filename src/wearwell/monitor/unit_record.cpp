#include "wearwell/monitor/unit_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "wearwell/base/error.h"
#include "wearwell/monitor/time_text.h"

namespace wearwell::monitor {
namespace {

using Json = nlohmann::json;

/// Of the saved state of a unit. A release that reads or writes another form has another one.
constexpr int record_version = 1;

/// Without what repairs took back.
std::optional<double> measured_level(const StoredReading& reading, double added,
                                     const TrackerUnits& units) {
  std::optional<double> level = units.measured(reading.numbers);
  if (level) *level -= units.level(added) - units.level(0);
  return level;
}

UnitMoment moment_of(const StoredReading& reading, const prognosis::ForecastQuantiles& forecast,
                     double added, const TrackerUnits& units) {
  UnitMoment moment;
  moment.key = reading.key;
  moment.time_ms = reading.time_ms ? reading.time_ms : reading.received_ms;
  moment.at = units.at(forecast.now);
  moment.measured = measured_level(reading, added, units);
  moment.level = units.level(forecast);
  const Interval remaining = units.remaining(forecast);
  moment.life = {moment.at + remaining.q05, moment.at + remaining.q50, moment.at + remaining.q95};
  return moment;
}

/// The forecast as it was at a reading: without later repairs.
prognosis::ForecastQuantiles forecast_with(UnitRecord& record, double restored) {
  record.state->set_restored(restored);
  const prognosis::ForecastQuantiles forecast = record.state->quantiles();
  record.state->set_restored(record.events->restored());
  return forecast;
}

/// Whether a repair lies between a reading and the one before it. The moment before it is kept then,
/// so that the path falls where the level did.
bool is_repaired_before(UnitRecord& record, const CountedReading& seen, const TrackerUnits& units) {
  const double before = record.events->restored_until(record.last_key);
  if (seen.restored == before) return false;
  if (record.moments.empty() || record.moments.back().key == record.last_key) return true;
  const prognosis::ForecastQuantiles forecast = forecast_with(record, before);
  StoredReading last;
  last.key = record.last_key;
  last.time_ms = record.last_time_ms;
  last.received_ms = record.last_received_ms;
  last.numbers.assign(units.tracker().columns().size(), std::nan(""));
  if (!std::isnan(forecast.passed)) record.moments.push_back(moment_of(last, forecast, 0, units));
  return true;
}

/// "alternating_stress": what a reading does not have and takes from the one before.
std::string carried_columns(const StoredReading& reading, const prognosis::Tracker& tracker) {
  std::string names;
  const auto columns = tracker.columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].carried && std::isnan(reading.numbers[i]))
      names += (names.empty() ? "" : ", ") + columns[i].name;
  }
  return names;
}

/// Why a reading is not one of its part: its counter was set back, and the event does not say so.
std::string before_installation(const UnitRecord& record, const StoredReading& reading,
                                const TrackerUnits& units) {
  const UnitPart& part = record.events->part();
  const double since = reading.numbers[units.watched().axis];
  if (!(since < 0) || !(part.from_use > 0)) return {};
  const prognosis::ReadingColumn& axis = units.tracker().axis();
  return fmt::format(
      "{0} = {1:.6g} {2} lies before {3:.6g} {2}, at which part {4} was installed; if the counter "
      "was set back then, cancel that event and report it with {0} = 0",
      axis.name, from_si(axis.unit, since + part.from_use), axis.unit.text,
      from_si(axis.unit, part.from_use), part.number);
}

Json json_of_moment(const UnitMoment& each) {
  return {
      each.key,       each.time_ms,   each.at,        each.measured ? Json(*each.measured) : Json(),
      each.level.q05, each.level.q50, each.level.q95, each.life.q05,
      each.life.q50,  each.life.q95};
}

UnitMoment moment_of(const Json& json) {
  UnitMoment moment;
  moment.key = json.at(0);
  moment.time_ms = json.at(1);
  moment.at = json.at(2);
  if (!json.at(3).is_null()) moment.measured = json.at(3).get<double>();
  moment.level = {json.at(4), json.at(5), json.at(6)};
  moment.life = {json.at(7), json.at(8), json.at(9)};
  return moment;
}

}  // namespace

std::vector<UnitDetail::CurvePoint> survival_curve(const prognosis::WeightedLives& lives,
                                                   const TrackerUnits& reported) {
  std::vector<UnitDetail::CurvePoint> curve;
  if (lives.points().empty()) return curve;
  constexpr double last = 0.995;
  double end = lives.quantile(last);
  for (double p = last; !std::isfinite(end) && p > 0.01; p -= 0.05) end = lives.quantile(p);
  if (!std::isfinite(end) || !(end > 0)) return curve;
  constexpr int points = 120;
  for (int i = 0; i <= points; ++i) {
    const double x = end * i / points;
    curve.push_back({reported.along(x), 1 - lives.cdf(x)});
  }
  return curve;
}

prognosis::History counted_history(const UnitRecord& record, std::int64_t until, Store& store) {
  return [&store, unit = record.unit, events = record.events, until](const auto& visit) {
    store.of_unit(unit, 0, until, [&](const StoredReading& each) {
      const CountedReading seen = events->counted(each);
      if (seen.part == events->part().number && seen.state == CountedReading::State::counts)
        visit({seen.reading.numbers, seen.reading.labels});
    });
  };
}

bool is_kept_moment(std::uint64_t n) {
  constexpr std::uint64_t all = 12;
  constexpr double step = 0.12;  // of the logarithm
  if (n <= all) return true;
  const auto class_of = [](std::uint64_t k) {
    return std::floor(std::log(static_cast<double>(k)) / step);
  };
  return class_of(n) != class_of(n - 1);
}

void take(UnitRecord& record, const StoredReading& stored, const TrackerUnits& units,
          Store& store) {
  using State = CountedReading::State;
  record.stored_key = record.place == 0 ? stored.key : std::max(record.stored_key, stored.key);
  record.place = stored.place;
  const CountedReading seen = record.events->counted(stored);
  record.earlier_readings = record.earlier_readings || is_of_earlier_part(seen);
  if (seen.part != record.events->part().number || seen.state == State::withdrawn) return;
  if (seen.state == State::out_of_service) {
    ++record.not_counted;
    record.last_problem = fmt::format(
        "a reading came after the part was out of service ({}); if a new one is installed, report "
        "the event \"replaced\"",
        name(record.events->part().service));
    return;
  }
  const StoredReading& reading = seen.reading;
  const bool first = record.readings == 0;
  const bool late = !first && reading.key < record.last_key;
  const bool repaired = !first && !late && is_repaired_before(record, seen, units);
  record.last_time_ms = std::max(record.last_time_ms, reading.time_ms);
  record.last_received_ms = reading.received_ms;
  record.late += late;
  record.last_key = first ? reading.key : std::max(record.last_key, reading.key);
  ++record.readings;
  const prognosis::History history = counted_history(record, reading.place - 1, store);
  const double added = units.tracker().rising() ? seen.restored : -seen.restored;
  const prognosis::UpdateResult taken =
      record.watch.update({units.tracker(), units.watched(), record.part, *record.state,
                           record.events->restored(), added, seen.offset},
                          {reading.numbers, reading.labels}, late, history);
  if (!taken.problem.empty()) record.last_problem = taken.problem;
  constexpr std::int64_t hour_ms = 3'600'000;  // clocks differ
  if (taken.problem.empty() && reading.time_ms > reading.received_ms + hour_ms)
    record.last_problem = fmt::format(
        "a reading has the time {}, which was more than an hour ahead when it arrived: one of two "
        "clocks is wrong",
        iso_of_unix_ms(reading.time_ms));
  if (taken.problem.empty()) {
    const std::string carried = carried_columns(reading, units.tracker());
    if (!carried.empty())
      record.last_problem = fmt::format(
          "a reading has no {}; that of the reading before holds for its use, too", carried);
  }
  if (!taken.counted) {
    ++record.not_counted;
    const std::string before = before_installation(record, reading, units);
    if (!before.empty()) record.last_problem = before;
    return;
  }
  if (!late) record.last_measured = measured_level(reading, added, units);
  record.contradicting += taken.contradicts;
  if (!first && !late) {
    constexpr double outside = 0.1;  // of 5 to 95 %, on both sides
    ++record.judged;
    record.held += taken.p_value >= outside;
  }
  if (!is_kept_moment(record.readings) && !repaired) return;
  const prognosis::ForecastQuantiles forecast = forecast_with(record, seen.restored);
  // If the continuation was undetermined, there was no forecast.
  if (!std::isnan(forecast.passed))
    record.moments.push_back(moment_of(reading, forecast, added, units));
}

UnitRecord begun_record(const std::string& unit, const prognosis::Tracker& tracker,
                        std::shared_ptr<const UnitEvents> events) {
  UnitRecord record;
  record.unit = unit;
  record.part = begun_name(unit, *events, tracker);
  record.state = tracker.begin(record.part);
  record.state->set_restored(events->restored());
  record.events = std::move(events);
  return record;
}

std::string bytes_of(const UnitRecord& record) {
  Json moments = Json::array();
  for (const UnitMoment& each : record.moments) moments.push_back(json_of_moment(each));
  const std::string state = record.state->save();
  prognosis::ByteWriter to;
  record.watch.save(to);
  const std::string watch = to.take();
  const Json json = {
      {"version", record_version},
      {"state", Json::binary({state.begin(), state.end()})},
      {"readings", record.readings},
      {"late", record.late},
      {"contradicting", record.contradicting},
      {"not_counted", record.not_counted},
      {"held", record.held},
      {"judged", record.judged},
      {"problem", record.last_problem},
      {"key", record.last_key},
      {"time_ms", record.last_time_ms},
      {"received_ms", record.last_received_ms},
      {"moments", moments},
      {"watch", Json::binary({watch.begin(), watch.end()})},
      {"event", record.events->last_of_state()},
      {"stored_key", record.stored_key},
      {"earlier_readings", record.earlier_readings},
      {"measured", record.last_measured ? Json(*record.last_measured) : Json()},
  };
  std::string bytes;
  Json::to_cbor(json, bytes);
  return bytes;
}

UnitRecord restored_record(const Checkpoint& checkpoint, const prognosis::Tracker& tracker,
                           std::shared_ptr<const UnitEvents> events) {
  try {
    const Json json = Json::from_cbor(checkpoint.bytes);
    if (!json.is_object() || json.value("version", 0) != record_version)
      throw InputError(fmt::format(
          "the state of unit '{}' was saved by another version of wearwell", checkpoint.unit));
    if (json.value("event", std::int64_t{0}) != events->last_of_state())
      throw InputError(fmt::format("the state of unit '{}' is from before event {}",
                                   checkpoint.unit, events->last_of_state()));
    const auto& state = json.at("state").get_binary();
    UnitRecord record;
    record.unit = checkpoint.unit;
    record.place = checkpoint.place;
    record.state = tracker.restore(std::string(state.begin(), state.end()));
    record.state->set_restored(events->restored());
    record.part = begun_name(record.unit, *events, tracker);
    record.events = std::move(events);
    json.at("readings").get_to(record.readings);
    json.at("late").get_to(record.late);
    json.at("contradicting").get_to(record.contradicting);
    json.at("not_counted").get_to(record.not_counted);
    json.at("held").get_to(record.held);
    json.at("judged").get_to(record.judged);
    json.at("problem").get_to(record.last_problem);
    json.at("key").get_to(record.last_key);
    json.at("stored_key").get_to(record.stored_key);
    json.at("earlier_readings").get_to(record.earlier_readings);
    if (!json.at("measured").is_null()) record.last_measured = json.at("measured").get<double>();
    json.at("time_ms").get_to(record.last_time_ms);
    json.at("received_ms").get_to(record.last_received_ms);
    for (const Json& each : json.at("moments")) record.moments.push_back(moment_of(each));
    const auto& watch = json.at("watch").get_binary();
    const std::string bytes(watch.begin(), watch.end());
    prognosis::ByteReader from(bytes, fmt::format("the state of unit '{}'", checkpoint.unit));
    record.watch.load(from, tracker);
    from.end();
    return record;
  } catch (const Json::exception& error) {
    throw InputError(
        fmt::format("the state of unit '{}' is damaged: {}", checkpoint.unit, error.what()));
  }
}

}  // namespace wearwell::monitor
