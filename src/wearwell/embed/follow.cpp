#include "wearwell/embed/follow.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/embed/fork_guard.h"
#include "wearwell/models/registry.h"
#include "wearwell/prognosis/backtest_report.h"
#include "wearwell/prognosis/reading_table.h"
#include "wearwell/prognosis/result_lives.h"

namespace wearwell::embed {
namespace {

std::string unit_or_only(const prognosis::Tracker& tracker, const std::string& unit, bool fresh) {
  if (!unit.empty()) return unit;
  if (fresh) return "new";
  if (tracker.seen().size() != 1)
    throw InputError(fmt::format("unit is missing: the study has {} units of the kind '{}'",
                                 tracker.seen().size(), tracker.noun()));
  return tracker.seen().front();
}

}  // namespace

std::shared_ptr<const Population> population_of(const Fitted& fitted) {
  const ForkGuard guard;
  prognosis::CarriedState state = state_of(fitted);
  if (state.parameters.empty())
    throw InputError(fitted.name() +
                     ": a clutch campaign has no posterior with which single units are followed");
  auto tracker = prognosis::required_tracker(state, all_models(), fitted.name());
  return std::make_shared<const Population>(
      Population{std::move(tracker), std::move(state.source), state.trusted});
}

FollowedUnit::FollowedUnit(std::shared_ptr<const Population> population, const std::string& unit,
                           bool fresh)
    : population_(std::move(population)),
      tracker_(population_->tracker, unit_or_only(*population_->tracker, unit, fresh), fresh) {}

std::string FollowedUnit::update(const Table& rows) {
  const ForkGuard guard;
  return prognosis::outcomes_json(tracker_.update(prognosis::in_study_names(
                                      rows, population_->tracker->columns(), population_->source)))
      .dump();
}

std::string FollowedUnit::json() const {
  const ForkGuard guard;
  return printable_json(tracker_.json().dump());
}

double FollowedUnit::risk(const std::string& within) const {
  const ForkGuard guard;
  return tracker_.risk(within);
}

std::vector<prognosis::ForecastBand> FollowedUnit::path() const {
  const ForkGuard guard;
  return tracker_.path();
}

Backtested backtest(const Population& population, const Table& readings, const Table& lives) {
  const ForkGuard guard;
  const prognosis::Tracker& tracker = *population.tracker;
  const std::array<prognosis::ReadingColumn, 1> life = {
      prognosis::ReadingColumn{"life", tracker.axis().unit, false}};
  const prognosis::Backtest test = prognosis::backtest(
      tracker, prognosis::in_study_names(readings, tracker.columns(), population.source),
      prognosis::in_study_names(lives, life, population.source));
  return {prognosis::backtest_text(test, tracker),
          printable_json(prognosis::backtest_json(test).dump(2)) + "\n",
          prognosis::backtest_csv(test, tracker)};
}

}  // namespace wearwell::embed
