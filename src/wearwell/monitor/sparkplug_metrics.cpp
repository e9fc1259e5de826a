#include "wearwell/monitor/sparkplug_metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/monitor/time_text.h"

namespace wearwell::monitor {
namespace {

constexpr std::uint32_t good_quality = 192;

std::string shown_text(std::string_view text) {
  return printable(shortened(text));
}

bool is_special(std::string_view field) {
  return field.find('{') != field.npos;
}

/// Reads a unit of measure: returns its conflict with the column of the configuration.
std::string take_unit(KnownMetric& known, const ColumnField& column, std::string_view said) {
  constexpr std::size_t longest = 100;
  const bool readable = !said.empty() && said.size() <= longest;
  if (column.unit_of_message) {
    if (!readable) return fmt::format("{} has no engUnit", shown_text(column.field));
    try {
      known.unit = read_unit(said, column.unit.text);
    } catch (const InputError& error) {
      return fmt::format("engUnit of {}: {}", shown_text(column.field), error.what());
    }
    return {};
  }
  // An unknown unit contradicts nothing.
  if (!readable || !parse_unit(std::string(said))) return {};
  try {
    const Unit unit = read_unit(said, column.unit.text);
    const double tolerance = 1e-9 * column.unit.scale;
    if (std::abs(unit.scale - column.unit.scale) <= tolerance &&
        std::abs(unit.offset - column.unit.offset) <= tolerance)
      return {};
  } catch (const InputError&) {
  }
  return fmt::format("{} comes in '{}' by its engUnit, but in '{}' by the configuration",
                     shown_text(column.field), shown_text(said), column.unit.text);
}

void take_units(KnownMetric& known, const SparkplugName& name, std::string_view said,
                const ReadingMapping& mapping) {
  known.problem.clear();
  known.unit.reset();
  for (const ColumnField& column : mapping.columns) {
    if (column.constant || column.field != name.text || !known.problem.empty()) continue;
    known.problem = take_unit(known, column, said);
  }
}

/// One value of a list in order of time: the nearest within `together_ms`, else the last before;
/// null if there is none.
const SparkplugValue* at(const std::vector<SparkplugValue>& values, std::int64_t time_ms,
                         bool fresh) {
  const auto later = std::lower_bound(
      values.begin(), values.end(), time_ms,
      [](const SparkplugValue& each, std::int64_t time) { return each.time_ms < time; });
  const SparkplugValue* after = later == values.end() ? nullptr : &*later;
  const SparkplugValue* before = later == values.begin() ? nullptr : &*std::prev(later);
  const std::int64_t to_after = after ? after->time_ms - time_ms : together_ms + 1;
  const std::int64_t to_before = before ? time_ms - before->time_ms : together_ms + 1;
  if (to_after <= together_ms && to_after <= to_before) return after;
  if (to_before <= together_ms || !fresh) return before;
  return nullptr;
}

const SparkplugValue* held(const KnownMetric& known, std::int64_t time_ms, bool historical) {
  const auto held_then = [&](const std::optional<SparkplugValue>& value) {
    return value && value->time_ms <= time_ms + together_ms;
  };
  if (known.now && (!historical || held_then(known.now))) return &*known.now;
  return historical && held_then(known.before) ? &*known.before : nullptr;
}

/// Metrics that are measured together.
struct Moment {
  std::int64_t time_ms = 0;
  std::vector<const SparkplugValue*> measured;  // by name
};

std::vector<Moment> moments_of(const std::vector<SparkplugName>& names,
                               const SparkplugValues& values) {
  std::vector<std::pair<const SparkplugValue*, std::size_t>> all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!names[i].measured) continue;
    for (const SparkplugValue& each : values[i]) all.emplace_back(&each, i);
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.first->time_ms < b.first->time_ms;
  });
  std::vector<Moment> moments;
  for (const auto& [value, name] : all) {
    if (moments.empty() || value->time_ms - moments.back().time_ms > together_ms ||
        moments.back().measured[name])
      moments.push_back(
          {value->time_ms, std::vector<const SparkplugValue*>(names.size(), nullptr)});
    moments.back().measured[name] = value;
  }
  return moments;
}

}  // namespace

