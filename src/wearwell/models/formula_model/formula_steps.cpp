#include "wearwell/models/formula_model/formula_steps.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/boost_policy.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/linear_form.h"

namespace wearwell::formula_model {
namespace {

// For a smaller factor of the mean the slope overflows.
constexpr double least_factor = 1e-290;

bool has_noise(const Measured& measured) {
  return std::count(measured.family_parameter.begin(), measured.family_parameter.end(), 2) > 0;
}

bool in_proportion(UnitRows& rows, double middle) {
  constexpr double factors[] = {1, 2, 0.3, 40};
  const std::size_t n = rows.columns()[0].unit.size();
  std::vector<double> mean[4], spread[4], noise[4];
  for (int k = 0; k < 4; ++k) {
    mean[k].resize(n);
    spread[k].resize(n);
    noise[k].resize(n);
    const double at = factors[k] * middle;
    rows.means_at(&at, 0, mean[k], spread[k], noise[k]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (int k = 1; k < 4; ++k) {
      const double expected = factors[k] * mean[0][i];
      if (!(std::abs(mean[k][i] - expected) <= 1e-13 * std::abs(expected))) return false;
      if (spread[k][i] != spread[0][i] || noise[k][i] != noise[0][i]) return false;
    }
  }
  return true;
}

}  // namespace

bool is_proportional(const FormulaModel& model, const std::vector<BoundColumn>& columns) {
  if (model.effects.size() != 1 || columns.size() != 1 || has_cases(model)) return false;
  const Measured& measured = *columns[0].measured;
  if (!measured.process) return false;
  if (has_noise(measured) && measured.process->process != Process::wiener) return false;
  for (const double count : columns[0].count) {
    if (count != 0 && count != 1) return false;
  }
  UnitRows rows(model, columns);
  for (const std::vector<double>& x : trial_points(model)) {
    rows.move_to(x.data());
    const double middle = rows.population().middle[0];
    if (!in_proportion(rows, middle != 0 ? middle : 1)) return false;
  }
  return true;
}

StepUnits::StepUnits(UnitRows& rows)
    : rows_(rows),
      model_(rows.model()),
      column_(rows.columns()[0]),
      noisy_(has_noise(*column_.measured)),
      scaled_(noisy_ && !column_.measured->process->by_sd),
      mean_(column_.unit.size()),
      spread_(mean_.size()),
      noise_(mean_.size()),
      by_mean_(mean_.size()),
      by_spread_(mean_.size()),
      by_noise_(mean_.size()),
      alike_of_(mean_.size()),
      unit_(model_.units.size()) {}

std::size_t StepUnits::units() const {
  return model_.units.size();
}

void StepUnits::move() {
  base_ = rows_.population().middle[0];
  if (base_ == 0) base_ = 1;
  rows_.means_at(&base_, 0, mean_, spread_, noise_);
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    Unit& unit = unit_[u];
    unit.constant = unit.by_log = unit.by_inverse = unit.by_one = unit.by_square = 0;
    unit.alike.clear();
    if (noisy_) {
      add_noisy_steps(u);
      continue;
    }
    double mean = 0, reading = 0, spread = 0;
    for (std::size_t i = column_.begin[u]; i < column_.begin[u + 1]; ++i) {
      if (!(column_.count[i] > 0)) continue;
      const double y = column_.responses.rows[i].at;
      add_step(i, mean_[i] - mean, y - reading, spread_[i], spread, unit);
      mean = mean_[i];
      reading = y;
      spread = spread_[i];
    }
  }
}

void StepUnits::add_noisy_steps(std::size_t u) {
  Unit& unit = unit_[u];
  unit.noisy.clear(scaled_);
  double mean = 0, spread = 0;
  for (std::size_t i = column_.begin[u]; i < column_.begin[u + 1]; ++i) {
    if (!(column_.count[i] > 0)) continue;
    const double w = mean_[i] - mean, s = spread_[i], error = noise_[i] * noise_[i];
    const double v = scaled_ ? s * w : s * s - spread * spread;
    if (!(v >= 0 && v + error > 0 && std::isfinite(w) && std::isfinite(v + error))) {
      unit.constant = -infinity;
      return;
    }
    unit.noisy.add(w, v, error, column_.responses.rows[i].at);
    mean = mean_[i];
    spread = s;
  }
  if (scaled_) return;
  const NoisySteps::Quadratic all = unit.noisy.quadratic();
  const bool finite = std::isfinite(all.constant + all.by_one + all.by_square);
  unit.constant = finite ? all.constant : -infinity;
  unit.by_one = all.by_one;
  unit.by_square = all.by_square;
}

// The term of a step dy with mean q w.
void StepUnits::add_step(std::size_t row, double w, double dy, double spread, double before,
                         Unit& unit) {
  const ProcessForm& form = *column_.measured->process;
  if (form.process == Process::wiener) {
    const double v = form.by_sd ? spread * spread - before * before : spread * w;
    if (!(v > 0 && std::isfinite(w))) {
      unit.constant = -infinity;
      return;
    }
    unit.constant -= 0.5 * (log_two_pi + std::log(v));
    if (form.by_sd) {
      unit.constant -= 0.5 * dy * dy / v;
      unit.by_one += w * dy / v;
      unit.by_square -= 0.5 * w * w / v;
    } else {  // the variance is q v
      unit.constant += dy / spread;
      unit.by_log -= 0.5;
      unit.by_inverse -= 0.5 * dy * dy / v;
      unit.by_one -= 0.5 * w / spread;
    }
    return;
  }
  if (w == 0 && dy == 0) return;
  if (!(w > 0 && dy > 0 && spread > 0 && std::isfinite(w))) {
    unit.constant = -infinity;
    return;
  }
  const double log_dy = column_.log_growth[row], log_u = std::log(spread);
  if (form.process == Process::inverse_gaussian) {
    unit.constant += std::log(w) - 0.5 * (log_two_pi + log_u + 3 * log_dy) - 0.5 * dy / spread;
    unit.by_log += 1;
    unit.by_one += w / spread;
    unit.by_square -= 0.5 * w * w / (spread * dy);
    return;
  }
  const double shape = w / spread;
  unit.constant -= log_dy + dy / spread;  // log u cancels against a term of the density
  unit.by_one += shape * (log_dy - log_u);
  // Steps that differ only in their last digits are replaced by their mean: the error is of second
  // order.
  const auto same = std::find_if(unit.alike.begin(), unit.alike.end(), [&](const Alike& each) {
    return std::abs(each.shape - shape) < 1e-9 * shape;
  });
  alike_of_[row] = static_cast<std::size_t>(same - unit.alike.begin());
  if (same == unit.alike.end()) {
    unit.alike.push_back({1, shape});
  } else {
    same->count += 1;
    same->shape += (shape - same->shape) / same->count;
  }
}

double StepUnits::slope_of(const Unit& unit, double q) const {
  if (scaled_) return unit.noisy.at(q).slope;
  double slope = unit.by_log / q - unit.by_inverse / (q * q) + unit.by_one + 2 * unit.by_square * q;
  for (const Alike& each : unit.alike) {
    slope -= each.count * each.shape * digamma(q * each.shape);
  }
  return slope;
}

void StepUnits::evaluate(std::span<const double> z, std::span<const std::uint8_t> wanted,
                         std::span<double> value, std::span<double> slope) {
  const Population& population = rows_.population();
  const bool lognormal = model_.effects[0].lognormal;
  const bool positive = !column_.measured->process->by_sd;
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    if (!wanted[u]) continue;
    const Unit& unit = unit_[u];
    const double q = population.value(model_, 0, &z[u]) / base_;
    value[u] = -infinity;
    if (!slope.empty()) slope[u] = 0;
    if ((positive && !(q > least_factor)) || !std::isfinite(q) || !(unit.constant > -infinity))
      continue;
    double at = unit.constant + unit.by_one * q + unit.by_square * q * q;
    if (scaled_) {
      at = unit.noisy.at(q).value;
    } else if (positive) {
      const double log_q =
          lognormal && base_ == population.middle[0] ? population.scatter[0] * z[u] : std::log(q);
      at += unit.by_log * log_q + unit.by_inverse / q;
    }
    for (const Alike& each : unit.alike) {
      const double shape = q * each.shape;
      at -= shape >= least_gamma_argument ? each.count * std::lgamma(shape) : infinity;
    }
    if (!std::isfinite(at)) continue;
    value[u] = at;
    if (slope.empty()) continue;
    slope[u] = slope_of(unit, q) * population.scatter[0] * (lognormal ? q : 1 / base_);
    if (std::isfinite(slope[u])) continue;
    value[u] = -infinity;
    slope[u] = 0;
  }
}

