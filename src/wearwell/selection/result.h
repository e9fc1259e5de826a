#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "wearwell/regress/selection.h"

namespace wearwell {

/// A selection of terms with what its writers need to speak of it.
struct SelectionResult {
  std::string version;
  std::string data_file, data_sha1, sql;       ///< sql: empty without
  std::vector<std::string> data_remarks = {};  ///< on how the table was read
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
/// like any term; where the model has none, a last row holds the intercept that scaling leaves.
struct CoefficientRow {
  std::string term;
  bool selected = true;  ///< false for an intercept that is no term: `scaled` and `inclusion` unset
  double scaled = 0, scaled_error = 0;
  double original = 0, original_error = 0;
  double inclusion = 0;  ///< share of the models found that hold the term
};

std::vector<CoefficientRow> coefficient_rows(const SelectionResult& result);

/// How `model` differs from `other`: "- a*b + a*a"; empty when they are the same.
std::string difference(const SelectionResult& result, const std::vector<int>& model,
                       const std::vector<int>& other);

/// What the criterion is called where its value stands: "PRESS", "AIC", ...
std::string criterion_title(Criterion criterion);

}  // namespace wearwell
