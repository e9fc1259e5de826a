#include "wearwell/models/ownlaw/own_drawn.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/bayes/log_density.h"
#include "wearwell/law/no_columns.h"
#include "wearwell/models/ownlaw/fail_at_place.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::ownlaw {
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

const LabelColumn& label_of(const TomlReader& root, const OwnData& data, const std::string& name) {
  const LabelColumn* column = data.label(name);
  if (!column) {
    root.required_table("varies").fail(
        name, "is no column under data.columns; what varies does so from label to label");
  }
  return *column;
}

Parameter standard_normal(std::string name) {
  Parameter parameter;
  parameter.name = std::move(name);
  parameter.si = "1";
  parameter.unit = Unit{"1", 1, 0};
  parameter.law = "standard normal";
  parameter.prior = make_law(Normal{0, 1}, -INFINITY, INFINITY);
  parameter.start = 0;
  parameter.scale = 1;
  parameter.of_model = true;
  return parameter;
}

// Scatters of drawn effects and their correlations; one thread's.
class ScattersAt {
 public:
  explicit ScattersAt(const OwnLaw& law)
      : law_(law),
        data_(law::bind_no_columns(law.drawn_scatter, law.symbols)),
        workspace_(law.drawn_scatter.workspace(1)) {}

  // Of level `i` of effect `e`.
  double value(std::size_t e, std::size_t i, const double* x) {
    const DrawnEffect& effect = law_.drawn[e];
    law_.drawn_scatter.forward(data_, 0, 1, {{x, law_.parameters.size()}, {}}, workspace_);
    double z = x[effect.first + i];
    if (effect.correlation) {
      const double r = workspace_.values(law_.drawn_correlation(e))[0];
      z = r * x[law_.drawn[e - 1].first + i] + std::sqrt(1 - r * r) * z;
    }
    const double moved = workspace_.values(e)[0] * z, middle = x[effect.middle];
    return effect.lognormal ? middle * std::exp(moved) : middle + moved;
  }

 private:
  const OwnLaw& law_;
  law::Data data_;
  law::Workspace workspace_;
};

void add_level_of_new(const TomlReader& root, const std::string& label, law::Symbols& symbols) {
  for (law::LabelSymbol& each : symbols.labels) {
    if (each.name != label) continue;
    const std::string fresh = "new " + label;
    if (std::find(each.levels.begin(), each.levels.end(), fresh) != each.levels.end()) {
      root.required_table("varies").fail(
          label, fmt::format("one in the data is called '{}', which is what one not yet seen is "
                             "called here; give it another name",
                             fresh));
    }
    each.levels.push_back(fresh);
  }
}

void require_few(const TomlReader& root, const OwnLaw& law, const std::string& label) {
  if (law.parameters.size() <= static_cast<std::size_t>(max_dimension)) return;
  root.required_table("varies").fail(
      label, fmt::format("what is drawn of each {} and of a new one makes {} parameters with all "
                         "others, and {} are the most that a posterior may have: let fewer vary, "
                         "or fewer {}s",
                         label, law.parameters.size(), max_dimension, label));
}

}  // namespace

std::size_t label_of_units(const TomlReader& root, const OwnData& data,
                           const std::vector<WrittenVaries>& varies) {
  const TomlReader table = root.required_table("data");
  std::vector<std::string> names;
  for (const WrittenVaries& each : varies) names.push_back(each.label);
  if (const auto said = table.text("rows_of")) {
    const auto at = std::find(names.begin(), names.end(), *said);
    if (at == names.end()) {
      table.fail("rows_of", fmt::format("'{}' is none of the labels that parameters vary with "
                                        "({}): the units are of one of them",
                                        *said, fmt::join(names, ", ")));
    }
    return static_cast<std::size_t>(at - names.begin());
  }
  if (varies.size() < 2) return 0;
  std::vector<std::size_t> inmost;
  for (std::size_t i = 0; i < varies.size(); ++i) {
    const LabelColumn& own = label_of(root, data, names[i]);
    const bool within = std::all_of(names.begin(), names.end(), [&](const std::string& other) {
      return lies_within(own, label_of(root, data, other));
    });
    if (within) inmost.push_back(i);
  }
  if (inmost.size() == 1) return inmost.front();
  root.required_table("varies").fail(
      names[1],
      fmt::format("which rows are of one unit, those of one {}? {}. Say so: rows_of = \"{}\" under "
                  "[data]",
                  fmt::join(names, " or of one "),
                  inmost.empty() ? "None lies within the others" : "Each lies within the others",
                  names[0]));
}