// The contribution of a node to the slopes of the unit's log-likelihood.
void StepUnits::take(Unit& unit, double z, double weight, Moments& m, Population& by) const {
  const Population& population = rows_.population();
  const bool lognormal = model_.effects[0].lognormal;
  const double q = population.value(model_, 0, &z) / base_;
  m.one += weight * q;
  m.square += weight * q * q;
  m.inverse += weight / q;
  double slope = unit.by_log / q - unit.by_inverse / (q * q) + unit.by_one + 2 * unit.by_square * q;
  for (Alike& each : unit.alike) {
    const double psi = digamma(q * each.shape);
    each.slope += weight * q * psi;
    slope -= each.count * each.shape * psi;
  }
  by.middle[0] += weight * slope * (lognormal ? q / population.middle[0] : 1 / base_);
  by.scatter[0] += weight * slope * z * (lognormal ? q : 1 / base_);
}

// To the means and spreads of the unit's rows.
void StepUnits::give(std::size_t u, const Moments& m) {
  if (noisy_) return give_noisy(u, m);
  const Unit& unit = unit_[u];
  const ProcessForm& form = *column_.measured->process;
  std::size_t last = column_.unit.size();  // the previous row
  for (std::size_t i = column_.begin[u]; i < column_.begin[u + 1]; ++i) {
    if (!(column_.count[i] > 0)) continue;
    const bool first = last == column_.unit.size();
    const double w = mean_[i] - (first ? 0 : mean_[last]), s = spread_[i];
    const double before = first ? 0 : spread_[last];
    const double dy = column_.responses.rows[i].at - (first ? 0 : column_.responses.rows[last].at);
    double by_w = 0;
    if (form.process == Process::wiener && form.by_sd) {
      const double v = s * s - before * before;
      by_w = (m.one * dy - m.square * w) / v;
      const double by_v =
          -0.5 / v + 0.5 * (dy * dy - 2 * m.one * w * dy + m.square * w * w) / (v * v);
      by_spread_[i] += 2 * s * by_v;
      if (!first) by_spread_[last] -= 2 * before * by_v;
    } else if (form.process == Process::wiener) {
      const double square = dy * dy * m.inverse / w;
      by_w = -0.5 / w + 0.5 * (square / w - m.one) / s;
      by_spread_[i] += -0.5 / s + 0.5 * (square - 2 * dy + m.one * w) / (s * s);
    } else if (w == 0 && dy == 0) {
    } else if (form.process == Process::inverse_gaussian) {
      by_w = 1 / w + m.one / s - m.square * w / (s * dy);
      by_spread_[i] += -0.5 / s + 0.5 * (dy - 2 * m.one * w + m.square * w * w / dy) / (s * s);
    } else {
      const double shape = w / s, log_share = column_.log_growth[i] - std::log(s);
      const double by_shape = m.one * log_share - unit.alike[alike_of_[i]].slope;
      by_w = by_shape / s;
      by_spread_[i] += -shape / s * by_shape + (dy / s - m.one * shape) / s;
    }
    by_mean_[i] += by_w;
    if (!first) by_mean_[last] -= by_w;
    last = i;
  }
}

