#include "wearwell/models/recurrence/recurrence_predictions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/recurrence/projection_report.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell::recurrence {
namespace {

QuantityRequest quantity(const char* name, const std::string& of, const std::string& at,
                         const Unit& unit) {
  QuantityRequest request{};
  request.name = name;
  request.of = of;
  request.at = at;
  request.unit = unit;
  request.safe_end = 0.05;
  return request;
}

// Quantiles of what is `known`, with the bounds that the study asks for.
template <class Known>
std::vector<QuantityQuantiles> quantiles_of(const Known& known,
                                            const std::optional<LifeLevels>& levels) {
  QuantityQuantiles q{known.quantile(0.05), known.quantile(0.5), known.quantile(0.95), 0, 0, 0};
  if (levels) add_bounds(known, *levels, q);
  return {q};
}

void add_quantity(const Asked& asked, PosteriorStudy& study, QuantityRequest request,
                  const Function& value) {
  if (asked.levels) ask_bounds(*asked.levels, request);
  study.quantity_groups.push_back(
      {{request}, [value, levels = asked.levels](const WeightedDraws& draws) {
         return quantiles_of(QuantityDistribution(draws, value), levels);
       }});
}

struct NextFailure {
  const Process& process;
  const WeightedDraws& draws;
  UnitState unit;
  double quantile(double p) const { return time_to_failure(process, draws, unit, p); }
};

void add_next_failure(const Asked& asked, PosteriorStudy& study, QuantityRequest request,
                      const UnitState& unit) {
  request.name = "time to the next failure";
  request.headline = false;
  if (asked.levels) ask_bounds(*asked.levels, request);
  study.quantity_groups.push_back(
      {{request},
       [process = asked.process, levels = asked.levels, unit](const WeightedDraws& draws) {
         return quantiles_of(NextFailure{process, draws, unit}, levels);
       }});
}

// A single unit has its name, a unit like several others has none.
std::string of_unit(const RecurrenceData& data) {
  return data.units.size() == 1 ? "unit " + data.units[0].name : "one unit";
}

// predict.level, sides and classical. The bounds of lives have a level of 50 % or less; intervals do not.
void read_levels(const TomlReader& predict, Asked& asked) {
  if (predict.has("b_lives"))
    predict.fail("b_lives",
                 "is of units that fail once; a repaired unit has predict.age (mean time between "
                 "failures, time to the next failure) and predict.next (failures to come)");
  const LifeLevels levels = read_life_levels(predict);
  const char* key = predict.has("credible_level") ? "credible_level" : "level";
  if (!levels.percents.empty()) asked.levels = levels;
  if (asked.outside() >= 0.5)
    predict.fail(key, "must exceed 50 % for the one-sided bounds of repairable units");
  if (predict.boolean("classical").value_or(false))
    asked.classical =
        ClassicalLevel{levels.credible_level, !asked.levels || levels.sides == BoundSides::both};
}

// The ages at which one unit is asked about: as stated, else that of the oldest unit.
std::vector<double> read_ages(const std::optional<TomlReader>& predict, const Asked& asked,
                              PosteriorStudy& study) {
  std::vector<double> ages;
  if (predict && predict->has("age")) {
    if (!asked.process.minimal_repair())
      predict->fail("age",
                    "does not matter for process = \"renewal\": a repaired unit is as good as new");
    for (const Quantity& age : predict->quantities("age", asked.data.si)) {
      if (!(age.si() > 0)) predict->fail("age", "must be positive");
      ages.push_back(age.si());
      study.reaches.push_back(
          {"the age of " + given_quantity(age),
           "the oldest unit was observed until " + age_text(asked.data, asked.data.longest()),
           age.si(), asked.data.longest()});
    }
  }
  if (ages.empty()) ages.push_back(asked.data.longest());
  return ages;
}

}  // namespace

void read_predictions(const TomlReader& root, Asked& asked, PosteriorStudy& study) {
  const auto predict = root.table("predict");
  if (predict) read_levels(*predict, asked);
  const RecurrenceData& data = asked.data;
  const Process& process = asked.process;
  const std::string unit = of_unit(data);
  ForecastRow all{data.units.size() == 1 ? unit : fmt::format("all {} units", data.units.size()),
                  "from the end of observation on",
                  {}};
  for (const UnitHistory& each : data.units) all.units.push_back(state_at_end(each));
  asked.rows.push_back(all);
  if (process.minimal_repair()) {
    asked.ages = read_ages(predict, asked, study);
    for (const double age : asked.ages) {
      QuantityRequest mtbf =
          quantity("mean time between failures", unit, "at age " + age_text(data, age), data.unit);
      mtbf.headline = true;
      add_quantity(asked, study, mtbf,
                   [process, age](const double* x) { return 1 / process.intensity(x, age); });
      add_next_failure(asked, study, mtbf, {age, age});
      if (data.units.size() > 1 || age != data.units[0].end)
        asked.rows.push_back({unit, "from age " + age_text(data, age) + " on", {{age, age}}});
    }
    if (process.kind == ProcessKind::power_law)
      add_quantity(
          asked, study,
          quantity("age at which one failure is expected (eta)", "new unit", "", data.unit),
          [process](const double* x) { return process.reference * std::pow(x[1], -1 / x[0]); });
  } else {
    static_cast<void>(read_ages(predict, asked, study));
    QuantityRequest mtbf = quantity("mean time between failures", unit, "", data.unit);
    mtbf.headline = true;
    add_quantity(asked, study, mtbf,
                 [](const double* x) { return x[1] * std::tgamma(1 + 1 / x[0]); });
    mtbf.at = "after a repair";
    add_next_failure(asked, study, mtbf, {data.longest(), 0});
    asked.rows.push_back({unit, "from a repair on", {{0, 0}}});
  }
  if (asked.growth_test) ask_projection(asked, *asked.growth_test, unit, study);
  if (!predict) return;
  asked.ahead = predict->quantities("next", data.si);
  for (const Quantity& ahead : asked.ahead) {
    if (!(ahead.si() > 0)) predict->fail("next", "must be positive");
    study.reaches.push_back({"the forecast over the next " + given_quantity(ahead),
                             "the oldest unit was observed until " + age_text(data, data.longest()),
                             data.longest() + ahead.si(), data.longest()});
  }
}

}  // namespace wearwell::recurrence
