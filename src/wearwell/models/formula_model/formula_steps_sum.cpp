#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_steps.h"
#include "wearwell/models/formula_model/unit_rule.h"

namespace wearwell::formula_model {
// Of the logarithm of a unit's integrand.
double StepUnits::slope_by_z(const Unit& unit, double z) const {
  const Population& population = rows_.population();
  const double q = population.value(model_, 0, &z) / base_;
  const double by_z = population.scatter[0] * (model_.effects[0].lognormal ? q : 1 / base_);
  return slope_of(unit, q) * by_z - z;
}

// The approximate maximum of a unit's integrand: the secant method within a bracket.
std::optional<StepUnits::LaplaceApproximation> StepUnits::approximation(const Unit& unit) const {
  constexpr double close = 0.1, longest = 3, probe = 0.02;
  constexpr int most_rounds = 40;
  double z = 0, slope = slope_by_z(unit, z), low = -infinity, high = infinity;
  double next = std::copysign(probe, slope);
  for (int round = 0; round < most_rounds && std::isfinite(slope); ++round) {
    (slope > 0 ? low : high) = z;
    if (round > 0 && !(next > low && next < high)) next = 0.5 * (low + high);
    if (!std::isfinite(next)) return {};
    const double there = slope_by_z(unit, next), by_secant = -(there - slope) / (next - z);
    const double bend = by_secant > 0 ? by_secant : std::max(1.0, std::abs(by_secant));
    z = next;
    slope = there;
    if (round > 0 && by_secant > 0 && std::abs(slope) < close * std::sqrt(bend)) {
      return LaplaceApproximation{z, 1 / std::sqrt(bend)};
    }
    next = z + std::clamp(slope / bend, -longest, longest);
  }
  return {};
}

// At several z together.
void StepUnits::log_densities(const Unit& unit, const double* z, double* log_f) const {
  constexpr std::size_t n = Nodes::together;
  const Population& population = rows_.population();
  const bool positive = !column_.measured->process->by_sd;
  double log_q[n], q[n];
  if (model_.effects[0].lognormal && base_ == population.middle[0]) {
    for (std::size_t i = 0; i < n; ++i) log_q[i] = population.scatter[0] * z[i];
    exp_all(log_q, q, n);
  } else {
    for (std::size_t i = 0; i < n; ++i) {
      q[i] = population.value(model_, 0, &z[i]) / base_;
      log_q[i] = positive ? std::log(q[i]) : 0;
    }
  }
  if (scaled_) {
    unit.noisy.log_densities(q, log_f);
    for (std::size_t i = 0; i < n; ++i) {
      const bool whole = q[i] > 0 && log_f[i] < infinity;
      log_f[i] = whole ? log_f[i] - 0.5 * z[i] * z[i] : -infinity;
    }
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    double at = unit.constant + (unit.by_one + unit.by_square * q[i]) * q[i];
    if (positive) at += unit.by_log * log_q[i] + unit.by_inverse / q[i];
    for (const Alike& each : unit.alike) at -= each.count * std::lgamma(q[i] * each.shape);
    log_f[i] = (positive && !(q[i] > 0)) || !(at < infinity) ? -infinity : at - 0.5 * z[i] * z[i];
  }
}

// Nodes on both sides of the mode, until the integrand is e^-30 of its maximum; false if there are
// too many.
bool StepUnits::rebuild(const Unit& unit, const LaplaceApproximation& about, double width) {
  constexpr std::size_t n = Nodes::together;
  nodes_.count = 0;
  double highest = -infinity;
  for (const int way : {1, -1}) {
    for (int first = way > 0 ? 0 : 1;; first += static_cast<int>(n)) {
      if (nodes_.count + n > Nodes::most) return false;
      double* z = &nodes_.z[nodes_.count];
      double* log_f = &nodes_.f[nodes_.count];
      for (std::size_t i = 0; i < n; ++i) {
        const int place = first + static_cast<int>(i);
        z[i] = about.center + way * place * width;
        nodes_.odd[nodes_.count + i] = place % 2 != 0;
      }
      log_densities(unit, z, log_f);
      for (std::size_t i = 0; i < n; ++i) highest = std::max(highest, log_f[i]);
      nodes_.count += n;
      if (!(log_f[n - 1] > highest - rule_fallen)) break;
    }
  }
  return highest > -infinity;
}

// Keeps the nodes and their weights.
std::optional<double> StepUnits::integral(const Unit& unit, std::span<const double> gaps) {
  const auto about = approximation(unit);
  if (!about) return {};
  for (const double gap : gaps) {
    const double width = gap * about->width;
    if (!rebuild(unit, *about, width)) return {};
    if (const auto log_integral = settled(nodes_, width)) return *log_integral - half_log_two_pi;
  }
  return {};
}

// A unit whose log-likelihood is quadratic in q, with a lognormal effect.
std::optional<LognormalUnit> StepUnits::quadratic(const Unit& unit) const {
  const Population& population = rows_.population();
  const bool lognormal = model_.effects[0].lognormal && base_ == population.middle[0];
  if (scaled_ || !lognormal || !unit.alike.empty()) return {};
  if (unit.by_log != 0 || unit.by_inverse != 0 || !(unit.by_square < 0)) return {};
  const double h = -2 * unit.by_square;
  return LognormalUnit{unit.by_one / h - 1, h, population.scatter[0]};
}

// Where the nodes are not needed all of them are evaluated at once.
std::optional<double> StepUnits::quick_integral(const Unit& unit, bool with_nodes) {
  if (const auto form = quadratic(unit)) {
    if (const auto log_integral = form->log_integral(with_nodes ? &kept_ : nullptr);
        log_integral && (!with_nodes || kept_.size() <= Nodes::most)) {
      nodes_.count = 0;
      for (std::size_t i = 0; with_nodes && i < kept_.size(); ++i) {
        nodes_.z[i] = kept_[i].z;
        nodes_.f[i] = kept_[i].weight;
        ++nodes_.count;
      }
      const double top = unit.constant + 0.5 * unit.by_one * (unit.by_one / form->h);
      return top + *log_integral - half_log_two_pi;
    }
  }
  return integral(unit, rule_gaps);
}

std::optional<double> StepUnits::sum(std::span<double> gradient) {
  double sum = 0;
  Population by;
  if (!gradient.empty()) begin_gradient();
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    Unit& unit = unit_[u];
    if (!(unit.constant > -infinity)) return -infinity;
    const auto log_integral = quick_integral(unit, !gradient.empty());
    if (!log_integral) return {};
    sum += *log_integral;
    if (gradient.empty()) continue;
    take_nodes(u, std::span(nodes_.z).first(nodes_.count), std::span(nodes_.f).first(nodes_.count),
               by);
  }
  if (!gradient.empty() && std::isfinite(sum)) end_gradient(by, gradient);
  return sum;
}

