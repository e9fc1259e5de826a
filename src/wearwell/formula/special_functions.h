#pragma once

namespace wearwell::formula {

// Special functions that the loops call out of line. NaN where they have no value, and at poles.

double probit(double p);          ///< the standard normal quantile; infinite at 0 and 1
double gamma_function(double x);  ///< infinite where it overflows
double log_gamma(double x);       ///< the logarithm of its absolute value
double digamma(double x);         ///< the derivative of `log_gamma`
double trigamma(double x);        ///< the derivative of `digamma`

}  // namespace wearwell::formula
