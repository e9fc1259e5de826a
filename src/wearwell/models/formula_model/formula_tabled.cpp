#include "wearwell/models/formula_model/formula_tabled.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

#include "wearwell/formula/no_columns.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/unit_rule.h"

namespace wearwell::formula_model {
namespace {

// Indices of the study's parameters that an expression of the rows depends on, other than effects.
std::vector<std::size_t> leans_on(const FormulaModel& model, const formula::Wanted& wanted) {
  const formula::Program program = formula::compile(model.lines, {wanted}, model.row_symbols);
  const std::vector<std::size_t> family_parameters = formula::slots(model.row_symbols);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < model.row_symbols.parameters.size(); ++i) {
    if (!program.uses_parameter(i)) continue;
    for (std::size_t s = family_parameters[i]; s < family_parameters[i + 1]; ++s)
      found.push_back(model.shared[s]);
  }
  return found;
}

// Kinks and jumps, which polynomials may miss.
bool is_smooth(const FormulaModel& model) {
  static const std::regex cases(R"(\b(where|min|max|abs)\b|[<>=])");
  const auto found = [](const auto& each) { return std::regex_search(each.text, cases); };
  return std::none_of(model.lines.begin(), model.lines.end(), found) &&
         std::none_of(model.measured[0].wanted.begin(), model.measured[0].wanted.end(), found);
}

// Sums of squares computed from the rows.
class RowMismatch final : public Mismatch {
 public:
  RowMismatch(UnitRows& rows, const TabledForm& form)
      : rows_(rows), form_(form), column_(rows.columns()[0]), effects_(rows.units()) {
    for (const Parameter& each : rows.model().parameters) at_.push_back(each.start);
    mean_.resize(column_.unit.size());
  }

  std::size_t units() const override { return effects_.size(); }

  void operator()(double shared, std::span<const double> x, std::span<double> sums) override {
    if (form_.shared) at_[*form_.shared] = shared;
    rows_.move_to(at_.data());
    const bool lognormal = rows_.model().effects[0].lognormal;
    for (std::size_t u = 0; u < effects_.size(); ++u) {
      effects_[u] = lognormal ? std::exp(x[u]) : x[u];
    }
    rows_.means_of_units(effects_, 0, mean_);
    std::fill(sums.begin(), sums.end(), 0.0);
    for (std::size_t i = 0; i < mean_.size(); ++i) {
      if (!(column_.count[i] > 0)) continue;
      double mean = mean_[i], reading = column_.responses.at[i];
      if (form_.logarithms) {
        mean = std::log(mean);
        reading = column_.responses.log_at[i];
      }
      const double off = reading - mean;
      double& sum = sums[column_.unit[i]];
      sum = std::isfinite(off) ? sum + column_.count[i] * off * off : infinity;
    }
  }

 private:
  UnitRows& rows_;
  const TabledForm& form_;
  const BoundColumn& column_;
  std::vector<double> at_, effects_, mean_;
};

// The range of a parameter by its prior.
std::optional<std::pair<double, double>> range_of(const Parameter& parameter) {
  constexpr double rare = 1e-9;
  if (!parameter.prior.proper) return {};
  return std::pair(quantile(parameter.prior, rare), quantile(parameter.prior, 1 - rare));
}

// The logarithm of a unit's effect: the range of the median, with a margin.
std::optional<std::pair<double, double>> range_of_effect(const FormulaModel& model) {
  constexpr double farthest = 25, beyond = 3;
  const Effect& effect = model.effects[0];
  const Parameter& middle = model.parameters[effect.parameter];
  const auto range = range_of(middle);
  if (!effect.lognormal) {
    if (!range) return {};
    const double width = range->second - range->first;
    return std::pair(range->first - 0.5 * width, range->second + 0.5 * width);
  }
  if (!(middle.start > 0)) return {};
  const double start = std::log(middle.start);
  double low = start - farthest, high = start + farthest;
  if (range && range->first > 0) low = std::max(low, std::log(range->first) - beyond);
  if (range && range->second > 0) high = std::min(high, std::log(range->second) + beyond);
  return std::pair(low, high);
}

}  // namespace

