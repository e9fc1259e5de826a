#include "wearwell/models/formula_model/formula_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "wearwell/base/error.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_density_unit.h"
#include "wearwell/models/formula_model/formula_drawn.h"
#include "wearwell/models/formula_model/formula_fit_data.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_predictions.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/formula_start.h"
#include "wearwell/models/formula_model/identified.h"
#include "wearwell/models/formula_model/life_paper.h"
#include "wearwell/models/formula_model/returns_report.h"
#include "wearwell/models/formula_model/subpopulation_order.h"
#include "wearwell/models/formula_model/use_rate_model.h"
#include "wearwell/prognosis/plural.h"

// Longer than others: one study, with its description, notes, checks and columns.
namespace wearwell {
namespace {

using formula_model::Effect;
using formula_model::FormulaModel;
using formula_model::FormulaRows;
using formula_model::Measured;
using formula_model::Observed;
using formula_model::UseRate;

// "weibull with scale = eta['early'], shape = beta['early']".
std::string description_of_family(const Measured& measured, std::size_t k) {
  const ResponseForm& form = form_of(measured.life.families[k]);
  std::vector<std::string> family_parameters;
  for (std::size_t o = 0; o < measured.wanted.size(); ++o) {
    const std::size_t at = measured.family_parameter[o];
    if (at / most_response_parameters != k) continue;
    family_parameters.push_back(
        fmt::format("{} = {}", form.family_parameters[at % most_response_parameters].name,
                    measured.program.text(o)));
  }
  return fmt::format("{} with {}", form.name, fmt::join(family_parameters, ", "));
}

// A mixture, and the shares of it.
std::string description_of_mixture(const FormulaModel& model) {
  const Measured& measured = model.measured.front();
  const auto text_at = [&](std::size_t place) {
    for (std::size_t o = 0; o < measured.wanted.size(); ++o)
      if (measured.family_parameter[o] == place) return measured.program.text(o);
    return std::string();
  };
  std::vector<std::string> parts;
  const LifeMixture& life = measured.life;
  for (std::size_t k = 0; k < life.families.size(); ++k) {
    std::string of;
    if (model.subpopulations)
      of = k == life.rest ? fmt::format(" of {} (the rest)", model.subpopulations->names[k])
                          : fmt::format(" of {} (share {})", model.subpopulations->names[k],
                                        text_at(life.share(k)));
    parts.push_back(
        fmt::format("{}{} is {}", measured.column, of, description_of_family(measured, k)));
  }
  if (life.limited)
    parts.push_back(
        fmt::format("a share {} of the parts can fail at all", text_at(life.share_defective())));
  if (life.dead)
    parts.push_back(fmt::format("a share {} is dead on arrival", text_at(life.share_dead())));
  if (model.subpopulations && model.subpopulations->exchangeable)
    parts.push_back(fmt::format("{} are named in the order of their median lives",
                                fmt::join(model.subpopulations->names, ", ")));
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::string description(const FormulaModel& model) {
  if (!model.measured.front().life.plain()) return description_of_mixture(model);
  std::vector<std::string> parts;
  for (const Measured& each : model.measured) {
    if (each.life.rate) {
      parts.push_back(fmt::format("{} where {} is unknown is {} over {}", each.column,
                                  model.measured.front().column, model.measured.front().column,
                                  UseRate::name));
      continue;
    }
    std::vector<std::string> family_parameters;
    const std::size_t written = each.wanted.size() - (model.has_exposure() ? 1 : 0);
    for (std::size_t o = 0; o < written; ++o) {
      family_parameters.push_back(
          fmt::format("{} = {}", each.form->family_parameters[each.family_parameter[o]].name,
                      each.program.text(o)));
    }
    parts.push_back(fmt::format("{}{} is {} with {}", each.column,
                                each.mode.empty() ? "" : " by " + each.mode, each.form->name,
                                fmt::join(family_parameters, ", ")));
  }
  if (model.steps)
    parts.push_back(
        fmt::format("by cumulative exposure over the steps of each {}", model.steps->label));
  if (model.ramp)
    parts.push_back(fmt::format("by cumulative exposure under a ramp of {} from {} at {}",
                                model.ramp->stress, model.ramp->start, model.ramp->rate));
  if (model.modes)
    parts.push_back(
        fmt::format("{} of a part is the earliest of these", model.measured.front().column));
  for (std::size_t e = 0; e < model.effects.size(); ++e) {
    const Effect& effect = model.effects[e];
    parts.push_back(fmt::format("{} of each of {} {} is {} about {} with {} {}", effect.name,
                                model.units.size(), prognosis::plural(*model.label),
                                effect.lognormal ? "lognormal" : "normal", effect.name,
                                effect.lognormal ? "log_sd" : "sd", model.population.text(e)));
  }
  if (model.correlated) {
    parts.push_back(
        fmt::format("their correlation is {}", model.population.text(model.effects.size())));
  }
  for (const formula_model::DrawnEffect& each : model.drawn) {
    parts.push_back(fmt::format("{} of each of {} {} is {} about {}_middle with {} {}{}", each.name,
                                each.seen, prognosis::plural(each.label),
                                each.lognormal ? "lognormal" : "normal", each.name,
                                each.lognormal ? "log_sd" : "sd", each.scatter,
                                each.correlation ? ", correlation " + *each.correlation : ""));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::vector<std::string> meanings(const FormulaModel& model) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    const auto effect = std::find_if(model.effects.begin(), model.effects.end(),
                                     [&](const Effect& each) { return each.parameter == i; });
    all.push_back(
        effect == model.effects.end()
            ? meaning_not_stated
            : fmt::format("{} {}'s", effect->lognormal ? "median" : "mean", *model.label));
  }
  for (const formula_model::DrawnEffect& each : model.drawn) {
    if (all[each.middle] == meaning_not_stated) {
      all[each.middle] = fmt::format("{} {}'s", each.lognormal ? "median" : "mean", each.label);
    }
    for (std::size_t i = 0; i <= each.seen; ++i) {
      all[each.first + i] =
          fmt::format("{} of this {}, relative to the median", each.name, each.label);
    }
  }
  return all;
}

// How the lives of all parts ended.
std::vector<std::string> notes_of_modes(const FormulaModel& model) {
  const formula_model::FailureModes& modes = *model.modes;
  std::vector<long long> of_mode(modes.modes.size());
  long long sum = 0, runouts = 0, masked = 0, bounded = 0, truncated = 0;
  for (std::size_t i = 0; i < model.lives.responses.size(); ++i) {
    const Response& y = model.lives.responses[i];
    const long long count = model.lives.counts[i];
    const std::uint32_t possible = modes.possible[i];
    sum += count;
    truncated += y.entry > -infinity ? count : 0;
    bounded += y.seen == Censoring::left || y.seen == Censoring::interval ? count : 0;
    if (possible == 0) {
      runouts += count;
    } else if (std::has_single_bit(possible)) {
      of_mode[static_cast<std::size_t>(std::countr_zero(possible))] += count;
    } else {
      masked += count;
    }
  }
  std::string note =
      fmt::format("{}: {} observation{}: {} run-out{}", model.measured.front().column, sum,
                  sum == 1 ? "" : "s", runouts, runouts == 1 ? "" : "s");
  for (std::size_t k = 0; k < of_mode.size(); ++k)
    note += fmt::format(", {} failed by {}", of_mode[k], modes.modes[k]);
  if (masked > 0) note += fmt::format(", {} by one of several modes (masked)", masked);
  if (bounded > 0) note += fmt::format("; {} lives are known to an interval", bounded);
  if (truncated > 0) note += fmt::format("; {} with delayed entry", truncated);
  std::vector<std::string> all = {note};
  for (std::size_t k = 0; k < of_mode.size(); ++k) {
    if (of_mode[k] > 0) continue;
    all.push_back(
        fmt::format("no failure is known to be by {} alone: what the data tell of this mode "
                    "comes from failures of several possible modes",
                    modes.modes[k]));
  }
  all.emplace_back(
      "failure modes are taken as independent, given the parameters: these data cannot test it");
  return all;
}

std::vector<std::string> notes(const FormulaModel& model) {
  static constexpr const char* words[] = {"exact", "right-censored", "left-censored",
                                          "interval-censored"};
  std::vector<std::string> all;
  if (model.modes) all = notes_of_modes(model);
  for (const Measured& each : model.measured) {
    if (model.modes) break;
    long long counts[4] = {}, sum = 0, truncated = 0, dead = 0;
    for (std::size_t i = 0; i < each.observed.responses.size(); ++i) {
      const Response& y = each.observed.responses[i];
      if (each.life.dead && y.seen == Censoring::none && y.at == 0) dead += each.observed.counts[i];
      counts[static_cast<int>(y.seen)] += each.observed.counts[i];
      sum += each.observed.counts[i];
      truncated += y.entry > -infinity ? each.observed.counts[i] : 0;
    }
    std::vector<std::string> parts;
    for (int i = 0; i < 4; ++i) {
      if (counts[i] > 0) parts.push_back(fmt::format("{} {}", counts[i], words[i]));
    }
    std::string note =
        fmt::format("{}: {} observation{}{}", each.column, sum, sum == 1 ? "" : "s",
                    counts[0] == sum ? "" : fmt::format(": {}", fmt::join(parts, ", ")));
    if (truncated > 0) note += fmt::format("; {} with delayed entry", truncated);
    if (dead > 0) note += fmt::format("; {} dead on arrival (a life of 0)", dead);
    all.push_back(note);
    if (!each.form->counted && each.observed.failures == 0 && !model.use_rate) {
      all.push_back(fmt::format(
          "no row of {} is a failure: the priors alone determine the upper end of a life",
          each.column));
    }
  }
  if (model.use_rate) {
    const Observed& unknown = model.use_rate->in_time.observed;
    const long long units = std::accumulate(unknown.counts.begin(), unknown.counts.end(), 0LL);
    all.push_back(
        fmt::format("{} of {} unit{} is unknown; each unit is used at a constant rate of its own, "
                    "independent of its life: these data cannot test it",
                    model.measured.front().column, units, units == 1 ? "" : "s"));
    if (formula_model::failures_of_use(model) == 0)
      all.emplace_back("no row is a failure: the priors alone determine the upper end of a life");
  }
  if (model.steps)
    all.push_back(fmt::format("steps of {} {}: the last row of each is its observation",
                              model.units.size(), prognosis::plural(model.steps->label)));
  if (model.ramp)
    all.push_back(fmt::format("the exposure along each ramp of {} is {}", model.ramp->stress,
                              model.ramp->closed ? "in closed form" : "by quadrature (32 nodes)"));
  if (model.has_random_effects())
    all.push_back(fmt::format("{} {}", model.units.size(), prognosis::plural(*model.label)));
  for (const formula_model::DrawnEffect& each : model.drawn) {
    all.push_back(
        fmt::format("{} of each of {} {} is drawn, not integrated out: by NUTS, without a "
                    "quadrature for comparison. The mode is then the joint mode of all drawn "
                    "values: its scatters are not estimates",
                    each.name, each.seen, prognosis::plural(each.label)));
  }
  return all;
}

bool saw_no_wear(const Observed& observed) {
  return std::all_of(observed.responses.begin(), observed.responses.end(), [](const Response& y) {
    return y.seen == Censoring::left || (y.seen == Censoring::none && y.at <= 0);
  });
}

// Lives without a failure, or wear along an axis without a reading above zero.
NothingSeen nothing_seen(const FormulaModel& model) {
  const auto all = [&](auto property) {
    return std::all_of(model.measured.begin(), model.measured.end(), property);
  };
  const auto counted = [](const Measured& each) { return each.form->counted; };
  if (std::any_of(model.measured.begin(), model.measured.end(), counted)) return {};
  const Measured& first = model.measured.front();
  const int count = std::accumulate(first.observed.counts.begin(), first.observed.counts.end(), 0);
  const std::string give_prior =
      "State what you know of the parameters; until a failure or wear is observed, read every "
      "upper end as a statement of the prior.";
  const bool none_failed =
      model.use_rate ? formula_model::failures_of_use(model) == 0
                     : all([](const Measured& each) { return each.observed.failures == 0; });
  if (!model.along && none_failed) {
    return {"no-failures",
            fmt::format("no failure was observed among {} observation{} of {}: the data only "
                        "exclude short lives, and the upper end of every life rests on the prior",
                        count, count == 1 ? "" : "s", first.column),
            give_prior};
  }
  if (model.along && all([](const Measured& each) { return saw_no_wear(each.observed); })) {
    return {"no-wear",
            fmt::format("no wear was observed: none of {} reading{} of {} lies above zero, so the "
                        "data only exclude fast wear, and the upper end of every life rests on "
                        "the prior",
                        count, count == 1 ? "" : "s", first.column),
            give_prior};
  }
  return {};
}

// What the likelihood is a density of, and its parameters.
void tell_data(const FormulaModel& model, PosteriorStudy& study) {
  std::vector<std::string> names;
  if (model.modes) {
    for (const std::uint32_t each : model.modes->possible) study.observed.push_back(each);
  }
  for (const Measured& each : model.measured) {
    if (names.empty() || !model.modes) names.push_back(each.column);
    for (std::size_t i = 0; i < each.observed.responses.size(); ++i) {
      const Response& y = each.observed.responses[i];
      study.observed.push_back(y.at);
      if (y.seen != Censoring::none || each.observed.counts[i] != 1 || y.entry > -infinity) {
        study.observed.insert(study.observed.end(), {static_cast<double>(y.seen), y.until,
                                                     static_cast<double>(each.observed.counts[i]),
                                                     y.entry > -infinity ? y.entry : 0});
      }
    }
  }
  study.quantity = fmt::format("{}", fmt::join(names, ", "));
  for (const formula_model::NumberColumn& column : model.data.numbers) {
    const bool whole = std::all_of(column.values.begin(), column.values.end(),
                                   [](double x) { return std::isfinite(x); });
    const bool integers =
        std::all_of(column.unit.powers.begin(), column.unit.powers.end(),
                    [](const auto& power) { return power.second.denominator() == 1; });
    if (!whole || !integers) continue;
    // A formula does not tell lengths that are sizes from lengths that are distances, such as a
    // car's mileage. A length measured along another axis is a size.
    const bool size = model.along &&
                      std::any_of(model.measured.begin(), model.measured.end(),
                                  [&](const Measured& each) { return each.column == column.name; });
    study.data_columns.push_back({.name = column.name,
                                  .si = formula::si_text(column.unit.powers),
                                  .unit = column.unit.unit,
                                  .values = column.values,
                                  .endless = !size});
  }
}

// Names the first expression that is not a number at the start of the search, with its row: clearer
// than reporting that the posterior is not finite there.
void require_numbers(const FormulaModel& model) {
  if (model.has_random_effects()) return;
  std::vector<double> x;
  for (const std::size_t i : model.shared) x.push_back(model.parameters[i].start);
  for (const formula_model::BoundColumn& bound :
       formula_model::bind_columns(model, model.data.table.rows)) {
    const auto fault =
        bound.measured->program.first_fault(bound.data, 0, bound.data.rows(), {x, {}});
    if (!fault) continue;
    const std::vector<std::size_t>& rows = bound.measured->observed.rows;
    const std::size_t term = bound.term[fault->row];
    // Rows without an observation only continue a path, which has all rows in order.
    const std::size_t row = term < rows.size() ? rows[term] : model.order[fault->row];
    throw InputError(fmt::format("{}{}: {} in '{}' ({}), at the start values of the parameters",
                                 model.data.table.source,
                                 fault->uniform ? "" : fmt::format(", row {}", row + 1), fault->why,
                                 fault->expression, fault->where));
  }
}

}  // namespace

void read_formula_study(const TomlReader& root, const Source& source, PosteriorStudy& study) {
  const std::shared_ptr<FormulaModel> model = formula_model::read_formula_model(root, source);
  if (study.stages) {
    root.required_table("update").fail(
        "stages",
        "is not possible for model \"formula\"; fit the first rows as a "
        "separate study (data.sql = \"select ... limit 6\")");
  }
  study.data_rows = model->data.table.rows;
  study.data_layout = model->data.table.layout;
  const auto bound = std::make_shared<FormulaRows>(model, study.data_rows, true);
  const std::shared_ptr<const FormulaRows> rows = bound;
  const auto likelihood = formula_model::formula_likelihood(rows);
  if (source.starts.empty()) {
    formula_model::find_starts(*likelihood, model->parameters);
  } else {
    formula_model::start_at(source.starts, model->parameters);
  }
  std::vector<double> start;
  for (const Parameter& each : model->parameters) start.push_back(each.start);
  bound->keep_gathered_at(start.data());
  if (!(likelihood->value(start) > -infinity)) require_numbers(*model);

  study.parameters = model->parameters;
  study.equation = description(*model);
  study.meanings = meanings(*model);
  study.data_notes = notes(*model);
  study.density = formula_model::density_unit(*model);
  study.log_prior_constant = formula_model::log_orders(*model);
  study.nothing_seen = nothing_seen(*model);
  tell_data(*model, study);
  if (model->has_random_effects()) {
    study.observation = *model->label;
  } else if (model->steps) {
    study.observation = model->steps->label;
  } else if (model->has_process()) {
    study.observation =
        model->symbols.labels.size() == 1 ? model->symbols.labels.front().name : "unit";
  }
  study.likelihood = [model, rows, likelihood](std::size_t count) {
    if (count == model->data.table.rows) return likelihood;
    return formula_model::formula_likelihood(
        std::make_shared<const FormulaRows>(model, count, true));
  };
  study.fit_data = formula_model::fit_data(rows);
  study.checks = [rows](const Fit& fit) {
    std::vector<Check> all = {formula_model::identified(*rows, rows->model().parameters, fit)};
    if (rows->model().subpopulations)
      all.push_back(formula_model::distinguished(rows->model(), fit));
    return all;
  };
  formula_model::tell_drawn_effects(model, study);
  formula_model::read_own_predictions(root, model, rows, study);
  // Ages under a stress that changes are not lives under any.
  if (model->has_exposure())
    formula_model::show_exposure_paper(root, model, rows, study);
  else
    formula_model::show_life_paper(root, model, study);
  formula_model::add_returns(root, source, model, study);
}

}  // namespace wearwell
