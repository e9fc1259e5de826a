#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "wearwell/math/root.h"
#include "wearwell/models/formula_model/effect_lines.h"
#include "wearwell/models/formula_model/formula_drawn.h"
#include "wearwell/models/formula_model/formula_path.h"

namespace wearwell::formula_model {

/// A life as a likelihood's family gives it, under conditions; of several, the earliest ends the part's
/// life (failure_modes.h).
struct Risk {
  std::shared_ptr<const Path> family_parameters;  ///< output o is the family's parameter places[o]
  std::vector<std::size_t> places;
  LifeMixture life;  ///< one family, or a mixture
  bool positive = true;
};

/// Parameters in a row: those of each risk's life, one after the other.
std::size_t parameters_of(std::span<const Risk> risks);

/// A life at one point of the parameters: a mixture over the random effects of new items and over conditions that
/// differ between units, one distribution where there are none; or the earliest of several independent lives, without
/// random effects. One thread at a time.
///
/// Conditions: the rule is refined until lives at neighbouring nodes overlap. Shares of units that fail are then within
/// 2e-6 of the integral, as tests against closed forms and integrals in R find. Where even the finest rule is too coarse,
/// for lives that scatter far less than the conditions make them differ, `resolved` is false.
class LifeAtPoint {
 public:
  /// They must outlive this.
  explicit LifeAtPoint(std::span<const Risk> risks);

  /// Natural parameters, SI. Throws Cancelled (base/stop_scope.h).
  void move_to(const double* x);
  /// Whether the sum over conditions is as close to its integral as stated above.
  bool resolved() const { return resolved_; }
  bool varies() const { return varied_ != nullptr; }  ///< conditions differ between units

  /// The components: their weights, which sum to 1, and their families' parameters, risk by risk. With conditions
  /// that differ between units their number depends on the point.
  std::size_t size() const { return nodes_.weight.size() * conditions() * new_units_.count(); }
  double weight(std::size_t i) const;
  const double* slots(std::size_t i, std::size_t risk = 0) const {
    return &family_parameters_[i * stride_ + risk * most_response_parameters];
  }

  double cdf(double life) const;
  double log_survival(double life) const;  ///< with all digits far in the tail
  double log_density(double life) const;
  double hazard(double life) const;  ///< density over survival
  double quantile(double p) const;
  /// A life in the middle of those that end: the median, except where a share never fails or is dead on arrival.
  double middle() const;
  double failing() const;  ///< the share whose life ends at all
  /// The first varied condition, SI, of a node where a parameter of the life is not finite; none if all are.
  std::optional<double> undefined_condition() const;
  /// The share of subpopulation k among the survivors of a life.
  double share_among_survivors(std::size_t k, double life) const;
  /// With a rate of use: the share that fails before both an age and a use.
  double failing_within(double age, double use) const;
  /// The share of that mean that comes from lives beyond `life`: E[N - from; N > life]/E[N - from], given N > from.
  double share_of_mean_beyond(double from, double life) const;
  /// The mean life of survivors of `from`, from there on, of positive lives: in closed form (prob/mean_residual_life.h)
  /// or as an integral (math/mean_beyond.h).
  double mean_beyond(double from) const;
  /// The probability that an item outlives one of `other`: the integral of this survival function
  /// over the other's distribution, within 1e-8 and the 2e-10 of its tails. One that never fails is outlived by none.
  double outlives(const LifeAtPoint& other) const;
  /// The share that has ended by `life` through this risk: its cumulative incidence, within 1e-7 of it and
  /// 1e-9 of the share that this risk alone would end.
  double incidence(std::size_t risk, double life) const;

 private:
  bool single() const { return size() == 1 && risks_.size() == 1; }
  std::size_t conditions() const { return rule_ ? rule_->count() : 1; }
  void fill(const double* x);
  bool is_fine() const;
  double dead_share() const;
  double log_survival(std::size_t component, double life) const;  // of all risks
  double log_density(std::size_t component, double life) const;

  std::span<const Risk> risks_;
  bool positive_, resolved_ = true;
  const FormulaModel& model_;
  NormalNodes nodes_;
  NewUnits new_units_;
  std::vector<PathAt> paths_;
  std::size_t stride_;
  std::vector<double> family_parameters_;
  const VariedConditions* varied_;  // null if conditions are the same for all units
  const ConditionNodes* rule_ = nullptr;
  std::vector<double> z_;
  std::vector<std::vector<double>> varied_at_;  // by condition, of a block of nodes
};

/// log of the share that outlasts `life`, of risks with these parameters.
double log_survival_of(std::span<const Risk> risks, double life, const double* family_parameters);

/// The quantile p of a cdf, found from `middle`; for positive values in the logarithm, where the first bracket
/// is `step` on either side.
template <class F>
double quantile_of_cdf(const F& cdf, double p, double middle, bool positive, double step = 0.5) {
  if (!std::isfinite(middle)) return std::nan("");
  if (!positive) {
    return solve_increasing([&](double y) { return cdf(y) - p; }, middle,
                            std::max(1e-3 * std::abs(middle), 1e-12), {.relative = 1e-10});
  }
  return std::exp(solve_increasing([&](double log_y) { return cdf(std::exp(log_y)) - p; },
                                   std::log(middle), step, {.absolute = 1e-10}, -700, 700));
}

}  // namespace wearwell::formula_model
