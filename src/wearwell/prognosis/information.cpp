#include "wearwell/prognosis/information.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/stop_scope.h"

namespace wearwell::prognosis {
namespace {

// Where it has failed with this probability, by the present forecast.
double failed_by(std::span<const Outcome> outcomes, double after) {
  double sum = 0;
  for (const Outcome& each : outcomes)
    sum += each.probability * (each.passed + (each.passed < 1 && !each.remaining.points().empty()
                                                  ? (1 - each.passed) * each.remaining.cdf(after)
                                                  : 0));
  return sum;
}

// The forecast of a unit after a reading.
class Asked {
 public:
  Asked(const Tracker& tracker, const TrackedUnit& unit, const Reading& reading, std::size_t column,
        const History& history)
      : tracker_(tracker),
        saved_(unit.save()),
        reading_(reading),
        column_(column),
        history_(history) {}

  std::unique_ptr<TrackedUnit> after(double value, double* p_value = nullptr) const {
    check_stop();
    auto unit = tracker_.restore(saved_);
    Reading reading = reading_;
    reading.numbers[column_] = value;
    const UpdateResult taken = unit->update(reading, history_);
    if (!taken.problem.empty() || !taken.counted)
      throw InputError(
          fmt::format("this unit does not accept the next reading: {}",
                      taken.problem.empty() ? "it does not count" : printable(taken.problem)));
    if (p_value) *p_value = taken.p_value;
    return unit;
  }
  double p_value(double value) const {
    double reported = 0;
    after(value, &reported);
    return reported;
  }

 private:
  const Tracker& tracker_;
  std::string saved_;
  Reading reading_;
  std::size_t column_;
  const History& history_;
};

// The median of the predictive distribution, where the predictive p-value is 1, from a guess and a
// width.
double middle(const Asked& asked, double guess, double width) {
  double low = guess - width, high = guess + width;
  constexpr double golden = 0.61803398874989485;
  // Widens until the guess is bracketed; the p-value decreases to both sides.
  for (int i = 0; i < 60 && asked.p_value(low) > 0.01; ++i) low -= (high - low);
  for (int i = 0; i < 60 && asked.p_value(high) > 0.01; ++i) high += (high - low);
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double at_a = asked.p_value(a), at_b = asked.p_value(b);
  for (int i = 0; i < 50; ++i) {
    if (at_a >= at_b) {
      high = b;
      b = a;
      at_b = at_a;
      at_a = asked.p_value(a = high - golden * (high - low));
    } else {
      low = a;
      a = b;
      at_a = at_b;
      at_b = asked.p_value(b = low + golden * (high - low));
    }
  }
  return (low + high) / 2;
}

// The reading of this two-sided probability on one side of the median.
double reading_at(const Asked& asked, double from, double step, double two_sided) {
  double inside = from, outside = from + step;
  for (int i = 0; i < 60 && asked.p_value(outside) > two_sided; ++i) {
    inside = outside;
    outside = from + (step *= 2);
  }
  for (int i = 0; i < 30; ++i) {
    const double at = (inside + outside) / 2;
    (asked.p_value(at) > two_sided ? inside : outside) = at;
  }
  return (inside + outside) / 2;
}

}  // namespace

InspectionWorth inspection_worth(const WeightedLives& remaining, double passed,
                                 std::span<const Outcome> outcomes, double after,
                                 const Costs& costs, double rate) {
  InspectionWorth worth;
  const double alive = 1 - passed, failed = after > 0 ? remaining.cdf(after) : 0;
  worth.without = passed * costs.failure + alive * cheapest_moment(remaining, costs, rate).cost;
  worth.with = passed * costs.failure +
               alive * (costs.failure * failed - rate * remaining.mean_up_to(after));
  for (const Outcome& each : outcomes) {
    if (each.passed >= 1 || each.remaining.points().empty()) continue;
    const UnitReplacement then = cheapest_moment(each.remaining, costs, rate);
    worth.with += each.probability * (1 - each.passed) * then.cost;
    if (then.after == 0) worth.replaced += each.probability;
  }
  worth.worth = worth.without - worth.with;
  worth.net = worth.worth - alive * (1 - failed) * costs.inspection;
  const double ahead = remaining.beyond(after).quantile(0.5);
  if (std::isfinite(ahead))
    worth.error = failed_by(outcomes, ahead) - (passed + alive * remaining.cdf(after + ahead));
  return worth;
}

std::vector<Outcome> possible_outcomes(const Tracker& tracker, const TrackedUnit& unit,
                                       const Reading& reading, std::size_t column,
                                       const History& history, std::size_t strata) {
  const Asked asked(tracker, unit, reading, column, history);
  const Forecast now = unit.forecast();
  double guess = now.level50, spread = now.level95 - now.level05;
  // The search begins where the quantity is expected at the position of the reading.
  for (std::size_t i = 0; i < tracker.columns().size(); ++i) {
    const double position = reading.numbers[i];
    if (tracker.columns()[i].name != tracker.axis().name || !(position > now.now)) continue;
    const std::vector<ForecastBand> band = unit.ahead({&position, 1});
    if (band.empty() || !std::isfinite(band[0].level95 - band[0].level05)) continue;
    guess = band[0].level50;
    spread = std::max(spread, band[0].level95 - band[0].level05);
  }
  const double width = std::max(spread, 1e-9 * std::abs(guess));
  const double center = middle(asked, guess, width > 0 ? width : 1);
  std::vector<Outcome> outcomes;
  for (std::size_t i = 0; i < strata; ++i) {
    const double p = (static_cast<double>(i) + 0.5) / static_cast<double>(strata);
    const double two_sided = 2 * std::min(p, 1 - p);
    const double value =
        two_sided >= 1
            ? center
            : reading_at(asked, center, (p < 0.5 ? -1 : 1) * (width > 0 ? width : 1), two_sided);
    const Forecast then = asked.after(value)->forecast();
    outcomes.push_back({1 / static_cast<double>(strata), value, then.passed, then.remaining});
  }
  return outcomes;
}

}  // namespace wearwell::prognosis
