#pragma once

#include <vector>

#include "wearwell/models/formula_model/formula_process.h"

namespace wearwell::formula_model {

/// Growth of the mean of a path until the path first has grown by `distance` (above 0), where
/// variances are `scale` times means: the p-quantile, in the unit of both. 0 < p < 1.
///
///   wiener            inverse Gaussian with mean `distance` and shape distance^2/scale
///   gamma             P(passed) = Q(m/scale, distance/scale), the incomplete gamma function
///   inverse_gaussian  P = Phi((m - d)/r) - exp(2 m/scale) Phi(-(m + d)/r), r^2 = scale d
double passage_quantile(Process process, double distance, double scale, double p);

/// The p-quantile of the growth of a path while its mean grows by `mean` above 0, in the same
/// terms.
double increment_quantile(Process process, double mean, double scale, double p);

/// Either of them at normal scores -4.8, -4.4 .. 4.8 from a table, to a relative 2e-5. The tails
/// beyond have a probability of 2e-6.
class ScoreTable {
 public:
  static const ScoreTable& passages(Process process);
  static const ScoreTable& increments(Process process);
  static constexpr int edges = 25;
  static constexpr double first_score = -4.8, score_step = 0.4;
  /// Of the scores: weights as nodes of the trapezoidal rule; they sum to 1.
  static const std::vector<double>& shares();
  /// Of a distance, or of a mean.
  void look_up(double size, double scale, double* values) const;

 private:
  using Quantile = double (*)(Process, double size, double scale, double p);
  ScoreTable(Process process, Quantile quantile);
  Process process_;
  Quantile quantile_;
  std::vector<double> log_value_;  // by size, then edge
};

}  // namespace wearwell::formula_model
