#include "wearwell/prognosis/unit_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/input/columns.h"
#include "wearwell/prognosis/bytes.h"
#include "wearwell/prognosis/interval_json.h"
#include "wearwell/prognosis/quantity_like.h"
#include "wearwell/prognosis/reading_table.h"

namespace wearwell::prognosis {
namespace {

using Json = nlohmann::ordered_json;

Json change_json(const std::optional<RateChange>& change, const TrackerUnits& units) {
  if (!change) return nullptr;
  return {{"probability", finite_or_null(change->probability)},
          {"since", interval_json(units.since(*change))},
          {"factor", interval_json(TrackerUnits::factor(*change))}};
}

void require_unit(const Tracker& tracker, const std::string& unit, bool fresh) {
  const auto seen = tracker.seen();
  const bool known = std::find(seen.begin(), seen.end(), unit) != seen.end();
  if (unit.empty()) throw InputError("unit is empty; it is the name of a unit");
  if (known && fresh)
    throw InputError(fmt::format("unit: {} '{}' is one of the study, so it is not new",
                                 tracker.noun(), printable(unit)));
  if (const std::string refusal = tracker.refusal(unit); !refusal.empty())
    throw InputError(fmt::format("unit: {}", refusal));
  if (!known && !fresh)
    throw InputError(fmt::format(
        "unit: the study has no {} '{}'; track it as a new one (new) to begin without readings{}",
        tracker.noun(), printable(unit),
        did_you_mean(unit, std::vector<std::string>(seen.begin(), seen.end()))));
}

bool is_complete(const Reading& reading) {
  return std::none_of(reading.numbers.begin(), reading.numbers.end(),
                      [](double x) { return std::isnan(x); });
}

}  // namespace

UnitTracker::UnitTracker(std::shared_ptr<const Tracker> tracker, std::string unit, bool fresh)
    : tracker_(std::move(tracker)), unit_(std::move(unit)), fresh_(fresh), reported_(*tracker_) {
  require_unit(*tracker_, unit_, fresh_);
  state_ = tracker_->begin(unit_);
}

std::vector<RowOutcome> UnitTracker::update(const Table& rows) {
  return update(readings_of_unit(*tracker_, unit_, rows));
}

std::vector<RowOutcome> UnitTracker::update(std::vector<Reading> readings) {
  const Before before = present();
  try {
    return taken(readings);
  } catch (...) {
    const StopScope to_the_end(nullptr);
    go_back(before);
    throw;
  }
}

UnitTracker::Before UnitTracker::present() const {
  ByteWriter watch;
  watch_.save(watch);
  return {state_->save(), watch.take(), history_.size(), repeated_,
          contradicting_, refused_,     last_problem_};
}

void UnitTracker::go_back(const Before& before) {
  state_ = tracker_->restore(before.state);
  ByteReader watch(before.watch, unit_);
  watch_ = {};
  watch_.load(watch, *tracker_);
  history_.erase(history_.begin() + static_cast<std::ptrdiff_t>(before.readings), history_.end());
  known_.clear();
  for (const Reading& each : history_)
    if (is_complete(each)) known_.emplace(each.numbers, each.labels);
  repeated_ = before.repeated;
  contradicting_ = before.contradicting;
  refused_ = before.refused;
  last_problem_ = before.last_problem;
}

std::vector<RowOutcome> UnitTracker::taken(std::vector<Reading>& readings) {
  std::vector<RowOutcome> outcomes;
  for (Reading& reading : readings) {
    RowOutcome outcome;
    if (is_complete(reading) && !known_.emplace(reading.numbers, reading.labels).second) {
      ++repeated_;
      outcome.repeated = true;
      outcomes.push_back(std::move(outcome));
      continue;
    }
    const History history = [&](const auto& visit) {
      for (const Reading& each : history_) visit(each);
    };
    outcome.result =
        watch_.update({*tracker_, reported_.watched(), unit_, *state_}, reading, false, history);
    if (!outcome.result.problem.empty()) last_problem_ = outcome.result.problem;
    refused_ += !outcome.result.counted;
    contradicting_ += outcome.result.counted && outcome.result.contradicts;
    if (outcome.result.counted) history_.push_back(std::move(reading));
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

std::optional<InPopulations> UnitTracker::in_populations() const {
  return state_->in_populations([&](const auto& visit) {
    for (const Reading& each : history_) visit(each);
  });
}

Json UnitTracker::json() const {
  const Forecast now = forecast();
  const bool known = !std::isnan(now.passed);
  const auto if_known = [&](const Json& value) { return known ? value : Json(nullptr); };
  const std::string doubt = watch_.reason();
  return {{"unit", unit_},
          {"noun", tracker_->noun()},
          {"new", fresh_},
          {"axis", tracker_->axis().name},
          {"axis_unit", tracker_->axis().unit.text},
          {"limited", tracker_->limited()},
          {"level_unit", tracker_->limit().unit.text},
          {"limit", finite_or_null(reported_.level(tracker_->limit().si()))},
          {"known", known},
          {"at", if_known(finite_or_null(reported_.at(now.now)))},
          {"level", if_known(known ? interval_json(reported_.level(now)) : Json())},
          {"remaining", if_known(interval_json(reported_.remaining(now)))},
          {"b10", if_known(finite_or_null(reported_.b10(now)))},
          {"numerical_error",
           if_known(finite_or_null(relative_error(now.remaining, tracker_->probability_error())))},
          {"passed", if_known(finite_or_null(std::clamp(now.passed, 0.0, 1.0)))},
          {"rate_change", if_known(known ? change_json(now.rate_change, reported_) : Json())},
          {"doubt", doubt.empty() ? Json(nullptr) : Json(doubt)},
          {"beyond", watch_.is_beyond()},
          {"quality",
           {{"readings", history_.size() + refused_},
            {"repeated", repeated_},
            {"contradicting", contradicting_},
            {"refused", refused_},
            {"last_problem", last_problem_}}}};
}

double UnitTracker::risk(const std::string& within) const {
  const double horizon =
      quantity_like("within", within, tracker_->axis().unit, Allowed::not_negative);
  const Forecast now = forecast();
  return std::isnan(now.passed) ? now.passed : risk_within(now, horizon);
}

std::vector<ForecastBand> UnitTracker::path() const {
  std::vector<ForecastBand> path = state_->ahead(places_ahead(forecast()));
  for (ForecastBand& each : path)
    each = {reported_.at(each.at), reported_.level(each.level05), reported_.level(each.level50),
            reported_.level(each.level95)};
  return path;
}

Json outcomes_json(const std::vector<RowOutcome>& outcomes) {
  Json all = Json::array();
  for (const auto& [repeated, result] : outcomes)
    all.push_back({{"counted", result.counted},
                   {"repeated", repeated},
                   {"contradicts", result.contradicts},
                   {"p_value", repeated ? Json(nullptr) : finite_or_null(result.p_value)},
                   {"problem", result.problem}});
  return all;
}

}  // namespace wearwell::prognosis
