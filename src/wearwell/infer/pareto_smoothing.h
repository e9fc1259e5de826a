#pragma once

#include <span>
#include <vector>

/// Importance weights with the largest smoothed by a generalized Pareto distribution (Vehtari,
/// Simpson, Gelman, Yao, Gabry 2024, JMLR 25(72)). Its shape k-hat shows whether the weights are
/// reliable. Conventions of the R package loo.
namespace wearwell {

/// P(X > x) = (1 + k x/sigma)^(-1/k).
struct GeneralizedPareto {
  double k = 0;
  double sigma = 1;

  double quantile(double p) const;
};

/// Zhang and Stephens (2009), Technometrics 51, 316-325, with k shrunk towards 1/2 with the weight
/// of 10 observations, as in that paper. `ascending` are positive.
GeneralizedPareto fit_generalized_pareto(std::span<const double> ascending);

/// Smooths the min(S/5, 3 sqrt(S)) largest of S importance weights in place (logarithms, up to a
/// constant) and returns k-hat; infinity if the tail has fewer than 5, 0 if all of it are equal.
double pareto_smooth(std::vector<double>& log_weights);

/// The largest reliable k-hat for this number of draws: min(1 - 1/log10(S), 0.7).
double khat_threshold(double draws);

}  // namespace wearwell
