#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "wearwell/regress/subset_search.h"

namespace wearwell {

/// How well a searched model predicts rows that the search has not seen (nested cross-validation):
/// the rows are cut into parts at random; without each part the whole search is done again, and
/// what it finds predicts the part. R2p of the winner of one search over all rows is optimistic, as
/// the rows predicted took part in choosing the terms; this is not.
struct Nested {
  std::string problem;  ///< why it was not done; empty when it was
  int folds = 0;        ///< parts
  double r2 = 0;        ///< 1 - sum w_i (y_i - prediction)^2 / sum w_i (y_i - mean)^2
  double r2_error = 0;  ///< its standard error, by the scatter of the summands over the rows
  double rmse = 0;      ///< root of the (weighted) mean square
  int unproven = 0;  ///< searches that were cut short: what they had found best predicted instead
};

/// From rows and what predicted them.
Nested nested_of(const Eigen::VectorXd& response, const Eigen::VectorXd& weights,
                 const Eigen::VectorXd& predicted, int folds);

/// Of search_subsets with these settings, criterion and forced terms. Each search may look at some
/// million rows of branches (`most_nodes`; the number of rows counts); it is stopped there. Does
/// not depend on the number of threads. Too few rows for a part to be spared are a `problem`, and
/// so is a search that is stopped by `settings.stop` or `settings.seconds`, all searches together.
Nested nested_search(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
                     const Eigen::VectorXd& weights, const SearchSettings& settings, int folds,
                     std::uint64_t seed);

}  // namespace wearwell
