#include "wearwell/prognosis/decision_request.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/input/option_value.h"
#include "wearwell/prognosis/money.h"
#include "wearwell/prognosis/quantity_like.h"

namespace wearwell::prognosis {
namespace {

Question question_of(const DecisionRequest& request, const Unit& axis) {
  Question question;
  Currency currency;
  question.costs.failure = amount("--failure-cost", request.failure_cost, currency);
  question.costs.replacement = replacement_amount(request.replacement_cost, currency);
  if (!request.inspection_cost.empty()) {
    question.costs.inspection = amount("--inspection-cost", request.inspection_cost, currency);
    question.inspected = true;
    if (question.costs.inspection <= 0)
      throw InputError(
          "--inspection-cost: must be above 0; otherwise the optimal interval is zero");
  }
  if (!request.downtime_cost.empty()) {
    if (!question.inspected)
      throw InputError(
          "--downtime-cost: applies to failures that only an inspection shows; it needs "
          "--inspection-cost");
    question.hidden = amount_per("--downtime-cost", request.downtime_cost, axis, currency);
  }
  if (!request.month.empty())
    question.per_month = quantity_like("--month", request.month, axis, Allowed::positive);
  question.currency = currency.text;
  question.months = request.months;
  question.service = request.service;
  if (!request.claims.empty()) {
    question.claims = option_value("--claims", request.claims, "1", Allowed::positive);
    if (!(*question.claims < 1))
      throw InputError(fmt::format("--claims: {} must lie between 0 and 100 %", request.claims));
  }
  return question;
}

WorthReport worth_of(const DecisionRequest& request, const FollowedUnits& units,
                     const Question& question, double rate) {
  if (!units.tracker)
    throw InputError(
        "--inspect-after: a table of lives does not predict what a reading would show");
  if (!question.inspected) throw InputError("--inspect-after: needs --inspection-cost");
  const Tracker& tracker = *units.tracker;
  require_known(units, request.unit);
  const auto unit = units.unit(request.unit);
  const Forecast now = unit->forecast();
  WorthReport report;
  report.unit = request.unit;
  report.after = quantity_like("--inspect-after", request.inspect_after, tracker.axis().unit,
                               Allowed::not_negative);
  const Reading reading = next_reading(tracker, now.now + report.after, request.given);
  const std::optional<std::size_t> measured = measured_column(tracker);
  if (!measured)
    throw InputError(fmt::format(
        "--inspect-after: a reading of a {} shows only whether it has failed", tracker.noun()));
  report.column = tracker.columns()[*measured].name;
  report.reading_unit = tracker.columns()[*measured].unit;
  report.outcomes =
      possible_outcomes(tracker, *unit, reading, *measured, units.history(request.unit));
  report.worth = inspection_worth(now.remaining, now.passed, report.outcomes, report.after,
                                  question.costs, rate);
  return report;
}

}  // namespace

DecisionsReport decide(const DecisionRequest& request, KnownLives lives,
                       const FollowedUnits& units) {
  if (request.unit.empty() != request.inspect_after.empty())
    throw InputError("--unit and --inspect-after go together; give both");
  DecisionsReport report;
  report.lives = std::move(lives);
  report.question = question_of(request, report.lives.unit);
  if (report.question.per_month && report.lives.units.empty())
    throw InputError("--month: there is no running unit to count");
  report.decisions = decide(report.lives, report.question);
  if (!request.unit.empty())
    report.worth = worth_of(request, units, report.question, report.decisions.reference);
  return report;
}

}  // namespace wearwell::prognosis
