#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "wearwell/regress/selection.h"

namespace wearwell {

/// A selection of terms with what its writers need to describe it.
struct SelectionResult {
  std::string version;
  std::string data_file, data_sha1, sql;       ///< sql: empty without
  std::vector<std::string> data_remarks = {};  ///< notes on reading the table
  std::string response;                        ///< column
  std::string weights_column;                  ///< empty without
  std::vector<std::string> inputs;             ///< columns of `input_values`
  Eigen::MatrixXd input_values;                ///< rows x inputs
  Design design;
  Eigen::VectorXd observed, weights;
  SelectionSettings settings;
  Selection selection;

  std::vector<std::string> names(const std::vector<int>& terms) const {
    std::vector<std::string> names;
    for (const int term : terms) names.push_back(design.terms[term].name);
    return names;
  }
};

/// One coefficient of the best model. A constant has its value in original units and its inclusion
/// like any term; if the model has none, a last row has the intercept implied by scaling.
struct CoefficientRow {
  std::string term;
  /// false for an intercept that is not a term: `scaled` and `inclusion` unset
  bool selected = true;
  double scaled = 0, scaled_error = 0;
  double original = 0, original_error = 0;
  double inclusion = 0;  ///< share of the models found that contain the term
};

std::vector<CoefficientRow> coefficient_rows(const SelectionResult& result);

/// The difference of `model` from `other`: "- a*b + a*a"; empty if they are equal.
std::string difference(const SelectionResult& result, const std::vector<int>& model,
                       const std::vector<int>& other);

/// The name of the criterion with its value: "PRESS", "AIC", ...
std::string criterion_title(Criterion criterion);

}  // namespace wearwell
