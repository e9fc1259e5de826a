#include "wearwell/formula/special_functions.h"

#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "wearwell/math/constants.h"

namespace wearwell::formula {
namespace {

namespace policies = boost::math::policies;
// In double, and without exceptions: a value that does not exist is NaN.
constexpr policies::policy<
    policies::promote_double<false>, policies::domain_error<policies::ignore_error>,
    policies::pole_error<policies::ignore_error>, policies::overflow_error<policies::ignore_error>,
    policies::evaluation_error<policies::ignore_error>>
    quiet;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool has_gamma(double x) {
  return x > 0 ? x < infinity : x != std::floor(x);
}

}  // namespace

double probit(double p) {
  if (p == 0) return -infinity;
  if (p == 1) return infinity;
  if (!(p > 0 && p < 1)) return nan;
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * p, quiet);
}

double gamma_function(double x) {
  return has_gamma(x) ? boost::math::tgamma(x, quiet) : x == infinity ? x : nan;
}

double log_gamma(double x) {
  return has_gamma(x) ? boost::math::lgamma(x, quiet) : x == infinity ? x : nan;
}

double digamma(double x) {
  return has_gamma(x) ? boost::math::digamma(x, quiet) : x == infinity ? x : nan;
}

double trigamma(double x) {
  return has_gamma(x) ? boost::math::trigamma(x, quiet) : x == infinity ? 0 : nan;
}

}  // namespace wearwell::formula