std::vector<SparkplugName> sparkplug_names(const ReadingMapping& mapping) {
  std::vector<SparkplugName> names;
  const auto add = [&](const std::string& text, bool measured, bool fresh) {
    if (text.empty() || is_special(text)) return;
    const auto same = [&](const SparkplugName& each) { return each.text == text; };
    const auto found = std::find_if(names.begin(), names.end(), same);
    SparkplugName& name = found == names.end() ? names.emplace_back() : *found;
    name.text = text;
    name.measured = name.measured || measured;
    name.fresh = name.fresh || fresh;
  };
  add(mapping.unit, false, false);
  add(mapping.time, false, true);
  add(mapping.sequence, false, true);
  for (const ColumnField& column : mapping.columns) {
    if (!column.constant) add(column.field, column.measured, column.measured);
  }
  for (const std::string& label : mapping.labels) add(label, false, false);
  return names;
}

void be_born(KnownMetric& known, const SparkplugName& name, const SparkplugMetric& metric,
             const ReadingMapping& mapping) {
  known.born = true;
  known.type = metric.type;
  known.good = true;
  take_units(known, name, metric.eng_unit.value_or(""), mapping);
}

SparkplugValue value_of(KnownMetric& known, const SparkplugName& name,
                        const SparkplugMetric& metric, std::optional<std::uint64_t> sent_ms,
                        const ReadingMapping& mapping) {
  if (metric.quality) known.good = *metric.quality == good_quality;
  if (metric.eng_unit) take_units(known, name, *metric.eng_unit, mapping);
  SparkplugValue value;
  const std::string shown = shown_text(name.text);
  const auto time = metric.timestamp ? metric.timestamp : sent_ms;
  if (!time || *time > static_cast<std::uint64_t>(latest_unix_ms)) {
    value.problem = shown + " has no time, or an impossible one";
    return value;
  }
  value.time_ms = static_cast<std::int64_t>(*time);
  if (metric.type != 0 && metric.type != known.type) {
    value.problem = fmt::format("{} has type {}, but its birth certificate has {}", shown,
                                metric.type, known.type);
  } else if (!known.good) {
    value.problem = fmt::format("{} does not have good quality, by its edge node", shown);
  } else if (!known.problem.empty()) {
    value.problem = known.problem;
  } else {
    try {
      value.field = field_of(metric, known.type, name.text);
      if (known.unit && value.field.kind == Field::Kind::number) {
        value.field.number = to_si(*known.unit, value.field.number);
        value.field.whole = false;
      }
    } catch (const InputError& error) {
      value.problem = error.what();
    }
  }
  return value;
}

std::vector<SparkplugReading> readings_of(const std::vector<SparkplugName>& names,
                                          const std::vector<KnownMetric>& known,
                                          const SparkplugValues& values, bool historical) {
  std::vector<SparkplugReading> readings;
  for (const Moment& moment : moments_of(names, values)) {
    SparkplugReading reading;
    for (std::size_t i = 0; i < names.size() && reading.problem.empty(); ++i) {
      const SparkplugValue* value = moment.measured[i];
      if (!names[i].measured) value = at(values[i], moment.time_ms, names[i].fresh);
      if (!value && !names[i].fresh) value = held(known[i], moment.time_ms, historical);
      if (!value) continue;
      reading.problem = value->problem;
      reading.fields.push_back(value->field);
    }
    Field time{std::string(timestamp_field), Field::Kind::number};
    time.number = static_cast<double>(moment.time_ms);
    time.integer = moment.time_ms;
    time.whole = true;
    reading.fields.push_back(std::move(time));
    readings.push_back(std::move(reading));
  }
  return readings;
}

void hold(const std::vector<SparkplugName>& names, const SparkplugValues& values, bool historical,
          std::vector<KnownMetric>& known) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].fresh || values[i].empty()) continue;
    const SparkplugValue& last = values[i].back();
    if (!historical) {
      if (known[i].now) known[i].before = known[i].now;
      known[i].now = last;
    } else if (!known[i].before || last.time_ms >= known[i].before->time_ms) {
      known[i].before = last;
    }
  }
}

}  // namespace wearwell::monitor