// Passes the derivatives of a unit's steps to its rows.
void StepUnits::give_slopes(std::size_t u) {
  std::size_t last = column_.unit.size(), step = 0;  // the previous row
  for (std::size_t i = column_.begin[u]; i < column_.begin[u + 1]; ++i) {
    if (!(column_.count[i] > 0)) continue;
    const bool first = last == column_.unit.size();
    double by_growth = slopes_.growth[step];
    const double by_variance = slopes_.variance[step];
    if (scaled_) {
      by_growth += spread_[i] * by_variance;
      by_spread_[i] += unit_[u].noisy[step].growth * by_variance;
    } else {
      by_spread_[i] += 2 * spread_[i] * by_variance;
      if (!first) by_spread_[last] -= 2 * spread_[last] * by_variance;
    }
    by_mean_[i] += by_growth;
    if (!first) by_mean_[last] -= by_growth;
    by_noise_[i] += 2 * noise_[i] * slopes_.noise[step];
    last = i;
    ++step;
  }
}

// The mean of a quadratic function is that of its values one standard deviation to both sides of
// the center.
void StepUnits::give_noisy(std::size_t u, const Moments& m) {
  const double away = std::sqrt(std::max(0.0, m.square - m.one * m.one));
  double q[NoisySteps::together] = {m.one + away, m.one - away}, by_q[NoisySteps::together];
  const double weight[NoisySteps::together] = {0.5, 0.5};
  std::fill(q + 2, q + NoisySteps::together, m.one);
  slopes_.restart(unit_[u].noisy.count());
  unit_[u].noisy.add_slopes(q, weight, slopes_, by_q);
  give_slopes(u);
}

void StepUnits::take_noisy(std::size_t u, std::span<const double> z, std::span<const double> weight,
                           Population& by) {
  constexpr std::size_t n = NoisySteps::together;
  const Population& population = rows_.population();
  const bool lognormal = model_.effects[0].lognormal;
  const NoisySteps& steps = unit_[u].noisy;
  slopes_.restart(steps.count());
  for (std::size_t first = 0; first < z.size(); first += n) {
    double q[n], share[n] = {}, by_q[n];
    bool any = false;
    std::fill_n(q, n, 1.0);
    for (std::size_t k = 0; k < std::min(n, z.size() - first); ++k) {
      if (!(weight[first + k] > 1e-14)) continue;
      q[k] = population.value(model_, 0, &z[first + k]) / base_;
      share[k] = weight[first + k];
      any = true;
    }
    if (!any) continue;
    steps.add_slopes(q, share, slopes_, by_q);
    for (std::size_t k = 0; k < n; ++k) {
      if (!(share[k] > 0)) continue;
      by.middle[0] += share[k] * by_q[k] * (lognormal ? q[k] / population.middle[0] : 1 / base_);
      by.scatter[0] += share[k] * by_q[k] * z[first + k] * (lognormal ? q[k] : 1 / base_);
    }
  }
  give_slopes(u);
}

bool StepUnits::each(std::vector<double>& log_likelihood) {
  log_likelihood.assign(unit_.size(), -infinity);
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    if (!(unit_[u].constant > -infinity)) continue;
    const auto log_integral = quick_integral(unit_[u], false);
    if (!log_integral) return false;
    log_likelihood[u] = *log_integral;
  }
  return true;
}

// Lives are mixed over the nodes, which are denser than sums need.
bool StepUnits::integrate(latent::UnitIntegrals& result) {
  constexpr double gaps[] = {0.25, 0.125};
  if (!noisy_) return false;
  result.restart(unit_.size(), 1);
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    if (!(unit_[u].constant > -infinity)) continue;
    const auto log_integral = integral(unit_[u], gaps);
    if (!log_integral) return false;
    result.log_likelihood[u] = *log_integral;
    std::size_t place = 0;
    for (std::size_t i = 0; i < nodes_.count; ++i) {
      if (nodes_.f[i] > 0) result.put(u, place++, &nodes_.z[i], nodes_.f[i]);
    }
  }
  result.finish();
  return true;
}

}  // namespace wearwell::formula_model
