#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/formula_model/formula_path.h"
#include "wearwell/models/formula_model/life_at_point.h"

namespace wearwell::formula_model {

/// "1/h" of "h", "1/(1e6 cycles)" of "1e6 cycles".
std::string per_unit(const Unit& unit);

/// The life of a measured column as a risk.
Risk risk_of(std::shared_ptr<const Path> family_parameters, const Measured& measured);
/// The life of subpopulation k alone; the outputs of the path are its parameters.
Risk risk_of_subpopulation(std::shared_ptr<const Path> family_parameters, const Measured& measured,
                           std::size_t k);

/// A life as a likelihood's family gives it, or the earliest of several, under conditions: its derived
/// quantities over a posterior.
class LifeDistribution {
 public:
  explicit LifeDistribution(std::vector<Risk> risks);

  /// The predictive distribution: averaged over all uncertainty.
  class Next {
   public:
    double cdf(double life) const;
    double quantile(double p) const;
    /// The remaining life of an item that has survived to `from`: its p-quantile.
    double quantile(double p, double from) const;
    std::size_t components() const { return weights_.size(); }

   private:
    friend class LifeDistribution;
    void add(const LifeAtPoint& at, double weight);  // its components, without the lightest
    std::vector<Risk> risks_;
    std::vector<double> weights_, family_parameters_;  // of the components, risk by risk
    double middle_ = 1;
  };
  /// Over all points of a posterior, or over few if items vary, fewer the more components a life has (conditions that
  /// differ between units): then all functions below take a share of the points below 1, to estimate the dependence on
  /// the points. A value of two lives is over all points only if both are.
  bool over_all() const;
  Next next(const WeightedDraws& draws, double share_of_points = 1) const;

  /// A value over a posterior; if it is interpolated, with its relative error
  /// (predict/interpolated.h).
  struct Known {
    QuantityDistribution distribution;
    std::optional<double> misfit = {};
  };
  /// The life by which a share p of all has failed.
  Known quantile(const WeightedDraws& draws, double p, double share_of_points = 1) const;
  /// The same for those that have survived to `from`, from there on.
  Known quantile_beyond(const WeightedDraws& draws, double p, double from,
                        double share_of_points = 1) const;
  /// The share of all that outlasts a life.
  Known survival(const WeightedDraws& draws, double life, double share_of_points = 1) const;
  /// The mean life of those that have survived to `from`, from there on, over the posterior given
  /// that survival; infinite where the distribution has none. `from` is 0 for a new item.
  Known mean_beyond(const WeightedDraws& draws, double from, double share_of_points = 1) const;
  /// The share of that mean that comes from lives beyond `life`, averaged over the posterior given survival to `from`.
  double share_of_mean_beyond(const WeightedDraws& draws, double from, double life) const;
  /// The hazard rate at this life, per SI unit of life.
  Known hazard(const WeightedDraws& draws, double life, double share_of_points = 1) const;
  /// The share that has ended by this life through one of the risks.
  Known incidence(const WeightedDraws& draws, std::size_t risk, double life,
                  double share_of_points = 1) const;
  /// The share that fails at all.
  Known failing(const WeightedDraws& draws, double share_of_points = 1) const;
  /// With a rate of use: the share that fails before both an age and a use.
  Known failing_within(const WeightedDraws& draws, double age, double use,
                       double share_of_points = 1) const;
  /// The share of subpopulation k among the survivors of a life.
  Known share_among_survivors(const WeightedDraws& draws, std::size_t k, double life,
                              double share_of_points = 1) const;
  /// The p-quantile over that of `other`.
  Known ratio(const WeightedDraws& draws, const LifeDistribution& other, double p,
              double share_of_points = 1) const;
  /// The same of the lives in the middle of those that end (LifeAtPoint::middle).
  Known ratio_of_middles(const WeightedDraws& draws, const LifeDistribution& other,
                         double share_of_points = 1) const;
  /// The share that outlasts a life, less that of `other`.
  Known survival_difference(const WeightedDraws& draws, const LifeDistribution& other, double life,
                            double share_of_points = 1) const;
  /// The probability that an item lives longer than one of `other`.
  Known outliving(const WeightedDraws& draws, const LifeDistribution& other,
                  double share_of_points = 1) const;

  /// At single points of the parameters; this must outlive it.
  LifeAtPoint at_point() const { return LifeAtPoint(risks_); }
  /// Several independent lives, of which the earliest counts.
  bool is_earliest_of_several() const { return risks_.size() > 1; }

 private:
  WeightedDraws points(const WeightedDraws& draws, double share_of_points = 1) const;
  // Those given survival to `from`; empty if hardly any item survives.
  std::optional<WeightedDraws> survivors(const WeightedDraws& draws, double from,
                                         double share_of_points) const;
  static Known undetermined(const WeightedDraws& draws);
  // A value of both distributions at a point.
  template <class Value>
  Known compared(const WeightedDraws& draws, const LifeDistribution& other, const Value& value,
                 double share_of_points) const;
  // `other`: the value depends on this life, too.
  template <class Value>
  Known over(const WeightedDraws& draws, const Value& value, double share_of_points = 1,
             const LifeDistribution* other = nullptr) const;

  std::vector<Risk> risks_;
};

}  // namespace wearwell::formula_model
