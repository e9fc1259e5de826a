#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>

#include "wearwell/monitor/fleet_unit.h"

// The forecasts of a fleet's units, as readers see them.
namespace wearwell::monitor {
namespace {

// What only the readings show to be wrong in an event.
std::string problem_of_events(const UnitRecord& record, const prognosis::Forecast& forecast,
                              const TrackerUnits& reported) {
  const UnitEvents& events = *record.events;
  if (record.readings == 0) return {};
  if (std::string problem = end_problem(events.part(), forecast.now, reported); !problem.empty())
    return problem;
  const prognosis::Tracker& tracker = reported.tracker();
  if (events.restored() > 0 && tracker.rising() && tracker.limit().value > 0 &&
      forecast.level95 < 0)
    return fmt::format("repairs take back more than there was: {} would be {:.3g} {}",
                       tracker.limited(), reported.level(forecast).q50, tracker.limit().unit.text);
  return {};
}

}  // namespace

void Fleet::forecast(Unit& unit) {
  const prognosis::Forecast forecast = unit.record.state->forecast();
  const bool known = !std::isnan(forecast.passed);
  const double risk = known ? risk_within(forecast, settings_.alarm.horizon) : 0;
  unit.by_risk = known ? alarm_at(risk, unit.by_risk, settings_.alarm) : Alarm::unknown;
  const prognosis::ChangeWatch& watch = unit.record.watch;
  const UnitPart& part = unit.record.events->part();
  unit.alarm = part.service == Service::in_service
                   ? alarm_of_readings(unit.by_risk, watch.is_beyond(), watch.in_doubt())
                   : Alarm::unknown;
  auto seen = std::make_shared<Seen>();
  UnitView& view = seen->view;
  const UnitRecord& record = unit.record;
  view.unit = record.unit;
  view.known = known;
  view.at = reported_.at(forecast.now);
  view.last_key = record.stored_key;
  // A reading cannot be newer than its message, even if the sender's clock says so.
  view.last_reading_ms = record.last_time_ms
                             ? std::min(record.last_time_ms, record.last_received_ms)
                             : record.last_received_ms;
  if (known) view.level = reported_.level(forecast);
  view.remaining = reported_.remaining(forecast);
  view.b10 = reported_.b10(forecast);
  view.numerical_error = relative_error(forecast.remaining, tracker_.probability_error());
  view.risk = risk;
  if (known) view.passed = std::clamp(forecast.passed, 0.0, 1.0);
  if (const auto& change = forecast.rate_change; known && change)
    view.rate_change = RateChangeView{change->probability, reported_.since(*change),
                                      prognosis::TrackerUnits::factor(*change)};
  view.doubt = watch.reason();
  view.beyond = watch.is_beyond();
  view.part = record.events->shown_part(part.number, record.earlier_readings);
  view.service = part.service;
  view.quality.readings = record.readings;
  view.quality.late = record.late;
  view.quality.contradicting = record.contradicting;
  view.quality.refused = view.quality.not_counted = record.not_counted;
  view.quality.state_problem = record.last_problem;
  if (std::string problem = problem_of_events(record, forecast, reported_); !problem.empty())
    view.quality.state_problem = problem;
  view.quality.last_problem = view.quality.state_problem;
  seen->survival = std::make_shared<const std::vector<UnitDetail::CurvePoint>>(
      survival_curve(forecast.remaining, reported_));
  seen->last_measured = record.last_measured;
  seen->held = record.held;
  seen->judged = record.judged;
  seen->moments = unit.seen && unit.seen->events == record.events &&
                          unit.seen->moments->size() == record.moments.size()
                      ? unit.seen->moments
                      : std::make_shared<const std::vector<UnitMoment>>(record.moments);
  seen->place = record.place;
  seen->events = record.events;
  seen->ahead = std::make_shared<Seen::Ahead>(unit);
  unit.seen = std::move(seen);
  unit.stale = false;
  unit.forecast_at = Clock::now();
}

// For readers: the state is locked meanwhile, and computed once for each displayed forecast.
std::vector<UnitDetail::PathPoint> Fleet::path_ahead(const Seen& seen) const {
  const std::lock_guard lock(seen.ahead->lock);
  if (seen.ahead->known) return seen.ahead->path;
  const Unit& unit = seen.ahead->unit;
  const std::lock_guard still(unit.moving);
  if (unit.lost || !unit.record.state) return {};
  const std::vector<double> places = prognosis::places_ahead(unit.record.state->forecast());
  for (const prognosis::ForecastBand& each : unit.record.state->ahead(places)) {
    seen.ahead->path.push_back({reported_.at(each.at),
                                {reported_.level(each.level05), reported_.level(each.level50),
                                 reported_.level(each.level95)}});
  }
  seen.ahead->known = true;
  return seen.ahead->path;
}

}  // namespace wearwell::monitor
