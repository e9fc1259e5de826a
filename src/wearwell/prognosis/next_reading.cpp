#include "wearwell/prognosis/next_reading.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/trimmed.h"
#include "wearwell/prognosis/quantity_like.h"

namespace wearwell::prognosis {
namespace {

std::size_t column_at(const Tracker& tracker, const std::string& name) {
  std::vector<std::string> names;
  for (const ReadingColumn& each : tracker.columns()) {
    if (each.name == name) return names.size();
    names.push_back(each.name);
  }
  throw InputError(fmt::format("--given: there is no '{}'; it is one of {}{}", printable(name),
                               fmt::join(names, ", "), did_you_mean(name, names)));
}

void add_given(const Tracker& tracker, const std::string& text, Reading& reading) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos)
    throw InputError(fmt::format("--given: '{}' must be like 'force = 20 N'", printable(text)));
  const std::string name(trimmed(text.substr(0, sign))), value(trimmed(text.substr(sign + 1)));
  const auto labels = tracker.labels();
  const auto label = std::find(labels.begin(), labels.end(), name);
  if (label != labels.end()) {
    reading.labels[static_cast<std::size_t>(label - labels.begin())] = value;
    return;
  }
  const std::size_t column = column_at(tracker, name);
  reading.numbers[column] = quantity_like("--given", value, tracker.columns()[column].unit);
}

}  // namespace

FollowedUnits units_of_study(const Tracker& tracker) {
  FollowedUnits units;
  units.tracker = &tracker;
  units.names.assign(tracker.seen().begin(), tracker.seen().end());
  units.unit = [&tracker](const std::string& name) { return tracker.begin(name); };
  units.history = [](const std::string&) -> History {
    return [](const std::function<void(const Reading&)>&) {};
  };
  return units;
}

void require_known(const FollowedUnits& units, const std::string& name) {
  if (std::find(units.names.begin(), units.names.end(), name) != units.names.end()) return;
  throw InputError(fmt::format("--unit: the {} has no {} '{}'{}", units.source,
                               units.tracker->noun(), printable(name),
                               did_you_mean(name, units.names)));
}

std::optional<std::size_t> measured_column(const Tracker& tracker) {
  const auto columns = tracker.columns();
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].measured) return i;
  return {};
}

Reading next_reading(const Tracker& tracker, double position,
                     const std::vector<std::string>& given) {
  Reading reading{std::vector<double>(tracker.columns().size(), std::nan("")),
                  std::vector<std::string>(tracker.labels().size())};
  for (const std::string& each : given) add_given(tracker, each, reading);
  reading.numbers[column_at(tracker, tracker.axis().name)] = position;
  return reading;
}

}  // namespace wearwell::prognosis
