#include "wearwell/models/formula_model/unit_effects.h"

#include <fmt/format.h>
#include <algorithm>
#include <numeric>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/fail_at_place.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t latent_effects = 2, most_unit_effects = 4;

}  // namespace

ChosenEffects choose_effects(const TomlReader& root, const WrittenStudy& study,
                             std::size_t integrated, const FormulaData& data) {
  if (study.effects.empty()) return {};
  const std::size_t unit = label_of_units(root, data, study.effects);
  ChosenEffects chosen{study.effects[unit], {}};
  WrittenEffects& units = *chosen.units;
  if (units.effects.size() > most_unit_effects) {
    root.required_table("random_effects")
        .required_table(units.label)
        .fail(units.effects[most_unit_effects].name,
              fmt::format(
                  "is one too many: at most {} parameters may have random effects over {} to {}",
                  most_unit_effects, units.label, units.label));
  }
  for (std::size_t v = 0; v < study.effects.size(); ++v) {
    if (v != unit) chosen.drawn.push_back(study.effects[v]);
  }
  const bool hidden = study.has_hidden_paths();
  if (units.effects.size() <= latent_effects && !hidden) return chosen;
  const std::size_t kept = hidden                                      ? 0
                           : units.effects.size() == most_unit_effects ? latent_effects
                                                                       : integrated;
  WrittenEffects rest{units.label, {}, {}};
  if (hidden) std::swap(rest.correlation, units.correlation);
  rest.effects.assign(units.effects.begin() + static_cast<std::ptrdiff_t>(kept),
                      units.effects.end());
  units.effects.resize(kept);
  chosen.drawn.push_back(std::move(rest));
  return chosen;
}

void add_unit_effects(const TomlReader& root, const ChosenEffects& chosen, FormulaModel& model) {
  model.row_symbols = model.symbols;
  if (!chosen.units) {
    model.shared.resize(model.parameters.size());
    std::iota(model.shared.begin(), model.shared.end(), 0);
    return;
  }
  const TomlReader random_effects = root.required_table("random_effects");
  const TomlReader table = random_effects.required_table(*model.label);
  if (!model.data.label(*model.label)) {
    random_effects.fail(
        *model.label,
        "is not a column under data.columns; random effects vary over the levels of a label");
  }
  const std::vector<std::size_t> begin = formula::slots(model.symbols);
  std::set<std::size_t> own;
  for (std::size_t s = 0; s < model.symbols.parameters.size(); ++s) {
    const formula::ParameterSymbol& symbol = model.symbols.parameters[s];
    const auto effect = std::find_if(chosen.units->effects.begin(), chosen.units->effects.end(),
                                     [&](const auto& each) { return each.name == symbol.name; });
    if (effect == chosen.units->effects.end()) continue;
    if (symbol.scope != formula::Scope::one) {
      table.fail(symbol.name,
                 "has one value for each level of a label; it cannot have a random effect as well");
    }
    model.effects.push_back({symbol.name, s, begin[s], effect->lognormal});
    model.row_symbols.parameters[s].scope = formula::Scope::per_row;
    own.insert(begin[s]);
  }
  for (const WrittenEffect& effect : chosen.units->effects) {
    const bool known = std::any_of(model.effects.begin(), model.effects.end(),
                                   [&](const Effect& each) { return each.name == effect.name; });
    if (!known) table.fail(effect.name, "is not a parameter: it has no prior");
  }
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    if (!own.count(i)) model.shared.push_back(i);
  }
  model.units = model.data.label(*model.label)->levels;
  if (model.units.size() < 2) {
    random_effects.fail(*model.label,
                        fmt::format("all rows of {} are of one {}; its variation needs at least 2",
                                    model.data.table.source, *model.label));
  }
  put_drawn_effects_in_rows(model);
}

void compile_population(const TomlReader& root, const ChosenEffects& chosen, FormulaModel& model) {
  if (!chosen.units) return;
  const TomlReader table = root.required_table("random_effects").required_table(*model.label);
  std::vector<formula::Wanted> wanted;
  for (const Effect& effect : model.effects) {
    const auto written =
        std::find_if(chosen.units->effects.begin(), chosen.units->effects.end(),
                     [&](const WrittenEffect& each) { return each.name == effect.name; });
    const formula::Powers powers =
        effect.lognormal ? formula::Powers() : model.symbols.parameters[effect.symbol].powers;
    wanted.push_back({fmt::format("[random_effects.{}] {} {}", *model.label, effect.name,
                                  effect.lognormal ? "log_sd" : "sd"),
                      written->scatter, powers,
                      effect.lognormal ? "the sd of a logarithm" : effect.name, true});
  }
  if (chosen.units->correlation) {
    wanted.push_back({fmt::format("[random_effects.{}] correlation", *model.label),
                      *chosen.units->correlation, formula::Powers(), "a correlation", true});
    model.correlated = true;
  }
  try {
    model.population = formula::compile({}, wanted, model.symbols);
  } catch (const InputError& error) {
    fail_at_place(root, table, error.what());
  }
}

}  // namespace wearwell::formula_model
