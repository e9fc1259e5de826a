#include "wearwell/models/formula_model/classical_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "wearwell/models/formula_model/classical_report.h"
#include "wearwell/models/formula_model/life_groups.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t most_classical_groups = 60;

bool is_earliest_of_modes(const FormulaModel& model) {
  return model.modes && model.measured.size() > 1;
}

// Of the part, and of each failure mode or subpopulation alone.
std::vector<ClassicalLife> classical_lives(const AskedOfModes& asked) {
  const FormulaModel& model = *asked.model;
  const std::string key = asked.predict.has("given") ? "given" : "";
  std::vector<ClassicalLife> lives = {
      {asked.noun, asked.words, asked.part.life, &model.measured.front()}};
  if (model.subpopulations) {
    for (std::size_t k = 0; k < model.subpopulations->names.size(); ++k)
      lives.push_back({fmt::format("{} of {}", asked.noun, model.subpopulations->names[k]),
                       asked.words,
                       life_of_subpopulation(asked.predict, key, asked.model, asked.conditions, k),
                       &model.measured.front()});
  }
  if (!is_earliest_of_modes(model)) return lives;
  for (std::size_t k = 0; k < model.modes->modes.size(); ++k) {
    lives.push_back({fmt::format("{} with {} alone", asked.noun, model.modes->modes[k]),
                     asked.words,
                     life_distribution(asked.predict, key, asked.model, asked.conditions,
                                       std::uint32_t{1} << k),
                     &model.measured[k]});
  }
  return lives;
}

// Whether the lives of a mode alone are not those of its failures with all others as run-outs.
bool has_masked_modes(const FormulaModel& model) {
  for (std::size_t i = 0; i < model.lives.responses.size(); ++i) {
    const Censoring seen = model.lives.responses[i].seen;
    if (std::popcount(model.modes->possible[model.lives.rows[i]]) > 1 || seen == Censoring::left ||
        seen == Censoring::interval)
      return true;
  }
  return false;
}

std::vector<LifeGroup> classical_groups(const AskedOfModes& asked,
                                        std::vector<std::string>& notes) {
  const FormulaModel& model = *asked.model;
  if (model.has_exposure()) {
    notes.push_back(
        fmt::format("Of a {} test there is no rank regression and no nonparametric estimate: both "
                    "need lives under constant conditions.",
                    model.steps ? "step-stress" : "ramp"));
    return {};
  }
  std::vector<LifeGroup> groups = life_groups(model, most_classical_groups);
  if (groups.empty())
    notes.push_back(
        fmt::format("More than {} conditions: there is no rank regression and no nonparametric "
                    "estimate of each.",
                    most_classical_groups));
  if (is_earliest_of_modes(model) && has_masked_modes(model)) {
    std::erase_if(groups, [](const LifeGroup& each) { return each.modes != ~std::uint32_t{0}; });
    notes.push_back(
        "Failures of an unknown mode, or within an interval, leave rank regression and the "
        "nonparametric estimate of single modes undefined.");
  }
  for (LifeGroup& each : groups)
    each.life =
        life_distribution(asked.predict, "classical", asked.model, each.conditions, each.modes);
  return groups;
}

}  // namespace

void add_classical_estimates(const AskedOfModes& asked, PosteriorStudy& study) {
  const FormulaModel& model = *asked.model;
  if (model.has_random_effects() || !model.drawn.empty())
    asked.predict.fail("classical",
                       "is for a likelihood without random effects: maximum likelihood, rank "
                       "regression and Kaplan-Meier take all items as independent");
  if (model.use_rate)
    asked.predict.fail("classical",
                       "is not possible with [use_rate]: plotting positions need the use of units "
                       "that did not fail");
  if (model.measured.size() > 1 && !model.modes)
    asked.predict.fail("classical", "is for one measured life; this study has several");
  const ClassicalLevel level{asked.part.levels.credible_level,
                             asked.part.levels.sides == BoundSides::both};
  if (!(level.within() > 0))
    asked.predict.fail(asked.predict.has("level") ? "level" : "credible_level",
                       "must exceed 50 % for the one-sided bounds of predict.classical");
  AskedOfClassics classics{asked.model,
                           study.likelihood(model.data.table.rows),
                           classical_lives(asked),
                           asked.part.levels.percents,
                           level,
                           asked.part.mean,
                           asked.part.survival,
                           {},
                           {}};
  classics.groups = classical_groups(asked, classics.notes);
  study.addition = [classics = std::make_shared<const AskedOfClassics>(std::move(classics)),
                    density = study.density](const Fit& fit) {
    return classical_addition(*classics, density, fit);
  };
}

}  // namespace wearwell::formula_model
