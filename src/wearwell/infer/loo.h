#pragma once

#include <span>
#include <string>
#include <vector>

#include "wearwell/infer/check.h"

/// The prediction of each observation from all others: leave-one-out cross-validation (Vehtari,
/// Gelman, Gabry 2017, Statistics and Computing 27, 1413-1432).
namespace wearwell {

/// One factor of the likelihood, left out.
struct LooTerm {
  double elpd = 0;        ///< log density of the observation, predicted from all others
  double lpd = 0;         ///< the same, predicted from all including itself
  double khat = 0;        ///< -infinity: more even weights than those of terms with a k-hat
                          ///< (loo_of_many.h)
  int count = 1;          ///< number of equal observations
  bool refitted = false;  ///< elpd is from the exact posterior of all others
  double tail = 1;        ///< two-sided tail probability of the observation given all others
                          ///< 1 if not requested
};

/// Above this k-hat the tails of 1/p extend noticeably beyond the nodes of the whole posterior;
/// such a term is refitted if quadrature is possible.
inline constexpr double refit_above = 0.5;

struct Loo {
  std::vector<LooTerm> terms;
  double threshold = 0.7;
  bool by_quadrature = false;  ///< on the nodes of the exact posterior: no Monte Carlo error
  double error = 0;  ///< of elpd: Monte Carlo standard error, or estimated error of a quadrature

  double observations() const;
  double elpd() const;   ///< sum over observations; natural logarithm, data in SI
  double se() const;     ///< standard error of that sum
  double p_loo() const;  ///< effective number of parameters
  double khat_max() const;
  /// k-hat is above the threshold, and the term was not refitted.
  bool doubtful(const LooTerm& term) const;
};

/// Thresholds above the number of parameters: the variation by chance with few observations
/// (tests/calibration/fit_check_test.cpp).
constexpr double p_loo_warns_above(int parameters) {
  return 2 * parameters + 2;
}
constexpr double p_loo_fails_above(int parameters) {
  return 10 * parameters + 10;
}

/// Reports observations with a k-hat above the threshold, and an effective number of parameters
/// above `parameters`; `noun` names an observation ("row").
Check loo_check(const Loo& loo, const std::string& noun, int parameters);

/// elpd of a minus that of b, with the standard error of the difference: sqrt(n) times the standard
/// deviation of the pointwise differences.
struct ElpdDifference {
  double value = 0;
  double se = 0;
};
/// Throws std::invalid_argument if they leave out different observations.
ElpdDifference elpd_difference(std::span<const LooTerm> a, std::span<const LooTerm> b);

}  // namespace wearwell
