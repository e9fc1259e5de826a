#include "wearwell/models/formula_model/formula_fit_data.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <map>

#include "wearwell/base/rng.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/mode_fit_data.h"
#include "wearwell/models/formula_model/use_rate_fit_data.h"

namespace wearwell::formula_model {
namespace {

// For one value; for normal distributions without the cdf.
double place(const LifeMixture& life, double value, const double* family_parameters,
             double trials) {
  constexpr double one_half = -0.693147180559945309;
  if (!life.plain()) {
    const double failed = life.log_cdf(value, family_parameters);
    if (failed < one_half) return normal_score(failed, 0);
    return normal_score(failed, life.log_survival(value, family_parameters));
  }
  const ResponseFamily family = life.families.front();
  constexpr double log_half = -0.693147180559945309;
  const bool sized = family_parameters[1] > 0 && std::isfinite(family_parameters[0]) &&
                     std::isfinite(family_parameters[1]);
  if (family == ResponseFamily::normal && sized)
    return (value - family_parameters[0]) / family_parameters[1];
  if (family == ResponseFamily::lognormal && sized && family_parameters[0] > 0 && value > 0) {
    return (std::log(value) - std::log(family_parameters[0])) / family_parameters[1];
  }
  const double below = log_cdf(family, value, family_parameters, trials);
  // From the smaller tail, to avoid cancellation.
  if (below < log_half) return normal_score(below, 0);
  return normal_score(below, log_survival(family, value, family_parameters, trials));
}

}  // namespace

NormalScore score_of(const ResponseForm& form, const Response& y, const double* family_parameters) {
  return score_of(form, {.families = {form.family}}, y, family_parameters);
}

NormalScore score_of(const ResponseForm& form, const LifeMixture& life, const Response& y,
                     const double* family_parameters) {
  // Given that it was not truncated at its entry: log P(Y > value | Y > entry).
  const auto left = [&](double value) {
    return life.plain() ? log_survival(form.family, value, family_parameters, y.trials)
                        : life.log_survival(value, family_parameters);
  };
  const double entered = y.entry > -infinity ? left(y.entry) : 0;
  const auto at = [&](double value) {
    if (!(y.entry > -infinity)) return place(life, value, family_parameters, y.trials);
    const double above = value > y.entry ? left(value) - entered : 0;
    return normal_score(std::log(-std::expm1(above)), above);
  };
  if (form.counted) {
    const double high = y.trials > 0 && y.at >= y.trials ? infinity : at(y.at);
    return {y.at > 0 ? at(y.at - 1) : -infinity, high};
  }
  switch (y.seen) {
    case Censoring::none: {
      const double z = at(y.at);
      if (life.dead && y.at == 0) return {-infinity, z};  // an atom
      return {z, z};
    }
    case Censoring::right:
      return {at(y.at), infinity};
    case Censoring::left:
      return {-infinity, at(y.at)};
    case Censoring::interval:
      break;
  }
  return {at(y.at), at(y.until)};
}

Rng lots_at(const double* x, std::size_t count) {
  std::uint64_t stream = 14695981039346656037ULL;
  for (std::size_t i = 0; i < count; ++i) {
    stream = (stream ^ std::bit_cast<std::uint64_t>(x[i])) * 1099511628211ULL;
    stream ^= stream >> 29;
  }
  constexpr std::uint64_t seed = 20261122;
  return Rng(seed, stream);
}

namespace {

// A random node of each unit.
std::vector<double> drawn_effects(const FormulaRows& rows, const double* x) {
  const std::size_t d = rows.model().effects.size(), units = rows.model().units.size();
  std::vector<double> z(units * d);
  if (d == 0) return z;
  const latent::UnitIntegrals& integrals = rows.integrate(x);
  Rng rng = lots_at(x, rows.model().parameters.size());
  for (std::size_t u = 0; u < units; ++u) {
    double left = rng.uniform();
    for (const latent::Sweep& sweep : integrals.sweeps) {
      if (!(sweep.weight[u] > 0)) continue;
      for (std::size_t e = 0; e < d; ++e) z[u * d + e] = sweep.z[u * d + e];
      left -= sweep.weight[u];
      if (left < 0) break;
    }
  }
  return z;
}

// Of ages at a report. All rows of a triangle have the same parameters, and few ages are different.
void add_report_scores(const Measured& column, const double* family_parameters,
                       std::vector<NormalScore>& scores) {
  std::map<double, double> known;
  const auto at = [&](double age) {
    constexpr double log_half = -0.693147180559945309;
    const auto [found, is_new] = known.try_emplace(age, 0.0);
    if (!is_new) return found->second;
    const double below = log_reported(column.life, *column.reporting, age, family_parameters);
    found->second = normal_score(
        below, below < log_half
                   ? 0
                   : log_unreported(column.life, *column.reporting, age, family_parameters));
    return found->second;
  };
  for (const Response& y : column.observed.responses) {
    const double first = y.seen == Censoring::left ? -infinity : at(y.at);
    scores.push_back({first, y.seen == Censoring::right  ? infinity
                             : y.seen == Censoring::left ? at(y.at)
                                                         : at(y.until)});
  }
}

// Of the observations of column c.
void add_scores(UnitRows& units, const std::vector<double>& z, std::size_t c,
                const std::vector<double>& family_parameters, std::vector<NormalScore>& scores) {
  const Measured& column = units.model().measured[c];
  if (column.process) {
    const std::vector<NormalScore> steps = units.step_scores(z, c);
    scores.insert(scores.end(), steps.begin(), steps.end());
    return;
  }
  const std::size_t count = column.life.parameters();
  if (column.reporting) return add_report_scores(column, family_parameters.data(), scores);
  for (std::size_t i = 0; i < column.observed.responses.size(); ++i) {
    check_stop();
    scores.push_back(score_of(*column.form, column.life, column.observed.responses[i],
                              &family_parameters[i * count]));
  }
}

// In which step a specimen fails is a result, not a condition: weak ones fail early.
bool changes(const FormulaModel& model, std::span<const double> values) {
  return model.steps && changes_between_steps(*model.steps, values, model.data);
}

// The columns that any expression depends on, if all observations have them.
std::vector<Driver> drivers_of(const FormulaModel& model) {
  std::vector<Driver> all;
  for (std::size_t c = 0; c < model.row_symbols.columns.size(); ++c) {
    const std::string& name = model.row_symbols.columns[c].name;
    if (model.steps && name == model.steps->duration) continue;  // the life itself
    if (model.ramp && (name == model.ramp->stress || name == RampStress::duration)) continue;
    if (changes(model, model.data.number(name)->values)) continue;
    bool used = model.ramp && name == model.ramp->rate, whole = true;
    Driver driver{name, {}};
    for (const Measured& measured : model.measured) {
      used |= measured.program.uses_column(c);
      for (const std::size_t row : measured.observed.rows) {
        driver.value.push_back(model.data.number(name)->values[row]);
        whole &= std::isfinite(driver.value.back());
      }
    }
    if (used && whole) all.push_back(std::move(driver));
  }
  return all;
}

// Labels of the study that distinguish observations. The status of an observation is not a label: it depends on the life
// itself, and scores of early and late lives scatter differently under a correct distribution.
std::vector<Label> labels_of(const FormulaModel& model) {
  std::vector<Label> all;
  for (const LabelColumn& column : model.data.labels) {
    if (column.name == "status" || (model.steps && model.steps->label == column.name) ||
        changes(model, std::vector<double>(column.at.begin(), column.at.end())))
      continue;
    Label label{column.name, {}};
    for (const Measured& measured : model.measured) {
      for (const std::size_t row : measured.observed.rows)
        label.level.push_back(static_cast<std::size_t>(column.at[row]));
    }
    all.push_back(std::move(label));
  }
  return all;
}

// What was measured exactly, as written; nothing for processes, whose readings depend on each
// other.
MeasuredValues measured_values(const FormulaModel& model) {
  MeasuredValues values;
  for (const Measured& measured : model.measured) {
    for (const Response& each : measured.observed.responses) {
      const bool exact = each.seen == Censoring::none && !measured.form->counted &&
                         !measured.process && !(measured.life.dead && each.at == 0);
      values.value.push_back(exact ? from_si(measured.unit, each.at) : NAN);
      values.unit.push_back(measured.unit.scale);
    }
  }
  return values;
}

// The location parameter of a family, or else its scale.
std::size_t location_parameter(const ResponseForm& form) {
  for (const ParameterKind kind : {ParameterKind::location, ParameterKind::scale}) {
    for (std::size_t s = 0; s < form.family_parameters.size(); ++s) {
      if (form.family_parameters[s].kind == kind && !form.family_parameters[s].optional) return s;
    }
  }
  return 0;
}

// Results of all columns as one.
std::vector<double> joined(const std::vector<std::vector<double>>& columns) {
  std::vector<double> all;
  for (const auto& column : columns) all.insert(all.end(), column.begin(), column.end());
  return all;
}

std::vector<double> fitted_places(const FormulaRows& rows, const double* x) {
  const std::vector<double> z = drawn_effects(rows, x);
  UnitRows& units = rows.mine().rows;
  units.move_to(x);
  const std::vector<std::vector<double>> family_parameters = units.each_family_parameter(z);
  std::vector<double> places;
  for (std::size_t c = 0; c < family_parameters.size(); ++c) {
    const Measured& measured = rows.model().measured[c];
    const std::size_t family_parameter = location_parameter(*measured.form);
    for (std::size_t i = family_parameter; i < family_parameters[c].size();
         i += measured.life.parameters())
      places.push_back(measured.process ? NAN : family_parameters[c][i]);
  }
  return places;
}

std::vector<double> log_densities(const FormulaRows& rows, const double* x) {
  const std::vector<double> z = drawn_effects(rows, x);
  UnitRows& units = rows.mine().rows;
  units.move_to(x);
  return joined(units.each_term(z));
}

Remedies remedies_of(const FormulaModel& model) {
  const Measured& first = model.measured.front();
  const ResponseFamily family = first.form->family;
  Remedies remedies;
  remedies.life = !model.along && model.measured.size() == 1 && first.form->positive &&
                  !first.form->counted && !first.process && !first.program.has_paths() &&
                  first.life.plain();
  if (first.process || first.form->counted) return remedies;
  if (family == ResponseFamily::normal) {
    remedies.scatter =
        "The scatter grows with the mean: try family = \"lognormal\", or an expression for the "
        "standard deviation.";
    remedies.heavy_tails =
        "Check the outermost rows for mistakes; if there are none, try heavier tails: family = "
        "\"student-t\".";
  } else {
    remedies.scatter =
        "Use an expression of conditions for the scatter (or shape); if the scatter grows, look "
        "for a second failure mode.";
  }
  return remedies;
}

}  // namespace

std::optional<FitData> fit_data(std::shared_ptr<const FormulaRows> rows) {
  const FormulaModel& model = rows->model();
  if (model.modes) return mode_fit_data(rows);
  if (model.use_rate) return use_rate_fit_data(rows);
  FitData data;
  for (const Measured& measured : model.measured) {
    for (const Response& each : measured.observed.responses) {
      if (each.entry > -infinity && measured.process) return {};
    }
    const std::vector<int>& counts = measured.observed.counts;
    data.counts.insert(data.counts.end(), counts.begin(), counts.end());
  }
  data.scores = [rows](const double* x) {
    const std::vector<double> z = drawn_effects(*rows, x);
    UnitRows& units = rows->mine().rows;
    units.move_to(x);
    std::vector<NormalScore> scores;
    const std::vector<std::vector<double>> family_parameters = units.each_family_parameter(z);
    for (std::size_t c = 0; c < family_parameters.size(); ++c)
      add_scores(units, z, c, family_parameters[c], scores);
    const std::size_t d = rows->model().effects.size();
    for (std::size_t e = 0; e < d; ++e) {
      for (std::size_t i = e; i < z.size(); i += d) scores.push_back({z[i], z[i]});
    }
    for (const DrawnEffect& each : rows->model().drawn) {
      for (std::size_t i = 0; i < each.seen; ++i) {
        scores.push_back({x[each.first + i], x[each.first + i]});
      }
    }
    return scores;
  };
  data.drivers = drivers_of(model);
  data.labels = labels_of(model);
  if (!model.has_exposure())
    data.fitted = [rows](const double* x) { return fitted_places(*rows, x); };
  if (!model.has_process()) {
    data.measured = measured_values(model);
    data.measured.log_density = [rows](const double* x) { return log_densities(*rows, x); };
  }
  data.remedies = remedies_of(model);
  for (std::size_t c = 0; model.measured.size() > 1 && c < model.measured.size(); ++c)
    data.column.insert(data.column.end(), model.measured[c].observed.rows.size(), c);
  if (model.measured.size() > 1) data.noun = "observation";
  // Serial correlation within one column; another column may deviate in the other direction.
  for (std::size_t c = 0; c < model.measured.size(); ++c) {
    if (model.measured.size() == 1 && !model.by_unit()) break;
    for (const std::size_t row : model.measured[c].observed.rows) {
      data.unit.push_back(c * model.units.size() + model.unit_of_row[row]);
    }
  }
  if (!model.by_unit()) return data;
  data.terms = false;  // factors of the likelihood are units
  for (const Effect& effect : model.effects) {
    UnitEffect named{effect.name, {}};
    for (const std::string& unit : model.units) {
      named.of.push_back(fmt::format("{} {}", *model.label, unit));
    }
    data.effects.push_back(std::move(named));
  }
  for (const DrawnEffect& effect : model.drawn) {
    const bool of_units = model.label == effect.label;
    UnitEffect named{of_units ? effect.name : effect.name + " of " + effect.label, {}};
    for (const std::string& level : model.data.label(effect.label)->levels) {
      named.of.push_back(fmt::format("{} {}", effect.label, level));
    }
    data.effects.push_back(std::move(named));
  }
  return data;
}

}  // namespace wearwell::formula_model
