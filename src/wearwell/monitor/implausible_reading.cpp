#include "wearwell/monitor/implausible_reading.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "wearwell/present/number.h"
#include "wearwell/prognosis/change_watch.h"

namespace wearwell::monitor {
namespace {

constexpr double most_lives = 1e6, most_limits = 1e12, most_restored = 10;

/// The longest life of a new unit (of 95 %, or of fewer if these never fail), SI; infinite if
/// nothing is known of it.
double longest_life(const prognosis::Tracker& tracker) {
  std::string name = "a new " + tracker.noun();
  if (!tracker.refusal(name).empty()) {
    if (tracker.seen().empty()) return std::numeric_limits<double>::infinity();
    name = tracker.seen().front();
  }
  const prognosis::Forecast forecast = tracker.begin(name)->forecast();
  for (const double p : {0.95, 0.5, 0.05, 0.001}) {
    if (forecast.remaining.points().empty()) break;
    const double life = forecast.now + forecast.remaining.quantile(p);
    if (std::isfinite(life) && life > 0) return life;
  }
  return std::numeric_limits<double>::infinity();
}

std::string quantity(double si, const Unit& unit) {
  return shown_number(from_si(unit, si), 3, Script::terminal) +
         (unit.text == "1" ? "" : " " + unit.text);
}

/// Why a position along the axis, shown as `what`, is none; empty if it may be one.
std::string too_far(double at, double life, const std::string& what,
                    const prognosis::Tracker& tracker) {
  if (!(std::abs(at) > most_lives * life)) return {};
  return fmt::format("{} = {} is more than a million times the life of a new {} ({})", what,
                     quantity(at, tracker.axis().unit), tracker.noun(),
                     quantity(life, tracker.axis().unit));
}

}  // namespace

std::function<std::string(const UnitEvent& event)> implausible_event(
    const prognosis::Tracker& tracker) {
  const double life = longest_life(tracker), limit = std::abs(tracker.limit().si());
  return [&tracker, life, limit](const UnitEvent& event) -> std::string {
    const std::string what = name(event.kind);
    const Unit& unit = tracker.limit().unit;
    const auto beyond = [&](const char* of, double amount, double most, const char* times) {
      if (!(limit > 0) || !(std::abs(amount) > most * limit)) return std::string();
      return fmt::format("{}: {} is more than {} times the threshold of {}", what, of, times,
                         quantity(limit, unit));
    };
    if (std::string why = too_far(event.use, life, what + ": " + tracker.axis().name, tracker);
        !why.empty())
      return why;
    if (std::string why = beyond("the offset", event.offset, most_limits, "10^12"); !why.empty())
      return why;
    return beyond("restored", event.restored, most_restored, "ten");
  };
}

std::function<std::string(const StoredReading& reading)> implausible_reading(
    const prognosis::Tracker& tracker) {
  const double life = longest_life(tracker), limit = std::abs(tracker.limit().si());
  const prognosis::WatchedColumns watched = prognosis::watched_columns(tracker);
  return [&tracker, life, limit, watched](const StoredReading& reading) -> std::string {
    const auto at = [&](std::size_t column) {
      return fmt::format("{} = {}", tracker.columns()[column].name,
                         quantity(reading.numbers[column], tracker.columns()[column].unit));
    };
    const double use = reading.numbers[watched.axis];
    if (std::string why = too_far(use, life, tracker.axis().name, tracker); !why.empty())
      return why;
    if (watched.level && limit > 0 &&
        std::abs(reading.numbers[*watched.level]) > most_limits * limit)
      return fmt::format("{} is more than 10^12 times the threshold of {}", at(*watched.level),
                         quantity(limit, tracker.limit().unit));
    return tracker.problem({reading.numbers, reading.labels});
  };
}

}  // namespace wearwell::monitor
