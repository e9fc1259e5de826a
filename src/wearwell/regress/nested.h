#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "wearwell/regress/subset_search.h"

namespace wearwell {

/// Prediction error of a searched model for rows outside the search (nested cross-validation): the
/// rows are divided into parts at random; without each part the whole search is repeated, and its
/// result predicts the part. R2p of the winner of one search over all rows is optimistic, since the
/// predicted rows took part in selecting the terms; this estimate is not.
struct Nested {
  std::string problem;  ///< reason why it was not done; empty if it was
  int folds = 0;        ///< parts
  double r2 = 0;        ///< 1 - sum w_i (y_i - prediction)^2 / sum w_i (y_i - mean)^2
  double r2_error = 0;  ///< its standard error, from the scatter of the summands over the rows
  double rmse = 0;      ///< root of the (weighted) mean square
  int unproven = 0;     ///< searches that were cut short: their best model so far predicted instead
};

/// From rows and their predictions.
Nested nested_of(const Eigen::VectorXd& response, const Eigen::VectorXd& weights,
                 const Eigen::VectorXd& predicted, int folds);

/// Of search_subsets with these settings, criterion and forced terms. Each search may visit some
/// million rows times branches (`most_nodes`; the number of rows counts); it then stops. Does not
/// depend on the number of threads. Too few rows for leaving out a part are a `problem`, and so is
/// a search stopped by `settings.stop` or `settings.seconds`, for all searches together.
Nested nested_search(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
                     const Eigen::VectorXd& weights, const SearchSettings& settings, int folds,
                     std::uint64_t seed);

}  // namespace wearwell
