#include "wearwell/models/formula_model/formula_linear.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/lognormal_unit.h"
#include "wearwell/models/formula_model/normal_unit.h"

// Longer than others: one special case of the likelihood, whose sums are all of one kind.
namespace wearwell::formula_model {

using Matrix2 = Eigen::Matrix2d;
using Vector2 = Eigen::Vector2d;

LinearUnits::LinearUnits(UnitRows& rows)
    : rows_(rows),
      model_(rows.model()),
      effects_(model_.effects.size()),
      parabola_(model_.units.size()),
      moments_(model_.units.size()) {
  std::size_t most = 0;
  for (const BoundColumn& column : rows.columns()) {
    for (auto& mean : mean_) mean.emplace_back(column.unit.size());
    sd_.emplace_back(column.unit.size());
    most = std::max(most, column.unit.size());
  }
  for (auto& each : by_mean_) each.resize(most);
  by_sd_.resize(most);
}

std::size_t LinearUnits::units() const {
  return model_.units.size();
}

void LinearUnits::move() {
  const Population& population = rows_.population();
  for (std::size_t e = 0; e < effects_; ++e) {
    base_[e] = population.middle[e];
    width_[e] = base_[e] != 0 ? std::abs(base_[e]) : population.scatter[e];
  }
  std::fill(parabola_.begin(), parabola_.end(), Parabola());
  for (std::size_t c = 0; c < rows_.columns().size(); ++c) {
    const BoundColumn& column = rows_.columns()[c];
    for (std::size_t r = 0; r <= effects_; ++r) {
      double at[2] = {base_[0], base_[1]};
      if (r > 0) at[r - 1] += width_[r - 1];
      rows_.means_at(at, c, mean_[r][c], sd_[c]);
    }
    for (std::size_t i = 0; i < column.unit.size(); ++i) {
      const double sd = sd_[c][i], mean = mean_[0][c][i];
      Parabola& p = parabola_[column.unit[i]];
      if (!(column.count[i] > 0)) continue;
      if (!(sd > 0 && std::isfinite(sd) && std::isfinite(mean))) {
        p.top = -infinity;
        continue;
      }
      const double weight = column.count[i] / (sd * sd), off = column.responses.at[i] - mean;
      const double d0 = mean_[1][c][i] - mean, d1 = effects_ > 1 ? mean_[2][c][i] - mean : 0;
      p.best[0] += weight * d0 * off;  // the slope, until all rows are summed
      p.best[1] += weight * d1 * off;
      p.bend[0] += weight * d0 * d0;
      p.bend[1] += weight * d0 * d1;
      p.bend[2] += weight * d1 * d1;
    }
  }
  for (Parabola& p : parabola_) {
    const double g0 = p.best[0], g1 = p.best[1];
    const double det = p.bend[0] * p.bend[2] - p.bend[1] * p.bend[1];
    const double trace = p.bend[0] + p.bend[2];
    if (effects_ > 1 && det > 1e-12 * p.bend[0] * p.bend[2]) {
      p.best[0] = (p.bend[2] * g0 - p.bend[1] * g1) / det;
      p.best[1] = (p.bend[0] * g1 - p.bend[1] * g0) / det;
    } else {  // along the only direction that the rows determine
      p.best[0] = trace > 0 ? g0 / trace : 0;
      p.best[1] = trace > 0 ? g1 / trace : 0;
    }
  }
  for (std::size_t c = 0; c < rows_.columns().size(); ++c) fill(c);
}

void LinearUnits::fill(std::size_t c) {
  const BoundColumn& column = rows_.columns()[c];
  double last = 0, log_sd = 0;
  for (std::size_t i = 0; i < column.unit.size(); ++i) {
    Parabola& p = parabola_[column.unit[i]];
    if (!(column.count[i] > 0) || !(p.top > -infinity)) continue;
    const double sd = sd_[c][i], mean = mean_[0][c][i];
    const double d0 = mean_[1][c][i] - mean, d1 = effects_ > 1 ? mean_[2][c][i] - mean : 0;
    const double z = (column.responses.at[i] - mean - d0 * p.best[0] - d1 * p.best[1]) / sd;
    if (sd != last) log_sd = std::log(last = sd);
    p.top -= column.count[i] * (log_sd + half_log_two_pi + 0.5 * z * z);
  }
}

void LinearUnits::steps(const double* z, double* step, double* effect) const {
  for (std::size_t e = 0; e < effects_; ++e) {
    effect[e] = rows_.population().value(model_, e, z);
    step[e] = (effect[e] - base_[e]) / width_[e];
  }
}

void LinearUnits::evaluate(std::span<const double> z, std::span<const std::uint8_t> wanted,
                           std::span<double> value, std::span<double> slope) {
  const Population& population = rows_.population();
  const double r = population.correlation, rest = std::sqrt(1 - r * r);
  for (std::size_t u = 0; u < parabola_.size(); ++u) {
    if (!wanted[u]) continue;
    const Parabola& p = parabola_[u];
    double s[2] = {}, effect[2] = {};
    steps(&z[u * effects_], s, effect);
    const double d0 = s[0] - p.best[0], d1 = effects_ > 1 ? s[1] - p.best[1] : 0;
    const double by0 = -(p.bend[0] * d0 + p.bend[1] * d1);
    const double by1 = -(p.bend[1] * d0 + p.bend[2] * d1);
    const double at = p.top + 0.5 * (by0 * d0 + by1 * d1);
    value[u] = std::isnan(at) ? -infinity : at;
    if (slope.empty()) continue;
    const auto by_own = [&](std::size_t e, double by) {
      return by / width_[e] * population.scatter[e] * (model_.effects[e].lognormal ? effect[e] : 1);
    };
    slope[u * effects_] = by_own(0, by0);
    if (effects_ == 1) continue;
    slope[u * effects_] += r * by_own(1, by1);
    slope[u * effects_ + 1] = rest * by_own(1, by1);
  }
}

bool LinearUnits::in_closed_form() const {
  const auto& effects = model_.effects;
  return std::none_of(effects.begin(), effects.end(), [](const auto& e) { return e.lognormal; });
}

Matrix2 LinearUnits::steps_of_z() const {
  const Population& population = rows_.population();
  Matrix2 A = Matrix2::Zero();
  A(0, 0) = population.scatter[0] / width_[0];
  if (effects_ == 1) return A;
  const double r = population.correlation, a = population.scatter[1] / width_[1];
  A(1, 0) = a * r;
  A(1, 1) = a * std::sqrt(1 - r * r);
  return A;
}

Vector2 LinearUnits::Parabola::at() const {
  return {best[0], best[1]};
}

Matrix2 LinearUnits::Parabola::H() const {
  Matrix2 H;
  H << bend[0], bend[1], bend[1], bend[2];
  return H;
}

EffectPair LinearUnits::pair(const Parabola& p) const {
  const Population& population = rows_.population();
  EffectPair pair{{p.best[0], p.best[1]}, {p.bend[0], p.bend[1], p.bend[2]}, {}, {}};
  for (std::size_t e = 0; e < 2; ++e) {
    pair.lognormal[e] = model_.effects[e].lognormal;
    pair.scatter[e] = population.scatter[e] / (pair.lognormal[e] ? 1 : width_[e]);
  }
  pair.correlation = population.correlation;
  return pair;
}

// Of exp(log likelihood - top) over the effects.
std::optional<double> LinearUnits::log_integral(const Parabola& p) {
  if (in_closed_form()) return NormalUnit(p.at(), p.H(), steps_of_z()).log_integral;
  if (effects_ == 2) return pair(p).log_integral(pair_nodes_);
  const LognormalUnit unit{p.best[0], p.bend[0], rows_.population().scatter[0]};
  auto integral = unit.log_integral(nullptr);
  if (integral) *integral -= half_log_two_pi;
  return integral;
}

bool LinearUnits::each(std::vector<double>& log_likelihood) {
  log_likelihood.assign(parabola_.size(), -infinity);
  for (std::size_t u = 0; u < parabola_.size(); ++u) {
    const Parabola& p = parabola_[u];
    if (!(p.top > -infinity)) continue;
    const auto integral = log_integral(p);
    if (!integral) return false;
    log_likelihood[u] = p.top + *integral;
  }
  return true;
}

bool LinearUnits::integrate(latent::UnitIntegrals& result) {
  if (effects_ == 1 && !model_.effects[0].lognormal) return false;
  result.restart(parabola_.size(), effects_);
  static thread_local std::vector<LognormalUnit::Node> nodes;
  for (std::size_t u = 0; u < parabola_.size(); ++u) {
    const Parabola& p = parabola_[u];
    if (!(p.top > -infinity)) continue;
    if (effects_ == 1) {
      const LognormalUnit unit{p.best[0], p.bend[0], rows_.population().scatter[0]};
      const auto integral = unit.log_integral(&nodes, LognormalUnit::fine);
      if (!integral) return false;
      result.log_likelihood[u] = p.top + *integral - half_log_two_pi;
      for (const auto& node : nodes) result.put(u, node.place, &node.z, node.weight);
      continue;
    }
    double open = 0;
    const auto integral = pair(p).log_integral(pair_nodes_, EffectPair::fine, &open);
    if (!integral) return false;
    if (open > 0) result.settled = false;
    result.unsettled += open;
    result.log_likelihood[u] = p.top + *integral;
    for (std::size_t l = 0; l < pair_nodes_.lines.size(); ++l) {
      const EffectPair::Nodes::Line& line = pair_nodes_.lines[l];
      for (std::size_t i = line.begin; i < pair_nodes_.end(l); ++i) {
        const double z[2] = {line.z0, pair_nodes_.z1[i]};
        result.put(u, i, z, pair_nodes_.share[i]);
      }
    }
  }
  result.finish();
  return true;
}

std::optional<double> LinearUnits::sum(std::span<double> gradient) {
  if (in_closed_form()) return sum_of_normal(gradient);
  return effects_ == 1 ? sum_of_lognormal(gradient) : sum_of_pairs(gradient);
}

std::optional<double> LinearUnits::sum_of_pairs(std::span<double> gradient) {
  // Where no rule holds and the integral is below this share of its integrand's top, its bound stands for it: places on the
  // way of a search, without any share of a posterior.
  constexpr double hopeless = -1e4;
  double sum = 0;
  Population by;
  for (std::size_t u = 0; u < parabola_.size(); ++u) {
    const Parabola& p = parabola_[u];
    if (!(p.top > -infinity)) return -infinity;
    const EffectPair unit = pair(p);
    auto integral = unit.log_integral(pair_nodes_);
    if (!integral && gradient.empty()) {
      if (const double bound = unit.log_bound(); bound < hopeless) integral = bound;
    }
    if (!integral) return {};
    sum += p.top + *integral;
    if (gradient.empty()) continue;
    const EffectPair::Moments m = unit.moments(pair_nodes_);
    moments_[u] = {{m.first[0], m.first[1]}, {m.second[0], m.second[1], m.second[2]}};
    for (std::size_t e = 0; e < 2; ++e) {
      by.middle[e] += m.slope[e] / width_[e];
      by.scatter[e] += m.slope_v[e] / (unit.lognormal[e] ? 1 : width_[e]);
    }
    if (model_.correlated) by.correlation += m.by_correlation;
  }
  if (!gradient.empty() && std::isfinite(sum)) add_gradient_of_moments(by, gradient);
  return sum;
}

double LinearUnits::sum_of_normal(std::span<double> gradient) {
  const Population& population = rows_.population();
  const Matrix2 A = steps_of_z();
  const double r = population.correlation, rest = std::sqrt(1 - r * r);
  double sum = 0;
  Population by;
  for (std::size_t u = 0; u < parabola_.size(); ++u) {
    const Parabola& p = parabola_[u];
    if (!(p.top > -infinity)) return -infinity;
    const Matrix2 H = p.H();
    const NormalUnit unit(p.at(), H, A);
    sum += p.top + unit.log_integral;
    if (gradient.empty()) continue;
    const Vector2 first = A * unit.mean;
    const Matrix2 second = A * unit.square * A.transpose();
    moments_[u] = {{first[0], first[1]}, {second(0, 0), second(0, 1), second(1, 1)}};
    // By steps, as means: of the slope itself, and of the slope times z.
    const Vector2 slope = -H * (first - p.at());
    const Matrix2 slope_z = -H * (A * unit.square - p.at() * unit.mean.transpose());
    by.middle[0] += slope[0] / width_[0];
    by.scatter[0] += slope_z(0, 0) / width_[0];
    if (effects_ == 1) continue;
    by.middle[1] += slope[1] / width_[1];
    by.scatter[1] += (r * slope_z(1, 0) + rest * slope_z(1, 1)) / width_[1];
    if (model_.correlated) {
      by.correlation +=
          population.scatter[1] / width_[1] * (slope_z(1, 0) - r / rest * slope_z(1, 1));
    }
  }
  if (!gradient.empty() && std::isfinite(sum)) add_gradient_of_moments(by, gradient);
  return sum;
}

std::optional<double> LinearUnits::sum_of_lognormal(std::span<double> gradient) {
  const Population& population = rows_.population();
  const double s = population.scatter[0], middle = population.middle[0];
  const bool sloped = !gradient.empty();
  double sum = 0;
  Population by;
  static thread_local std::vector<LognormalUnit::Node> nodes;
  for (std::size_t u = 0; u < parabola_.size(); ++u) {
    const Parabola& p = parabola_[u];
    Moments& m = moments_[u];
    if (!(p.top > -infinity)) return -infinity;
    const LognormalUnit unit{p.best[0], p.bend[0], s};
    const auto integral = unit.log_integral(sloped ? &nodes : nullptr);
    if (!integral) return {};
    sum += p.top + *integral - half_log_two_pi;
    if (!sloped) continue;
    m = {};
    double by_middle = 0, by_scatter = 0;
    for (const auto& node : nodes) {
      const double slope = -node.weight * unit.h * (node.step - unit.best) * (node.step + 1);
      m.first[0] += node.weight * node.step;
      m.second[0] += node.weight * node.step * node.step;
      by_middle += slope;
      by_scatter += slope * node.z;
    }
    by.middle[0] += by_middle / middle;
    by.scatter[0] += by_scatter;
  }
  if (sloped && std::isfinite(sum)) add_gradient_of_moments(by, gradient);
  return sum;
}

void LinearUnits::add_gradient(const latent::UnitIntegrals& integrals, std::span<double> gradient) {
  const Population& population = rows_.population();
  const double r = population.correlation, rest = std::sqrt(1 - r * r);
  std::fill(moments_.begin(), moments_.end(), Moments());
  Population by;
  for (const latent::Sweep& sweep : integrals.sweeps) {
    for (std::size_t u = 0; u < parabola_.size(); ++u) {
      const double weight = sweep.weight[u];
      if (!(weight > 1e-14)) continue;
      const double* z = &sweep.z[u * effects_];
      double s[2] = {}, effect[2] = {};
      steps(z, s, effect);
      Moments& m = moments_[u];
      m.first[0] += weight * s[0];
      m.first[1] += weight * s[1];
      m.second[0] += weight * s[0] * s[0];
      m.second[1] += weight * s[0] * s[1];
      m.second[2] += weight * s[1] * s[1];
      const Parabola& p = parabola_[u];
      const double d0 = s[0] - p.best[0], d1 = effects_ > 1 ? s[1] - p.best[1] : 0;
      const double slope[2] = {-(p.bend[0] * d0 + p.bend[1] * d1),
                               -(p.bend[1] * d0 + p.bend[2] * d1)};
      for (std::size_t e = 0; e < effects_; ++e) {
        const bool lognormal = model_.effects[e].lognormal;
        const double by_effect = weight * slope[e] / width_[e];
        const double own = e == 0 ? z[0] : r * z[0] + rest * z[1];
        by.middle[e] += by_effect * (lognormal ? effect[e] / base_[e] : 1);
        const double by_own = by_effect * (lognormal ? effect[e] : 1);
        by.scatter[e] += by_own * own;
        if (e == 1 && model_.correlated) {
          by.correlation += by_own * population.scatter[e] * (z[0] - r / rest * z[1]);
        }
      }
    }
  }
  add_gradient_of_moments(by, gradient);
}

void LinearUnits::add_gradient_of_moments(const Population& by, std::span<double> gradient) {
  rows_.add_population_gradient(by, gradient);
  for (std::size_t c = 0; c < rows_.columns().size(); ++c) {
    const BoundColumn& column = rows_.columns()[c];
    const std::size_t n = column.unit.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Moments& m = moments_[column.unit[i]];
      const double sd = sd_[c][i], inverse = 1 / (sd * sd);
      const double off = column.responses.at[i] - mean_[0][c][i];
      const double d0 = mean_[1][c][i] - mean_[0][c][i];
      const double d1 = effects_ > 1 ? mean_[2][c][i] - mean_[0][c][i] : 0;
      // Of the residual, times one, each step, and itself.
      const double rest_mean = off - d0 * m.first[0] - d1 * m.first[1];
      const double by_one = off * m.first[0] - d0 * m.second[0] - d1 * m.second[1];
      const double by_two = off * m.first[1] - d0 * m.second[1] - d1 * m.second[2];
      const double square = off * rest_mean - d0 * by_one - d1 * by_two;
      by_mean_[0][i] = (rest_mean - by_one - by_two) * inverse;
      by_mean_[1][i] = by_one * inverse;
      by_mean_[2][i] = by_two * inverse;
      by_sd_[i] = square * inverse / sd - 1 / sd;
    }
    for (std::size_t e = 0; e <= effects_; ++e) {
      double at[2] = {base_[0], base_[1]};
      if (e > 0) at[e - 1] += width_[e - 1];
      rows_.add_mean_gradient(
          at, c, {by_mean_[e].data(), n},
          e == 0 ? std::span<const double>(by_sd_.data(), n) : std::span<const double>(), gradient);
    }
  }
}

}  // namespace wearwell::formula_model
