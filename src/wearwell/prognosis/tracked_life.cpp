#include "wearwell/prognosis/tracked_life.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::prognosis {
namespace {

bool is_named(const Tracker& tracker, const std::string& name) {
  return std::ranges::find(tracker.seen(), name) != tracker.seen().end() ||
         !tracker.refusal(name).empty();
}

double never_ending(const WeightedLives& lives) {
  double share = 0;
  for (std::size_t i = 0; i < lives.points().size(); ++i)
    if (std::isinf(lives.points()[i])) share += lives.weights()[i];
  return share;
}

}  // namespace

std::optional<std::string> tracked_name(const Tracker& tracker, const std::string& asked) {
  if (asked.empty()) return {};
  if (is_named(tracker, asked)) return asked;
  const std::string noun = tracker.noun() + " ";
  if (!asked.starts_with(noun)) return {};
  const std::string bare = asked.substr(noun.size());
  return is_named(tracker, bare) ? std::optional(bare) : std::nullopt;
}

UnitLife tracked_life(const Tracker& tracker, const std::string& name,
                      const LifeQuestion& question) {
  const auto unit = tracker.begin(name);
  return tracked_life(tracker, name, question, *unit);
}

UnitLife tracked_life(const Tracker& tracker, const std::string& name, const LifeQuestion& question,
                      TrackedUnit& unit) {
  if (const std::string why = tracker.refusal(name); !why.empty())
    throw InputError(fmt::format("--unit: {}", why));
  const Unit& reported = tracker.axis().unit;
  UnitLife life{.of = tracker.noun() + " " + name, .at = "until failure", .unit = reported.text};
  life.name = "remaining useful life";
  const double seen = from_si(reported, unit.forecast().now);
  if (question.survived) {
    const double survived = along_life("--survived", *question.survived, life.unit);
    if (survived < seen * (1 - 1e-12))
      throw InputError(
          fmt::format("--survived: {} has already reached {:.6g} {}: leave out --survived; the "
                      "remaining life counts from there",
                      printable(life.of), seen, life.unit));
    Reading reading{
        std::vector<double>(tracker.columns().size(), std::numeric_limits<double>::quiet_NaN()),
        {}};
    for (std::size_t c = 0; c < reading.numbers.size(); ++c)
      if (tracker.columns()[c].name == tracker.axis().name)
        reading.numbers[c] = to_si(reported, survived);
    life.passed = 0;
    // At its present place, but for the rounding of units, it says nothing new.
    if (to_si(reported, survived) > unit.forecast().now) {
      const UpdateResult taken = unit.update(reading, [](const auto&) {});
      if (!taken.problem.empty())
        throw InputError(fmt::format("--survived: {}: {}", printable(life.of), taken.problem));
      life.passed = 1 - taken.p_value;
    }
  }
  const Forecast forecast = unit.forecast();
  if (std::isnan(forecast.passed))
    throw InputError(fmt::format("the study has no life of {}", printable(life.of)));
  life.from = from_si(reported, forecast.now);
  life.numerical_error = relative_error(forecast.remaining, tracker.probability_error());
  for (const double percent :
       life_percentages(question.risk.value_or(life.risk), question.shares)) {
    life.share.push_back(percent / 100);
    life.life.push_back(from_si(reported, forecast.remaining.quantile(percent / 100)));
  }
  if (const double never = never_ending(forecast.remaining); never > 1e-9) life.never = never;
  answer(question, life,
         [&](double until) { return forecast.remaining.cdf(to_si(reported, until)); });
  return life;
}

}  // namespace wearwell::prognosis