std::optional<TabledForm> tabled_form(const FormulaModel& model,
                                      const std::vector<BoundColumn>& columns) {
  if (model.effects.size() != 1 || columns.size() != 1) return {};
  const Measured& measured = *columns[0].measured;
  const ResponseFamily family = measured.form->family;
  const bool logarithms =
      family == ResponseFamily::lognormal || family == ResponseFamily::log10_normal;
  if (measured.process || !columns[0].responses.plain || !is_smooth(model)) return {};
  if (!logarithms && family != ResponseFamily::normal) return {};
  if (logarithms && columns[0].responses.log_at.size() != columns[0].unit.size()) return {};
  TabledForm form;
  form.logarithms = logarithms;
  for (std::size_t o = 0; o < measured.wanted.size(); ++o) {
    if (measured.family_parameter[o] == 0) {
      const std::vector<std::size_t> shared = leans_on(model, measured.wanted[o]);
      if (shared.size() > 1) return {};
      if (!shared.empty()) form.shared = shared[0];
    } else if (measured.family_parameter[o] == 1 && measured.program.outputs()[o].uniform) {
      form.size = formula::compile(model.lines, {measured.wanted[o]}, model.symbols);
      form.per_parameter = family == ResponseFamily::log10_normal ? ln10 : 1;
    } else {
      return {};
    }
  }
  return form;
}

std::shared_ptr<const MismatchTable> make_table(UnitRows& rows, const TabledForm& form) {
  const FormulaModel& model = rows.model();
  const auto x = range_of_effect(model);
  std::optional<std::pair<double, double>> shared = std::pair(0.0, 0.0);
  if (form.shared) shared = range_of(model.parameters[*form.shared]);
  if (!x || !shared) return {};
  double readings = 0;
  for (const double count : rows.columns()[0].count) readings += count;
  const double fitted = static_cast<double>(model.units.size()) + (form.shared ? 1 : 0);
  RowMismatch mismatch(rows, form);
  return MismatchTable::make(
      mismatch, {x->first, x->second, shared->first, shared->second, readings - fitted});
}

TabledUnits::TabledUnits(UnitRows& rows, const TabledForm& form,
                         std::shared_ptr<const MismatchTable> table)
    : rows_(rows),
      model_(rows.model()),
      form_(form),
      slice_(std::move(table)),
      readings_(model_.units.size()),
      constant_(model_.units.size()),
      beyond_(model_.units.size()) {
  const BoundColumn& column = rows.columns()[0];
  for (std::size_t i = 0; i < column.unit.size(); ++i) {
    readings_[column.unit[i]] += column.count[i];
    if (form.logarithms) constant_[column.unit[i]] -= column.count[i] * column.responses.log_at[i];
  }
  size_data_ = formula::bind_no_columns(form_.size, model_.symbols);
  size_workspace_ = form_.size.workspace(1);
}

std::size_t TabledUnits::units() const {
  return model_.units.size();
}

void TabledUnits::move() {
  x_ = rows_.at();
  const Population& population = rows_.population();
  middle_ = model_.effects[0].lognormal ? std::log(population.middle[0]) : population.middle[0];
  scatter_ = population.scatter[0];
  form_.size.forward(size_data_, 0, 1, {{x_, model_.parameters.size()}, {}}, size_workspace_);
  size_ = form_.per_parameter * size_workspace_.values(0)[0];
  log_size_ = std::log(size_);
  inside_ = slice_.move(form_.shared ? x_[*form_.shared] : 0) && size_ > 0 &&
            std::isfinite(size_) && std::isfinite(middle_);
}

double TabledUnits::constant(std::size_t unit) const {
  return constant_[unit] - readings_[unit] * (log_size_ + half_log_two_pi);
}

void TabledUnits::evaluate(std::span<const double> z, std::span<const std::uint8_t> wanted,
                           std::span<double> value, std::span<double> slope) {
  const double per_square = 0.5 / (size_ * size_);
  bool any = false;
  for (std::size_t u = 0; u < beyond_.size(); ++u) {
    beyond_[u] = 0;
    if (!wanted[u]) continue;
    const double x = x_of(z[u]);
    if (!inside_ || !slice_.holds(u, x)) {
      beyond_[u] = 1;
      any = true;
      continue;
    }
    if (slope.empty()) {
      value[u] = constant(u) - slice_.value(u, x) * per_square;
    } else {
      const MismatchSlice::Place place = slice_.place(u, x);
      value[u] = constant(u) - place.value * per_square;
      slope[u] = -place.slope * per_square * scatter_;
    }
  }
  if (any) rows_.evaluate(z, beyond_, value, slope);
}

