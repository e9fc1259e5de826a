#pragma once

#include <span>
#include <vector>

#include "wearwell/models/fatigue/damage.h"
#include "wearwell/models/fatigue/damage_sum.h"
#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/predict/thinned_posterior.h"
#include "wearwell/prognosis/weighted_lives.h"

namespace wearwell::fatigue {

/// A part that has survived cycles under several stresses and goes on under one: Miner's sum, for
/// each of a posterior's points and over the scatter. A part keeps its place in the scatter: at score
/// z of the standard distribution of lives its life under each stress is the curve's times
/// 10^(sigma z), with sigma of that stress, so it has used D(z) = sum of n/N(z). It fails when D
/// reaches the damage sum. With a random fatigue limit it keeps its own limit too, which is
/// independent of z and does not fall with damage; stresses below it do none. Only for distributions
/// on a logarithmic scale (SnLaw::logarithmic).
class PartDamage {
 public:
  /// `run`: counts of 0 or more. Law and points must outlive it.
  PartDamage(const SnLaw& law, const ThinnedPosterior& points, const LoadCycles& run,
             const Stress& ahead, const DamageSum& sum = {});

  /// log P(the part survives the run) at each point; minus infinity where it never does, or where the
  /// model has no life under one of the stresses.
  std::vector<double> log_survival() const;

  /// The remaining life [cycles] under the stress ahead, infinite if life has no end: mixed over the
  /// points with these weights, which include the survival of the run.
  prognosis::WeightedLives remaining(std::span<const double> weight) const;

  /// Quantiles of the used share of its damage sum, D over the sum, after so many further cycles
  /// [each `further`]; of parts that have survived the run, with weights as above. By `further`, then
  /// by level.
  std::vector<std::vector<double>> used(std::span<const double> weight,
                                        std::span<const double> further,
                                        std::span<const double> levels) const;

 private:
  // log10 of damage at score 0, and its decrease per score.
  struct Term {
    double log10_damage, sigma;
  };
  // Parts of one point with the same fatigue limit.
  struct Item {
    double share = 1;                // of the point's parts
    double used = 0;                 // damage at score 0, if sigma is the same for all terms
    double rate = 0;                 // the same of one cycle ahead; 0 if it does none
    double sigma = 0;                // of the stress ahead
    std::size_t first = 0, end = 0;  // of terms_, if sigma differs
  };
  // One damage sum of the distribution.
  struct Sum {
    double weight = 1, log10 = 0;
  };
  struct Point {
    std::size_t first = 0, end = 0;  // of items_
    double survival = 0;
    bool defined = true;
  };

  void read_sums(const DamageSum& sum, double least_sigma);
  void add_point(const double* x, std::size_t index, const LoadCycles& run, const Stress& ahead);
  void add_item(const double* x, double share, std::span<const double> lives,
                std::span<const double> sigmas, std::span<const double> counts);
  double score(const Item& item, double further, double log10_sum) const;
  double survivors(const Item& item, double further) const;
  double further_at(const Item& item, double z, double log10_sum) const;
  double left_after(std::span<const double> weight, double further) const;
  std::vector<double> places(std::span<const double> weight) const;
  double endless(std::span<const double> weight) const;

  const SnLaw& law_;
  const ThinnedPosterior& points_;
  std::vector<Point> point_;
  std::vector<Item> items_;
  std::vector<Term> terms_;
  std::vector<Sum> sums_;
  double widened_ = 0;  // standard deviation of log10 of the sum, where it joins a normal scatter
  double sum_median_ = 0, sum_sd_ = 0;  // of log10 of the damage sum
};

}  // namespace wearwell::fatigue