void StepUnits::add_gradient(const latent::UnitIntegrals& integrals, std::span<double> gradient) {
  begin_gradient();
  Population by;
  std::vector<double> z, weight;
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    z.clear();
    weight.clear();
    for (const latent::Sweep& sweep : integrals.sweeps) {
      if (!(sweep.weight[u] > 1e-14)) continue;
      z.push_back(sweep.z[u]);
      weight.push_back(sweep.weight[u]);
    }
    take_nodes(u, z, weight, by);
  }
  end_gradient(by, gradient);
}

void StepUnits::begin_gradient() {
  std::fill(by_mean_.begin(), by_mean_.end(), 0.0);
  std::fill(by_spread_.begin(), by_spread_.end(), 0.0);
  std::fill(by_noise_.begin(), by_noise_.end(), 0.0);
}

void StepUnits::take_nodes(std::size_t u, std::span<const double> z, std::span<const double> weight,
                           Population& by) {
  Unit& unit = unit_[u];
  if (scaled_) return take_noisy(u, z, weight, by);
  Moments m;
  for (Alike& each : unit.alike) each.slope = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (weight[i] > 1e-14) take(unit, z[i], weight[i], m, by);
  }
  give(u, m);
}

void StepUnits::end_gradient(const Population& by, std::span<double> gradient) {
  rows_.add_population_gradient(by, gradient);
  rows_.add_mean_gradient(&base_, 0, by_mean_, by_spread_, gradient,
                          noisy_ ? std::span<const double>(by_noise_) : std::span<const double>());
}

}  // namespace wearwell::formula_model