void add_drawn_effects(const TomlReader& root, const std::vector<WrittenVaries>& written,
                       OwnLaw& law) {
  std::vector<law::Wanted> scatters, correlations;
  for (const WrittenVaries& varies : written) {
    const TomlReader table = root.required_table("varies").required_table(varies.label);
    const LabelColumn& label = label_of(root, law.data, varies.label);
    if (label.levels.size() < 2) {
      root.required_table("varies").fail(
          varies.label, fmt::format("all rows of {} are of one {}; how it varies needs at least 2",
                                    law.data.table.source, varies.label));
    }
    add_level_of_new(root, varies.label, law.symbols);
    const std::vector<std::size_t> begin = law::slots(law.symbols);
    for (const WrittenEffect& each : varies.effects) {
      DrawnEffect effect;
      effect.name = each.name;
      effect.label = varies.label;
      effect.scatter = each.scatter;
      effect.lognormal = each.lognormal;
      effect.z = each.name + "_" + varies.label + "_z";
      effect.seen = label.levels.size();
      const auto middle = std::find_if(law.symbols.parameters.begin(), law.symbols.parameters.end(),
                                       [&](const auto& s) { return s.name == each.name; });
      if (middle == law.symbols.parameters.end()) {
        table.fail(each.name, "is no parameter: it has no prior");
      }
      if (middle->scope != law::Scope::one) {
        table.fail(each.name, "is one for each level of a label already; it cannot vary as well");
      }
      effect.middle = begin[static_cast<std::size_t>(middle - law.symbols.parameters.begin())];
      scatters.push_back({fmt::format("[varies.{}] {} {}", varies.label, each.name,
                                      each.lognormal ? "log_sd" : "sd"),
                          each.scatter, each.lognormal ? law::Powers() : middle->powers,
                          each.lognormal ? "a logarithm's scatter" : each.name, true});
      if (varies.correlation && &each != &varies.effects.front()) {
        effect.correlation = varies.correlation;
        correlations.push_back({fmt::format("[varies.{}] correlation", varies.label),
                                *varies.correlation, law::Powers(), "a correlation", true});
      }
      law.drawn.push_back(std::move(effect));
    }
    for (std::size_t e = law.drawn.size() - varies.effects.size(); e < law.drawn.size(); ++e) {
      DrawnEffect& effect = law.drawn[e];
      effect.first = law.parameters.size();
      for (const std::string& level : label.levels) {
        law.parameters.push_back(standard_normal(fmt::format("{}[{}]", effect.z, level)));
      }
      law.parameters.push_back(standard_normal(fmt::format("{}[new {}]", effect.z, effect.label)));
    }
    require_few(root, law, varies.label);
  }
  if (law.drawn.empty()) return;
  for (const DrawnEffect& each : law.drawn) {
    law.symbols.parameters.push_back({each.z, {}, law::Scope::per_level, each.label});
  }
  scatters.insert(scatters.end(), correlations.begin(), correlations.end());
  try {
    law.drawn_scatter = law::compile({}, scatters, law.symbols);
  } catch (const InputError& error) {
    fail_at_place(root, root.required_table("varies"), error.what());
  }
}

void put_drawn_effects_in_rows(OwnLaw& law) {
  std::vector<std::string> done;
  for (const DrawnEffect& one : law.drawn) {
    if (std::find(done.begin(), done.end(), one.name) != done.end()) continue;
    done.push_back(one.name);
    std::string text = one.name + "_middle", exponent;
    for (std::size_t e = 0; e < law.drawn.size(); ++e) {
      const DrawnEffect& each = law.drawn[e];
      if (each.name != one.name) continue;
      std::string z = fmt::format("{}[{}]", each.z, each.label);
      if (each.correlation) {
        z = fmt::format("(({0}) * {1}[{2}] + sqrt(1 - ({0})^2) * {3})", *each.correlation,
                        law.drawn[e - 1].z, each.label, z);
      }
      const std::string moved = fmt::format("({}) * {}", each.scatter, z);
      if (each.lognormal) {
        exponent += (exponent.empty() ? "" : " + ") + moved;
      } else {
        text += " + " + moved;
      }
    }
    if (!exponent.empty()) text = fmt::format("({}) * exp({})", text, exponent);
    law.lines.push_back({one.name, text});
    for (law::ParameterSymbol& each : law.row_symbols.parameters) {
      if (each.name == one.name) each.name += "_middle";
    }
  }
}

Function drawn_value(std::shared_ptr<const OwnLaw> law, std::size_t effect, std::size_t level) {
  auto own = std::make_shared<tbb::enumerable_thread_specific<std::unique_ptr<ScattersAt>>>();
  return [=](const double* x) {
    std::unique_ptr<ScattersAt>& mine = own->local();
    if (!mine) mine = std::make_unique<ScattersAt>(*law);
    return mine->value(effect, level, x);
  };
}

void tell_drawn_effects(std::shared_ptr<const OwnLaw> law, PosteriorStudy& study) {
  for (std::size_t e = 0; e < law->drawn.size(); ++e) {
    const DrawnEffect& effect = law->drawn[e];
    const std::vector<std::string>& levels = law->data.label(effect.label)->levels;
    for (std::size_t i = 0; i <= levels.size(); ++i) {
      const std::string of =
          i < levels.size() ? effect.label + " " + levels[i] : "new " + effect.label;
      study.quantities.push_back({effect.name,
                                  of,
                                  "",
                                  law->parameters[effect.middle].unit,
                                  true,
                                  false,
                                  [](double y) { return y; },
                                  drawn_value(law, e, i),
                                  {}});
    }
  }
}

void refuse_drawn_effects(const OwnLaw& law, const std::string& what) {
  if (law.drawn.empty()) return;
  throw InputError(fmt::format(
      "what varies with {} is drawn, not integrated out ({} of each {}): units of such a law are "
      "not {}; fit the study again when there is more data",
      law.drawn.front().label, law.drawn.front().name, law.drawn.front().label, what));
}

namespace {

// Of the effects of units, those that are drawn.
std::vector<std::size_t> drawn_of_units(const OwnLaw& law) {
  std::vector<std::size_t> places;
  for (const DrawnEffect& each : law.drawn) {
    if (law.label == each.label) places.push_back(each.first + each.seen);
  }
  return places;
}

}  // namespace

NewUnits::NewUnits(const OwnLaw& law)
    : place_(drawn_of_units(law)), nodes_(place_.size(), drawn_reach) {}

const double* NewUnits::at(std::size_t i, const double* x, std::size_t parameters) {
  if (place_.empty()) return x;
  moved_.assign(x, x + parameters);
  for (std::size_t k = 0; k < place_.size(); ++k)
    moved_[place_[k]] = nodes_.z[i * place_.size() + k];
  return moved_.data();
}

}  // namespace wearwell::ownlaw
