#pragma once

#include <functional>

namespace wearwell {

/// The mean of X - from given X > from, of a positive X with median `middle`: the integral of the
/// survival function beyond `from`, over its value there. `log_survival` gives ln P(X > x) of x > 0.
/// Infinite where the tail falls no faster than x^-1.001; NaN where nothing is known to survive `from`
/// (its logarithm is NaN or -infinity) or the median is not positive and finite. Relative error 1e-8,
/// by adaptive Gauss-Kronrod quadrature in ln x.
double mean_beyond(const std::function<double(double x)>& log_survival, double middle,
                   double from = 0);

}  // namespace wearwell
