#pragma once

#include <span>
#include <string>
#include <vector>

#include "wearwell/infer/check.h"

/// How well would the model have predicted each observation from all others? Leave-one-out
/// cross-validation (Vehtari, Gelman, Gabry 2017, Statistics and Computing 27, 1413-1432).
namespace wearwell {

/// One factor of the likelihood, left out.
struct LooTerm {
  double elpd = 0;  ///< log density of the observation, predicted from all others
  double lpd = 0;   ///< the same, predicted from all with itself
  double khat = 0;  ///< -infinity: weights more even than of those that have one (loo_of_many.h)
  int count = 1;    ///< as many observations were seen alike
  bool refitted = false;  ///< elpd is from the exact posterior of all others
  double tail = 1;  ///< how improbable all others make an observation so far out on its side, twice
                    ///< for either side; 1 where that was not asked for
};

/// Above this k-hat the tails of 1/p reach noticeably beyond the nodes of the whole posterior: where
/// quadrature reaches, such a term is fitted anew.
inline constexpr double refit_above = 0.5;

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

/// Beyond as many parameters as there are and what few observations may add by chance; and beyond
/// what chance may add (tests/calibration/fit_check_test.cpp).
constexpr double p_loo_warns_above(int parameters) {
  return 2 * parameters + 2;
}
constexpr double p_loo_fails_above(int parameters) {
  return 10 * parameters + 10;
}

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
