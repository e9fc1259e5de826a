#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "wearwell/regress/nested.h"
#include "wearwell/regress/subset_search.h"
#include "wearwell/regress/terms.h"

namespace wearwell {

/// How terms are searched, and how the models found are validated.
struct SelectionSettings {
  SearchSettings search;
  int folds = 0;  ///< k-fold cross-validation of the models found; 0: none
  int fold_repeats = 20;
  /// Parts of the nested cross-validation; 0: none; negative: 10, up to `most_nested_rows` rows
  /// (with more, a search is hardly optimistic, and ten repetitions take long).
  int nested = -1;
  static constexpr int usual_nested = 10, most_nested_rows = 2000;
  std::uint64_t seed = 1;  ///< of the folds and of nested parts
};

/// The certainty of the selection of one term.
struct TermSupport {
  double inclusion = 0;  ///< share of the models found (those near the best) that contain it
  double weight = 0;     ///< sum of the stacking weights of the models that contain it
};

/// A subset search and the properties of its models.
struct Selection {
  SearchResult search;
  LinearFit fit;  ///< of the best model
  OriginalCoefficients original;
  /// Stacking weights of the first models of `search.models` from their leave-one-out residuals;
  /// models without these have none. At most `most_stacked`.
  static constexpr std::size_t most_stacked = 200;
  std::vector<double> weights;
  std::vector<TermSupport> support;  ///< by term of the design
  Nested nested;                     ///< of the whole search
  std::vector<double> k_fold_press;  ///< by model, the first `most_stacked`; empty without folds
};

/// Searches the terms of `design` and describes the outcome. `response` has one entry a row of
/// `design.columns`; `weights` likewise, 1/variance of a row, or empty. Throws InputError as
/// search_subsets. Where a search was stopped before it found any model, `search.models` and the rest
/// are empty.
Selection select_terms(const Design& design, const Eigen::VectorXd& response,
                       const Eigen::VectorXd& weights, const SelectionSettings& settings);

}  // namespace wearwell
