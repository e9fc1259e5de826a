#include "wearwell/models/formula_model/formula_drawn.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/bayes/log_density.h"
#include "wearwell/formula/no_columns.h"
#include "wearwell/models/formula_model/fail_at_place.h"
#include "wearwell/prognosis/plural.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::formula_model {
namespace {

constexpr double drawn_reach = 4.5;  // of effects of a new unit

// Whether all rows of a level of `inner` are of one level of `outer`.
bool lies_within(const LabelColumn& inner, const LabelColumn& outer) {
  std::vector<int> of(inner.levels.size(), -1);
  for (std::size_t row = 0; row < inner.at.size(); ++row) {
    int& known = of[static_cast<std::size_t>(inner.at[row])];
    if (known >= 0 && known != outer.at[row]) return false;
    known = outer.at[row];
  }
  return true;
}

const LabelColumn& label_of(const TomlReader& root, const FormulaData& data,
                            const std::string& name) {
  const LabelColumn* column = data.label(name);
  if (!column) {
    root.required_table("random_effects")
        .fail(name,
              "is not a column under data.columns; random effects vary over the levels of a label");
  }
  return *column;
}

Parameter standard_normal(std::string name) {
  Parameter parameter;
  parameter.name = std::move(name);
  parameter.si = "1";
  parameter.unit = Unit{"1", 1, 0};
  parameter.distribution = "standard normal";
  parameter.prior = make_distribution(Normal{0, 1}, -INFINITY, INFINITY);
  parameter.start = 0;
  parameter.scale = 1;
  parameter.of_model = true;
  return parameter;
}

// Scatters of drawn effects and their correlations; one thread's.
class ScattersAt {
 public:
  explicit ScattersAt(const FormulaModel& model)
      : model_(model),
        data_(formula::bind_no_columns(model.drawn_scatter, model.symbols)),
        workspace_(model.drawn_scatter.workspace(1)) {}

  // Level `i` of effect `e`.
  double value(std::size_t e, std::size_t i, const double* x) {
    const DrawnEffect& effect = model_.drawn[e];
    model_.drawn_scatter.forward(data_, 0, 1, {{x, model_.parameters.size()}, {}}, workspace_);
    double z = x[effect.first + i];
    if (effect.correlation) {
      const double r = workspace_.values(model_.drawn_correlation(e))[0];
      z = r * x[model_.drawn[e - 1].first + i] + std::sqrt(1 - r * r) * z;
    }
    const double moved = workspace_.values(e)[0] * z, middle = x[effect.middle];
    return effect.lognormal ? middle * std::exp(moved) : middle + moved;
  }

 private:
  const FormulaModel& model_;
  formula::Data data_;
  formula::Workspace workspace_;
};

void add_level_of_new(const TomlReader& root, const std::string& label, formula::Symbols& symbols) {
  for (formula::LabelSymbol& each : symbols.labels) {
    if (each.name != label) continue;
    const std::string fresh = "new " + label;
    if (std::find(each.levels.begin(), each.levels.end(), fresh) != each.levels.end()) {
      root.required_table("random_effects")
          .fail(label, fmt::format("a level in the data is called '{}', which is "
                                   "the name of a new level here; rename it",
                                   fresh));
    }
    each.levels.push_back(fresh);
  }
}

void require_few(const TomlReader& root, const FormulaModel& model, const std::string& label) {
  if (model.parameters.size() <= static_cast<std::size_t>(max_dimension)) return;
  root.required_table("random_effects")
      .fail(label,
            fmt::format(
                "the random effects of each {} and of a new one bring the number of parameters "
                "to {}; a posterior may have at most {}: use fewer random effects, or fewer {}",
                label, model.parameters.size(), max_dimension, prognosis::plural(label)));
}

}  // namespace

