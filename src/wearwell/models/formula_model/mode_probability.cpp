#include "wearwell/models/formula_model/mode_probability.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "wearwell/math/constants.h"
#include "wearwell/math/quadrature.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t most_parameters = most_response_parameters;

// The hazard and the survival of each mode at a life, as logarithms; with derivatives where they are wanted.
struct ModesAt {
  std::vector<ResponseTerm> hazard, survival;
  double log_survival = 0;  // of the part
};

ModesAt modes_at_begin(const ModeLives& lives) {  // at 0 all survive, whatever the parameters
  const std::size_t modes = lives.families.size();
  return {std::vector<ResponseTerm>(modes), std::vector<ResponseTerm>(modes)};
}

void set(ModesAt& at, const ModeLives& lives, double life, bool with_slopes) {
  at.log_survival = 0;
  for (std::size_t k = 0; k < lives.families.size(); ++k) {
    const double* own = lives.family_parameters + k * most_parameters;
    const ResponseFamily family = lives.families[k];
    const Response lasts{Censoring::right, life}, fails{Censoring::none, life};
    ResponseTerm &survival = at.survival[k], &hazard = at.hazard[k];
    if (with_slopes) {
      survival = log_response(family, lasts, own);
      hazard = log_response(family, fails, own);
      for (std::size_t s = 0; s < most_parameters; ++s) hazard.slope[s] -= survival.slope[s];
    } else {
      survival.value = log_response_value(family, lasts, own);
      hazard.value = log_response_value(family, fails, own);
    }
    hazard.value -= survival.value;
    at.log_survival += survival.value;
  }
}

ModesAt modes_at(const ModeLives& lives, double life, bool with_slopes) {
  ModesAt at = modes_at_begin(lives);
  if (life > 0) set(at, lives, life, with_slopes);
  return at;
}

// By mode: the probability of a failure by it within an interval, of a part that has survived to its begin, and the
// derivatives by all parameters.
struct ByMode {
  std::vector<double> value, slope;
};

// Nodes in (0, 1) with weights: Gauss-Legendre for a start; then double exponential (Takahasi and Mori 1974),
// for integrands with a power of the life near 0.
struct RuleNodes {
  std::vector<double> at, weight;
};

RuleNodes gauss_nodes(int order) {
  RuleNodes nodes;
  const GaussLegendre rule = gauss_legendre(order);
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

struct Refinements {
  std::vector<RuleNodes> from_zero, elsewhere;
};

const Refinements& refinements() {
  static const Refinements all = [] {
    Refinements rules;
    for (const double step : {0.25, 0.125, 0.0625, 0.03125, 0.015625, 0.0078125})
      rules.from_zero.push_back(double_exponential_nodes(step));
    rules.elsewhere = {gauss_nodes(5), gauss_nodes(8)};
    rules.elsewhere.insert(rules.elsewhere.end(), rules.from_zero.begin() + 1,
                           rules.from_zero.end());
    return rules;
  }();
  return all;
}

void add(ByMode& sum, double width, const ModesAt& at, const ModesAt& before) {
  const std::size_t modes = at.hazard.size(), size = modes * most_parameters;
  const double survival = std::exp(at.log_survival - before.log_survival) * width;
  for (std::size_t k = 0; k < modes; ++k) {
    const double weight = survival * std::exp(at.hazard[k].value);
    if (!(weight > 0)) continue;
    sum.value[k] += weight;
    if (sum.slope.empty()) continue;
    double* slope = &sum.slope[k * size];
    for (std::size_t m = 0; m < modes; ++m) {
      for (std::size_t s = 0; s < most_parameters; ++s)
        slope[m * most_parameters + s] +=
            weight * (at.survival[m].slope[s] - before.survival[m].slope[s]);
    }
    for (std::size_t s = 0; s < most_parameters; ++s)
      slope[k * most_parameters + s] += weight * at.hazard[k].slope[s];
  }
}

// The modes of a set together.
ByMode total(const ByMode& modes, std::uint32_t set, std::size_t size) {
  ByMode sum{{0}, std::vector<double>(size)};
  for (std::size_t k = 0; k < modes.value.size(); ++k) {
    if (!(set >> k & 1)) continue;
    sum.value[0] += modes.value[k];
    for (std::size_t j = 0; j < size; ++j) sum.slope[j] += modes.slope[k * size + j];
  }
  return sum;
}

}  // namespace

ModeTerm log_hazard(const ModeLives& lives, std::uint32_t possible, double life,
                    std::span<double> slope) {
  const ModesAt at = modes_at(lives, life, !slope.empty());
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

void log_failures(const ModeLives& lives, std::span<const std::uint32_t> possible, double from,
                  double until, std::span<ModeTerm> terms, std::span<double> slopes) {
  constexpr double close = 1e-9;
  const bool with_slopes = !slopes.empty();
  const std::size_t modes = lives.families.size();
  const std::size_t size = with_slopes ? modes * most_parameters : 0;
  const std::uint32_t any = (std::uint32_t{1} << modes) - 1;
  const ModesAt before = modes_at(lives, from, with_slopes);
  ModesAt at = modes_at(lives, until, with_slopes);
  const double lasts = at.log_survival - before.log_survival, fails = -std::expm1(lasts);
  std::fill(slopes.begin(), slopes.end(), 0.0);
  std::fill(terms.begin(), terms.end(), ModeTerm{-infinity});
  if (!(fails > 0)) return;
  // d log(1 - S) = -S/(1 - S) dlog S.
  const double by_survival = -std::exp(lasts) / fails;
  std::vector<double> failed(size);
  for (std::size_t j = 0; j < size && by_survival != 0; ++j) {
    const std::size_t k = j / most_parameters, s = j % most_parameters;
    failed[j] = by_survival * (at.survival[k].slope[s] - before.survival[k].slope[s]);
  }
  ByMode by_mode;
  double open = infinity;
  const bool whole = std::all_of(possible.begin(), possible.end(),
                                 [any](std::uint32_t set) { return set == any; });
  for (const RuleNodes& rule : from > 0 ? refinements().elsewhere : refinements().from_zero) {
    if (whole) break;
    by_mode = {std::vector<double>(modes), std::vector<double>(modes * size)};
    for (std::size_t j = 0; j < rule.at.size(); ++j) {
      set(at, lives, from + (until - from) * rule.at[j], with_slopes);
      add(by_mode, rule.weight[j] * (until - from), at, before);
    }
    open = std::abs(total(by_mode, any, 0).value[0] / fails - 1);
    if (open < close) break;
  }
  const ByMode all = total(by_mode, any, size);
  for (std::size_t i = 0; i < possible.size(); ++i) {
    const std::span<double> slope = slopes.subspan(i * size, size);
    std::copy(failed.begin(), failed.end(), slope.begin());
    if (possible[i] == any) {
      terms[i] = {std::log(fails)};
      continue;
    }
    const ByMode some = total(by_mode, possible[i], size);
    terms[i].open = open;
    if (!(some.value[0] > 0) || !(all.value[0] > 0)) continue;
    for (std::size_t j = 0; j < size; ++j)
      slope[j] += some.slope[j] / some.value[0] - all.slope[j] / all.value[0];
    terms[i].value = std::log(fails) + std::log(some.value[0] / all.value[0]);
  }
}

}  // namespace wearwell::formula_model
