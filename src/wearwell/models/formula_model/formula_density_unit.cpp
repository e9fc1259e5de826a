#include "wearwell/models/formula_model/formula_density_unit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wearwell::formula_model {
namespace {

// Observations of a column that contribute a density, not a probability.
std::vector<bool> has_density(const FormulaModel& model, const Measured& measured) {
  const Observed& observed = measured.observed;
  std::vector<bool> has(observed.responses.size());
  if (measured.form->counted || measured.trials) return has;
  for (std::size_t i = 0; i < has.size(); ++i)
    has[i] = observed.responses[i].seen == Censoring::none &&
             !(measured.life.dead && observed.responses[i].at == 0);
  const bool noisy =
      std::count(measured.family_parameter.begin(), measured.family_parameter.end(), 2) > 0;
  if (!measured.process || measured.process->process == Process::wiener || noisy) return has;
  // Where the mean of an increasing process does not grow, the path is constant with certainty.
  std::vector<std::size_t> of_row(model.data.table.rows, has.size());
  for (std::size_t i = 0; i < has.size(); ++i) of_row[observed.rows[i]] = i;
  std::vector<double> before(model.units.size(), 0.0);
  for (const std::size_t row : model.order) {
    const std::size_t i = of_row[row];
    if (i == has.size()) continue;
    double& last = before[model.unit_of_row[row]];
    has[i] = has[i] && observed.responses[i].at != last;
    last = observed.responses[i].at;
  }
  return has;
}

}  // namespace

// By row: the density of a part's life.
static DensityUnit unit_of_lives(const FormulaModel& model) {
  const Unit& life = model.measured.front().unit;
  DensityUnit unit{life.text, {}, 0};
  for (std::size_t i = 0; i < model.lives.responses.size(); ++i) {
    const bool exact = model.lives.responses[i].seen == Censoring::none;
    unit.terms.push_back(exact ? std::log(life.scale) : 0);
    unit.total += unit.terms.back() * model.lives.counts[i];
  }
  return unit;
}

DensityUnit density_unit(const FormulaModel& model) {
  if (model.modes) return unit_of_lives(model);
  DensityUnit unit{"", {}, 0};
  const bool by_unit = model.by_unit() || model.draws_units();
  if (by_unit) unit.terms.resize(model.units.size());
  for (const Measured& measured : model.measured) {
    if (!measured.form->counted && !measured.trials && measured.unit.text != "1" &&
        (", " + unit.text + ",").find(", " + measured.unit.text + ",") == std::string::npos)
      unit.text += (unit.text.empty() ? "" : ", ") + measured.unit.text;
    const std::vector<bool> has = has_density(model, measured);
    const double log_scale = std::log(measured.unit.scale);
    for (std::size_t i = 0; i < has.size(); ++i) {
      const double each = has[i] ? log_scale : 0;
      const double all = each * measured.observed.counts[i];
      unit.total += all;
      if (by_unit) {
        unit.terms[model.unit_of_row[measured.observed.rows[i]]] += all;
      } else {
        unit.terms.push_back(each);
      }
    }
  }
  if (unit.text.empty()) unit.text = "1";
  return unit;
}

}  // namespace wearwell::formula_model
