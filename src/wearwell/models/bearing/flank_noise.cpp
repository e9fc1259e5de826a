#include "wearwell/models/bearing/flank_noise.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace wearwell::bearing {
namespace {

using Index = Eigen::Index;

// Noise of which the share `share` of the variance has the autocorrelation phi^lag.
struct Memory {
  double phi, share;
};

// Makes the rows of one flank independent and of unit variance, by predicting each from earlier
// ones (the Kalman filter of a first-order process observed with white noise). Returns the log
// determinant of their correlation.
double whiten(const Memory& memory, Eigen::Ref<Eigen::MatrixXd> rows) {
  Eigen::RowVectorXd state = Eigen::RowVectorXd::Zero(rows.cols());  // predicted, of each column
  double variance = memory.share, log_determinant = 0;
  for (Index i = 0; i < rows.rows(); ++i) {
    const double seen = variance + 1 - memory.share;
    const Eigen::RowVectorXd innovation = rows.row(i) - state;
    const double gain = variance / seen;
    state = memory.phi * (state + gain * innovation);
    variance = memory.phi * memory.phi * variance * (1 - gain) +
               (1 - memory.phi * memory.phi) * memory.share;
    rows.row(i) = innovation / std::sqrt(seen);
    log_determinant += std::log(seen);
  }
  return log_determinant;
}

// Variance of the weighted sum, for noise of unit variance.
double sum_variance(const Memory& memory, const std::vector<double>& weights) {
  double squares = 0, products = 0, before = 0;
  for (const double w : weights) {
    squares += w * w;
    products += w * before;
    before = memory.phi * (before + w);
  }
  return squares + 2 * memory.share * products;
}

struct Candidate {
  double log_weight, scale, correlation;
};

}  // namespace

FlankNoise flank_noise(const std::vector<double>& residuals, const Eigen::MatrixXd& design,
                       std::size_t left, std::size_t right, const std::vector<double>& weights) {
  const auto n = static_cast<Index>(residuals.size()), p = design.cols();
  const auto first = static_cast<Index>(left), last = n - static_cast<Index>(right);
  Eigen::MatrixXd rows(first + last, p + 1);
  rows.leftCols(p) << design.topRows(first), design.bottomRows(last);
  const Eigen::Map<const Eigen::VectorXd> all(residuals.data(), n);
  rows.col(p) << all.head(first), all.tail(last);
  for (Index j = 0; j < p; ++j) rows.col(j) /= rows.col(j).norm();
  const double degrees = static_cast<double>(rows.rows() - p);

  std::vector<Candidate> candidates;
  double best = -std::numeric_limits<double>::infinity();
  for (int step = 0; step <= 24; ++step) {
    const double phi = 1 - std::pow(0.02, step / 24.0);  // 0 .. 0.98, denser towards 1
    for (double share = 0.4; share < 1.05; share += 0.15) {
      const Memory memory{phi, std::min(share, 0.999)};
      Eigen::MatrixXd white = rows;
      double log_determinant = whiten(memory, white.topRows(first));
      log_determinant += whiten(memory, white.bottomRows(last));
      const Eigen::MatrixXd normal = white.leftCols(p).transpose() * white.leftCols(p);
      const Eigen::LLT<Eigen::MatrixXd> root(normal);
      const Eigen::VectorXd along = white.leftCols(p).transpose() * white.col(p);
      const double squares = white.col(p).squaredNorm() - along.dot(root.solve(along));
      if (!(squares > 0)) continue;
      const double log_normal = 2 * root.matrixLLT().diagonal().array().log().sum();
      // Prior: a third for white noise (the others sum to 26); otherwise each phi of a grid is
      // equally likely, with a grid denser towards 1.
      const double log_weight = (step == 0 ? std::log(13) : std::log(1 - phi)) -
                                0.5 * (log_determinant + log_normal + degrees * std::log(squares));
      best = std::max(best, log_weight);
      candidates.push_back({log_weight,
                            std::sqrt(squares / degrees * sum_variance(memory, weights)),
                            1 + 2 * memory.share * phi / (1 - phi)});
      if (step == 0) break;  // without memory its share is zero
    }
  }
  FlankNoise noise{0, 0, 1};
  if (candidates.empty()) return noise;  // profiles without any noise
  double total = 0, variance = 0, log_correlation = 0, largest = 0;
  for (Candidate& each : candidates) {
    each.log_weight = std::exp(each.log_weight - best);
    total += each.log_weight;
    variance += each.log_weight * each.scale * each.scale * degrees / (degrees - 2);
    log_correlation += each.log_weight * std::log(each.correlation);
    largest = std::max(largest, each.scale);
  }
  noise.sd = std::sqrt(variance / total);
  noise.correlation = std::exp(log_correlation / total);
  const boost::math::students_t student(degrees);
  double low = 0, high = 100 * largest;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    double inside = 0;
    for (const Candidate& each : candidates) {
      if (each.log_weight > 1e-9 * total)
        inside += each.log_weight * cdf(student, middle / each.scale);
    }
    (inside < 0.95 * total ? low : high) = middle;
  }
  noise.half_width = 0.5 * (low + high);
  return noise;
}

}  // namespace wearwell::bearing
