#include "wearwell/models/formula_model/linear_form.h"

#include <algorithm>
#include <cmath>
#include <regex>

#include "wearwell/models/formula_model/formula_likelihood.h"

namespace wearwell::formula_model {
namespace {

// Means of the rows at three points on a line through the effects: is the middle one halfway?
bool straight(UnitRows& rows, std::size_t c, const double* from, const double* to,
              std::size_t effects) {
  constexpr double shares[] = {0, 0.25, 0.5, 1, 1e-3};
  const std::size_t n = rows.columns()[c].unit.size();
  std::vector<double> mean[5], sd[5];
  for (int k = 0; k < 5; ++k) {
    double at[2] = {};
    for (std::size_t e = 0; e < effects; ++e) at[e] = from[e] + shares[k] * (to[e] - from[e]);
    mean[k].resize(n);
    sd[k].resize(n);
    rows.means_at(at, c, mean[k], sd[k]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (int k = 1; k < 5; ++k) {
      const double expected = mean[0][i] + shares[k] * (mean[3][i] - mean[0][i]);
      const double size = std::max(std::abs(mean[0][i]), std::abs(mean[3][i]));
      if (!(std::abs(mean[k][i] - expected) <= 1e-12 * size) || sd[k][i] != sd[0][i]) return false;
    }
  }
  return true;
}

}  // namespace

bool has_cases(const FormulaModel& model) {
  static const std::regex cases(R"(\b(where|min|max|abs)\b|[<>=])");
  const auto found = [&](const std::string& text) { return std::regex_search(text, cases); };
  return std::any_of(model.measured.begin(), model.measured.end(), [&](const Measured& measured) {
    for (std::size_t o = 0; o < measured.program.outputs().size(); ++o) {
      if (found(measured.program.text(o))) return true;
    }
    return measured.program.has_paths();
  });
}

std::vector<std::vector<double>> trial_points(const FormulaModel& model) {
  std::vector<std::vector<double>> points;
  for (const double factor : {1.0, 1.7, 0.3}) {
    std::vector<double>& x = points.emplace_back();
    for (const Parameter& each : model.parameters) {
      const double moved = each.start * factor;
      const bool inside = each.prior.lower < moved && moved < each.prior.upper;
      x.push_back(inside ? moved : each.start);
    }
  }
  return points;
}

namespace {

// Whether the form of its expressions proves that a column's mean is linear in the effects.
bool straight_by_form(const Measured& measured) {
  for (std::size_t o = 0; o < measured.wanted.size(); ++o) {
    const formula::ByRowDegree most = measured.family_parameter[o] == 0
                                          ? formula::ByRowDegree::linear
                                          : formula::ByRowDegree::none;
    if (measured.program.by_row_degree(o) > most) return false;
  }
  return !measured.program.has_paths();
}

bool straight_by_trial(const FormulaModel& model, const std::vector<BoundColumn>& columns) {
  UnitRows rows(model, columns);
  const std::size_t d = model.effects.size();
  for (const std::vector<double>& x : trial_points(model)) {
    rows.move_to(x.data());
    const Population& population = rows.population();
    for (const double away : {0.5, 3.0, 200.0}) {
      double from[2] = {}, to[2] = {}, other[2] = {};
      for (std::size_t e = 0; e < d; ++e) {
        const double middle = population.middle[e];
        const double size = middle != 0 ? std::abs(middle) : std::abs(population.scatter[e]);
        from[e] = middle;
        to[e] = middle + away * size;
        other[e] = middle - (model.effects[e].lognormal ? 0.999 : away) * size;
      }
      for (std::size_t c = 0; c < columns.size(); ++c) {
        if (!straight(rows, c, from, to, d) || !straight(rows, c, from, other, d)) return false;
        const double one[2] = {to[0], from[1]}, two[2] = {other[0], to[1]};
        if (d > 1 && (!straight(rows, c, from, one, d) || !straight(rows, c, one, two, d))) {
          return false;
        }
      }
    }
  }
  return true;
}

}  // namespace

bool is_linear(const FormulaModel& model, const std::vector<BoundColumn>& columns) {
  if (!model.has_random_effects()) return false;
  bool by_form = true;
  for (const BoundColumn& column : columns) {
    const bool normal = column.measured->form->family == ResponseFamily::normal;
    if (!normal || column.measured->process || !column.responses.plain) return false;
    by_form &= straight_by_form(*column.measured);
  }
  return by_form || (!has_cases(model) && straight_by_trial(model, columns));
}

}  // namespace wearwell::formula_model