std::size_t label_of_units(const TomlReader& root, const FormulaData& data,
                           const std::vector<WrittenEffects>& random_effects) {
  const TomlReader table = root.required_table("data");
  std::vector<std::string> names;
  for (const WrittenEffects& each : random_effects) names.push_back(each.label);
  if (const auto said = table.text("rows_of")) {
    const auto at = std::find(names.begin(), names.end(), *said);
    if (at == names.end()) {
      table.fail(
          "rows_of",
          fmt::format("'{}' is not a label with random effects ({}); units must be one of them",
                      *said, fmt::join(names, ", ")));
    }
    return static_cast<std::size_t>(at - names.begin());
  }
  if (random_effects.size() < 2) return 0;
  std::vector<std::size_t> inmost;
  for (std::size_t i = 0; i < random_effects.size(); ++i) {
    const LabelColumn& own = label_of(root, data, names[i]);
    const bool within = std::all_of(names.begin(), names.end(), [&](const std::string& other) {
      return lies_within(own, label_of(root, data, other));
    });
    if (within) inmost.push_back(i);
  }
  if (inmost.size() == 1) return inmost.front();
  root.required_table("random_effects")
      .fail(
          names[1],
          fmt::format("which label identifies the units, {}? {}. Add rows_of = \"{}\" under [data]",
                      fmt::join(names, " or "),
                      inmost.empty() ? "No label is nested in the others"
                                     : "The labels are nested in each other",
                      names[0]));
}

void add_drawn_effects(const TomlReader& root, const std::vector<WrittenEffects>& written,
                       FormulaModel& model) {
  std::vector<formula::Wanted> scatters, correlations;
  for (const WrittenEffects& random_effects : written) {
    const TomlReader table =
        root.required_table("random_effects").required_table(random_effects.label);
    const LabelColumn& label = label_of(root, model.data, random_effects.label);
    if (label.levels.size() < 2) {
      root.required_table("random_effects")
          .fail(random_effects.label,
                fmt::format("all rows of {} are of one {}; its variation needs at least 2",
                            model.data.table.source, random_effects.label));
    }
    add_level_of_new(root, random_effects.label, model.symbols);
    const std::vector<std::size_t> begin = formula::slots(model.symbols);
    for (const WrittenEffect& each : random_effects.effects) {
      DrawnEffect effect;
      effect.name = each.name;
      effect.label = random_effects.label;
      effect.scatter = each.scatter;
      effect.lognormal = each.lognormal;
      effect.z = each.name + "_" + random_effects.label + "_z";
      effect.seen = label.levels.size();
      const auto middle =
          std::find_if(model.symbols.parameters.begin(), model.symbols.parameters.end(),
                       [&](const auto& s) { return s.name == each.name; });
      if (middle == model.symbols.parameters.end()) {
        table.fail(each.name, "is not a parameter: it has no prior");
      }
      if (middle->scope != formula::Scope::one) {
        table.fail(
            each.name,
            "has one value for each level of a label; it cannot have a random effect as well");
      }
      effect.middle = begin[static_cast<std::size_t>(middle - model.symbols.parameters.begin())];
      scatters.push_back({fmt::format("[random_effects.{}] {} {}", random_effects.label, each.name,
                                      each.lognormal ? "log_sd" : "sd"),
                          each.scatter, each.lognormal ? formula::Powers() : middle->powers,
                          each.lognormal ? "the sd of a logarithm" : each.name, true});
      if (random_effects.correlation && &each != &random_effects.effects.front()) {
        effect.correlation = random_effects.correlation;
        correlations.push_back(
            {fmt::format("[random_effects.{}] correlation", random_effects.label),
             *random_effects.correlation, formula::Powers(), "a correlation", true});
      }
      model.drawn.push_back(std::move(effect));
    }
    for (std::size_t e = model.drawn.size() - random_effects.effects.size(); e < model.drawn.size();
         ++e) {
      DrawnEffect& effect = model.drawn[e];
      effect.first = model.parameters.size();
      for (const std::string& level : label.levels) {
        model.parameters.push_back(standard_normal(fmt::format("{}[{}]", effect.z, level)));
      }
      model.parameters.push_back(
          standard_normal(fmt::format("{}[new {}]", effect.z, effect.label)));
    }
    require_few(root, model, random_effects.label);
  }
  if (model.drawn.empty()) return;
  for (const DrawnEffect& each : model.drawn) {
    model.symbols.parameters.push_back({each.z, {}, formula::Scope::per_level, each.label});
  }
  scatters.insert(scatters.end(), correlations.begin(), correlations.end());
  try {
    model.drawn_scatter = formula::compile({}, scatters, model.symbols);
  } catch (const InputError& error) {
    fail_at_place(root, root.required_table("random_effects"), error.what());
  }
}

