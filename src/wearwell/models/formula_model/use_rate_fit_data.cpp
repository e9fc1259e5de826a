#include "wearwell/models/formula_model/use_rate_fit_data.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/models/formula_model/formula_fit_data.h"
#include "wearwell/models/formula_model/mode_fit_data.h"
#include "wearwell/prob/use_rate.h"

namespace wearwell::formula_model {
namespace {

// Lives in use, then rates, by row.
std::vector<NormalScore> scores_of_use(const FormulaRows& rows, const double* x) {
  const FormulaModel& model = rows.model();
  const std::size_t n = model.data.table.rows;
  UnitRows& units = rows.mine().rows;
  units.move_to(x);
  const std::vector<std::vector<double>> family_parameters = units.each_family_parameter({});
  std::vector<NormalScore> scores(2 * n);
  for (std::size_t c = 0; c < 2; ++c) {
    const Measured& known = model.measured[c];
    for (std::size_t i = 0; i < known.observed.rows.size(); ++i)
      scores[c * n + known.observed.rows[i]] =
          score_of(*known.form, known.observed.responses[i],
                   &family_parameters[c][i * most_response_parameters]);
  }
  if (model.measured.size() < 3) return scores;
  Rng rng = lots_at(x, model.parameters.size());
  const Measured &life = model.measured[0], &rate = model.measured[1], &age = model.measured[2];
  for (std::size_t i = 0; i < age.observed.rows.size(); ++i) {
    const double* const own = &family_parameters[2][i * age.life.parameters()];
    const double* const of_rate = own + age.life.of_rate();
    Response y = age.observed.responses[i];
    const double drawn =
        rate_given({life.form->family, rate.form->family, own, of_rate}, y, rng.uniform());
    y.at *= drawn;
    y.until *= drawn;
    const std::size_t row = age.observed.rows[i];
    scores[row] = as_drawn(score_of(*life.form, y, own));
    scores[n + row] = as_drawn(score_of(*rate.form, {Censoring::none, drawn}, of_rate));
  }
  return scores;
}

// What was measured exactly: uses at failure, and rates.
MeasuredValues measured_uses(std::shared_ptr<const FormulaRows> rows) {
  const FormulaModel& model = rows->model();
  const std::size_t n = model.data.table.rows;
  MeasuredValues values;
  values.value.assign(2 * n, NAN);
  values.unit.assign(2 * n, 1);
  for (std::size_t c = 0; c < 2; ++c) {
    const Measured& known = model.measured[c];
    for (std::size_t i = 0; i < known.observed.rows.size(); ++i) {
      const Response& y = known.observed.responses[i];
      const std::size_t at = c * n + known.observed.rows[i];
      if (y.seen == Censoring::none) values.value[at] = from_si(known.unit, y.at);
      values.unit[at] = known.unit.scale;
    }
  }
  values.log_density = [rows, n](const double* x) {
    UnitRows& units = rows->mine().rows;
    units.move_to(x);
    std::vector<double> all(2 * n);
    const auto terms = units.each_term({});
    for (std::size_t c = 0; c < 2; ++c) {
      const std::vector<std::size_t>& row = rows->model().measured[c].observed.rows;
      for (std::size_t i = 0; i < row.size(); ++i) all[c * n + row[i]] = terms[c][i];
    }
    return all;
  };
  return values;
}

// How many units a row stands for.
std::vector<int> counts_of_rows(const FormulaModel& model) {
  std::vector<int> counts(model.data.table.rows, 1);
  for (const Measured& each : model.measured)
    for (std::size_t i = 0; i < each.observed.rows.size(); ++i)
      counts[each.observed.rows[i]] = each.observed.counts[i];
  return counts;
}

template <class T>
std::vector<T> of_both(std::vector<T> by_row) {
  const std::size_t n = by_row.size();
  by_row.resize(2 * n);
  std::copy_n(by_row.begin(), n, by_row.begin() + static_cast<std::ptrdiff_t>(n));
  return by_row;
}

}  // namespace

FitData use_rate_fit_data(std::shared_ptr<const FormulaRows> rows) {
  const FormulaModel& model = rows->model();
  FitData data;
  data.scores = [rows](const double* x) { return scores_of_use(*rows, x); };
  data.counts = of_both(counts_of_rows(model));
  data.terms =
      false;  // a row of unknown use is one factor, but has a residual of the life and one of the rate
  data.noun = "residual";
  const std::string names[] = {model.measured[0].column, UseRate::name};
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t i = 0; i < model.data.table.rows; ++i) {
      data.column.push_back(c);
      data.names.push_back(fmt::format("row {}, as to {},", i + 1, names[c]));
    }
  }
  for (std::size_t c = 0; c < model.row_symbols.columns.size(); ++c) {
    const bool used =
        std::any_of(model.measured.begin(), model.measured.end(),
                    [c](const Measured& each) { return each.program.uses_column(c); });
    const std::string& name = model.row_symbols.columns[c].name;
    if (used) data.drivers.push_back({name, of_both(model.data.number(name)->values)});
  }
  for (const LabelColumn& column : model.data.labels) {
    if (column.name == "status") continue;
    data.labels.push_back(
        {column.name, of_both(std::vector<std::size_t>(column.at.begin(), column.at.end()))});
  }
  data.measured = measured_uses(rows);
  data.remedies.scatter =
      "Use an expression of conditions for the scatter (or shape) of the life or of the rate, or "
      "another family.";
  return data;
}

}  // namespace wearwell::formula_model