std::optional<double> TabledUnits::sum(std::span<double> gradient) {
  if (!inside_) return {};
  double sum = 0;
  Moments all;
  double squares = 0, readings = 0;
  for (std::size_t u = 0; u < readings_.size(); ++u) {
    Moments moments;
    const auto log_integral = integral(u, gradient.empty() ? nullptr : &moments);
    if (!log_integral) return {};
    sum += *log_integral;
    all.slope += moments.slope;
    all.slope_z += moments.slope_z;
    all.by_shared += moments.by_shared;
    squares += moments.square;
    readings += readings_[u];
  }
  if (gradient.empty() || !std::isfinite(sum)) return sum;
  const double variance = size_ * size_;
  Population by;
  const bool lognormal = model_.effects[0].lognormal;
  by.middle[0] = all.slope / (lognormal ? rows_.population().middle[0] : 1);
  by.scatter[0] = all.slope_z;
  rows_.add_population_gradient(by, gradient);
  if (form_.shared) gradient[*form_.shared] += all.by_shared;
  size_workspace_.adjoints(0)[0] = form_.per_parameter * (squares / variance - readings) / size_;
  form_.size.reverse(size_data_, 0, 1, {{x_, model_.parameters.size()}, {}}, size_workspace_,
                     gradient);
  return sum;
}

bool TabledUnits::each(std::vector<double>& log_likelihood) {
  if (!inside_) return false;
  log_likelihood.resize(readings_.size());
  for (std::size_t u = 0; u < readings_.size(); ++u) {
    const auto log_integral = integral(u, nullptr);
    if (!log_integral) return false;
    log_likelihood[u] = *log_integral;
  }
  return true;
}

// The approximate mode of a unit's integrand and its width there, in x; empty if it is outside the
// table.
std::optional<TabledUnits::LaplaceApproximation> TabledUnits::approximation(std::size_t unit) {
  constexpr double close = 0.1;
  const double per_square = 0.5 / (size_ * size_), prior = 1 / (scatter_ * scatter_);
  const double low = slice_.low(unit), high = slice_.high(unit);
  double x = slice_.best(unit);
  const double held = std::max(0.0, slice_.place(unit, x).bend * per_square);
  x = std::clamp((held * x + prior * middle_) / (held + prior), low, high);
  double left = low, right = high;
  for (int round = 0; round < 40; ++round) {
    const MismatchSlice::Place at = slice_.place(unit, x);
    const double slope = -at.slope * per_square - (x - middle_) * prior;
    const double bend = at.bend * per_square + prior;
    if (bend > 0 && std::abs(slope) < close * std::sqrt(bend))
      return LaplaceApproximation{x, 1 / std::sqrt(bend)};
    (slope > 0 ? left : right) = x;
    double next = bend > 0 ? x + slope / bend : 0.5 * (left + right);
    if (!(next > left && next < right)) next = 0.5 * (left + right);
    x = next;
  }
  return {};
}

// By nodes on both sides of the mode; empty if they are too many or leave the table.
std::optional<double> TabledUnits::integral(std::size_t unit, Moments* moments) {
  if (!(readings_[unit] > 0)) return 0.0;
  if (!(scatter_ > 0 && std::isfinite(scatter_))) return {};
  const auto about = approximation(unit);
  if (!about) return {};
  const double per_square = 0.5 / (size_ * size_);
  for (const double gap : rule_gaps) {
    const double width = gap * about->width;
    nodes_.count = 0;
    double highest = -infinity;
    for (const int way : {1, -1}) {
      for (int n = way > 0 ? 0 : 1;; ++n) {
        const double x = about->center + way * n * width, z = (x - middle_) / scatter_;
        if (!slice_.holds(unit, x) || nodes_.count == Nodes::most) return {};
        const double log_f = -slice_.value(unit, x) * per_square - 0.5 * z * z;
        highest = std::max(highest, log_f);
        nodes_.x[nodes_.count] = x;
        nodes_.odd[nodes_.count] = n % 2;
        nodes_.f[nodes_.count++] = log_f;
        if (log_f < highest - rule_fallen) break;
      }
    }
    const auto log_integral = settled(nodes_, width / scatter_);
    if (!log_integral) continue;
    if (moments) add_moments(unit, *moments);
    return constant(unit) + *log_integral - half_log_two_pi;
  }
  return {};
}

// Means of derivatives of the integrand under the unit's posterior.
void TabledUnits::add_moments(std::size_t unit, Moments& moments) {
  constexpr double negligible = 1e-12;
  const double per_square = 0.5 / (size_ * size_);
  for (std::size_t i = 0; i < nodes_.count; ++i) {
    const double weight = nodes_.f[i];
    if (!(weight > negligible)) continue;
    const double x = nodes_.x[i], z = (x - middle_) / scatter_;
    const MismatchSlice::Place place = slice_.place(unit, x);
    const double slope = -weight * place.slope * per_square;
    moments.slope += slope;
    moments.slope_z += slope * z;
    moments.square += weight * place.value;
    if (form_.shared) moments.by_shared -= weight * slice_.by_theta(unit, x) * per_square;
  }
}

}  // namespace wearwell::formula_model
