#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/models/ownlaw/own_likelihood.h"
#include "wearwell/models/ownlaw/own_steps.h"
#include "wearwell/models/ownlaw/unit_rule.h"

namespace wearwell::ownlaw {
// Of the logarithm of a unit's integrand.
double StepUnits::slope_by_z(const Unit& unit, double z) const {
  const Population& population = rows_.population();
  const double q = population.value(law_, 0, &z) / base_;
  const double by_z = population.scatter[0] * (law_.effects[0].lognormal ? q : 1 / base_);
  return slope_of(unit, q) * by_z - z;
}

// Where a unit's integrand is highest, about: the secant's method within a bracket.
std::optional<StepUnits::Bell> StepUnits::bell(const Unit& unit) const {
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
      return Bell{z, 1 / std::sqrt(bend)};
    }
    next = z + std::clamp(slope / bend, -longest, longest);
  }
  return {};
}

// At some z together.
void StepUnits::log_densities(const Unit& unit, const double* z, double* log_f) const {
  constexpr std::size_t n = Nodes::together;
  const Population& population = rows_.population();
  const bool positive = !column_.measured->process->by_sd;
  double log_q[n], q[n];
  if (law_.effects[0].lognormal && base_ == population.middle[0]) {
    for (std::size_t i = 0; i < n; ++i) log_q[i] = population.scatter[0] * z[i];
    exp_all(log_q, q, n);
  } else {
    for (std::size_t i = 0; i < n; ++i) {
      q[i] = population.value(law_, 0, &z[i]) / base_;
      log_q[i] = positive ? std::log(q[i]) : 0;
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    double at = unit.constant + (unit.by_one + unit.by_square * q[i]) * q[i];
    if (positive) at += unit.by_log * log_q[i] + unit.by_inverse / q[i];
    for (const Alike& each : unit.alike) at -= each.count * std::lgamma(q[i] * each.shape);
    log_f[i] = (positive && !(q[i] > 0)) || !(at < infinity) ? -infinity : at - 0.5 * z[i] * z[i];
  }
}

// Nodes on both sides of the middle, until the integrand is e^-30 of its highest; false where there are too many.
bool StepUnits::lay(const Unit& unit, const Bell& about, double width) {
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

// The nodes and their shares are kept.
std::optional<double> StepUnits::integral(const Unit& unit) {
  const auto about = bell(unit);
  if (!about) return {};
  for (const double gap : rule_gaps) {
    const double width = gap * about->width;
    if (!lay(unit, *about, width)) return {};
    if (const auto log_integral = settled(nodes_, width)) return *log_integral - half_log_two_pi;
  }
  return {};
}

std::optional<double> StepUnits::sum(std::span<double> gradient) {
  double sum = 0;
  Population by;
  if (!gradient.empty()) {
    std::fill(by_mean_.begin(), by_mean_.end(), 0.0);
    std::fill(by_spread_.begin(), by_spread_.end(), 0.0);
  }
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    Unit& unit = unit_[u];
    if (!(unit.constant > -infinity)) return -infinity;
    const auto log_integral = integral(unit);
    if (!log_integral) return {};
    sum += *log_integral;
    if (gradient.empty()) continue;
    Moments m;
    for (Alike& each : unit.alike) each.slope = 0;
    for (std::size_t i = 0; i < nodes_.count; ++i) {
      if (nodes_.f[i] > 1e-14) take(unit, nodes_.z[i], nodes_.f[i], m, by);
    }
    give(u, m);
  }
  if (!gradient.empty() && std::isfinite(sum)) {
    rows_.add_population_gradient(by, gradient);
    rows_.add_mean_gradient(&base_, 0, by_mean_, by_spread_, gradient);
  }
  return sum;
}

bool StepUnits::each(std::vector<double>& log_likelihood) {
  log_likelihood.assign(unit_.size(), -infinity);
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    if (!(unit_[u].constant > -infinity)) continue;
    const auto log_integral = integral(unit_[u]);
    if (!log_integral) return false;
    log_likelihood[u] = *log_integral;
  }
  return true;
}

}  // namespace wearwell::ownlaw
