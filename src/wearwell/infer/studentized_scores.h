#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

namespace wearwell {

/// Residuals of a posterior, each of variance 1 under a right law.
struct StudentizedScores {
  std::vector<std::vector<double>> scores;  ///< draws x observations; one row where draws are alike
  /// Draws x observations: how far the score of a draw is from its mean over draws, over the root of the number of draws.
  /// Zero where an observation is not exact.
  Eigen::MatrixXd deviation;
};

/// Of the scores (bayes/normal_score.h) of observations under draws, draws x observations, their means over the draws,
/// each divided by its standard deviation.
///
/// Truth and draw are exchangeable given the data. So under a right law the scores under a draw have covariance I, which
/// is C between draws and I - C of the means over draws, for any number of parameters and any prior. Of a linear model
/// with a flat prior C is the hat matrix, its diagonal c the leverage, and mean over root (1 - c) the studentized residual
/// (Cook and Weisberg 1982, section 2.2.1). Where more than half of the variance is between draws the divisor is root 1/2,
/// and so much of each draw's deviation is left that the variance is 1: what little is known of such a score is not
/// magnified.
///
/// The factor that all scores of a draw have in common is taken out first: the scatter's uncertainty is no leverage.
/// Scores that are not `exact` are drawn from intervals and are kept draw by draw: their means are not normal.
StudentizedScores studentized_scores(std::vector<std::vector<double>> scores,
                                     const std::vector<bool>& exact);

/// The root mean square, by simulation, of a test of the scores of one draw under a right law: residuals are normal with
/// the covariance of studentized ones. It is 1 of independent ones when `test` is a standard normal number of those.
double null_size(const StudentizedScores& of,
                 const std::function<double(std::span<const double>)>& test);

}  // namespace wearwell