void put_drawn_effects_in_rows(FormulaModel& model) {
  std::vector<std::string> done;
  for (const DrawnEffect& one : model.drawn) {
    if (std::find(done.begin(), done.end(), one.name) != done.end()) continue;
    done.push_back(one.name);
    std::string text = one.name + "_middle", exponent;
    for (std::size_t e = 0; e < model.drawn.size(); ++e) {
      const DrawnEffect& each = model.drawn[e];
      if (each.name != one.name) continue;
      std::string z = fmt::format("{}[{}]", each.z, each.label);
      if (each.correlation) {
        z = fmt::format("(({0}) * {1}[{2}] + sqrt(1 - ({0})^2) * {3})", *each.correlation,
                        model.drawn[e - 1].z, each.label, z);
      }
      const std::string moved = fmt::format("({}) * {}", each.scatter, z);
      if (each.lognormal) {
        exponent += (exponent.empty() ? "" : " + ") + moved;
      } else {
        text += " + " + moved;
      }
    }
    if (!exponent.empty()) text = fmt::format("({}) * exp({})", text, exponent);
    model.lines.push_back({one.name, text});
    for (formula::ParameterSymbol& each : model.row_symbols.parameters) {
      if (each.name == one.name) each.name += "_middle";
    }
  }
}

Function drawn_value(std::shared_ptr<const FormulaModel> model, std::size_t effect,
                     std::size_t level) {
  auto own = std::make_shared<tbb::enumerable_thread_specific<std::unique_ptr<ScattersAt>>>();
  return [=](const double* x) {
    std::unique_ptr<ScattersAt>& mine = own->local();
    if (!mine) mine = std::make_unique<ScattersAt>(*model);
    return mine->value(effect, level, x);
  };
}

void tell_drawn_effects(std::shared_ptr<const FormulaModel> model, PosteriorStudy& study) {
  for (std::size_t e = 0; e < model->drawn.size(); ++e) {
    const DrawnEffect& effect = model->drawn[e];
    const std::vector<std::string>& levels = model->data.label(effect.label)->levels;
    for (std::size_t i = 0; i <= levels.size(); ++i) {
      const std::string of =
          i < levels.size() ? effect.label + " " + levels[i] : "new " + effect.label;
      study.quantities.push_back({effect.name,
                                  of,
                                  "",
                                  model->parameters[effect.middle].unit,
                                  true,
                                  false,
                                  [](double y) { return y; },
                                  drawn_value(model, e, i),
                                  {}});
    }
  }
}

void refuse_unsupported(const FormulaModel& model, const std::string& what) {
  if (model.modes)
    throw InputError(
        fmt::format("a study with [failure_modes] cannot be {}: its life is the earliest of "
                    "several; fit it, and read the lives of the result",
                    what));
  if (!model.measured.front().life.plain())
    throw InputError(
        fmt::format("a study with subpopulations, share_defective or share_dead_on_arrival cannot "
                    "be {}; fit it, and read the lives of the result",
                    what));
  if (model.use_rate)
    throw InputError(
        fmt::format("a study with [use_rate] cannot be {}: units differ in their rates of use; fit "
                    "it, and read the lives of the result",
                    what));
  if (model.drawn.empty()) return;
  throw InputError(fmt::format(
      "the random effects of {} are drawn, not integrated out ({} of each {}): units "
      "of such a model cannot be {}; fit the study again when you have more data",
      model.drawn.front().label, model.drawn.front().name, model.drawn.front().label, what));
}

namespace {

// Those effects of units that are drawn.
std::vector<std::size_t> drawn_of_units(const FormulaModel& model) {
  std::vector<std::size_t> places;
  for (const DrawnEffect& each : model.drawn) {
    if (model.label == each.label) places.push_back(each.first + each.seen);
  }
  return places;
}

}  // namespace

NewUnits::NewUnits(const FormulaModel& model)
    : place_(drawn_of_units(model)), nodes_(place_.size(), drawn_reach) {}

const double* NewUnits::at(std::size_t i, const double* x, std::size_t parameters) {
  if (place_.empty()) return x;
  moved_.assign(x, x + parameters);
  for (std::size_t k = 0; k < place_.size(); ++k)
    moved_[place_[k]] = nodes_.z[i * place_.size() + k];
  return moved_.data();
}

}  // namespace wearwell::formula_model
