#pragma once

namespace wearwell::formula {

/// Distributions without elementary functions, in standard form with one parameter, as `prob` has
/// them: gamma and its shape (scale 1); inverse Gaussian and its shape (mean 1); generalized gamma
/// of omega = log(y/scale)/sigma and its lambda (prob/generalized_gamma.h); Student t and its
/// degrees of freedom (location 0, scale 1).
enum class Standard { gamma, inverse_gaussian, generalized_gamma, student_t };

// The loops call these out of line. NaN for a parameter or probability that does not exist.

double standard_cdf(Standard family, double x, double parameter);
double standard_survival(Standard family, double x, double parameter);
double standard_pdf(Standard family, double x, double parameter);
double standard_quantile(Standard family, double p, double parameter);

// Derivatives by the parameter; that of the quantile is at the quantile x.
double cdf_slope(Standard family, double x, double parameter);
double survival_slope(Standard family, double x, double parameter);
double pdf_slope(Standard family, double x, double parameter);
double quantile_slope(Standard family, double x, double parameter);
double pdf_slope_by_x(Standard family, double x, double parameter);

}  // namespace wearwell::formula
