#include "wearwell/models/formula_model/mode_probability.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "wearwell/math/constants.h"
#include "wearwell/math/quadrature.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t most_parameters = most_response_parameters;

// The hazard and the survival of each mode at a life, as logarithms with derivatives.
struct ModesAt {
  std::vector<ResponseTerm> hazard, survival;
  double log_survival = 0;  // of the part

  ModesAt(const ModeLives& lives, double life) {
    for (std::size_t k = 0; k < lives.families.size(); ++k) {
      const double* own = lives.family_parameters + k * most_parameters;
      survival.push_back(log_response(lives.families[k], {Censoring::right, life}, own));
      hazard.push_back(log_response(lives.families[k], {Censoring::none, life}, own));
      hazard.back().value -= survival.back().value;
      for (std::size_t s = 0; s < most_parameters; ++s)
        hazard.back().slope[s] -= survival.back().slope[s];
      log_survival += survival.back().value;
    }
  }
};

// A sum of positive terms exp(value), with derivatives of the sum.
struct Sum {
  double value = 0;
  std::vector<double> slope;
};

// Nodes in (0, 1) with weights: Gauss-Legendre for a start; then double exponential (Takahasi and Mori 1974),
// for integrands with a power of the life near 0.
struct RuleNodes {
  std::vector<double> at, weight;
};

RuleNodes gauss_nodes() {
  RuleNodes nodes;
  const GaussLegendre rule = gauss_legendre(8);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    nodes.at.push_back(0.5 * (1 + rule.node[i]));
    nodes.weight.push_back(0.5 * rule.weight[i]);
  }
  return nodes;
}

RuleNodes double_exponential_nodes(double step) {
  constexpr double pi = 3.14159265358979323846, lowest = -5.2,
                   highest = 3.2;  // 1e-123 from 0, 1e-17 from 1
  RuleNodes nodes;
  for (double s = lowest; s <= highest; s += step) {
    const double e = std::exp(-pi * std::sinh(s));
    nodes.at.push_back(1 / (1 + e));
    nodes.weight.push_back(step * pi * std::cosh(s) * e / ((1 + e) * (1 + e)));
  }
  return nodes;
}

const std::vector<RuleNodes>& refinements() {
  static const std::vector<RuleNodes> all = [] {
    std::vector<RuleNodes> rules = {gauss_nodes()};
    for (const double step : {0.125, 0.0625, 0.03125, 0.015625, 0.0078125})
      rules.push_back(double_exponential_nodes(step));
    return rules;
  }();
  return all;
}

void add(Sum& sum, double weight, const ModesAt& at, std::size_t k) {
  if (!(weight > 0)) return;
  sum.value += weight;
  if (sum.slope.empty()) return;
  for (std::size_t s = 0; s < most_parameters; ++s)
    sum.slope[k * most_parameters + s] += weight * at.hazard[k].slope[s];
}

// The derivative of the survival of all modes.
void add_survival(Sum& sum, double weight, const ModesAt& at, const ModesAt& before) {
  if (!(weight > 0) || sum.slope.empty()) return;
  for (std::size_t k = 0; k < at.survival.size(); ++k) {
    for (std::size_t s = 0; s < most_parameters; ++s)
      sum.slope[k * most_parameters + s] +=
          weight * (at.survival[k].slope[s] - before.survival[k].slope[s]);
  }
}

// At 0 all survive, whatever the parameters.
ModesAt at_begin(const ModeLives& lives, double from) {
  if (from > 0) return {lives, from};
  ModesAt none(lives, 1);
  none.log_survival = 0;
  none.survival.assign(lives.families.size(), {});
  return none;
}

}  // namespace

ModeTerm log_hazard(const ModeLives& lives, std::uint32_t possible, double life,
                    std::span<double> slope) {
  const ModesAt at(lives, life);
  double most = -infinity, sum = 0;
  const auto is_possible = [&](std::size_t k) { return possible >> k & 1; };
  for (std::size_t k = 0; k < lives.families.size(); ++k)
    if (is_possible(k)) most = std::max(most, at.hazard[k].value);
  if (!(most > -infinity)) return {-infinity};
  for (std::size_t k = 0; k < lives.families.size(); ++k)
    if (is_possible(k)) sum += std::exp(at.hazard[k].value - most);
  std::fill(slope.begin(), slope.end(), 0.0);
  for (std::size_t k = 0; k < lives.families.size() && !slope.empty(); ++k) {
    const double share = is_possible(k) ? std::exp(at.hazard[k].value - most) / sum : 0;
    if (!(share > 0)) continue;
    for (std::size_t s = 0; s < most_parameters; ++s)
      slope[k * most_parameters + s] = share * at.hazard[k].slope[s];
  }
  return {most + std::log(sum)};
}

ModeTerm log_failure(const ModeLives& lives, std::uint32_t possible, double from, double until,
                     std::span<double> slope) {
  constexpr double close = 1e-9;
  const std::size_t modes = lives.families.size(), size = slope.size();
  const ModesAt before = at_begin(lives, from), after(lives, until);
  const double lasts = after.log_survival - before.log_survival, fails = -std::expm1(lasts);
  if (!(fails > 0)) return {-infinity};
  // d log(1 - S) = -S/(1 - S) dlog S.
  const double by_survival = -std::exp(lasts) / fails;
  std::fill(slope.begin(), slope.end(), 0.0);
  for (std::size_t j = 0; j < size && by_survival != 0; ++j) {
    const std::size_t k = j / most_parameters, s = j % most_parameters;
    slope[j] = by_survival * (after.survival[k].slope[s] - before.survival[k].slope[s]);
  }
  if (possible == (std::uint32_t{1} << modes) - 1) return {std::log(fails)};
  Sum some, all;
  double open = infinity;
  for (const RuleNodes& rule : refinements()) {
    if (from <= 0 && rule.at.size() < 10) continue;  // a power of the life at 0
    some = {0, std::vector<double>(size)};
    all = some;
    for (std::size_t j = 0; j < rule.at.size(); ++j) {
      const double life = from + (until - from) * rule.at[j];
      const ModesAt at(lives, life);
      const double survival =
          std::exp(at.log_survival - before.log_survival) * rule.weight[j] * (until - from);
      double possible_here = 0, any_here = 0;
      for (std::size_t k = 0; k < modes; ++k) {
        const double weight = survival * std::exp(at.hazard[k].value);
        if (!(weight > 0)) continue;
        any_here += weight;
        add(all, weight, at, k);
        if (!(possible >> k & 1)) continue;
        possible_here += weight;
        add(some, weight, at, k);
      }
      add_survival(some, possible_here, at, before);
      add_survival(all, any_here, at, before);
    }
    open = std::abs(all.value / fails - 1);
    if (open < close) break;
  }
  if (!(some.value > 0) || !(all.value > 0)) return {-infinity, open};
  for (std::size_t j = 0; j < size; ++j)
    slope[j] += some.slope[j] / some.value - all.slope[j] / all.value;
  return {std::log(fails) + std::log(some.value / all.value), open};
}

}  // namespace wearwell::formula_model
