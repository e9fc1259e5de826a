#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

namespace wearwell {

/// Residuals of a posterior, with variance 1 for a correct model.
struct StudentizedScores {
  std::vector<std::vector<double>> scores;  ///< draws x observations; one row if draws are equal
  /// Draws x observations: the deviation of a draw's score from its mean over draws, divided by the
  /// root of the number of draws. Zero for an observation that is not exact.
  Eigen::MatrixXd deviation;
};

/// Standardized means over the draws of the observations' scores (bayes/normal_score.h), draws x
/// observations.
///
/// Truth and draw are exchangeable given the data. So for a correct model the scores under a draw
/// have covariance I, composed of C between draws and I - C of the means over draws, for any number
/// of parameters and any prior. For a linear model with a flat prior C is the hat matrix, its
/// diagonal c the leverage, and the mean over root (1 - c) the studentized residual (Cook and
/// Weisberg 1982, section 2.2.1). If more than half of the variance is between draws, the divisor
/// is root 1/2, and part of each draw's deviation is kept so that the variance is 1; this avoids
/// amplifying uncertain scores.
///
/// The common factor of all scores of a draw is removed first, because the uncertainty of the
/// scatter is not leverage. Scores that are not `exact` are random draws from intervals and stay
/// separate, because their means are not normal.
StudentizedScores studentized_scores(std::vector<std::vector<double>> scores,
                                     const std::vector<bool>& exact);

/// The root mean square, by simulation, of a test of one draw's scores for a correct model, with
/// normal residuals of the studentized covariance. It is 1 for independent residuals if `test` is a
/// standard normal score.
double null_size(const StudentizedScores& of,
                 const std::function<double(std::span<const double>)>& test);

}  // namespace wearwell
