#include "wearwell/models/formula_model/use_rate_answers.h"

#include <fmt/format.h>

#include "wearwell/models/formula_model/formula_asked.h"
#include "wearwell/models/formula_model/life_groups.h"
#include "wearwell/models/formula_model/part_lives.h"

namespace wearwell::formula_model {
namespace {

Quantity positive(const TomlReader& table, const std::string& key, const std::string& si) {
  const Quantity found = table.required_quantity(key, si);
  if (!(found.si() > 0)) table.fail(key, "must be positive");
  return found;
}

void add_warranty(const AskedOfMixture& asked, const std::shared_ptr<const LifeDistribution>& life,
                  PosteriorStudy& study) {
  const auto warranty = asked.predict.table("warranty");
  if (!warranty) return;
  const Measured &of_use = asked.model->measured.front(), &in_time = asked.model->use_rate->in_time;
  const Quantity age = positive(*warranty, "age", formula::si_text(in_time.powers)),
                 use = positive(*warranty, "use", formula::si_text(of_use.powers));
  QuantityGroup group;
  group.requests.push_back(
      request(fmt::format("failing within {} and {}", description(age), description(use)),
              asked.noun, asked.words, Unit{"%", 0.01, 0}));
  group.requests.back().safe_end = 0.95;
  ask_bounds(asked.part.levels, group.requests.back());
  group.from_draws = [life, age = age.si(), use = use.si(),
                      levels = asked.part.levels](const WeightedDraws& draws) {
    const LifeDistribution::Known known = life->failing_within(draws, age, use);
    const QuantityDistribution& of = known.distribution;
    QuantityQuantiles found{of.quantile(0.05), of.quantile(0.5), of.quantile(0.95), 0, 0, 0};
    add_bounds(of, levels, found);
    found.predictive = of.mean();
    found.numerical_error = known.misfit;
    return std::vector<QuantityQuantiles>{found};
  };
  study.quantity_groups.push_back(std::move(group));
}

}  // namespace

void add_use_rate_answers(const AskedOfMixture& asked, PosteriorStudy& study) {
  const std::string key = asked.predict.has("given") ? "given" : "";
  const Measured& in_time = asked.model->use_rate->in_time;
  const auto life = life_in_calendar_time(asked.predict, key, asked.model, asked.conditions);
  AskedOfLife own = asked.part;
  own.life = life;
  own.survival.clear();
  own.observed = {};  // lives in use
  own.survived.reset();
  if (const auto calendar = asked.predict.table("calendar")) {
    const std::string si = formula::si_text(in_time.powers);
    own.survival = calendar->quantities("survival_to", si);
    own.survived = calendar->quantity("survived", si);
  }
  add_lives_of(own, asked.noun + " in calendar time", asked.words, in_time.unit, study);
  add_warranty(asked, life, study);
}

}  // namespace wearwell::formula_model
