#include "wearwell/models/formula_model/written_parameters.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <set>

#include "wearwell/base/trimmed.h"
#include "wearwell/input/prior.h"

namespace wearwell::formula_model {
namespace {

struct Bounds {
  double lower = -INFINITY, upper = INFINITY;

  void take(double least, double most) {
    lower = std::max(lower, least);
    upper = std::min(upper, most);
  }
};

// Keys of a prior whose values have the dimension of its parameter, for every distribution.
const std::vector<std::string>& dimensional_keys() {
  static const auto all = [] {
    std::map<std::string, bool> family_parameters;
    for (const ResponseForm& form : prior_forms()) {
      for (const ParameterForm& family_parameter : form.family_parameters) {
        const bool dimensional = family_parameter.kind == ParameterKind::location ||
                                 family_parameter.kind == ParameterKind::scale;
        bool& always =
            family_parameters.try_emplace(std::string(family_parameter.name), true).first->second;
        always = always && dimensional;
      }
    }
    std::vector<std::string> keys = {"unit"};
    for (const auto& [name, always] : family_parameters)
      if (always) keys.push_back(name);
    keys.insert(keys.end(), {"lower", "upper"});
    return keys;
  }();
  return all;
}

// The sign of a parameter, from the places where it stands alone.
std::map<std::string, Bounds> natural_bounds(const WrittenStudy& study) {
  std::map<std::string, Bounds> bounds;
  const auto base = [](const std::string& text) {
    const std::string_view name = trimmed(text);
    return std::string(trimmed(name.substr(0, name.find('['))));
  };
  for (const WrittenLikelihood& written : study.likelihoods) {
    for (const WrittenLikelihood& each : parts_of(written)) {
      for (const auto& [family_parameter, text] : each.family_parameters) {
        const ParameterKind kind = each.form->family_parameters[family_parameter].kind;
        if (kind == ParameterKind::probability) bounds[base(text)].take(0, 1);
        if (kind == ParameterKind::scale || kind == ParameterKind::number)
          bounds[base(text)].take(0, INFINITY);
      }
      if (each.sigma) bounds[base(*each.sigma)].take(0, INFINITY);
    }
    for (const WrittenShare& each : written.shares) bounds[base(each.text)].take(0, 1);
  }
  for (const WrittenEffects& random_effects : study.effects) {
    for (const WrittenEffect& each : random_effects.effects) {
      if (each.lognormal) bounds[each.name].take(0, INFINITY);
      bounds[std::string(trimmed(each.scatter))].take(0, INFINITY);
    }
    if (random_effects.correlation)
      bounds[std::string(trimmed(*random_effects.correlation))].take(-1, 1);
  }
  return bounds;
}

formula::Powers powers_of_prior(const TomlReader& priors, const std::string& key) {
  const TomlReader table = priors.required_table(key);
  for (const std::string& each : dimensional_keys()) {
    if (!table.has(each) || !table.is_text(each)) continue;
    try {
      return each == "unit" ? formula::read_any_unit(table.required_text(each)).powers
                            : formula::read_any_quantity(table.required_text(each)).powers;
    } catch (const InputError& error) {
      table.fail(each, error.what());
    }
  }
  return {};
}

Parameter read_one(const TomlReader& priors, const std::string& key, const std::string& name,
                   const formula::Powers& powers, const Bounds& bounds) {
  std::string si;
  try {
    si = formula::si_text(powers);
  } catch (const InputError& error) {
    priors.fail(key, error.what());
  }
  Parameter parameter = read_prior(priors, {key, si, bounds.lower, bounds.upper, 1});
  parameter.name = name;
  if (parameter.prior.proper) {
    parameter.start = quantile(parameter.prior, 0.5);
  } else if (parameter.prior.lower < parameter.unit.scale &&
             parameter.unit.scale < parameter.prior.upper) {
    parameter.start = parameter.scale = parameter.unit.scale;
  }
  return parameter;
}

// k[material]: one prior for all under `k` (or "k[material]"), or one each under "k[PTFE]".
void read_levels(const TomlReader& priors, const std::string& base, const std::string& label,
                 const Bounds& bounds, const std::vector<WrittenEffects>& drawn,
                 FormulaModel& model) {
  const LabelColumn* column = model.data.label(label);
  const std::vector<std::string>* const unstated =  // levels that no row states
      model.modes && model.modes->name == label                ? &model.modes->modes
      : model.subpopulations && label == Subpopulations::label ? &model.subpopulations->names
                                                               : nullptr;
  if (!column && !unstated) {
    const auto& labels = model.data.labels;
    const bool is_level = std::any_of(labels.begin(), labels.end(), [&](const LabelColumn& each) {
      return std::find(each.levels.begin(), each.levels.end(), label) != each.levels.end();
    });
    priors.fail(
        base, is_level
                  ? fmt::format("an expression has {0}[{1}]; write {0}['{1}'] for the value at the "
                                "level '{1}'",
                                base, label)
                  : fmt::format("is indexed by [{}], but '{}' is not a label under data.columns",
                                label, label));
  }
  if (std::any_of(drawn.begin(), drawn.end(),
                  [&](const WrittenEffects& each) { return each.label == label; })) {
    priors.fail(base, fmt::format("has an independent value for each {}, and a random effect in "
                                  "[random_effects.{}]; remove one of the two",
                                  label, label));
  }
  std::optional<formula::Powers> powers;
  const std::string common = priors.has(base) ? base : fmt::format("{}[{}]", base, label);
  for (const std::string& level : unstated ? *unstated : column->levels) {
    const std::string name = fmt::format("{}[{}]", base, level);
    const std::string key = priors.has(name) ? name : common;
    if (!priors.has(key)) {
      priors.fail("", fmt::format("no prior for {}; give one for all levels as {}, or one each",
                                  name, base));
    }
    const formula::Powers own = powers_of_prior(priors, key);
    if (powers && *powers != own) {
      priors.fail(key, fmt::format("is in {}, but in {} at another level",
                                   formula::description(own), formula::description(*powers)));
    }
    powers = own;
    model.parameters.push_back(read_one(priors, key, name, own, bounds));
  }
  model.symbols.parameters.push_back({base, *powers, formula::Scope::per_level, label});
}

}  // namespace

void read_parameters(const TomlReader& root, const WrittenStudy& study,
                     const std::vector<WrittenEffects>& drawn, FormulaModel& model) {
  const TomlReader priors = root.required_table("prior");
  const std::map<std::string, Bounds> natural = natural_bounds(study);
  const auto bounds_of = [&](const std::string& name) {
    const auto at = natural.find(name);
    return at == natural.end() ? Bounds() : at->second;
  };
  const std::map<std::string, std::string> indexed = indexed_parameters(study);
  std::set<std::string> done;
  for (const std::string& key : priors.keys()) {
    const std::string base(trimmed(std::string_view(key).substr(0, key.find('['))));
    const auto at = indexed.find(base);
    if (at == indexed.end()) {
      if (base != key) {
        priors.fail(key, fmt::format("no expression uses {}[...]; write a parameter with one value "
                                     "per level as {}[material], where 'material' is a label",
                                     base, base));
      }
      const formula::Powers powers = powers_of_prior(priors, key);
      model.parameters.push_back(read_one(priors, key, key, powers, bounds_of(key)));
      model.symbols.parameters.push_back({key, powers});
      continue;
    }
    if (!done.insert(base).second) continue;
    read_levels(priors, base, at->second, bounds_of(base), drawn, model);
  }
}

}  // namespace wearwell::formula_model
