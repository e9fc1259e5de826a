#include "wearwell/regress/terms.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"

namespace wearwell {
namespace {

constexpr std::size_t most_terms = 10'000;

std::string name_of(const std::vector<int>& factors, const std::vector<std::string>& inputs) {
  if (factors.empty()) return "1";
  std::vector<std::string> names;
  for (const int factor : factors) names.push_back(inputs[factor]);
  return fmt::format("{}", fmt::join(names, "*"));
}

/// The next ascending sequence of the same length in lexicographic order; false after the last.
bool advance(std::vector<int>& factors, int inputs) {
  auto position = factors.rbegin();
  while (position != factors.rend() && *position == inputs - 1) ++position;
  if (position == factors.rend()) return false;
  const int next = *position + 1;
  std::fill(factors.rbegin(), position + 1, next);
  return true;
}

Eigen::VectorXd values_of(const Term& term, const Eigen::MatrixXd& inputs) {
  Eigen::VectorXd values = Eigen::VectorXd::Ones(inputs.rows());
  for (const int factor : term.factors) values.array() *= inputs.col(factor).array();
  return values;
}

}  // namespace

std::vector<Term> polynomial_terms(const std::vector<std::string>& inputs, int degree) {
  if (inputs.empty()) throw InputError("a regression needs at least one input");
  if (degree < 0)
    throw InputError(fmt::format("the degree is {}; it must not be negative", degree));
  for (auto name = inputs.begin(); name != inputs.end(); ++name) {
    if (name->empty()) throw InputError("an input has no name");
    if (std::find(inputs.begin(), name, *name) != name)
      throw InputError(fmt::format("input '{}' occurs twice", *name));
  }
  std::vector<Term> terms;
  for (int d = 0; d <= degree; ++d) {
    std::vector<int> factors(d, 0);
    do {
      if (terms.size() == most_terms)
        throw InputError(fmt::format("degree {} in {} inputs has more than {} terms", degree,
                                     inputs.size(), most_terms));
      terms.push_back({factors, name_of(factors, inputs)});
    } while (advance(factors, static_cast<int>(inputs.size())));
  }
  return terms;
}

Design make_design(const std::vector<Term>& terms, const Eigen::MatrixXd& inputs) {
  const auto count = static_cast<Eigen::Index>(terms.size());
  Design design{terms, Eigen::MatrixXd(inputs.rows(), count), Eigen::VectorXd::Zero(count),
                Eigen::VectorXd::Ones(count)};
  for (Eigen::Index t = 0; t < count; ++t) {
    Eigen::VectorXd values = values_of(terms[t], inputs);
    for (Eigen::Index row = 0; row < values.size(); ++row) {
      if (!std::isfinite(values[row]))
        throw InputError(fmt::format("term '{}' is {} in row {}; it must be a finite number",
                                     terms[t].name, values[row], row + 1));
    }
    if (!terms[t].factors.empty()) {
      design.minimum[t] = values.minCoeff();
      design.range[t] = values.maxCoeff() - design.minimum[t];
      if (!(design.range[t] > 0))
        throw InputError(fmt::format("term '{}' is {} in every row; only the constant may be",
                                     terms[t].name, design.minimum[t]));
      values.array() = (values.array() - design.minimum[t]) / design.range[t];
    }
    design.columns.col(t) = values;
  }
  return design;
}

Eigen::MatrixXd scaled_terms(const Design& design, std::span<const int> chosen,
                             const Eigen::MatrixXd& inputs) {
  Eigen::MatrixXd columns(inputs.rows(), static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t j = 0; j < chosen.size(); ++j) {
    const int t = chosen[j];
    columns.col(static_cast<Eigen::Index>(j)) =
        (values_of(design.terms[t], inputs).array() - design.minimum[t]) / design.range[t];
  }
  return columns;
}

OriginalCoefficients original_coefficients(const Design& design, std::span<const int> chosen,
                                           const Eigen::VectorXd& coefficients,
                                           const Eigen::MatrixXd& covariance) {
  // With x' = (x - m)/r, b x' = (b/r) x - b m/r: linear in b, so the covariance follows.
  const auto count = static_cast<Eigen::Index>(chosen.size());
  Eigen::VectorXd to_intercept(count), to_coefficient(count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const int t = chosen[j];
    const bool constant = design.terms[t].factors.empty();
    to_intercept[j] = constant ? 1 : -design.minimum[t] / design.range[t];
    to_coefficient[j] = constant ? 0 : 1 / design.range[t];
  }
  OriginalCoefficients original;
  original.intercept = to_intercept.dot(coefficients);
  original.intercept_error = std::sqrt(to_intercept.dot(covariance * to_intercept));
  original.coefficients = to_coefficient.cwiseProduct(coefficients);
  original.standard_errors = to_coefficient.cwiseProduct(covariance.diagonal().cwiseSqrt());
  return original;
}

}  // namespace wearwell
