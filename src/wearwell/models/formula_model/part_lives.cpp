#include "wearwell/models/formula_model/part_lives.h"

#include <fmt/format.h>

#include "wearwell/models/formula_model/formula_asked.h"

namespace wearwell::formula_model {

void add_lives_of(const AskedOfLife& asked, const std::string& noun, const std::string& at,
                  const Unit& unit, PosteriorStudy& study) {
  AskedOfLife own = asked;
  own.fast = own.other = nullptr;
  own.hazard.clear();
  own.observed = asked.observed.of_other_life();
  QuantityGroup group;
  const auto add = [&](const std::string& name, const std::string& where, const Unit& in) {
    group.requests.push_back(request(name, noun, where, in));
    group.requests.back().safe_end = 0.05;
    ask_bounds(own.levels, group.requests.back());
  };
  const auto add_life = [&](const std::string& name, const std::string& where) {
    group.requests.push_back(request(name, "new " + noun, where, unit));
    group.requests.back().safe_end = 0.05;
    group.requests.back().is_life = true;
    for (const double percent : own.levels.percents) add(b_life_name(percent, name), where, unit);
    if (own.mean) add("mean " + name, where, unit);
  };
  add_life("life", at);
  if (own.survived)
    add_life("remaining useful life",
             joined(at, fmt::format("from {} on", description(*own.survived))));
  for (const Quantity& each : own.survival)
    add("survival to " + description(each), at, Unit{"%", 0.01, 0});
  group.from_draws = [own](const WeightedDraws& draws) { return life_answers(own, draws); };
  group.lives = [own](const WeightedDraws& draws) { return predictive_lives(own, draws); };
  study.quantity_groups.push_back(std::move(group));
}

}  // namespace wearwell::formula_model
