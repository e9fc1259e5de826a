#include "wearwell/monitor/population.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/monitor/learned_readings.h"

namespace wearwell::monitor {
namespace {

std::string listed(const prognosis::Tracker& tracker) {
  std::string text;
  for (const prognosis::ReadingColumn& each : tracker.columns())
    text += fmt::format("{}{} [{}]", text.empty() ? "" : ", ", each.name, each.unit.text);
  for (const std::string& each : tracker.labels())
    text += fmt::format("{}{}", text.empty() ? "" : ", ", each);
  return text;
}

}  // namespace

std::string misfit(const Population& present, const Population& now,
                   const std::vector<std::string>& units) {
  if (!now.trusted) return "it did not pass its checks and is not trusted";
  const prognosis::Tracker &old = *present.tracker, &tracker = *now.tracker;
  const auto differ = [](const std::string& what, const std::string& a, const std::string& b) {
    return a == b ? std::string() : fmt::format("its {} is {}, not {}", what, b, a);
  };
  const auto quantity = [](const prognosis::Tracker& of) {
    return fmt::format("{} {} = {} {}", of.limited(), of.rising() ? "from below" : "from above",
                       of.limit().value, of.limit().unit.text);
  };
  if (listed(old) != listed(tracker))
    return fmt::format("its readings have the columns {}, not {}", listed(tracker), listed(old));
  for (const std::string& why : {differ("axis of life", old.axis().name, tracker.axis().name),
                                 differ("threshold", quantity(old), quantity(tracker)),
                                 differ("kind of unit", old.noun(), tracker.noun())}) {
    if (!why.empty()) return why;
  }
  for (const std::string& unit : units) {
    if (const std::string why = tracker.refusal(unit); !why.empty()) return why;
  }
  return learned_units(old, tracker, units);
}

PopulationChecks::PopulationChecks(std::shared_ptr<const prognosis::Tracker> tracker) {
  set(std::move(tracker));
}

void PopulationChecks::set(std::shared_ptr<const prognosis::Tracker> tracker) {
  auto now = std::make_shared<Present>();
  now->mapping = tracker_checks(*tracker);
  now->tracker = std::move(tracker);
  const std::lock_guard lock(lock_);
  present_ = std::move(now);
}

std::shared_ptr<const PopulationChecks::Present> PopulationChecks::present() const {
  const std::lock_guard lock(lock_);
  return present_;
}

void PopulationChecks::bind(ReadingMapping& mapping) const {
  mapping.refusal = [this](const std::string& unit) { return present()->mapping.refusal(unit); };
  mapping.implausible = [this](const StoredReading& reading) {
    return present()->mapping.implausible(reading);
  };
  mapping.in_study = [this](const std::string& unit) { return present()->mapping.in_study(unit); };
  mapping.event_problem = [this](const UnitEvent& event) {
    return present()->mapping.event_problem(event);
  };
}

}  // namespace wearwell::monitor
