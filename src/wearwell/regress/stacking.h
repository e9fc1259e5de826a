#pragma once

#include <Eigen/Core>

namespace wearwell {

/// Weights of models by stacking (Breiman, Machine Learning 24 (1996) 49-64; "stacking of means" in
/// Yao et al., Bayesian Analysis 13 (2018), 917-1007): the non-negative weights v with sum 1 for
/// which the mixed prediction has the smallest leave-one-out error, sum of w_i (sum_m v_m e_im)^2.
///
/// `residuals`: rows x models, leave-one-out residuals e. `row_weights` may be empty (all 1).
/// Models with nearly equal predictions share one weight: its division is then not unique, and few
/// are above zero. Throws InputError for no model or a residual that is not finite.
Eigen::VectorXd stacking_weights(const Eigen::MatrixXd& residuals,
                                 const Eigen::VectorXd& row_weights = {});

}  // namespace wearwell
