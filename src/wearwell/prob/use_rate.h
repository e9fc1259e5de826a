#pragma once

#include <span>

#include "wearwell/prob/response.h"

namespace wearwell {

/// A unit whose life U is in use (distance, cycles, hours of operation) and which is used at its own constant rate R, the
/// use per time, independent of U. It fails at the age T = U / R:
///
///     P(T > t) = int S(r t) g(r) dr,   f_T(t) = int r f(r t) g(r) dr,
///
/// with the survival function S and density f of U, and the density g of R (Lawless, Hu and Cao 1995, Lifetime Data Anal. 1,
/// 227-240; Meeker, Escobar and Pascual 2022, Statistical Methods for Reliability Data, 2nd ed., on use-rate models). The age t
/// and use u of one failure together have the density f(u) g(u/t) u/t^2; the factor u/t^2 has no parameter.
///
/// The integrals are sums over equal steps of log r, whose error for these integrands falls exponentially with 1/step. The
/// sums over every second step give its estimate, and the step is halved until they agree within 1e-4, so that the
/// sum over all steps is within about 1e-8 (relative). Integrands are log-concave in log r: lives are Weibull, exponential,
/// lognormal, loglogistic or gamma, rates lognormal, Weibull or gamma.
bool can_be_life_at_rate(ResponseFamily family);
bool can_be_rate(ResponseFamily family);

/// Families with their parameters, SI.
struct LifeAtRate {
  ResponseFamily life, rate;
  const double *life_parameters, *rate_parameters;
};

/// While it lives, exact and right-censored ages in its thread that have the same families and parameters share their
/// integrals: those at equal steps of the logarithm of age, with a polynomial of degree 5 between, within 1e-6 of the
/// logarithm. For ages under few parameters only.
class SharedAges {
 public:
  SharedAges();
  ~SharedAges();
  SharedAges(const SharedAges&) = delete;
  SharedAges& operator=(const SharedAges&) = delete;
};

/// Log density or log probability of one age, without its entry; -infinity where a parameter is invalid, or so extreme
/// that the sum does not settle. `slope` has
/// `most_response_parameters` entries for the life and as many for the rate, or none.
double log_response(const LifeAtRate& unit, const Response& age, std::span<double> slope = {});

/// The probability to fail before both an age and a use: int F(min(use, r age)) g(r) dr, within 1e-9 of it and 1e-13.
/// Either may be infinite.
double failing_within(const LifeAtRate& unit, double age, double use);

/// The rate of a unit of which this is known of the age, at `share` of its distribution given that: between 0 and 1.
/// NaN where a parameter is invalid.
double rate_given(const LifeAtRate& unit, const Response& age, double share);

}  // namespace wearwell
