#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace wearwell {

/// The rows 0 ... rows - 1 in `folds` random parts of nearly equal size. Partition `number` owns
/// that random stream of the seed.
std::vector<std::vector<Eigen::Index>> random_folds(Eigen::Index rows, int folds,
                                                    std::uint64_t seed, std::uint64_t number);

/// k-fold cross-validation of one least-squares model: the sum of w_i (y_i - prediction by the fit
/// to the other folds)^2, averaged over `repeats` random partitions of the rows into `folds` parts
/// of nearly equal size. With as many folds as rows it is PRESS. Infinite if a part alone
/// determines a coefficient.
///
/// A heuristic: the value depends on the partitions, so it neither ranks nor proves models. `seed`
/// fixes the partitions, the same for all models, for comparison. Throws InputError for fewer than
/// 2 folds, more folds than rows, or dependent columns.
double k_fold_press(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
                    const Eigen::VectorXd& weights, int folds, int repeats, std::uint64_t seed);

}  // namespace wearwell
