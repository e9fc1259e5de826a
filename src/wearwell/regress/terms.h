#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

namespace wearwell {

/// A product of inputs, a column of a polynomial regression.
struct Term {
  std::vector<int> factors;  ///< indices of inputs, ascending, repeated for powers; empty: constant
  std::string name;          ///< "ds*ds*Td" for ds^2 Td; "1" for the constant
};

/// All products of at most `degree` of `inputs`, the constant first: by degree, then
/// lexicographically in the order of the inputs. Their number is binomial(inputs + degree, degree).
/// Throws InputError for no input, a repeated or empty name, a negative degree, more than 10,000
/// terms.
std::vector<Term> polynomial_terms(const std::vector<std::string>& inputs, int degree);

/// Terms evaluated at the data: rows x terms, each term scaled to [0, 1] as in Haramina et al.
/// (2025), eq. 13: x' = (x - minimum) / (maximum - minimum). The constant stays 1.
struct Design {
  std::vector<Term> terms;
  Eigen::MatrixXd columns;
  Eigen::VectorXd minimum;  ///< of each term in the units of the inputs; 0 for the constant
  Eigen::VectorXd range;    ///< maximum - minimum; 1 for the constant
};

/// Evaluates `terms` at `inputs` (rows x inputs). Throws InputError that names a value that is not
/// finite, or a term that is the same in every row.
Design make_design(const std::vector<Term>& terms, const Eigen::MatrixXd& inputs);

/// The terms of one model at new inputs (rows x inputs), with the scaling of `design`: rows x chosen.
/// `chosen`: indices of `design.terms`.
Eigen::MatrixXd scaled_terms(const Design& design, std::span<const int> chosen,
                             const Eigen::MatrixXd& inputs);

/// The model y = intercept + sum of coefficient[j] * (term j, unscaled).
struct OriginalCoefficients {
  double intercept = 0;          ///< implied by the scaling even if the model has no constant term
  double intercept_error = 0;    ///< standard error
  Eigen::VectorXd coefficients;  ///< one per chosen term; that of the constant is 0
  Eigen::VectorXd standard_errors;  ///< the same
};

/// From coefficients of the scaled terms `chosen` of `design` and their covariance, chosen x chosen,
/// in the unit of the response.
OriginalCoefficients original_coefficients(const Design& design, std::span<const int> chosen,
                                           const Eigen::VectorXd& coefficients,
                                           const Eigen::MatrixXd& covariance);

}  // namespace wearwell
