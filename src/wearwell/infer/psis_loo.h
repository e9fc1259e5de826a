#pragma once

#include <span>
#include <string>
#include <vector>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/infer/check.h"
#include "wearwell/infer/fit.h"

/// How well would the model have predicted each observation from all others? Leave-one-out
/// cross-validation without fitting anew: draws of the whole posterior, weighted by one over the
/// density of the observation that is left out, the largest weights smoothed by a generalized
/// Pareto law (Vehtari, Gelman, Gabry 2017, Statistics and Computing 27, 1413-1432; Vehtari,
/// Simpson, Gelman, Yao, Gabry 2024, JMLR 25(72)). The shape k-hat of that law says whether the
/// weights may be trusted. Conventions of the R package loo.
namespace wearwell {

/// P(X > x) = (1 + k x/sigma)^(-1/k).
struct GeneralizedPareto {
  double k = 0;
  double sigma = 1;

  double quantile(double p) const;
};

/// Zhang and Stephens (2009), Technometrics 51, 316-325, with k drawn towards 1/2 by the weight of
/// 10 observations, as in the second paper. `ascending` are positive.
GeneralizedPareto fit_generalized_pareto(std::span<const double> ascending);

/// Smooths the min(S/5, 3 sqrt(S)) largest of S importance weights in place (logarithms, up to a
/// constant) and returns k-hat; infinity where the tail has fewer than 5, 0 where all
/// of it are equal.
double pareto_smooth(std::vector<double>& log_weights);

/// Up to this k-hat weights from so many draws may be trusted: min(1 - 1/log10(S), 0.7).
double khat_threshold(double draws);

/// One factor of the likelihood, left out.
struct LooTerm {
  double elpd = 0;  ///< log density of the observation, predicted from all others
  double lpd = 0;   ///< the same, predicted from all with itself
  double khat = 0;
  int count = 1;          ///< as many observations were seen alike
  bool refitted = false;  ///< elpd is from the exact posterior of all others
  double tail = 1;  ///< how improbable all others make an observation so far out on its side, twice
                    ///< for either side; 1 where that was not asked for
};

struct Loo {
  std::vector<LooTerm> terms;
  double threshold = 0.7;
  bool by_quadrature = false;  ///< on the nodes of the exact posterior: no Monte Carlo error
  double error =
      0;  ///< of elpd: its Monte Carlo standard error; of a quadrature the estimated error

  double observations() const;
  double elpd() const;   ///< sum over observations; natural logarithm, data in SI
  double se() const;     ///< standard error of that sum
  double p_loo() const;  ///< effective number of parameters
  double khat_max() const;
  /// k-hat is above the threshold, and it was not fitted anew.
  bool doubtful(const LooTerm& term) const;
};

/// Empty terms when the likelihood is no product of observations. `draws` have one weight, and count
/// for `efficiency` times as many independent ones. `scores`, when given, are of the terms one by
/// one, and ask for their tails.
Loo psis_loo(const LogDensity& likelihood, const WeightedDraws& draws, double efficiency = 1,
             const Scores* scores = nullptr);

/// The same. Where `fit` holds an exact posterior the densities are integrated over its nodes, and
/// terms whose weights are uneven are fitted anew by quadrature; k-hat remains that of the draws.
Loo leave_one_out(const Posterior& posterior, const Fit& fit, const Scores* scores = nullptr);

/// The exact elpd of one term: quadrature of the posterior of all others; NaN where that fails.
double exact_elpd(const Posterior& posterior, const Whitening& whitening, std::size_t term);

/// Says which observations have a k-hat above the threshold, and whether the effective number of
/// parameters goes beyond the `parameters` there are; `noun` is what observations are ("row").
Check loo_check(const Loo& loo, const std::string& noun, int parameters);

/// elpd of a less that of b (0 of itself), with the standard error of the difference: sqrt(n) times the standard
/// deviation of the differences observation by observation.
struct ElpdDifference {
  double value = 0;
  double se = 0;
};
/// Throws std::invalid_argument when they leave out different observations.
ElpdDifference elpd_difference(std::span<const LooTerm> a, std::span<const LooTerm> b);

}  // namespace wearwell
