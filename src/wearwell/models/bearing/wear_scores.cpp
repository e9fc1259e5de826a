#include "wearwell/models/bearing/wear_scores.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"

namespace wearwell::bearing {
namespace {

// The density of the bearing's z, ln k_b = ln k + scatter z, given its rows so far: its logarithm
// at even points.
struct Grid {
  std::vector<double> z, log_density;
};

class BearingScores {
 public:
  BearingScores(const WearModel& model, const Inspections& inspections)
      : model_(model), curves_(depth_functions(inspections.duty, guess(inspections).k)) {
    for (const double d : inspections.depth) {
      at_.push_back(model.family == ObservationFamily::normal ? d : std::log(d));
    }
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const std::size_t bearing = model.has_scatter ? inspections.bearing[i] : 0;
      rows_.resize(std::max(rows_.size(), bearing + 1));
      rows_[bearing].push_back(i);
    }
  }

  std::vector<NormalScore> operator()(const double* x) const {
    std::vector<NormalScore> scores(at_.size());
    const double log_k = std::log(x[0]), sigma = model_.sigma(x);
    if (!model_.has_scatter) {
      for (std::size_t i = 0; i < at_.size(); ++i) {
        const double z = score(i, log_k, sigma);
        scores[i] = {z, z};
      }
      return scores;
    }
    for (const auto& rows : rows_) {
      for (std::size_t j = 0; j < rows.size(); ++j) {
        const double z = score_after(rows, j, log_k, sigma, model_.scatter(x));
        scores[rows[j]] = {z, z};
      }
    }
    return scores;
  }

 private:
  // Of row i given its bearing's ln k; a k beyond the geometry gives a depth larger than any.
  double score(std::size_t i, double log_k, double sigma) const {
    if (!(log_k <= curves_[i].limit())) return -infinity;
    return ObservationDistribution(model_.family, curves_[i].depth(log_k), sigma).score(at_[i]);
  }

  double log_density(std::size_t i, double log_k, double sigma) const {
    if (!(log_k <= curves_[i].limit())) return -infinity;
    const ObservationDistribution curve(model_.family, curves_[i].depth(log_k), sigma);
    const double z = curve.score(at_[i]);
    return -0.5 * z * z - std::log(curve.scale);
  }

  double score_after(const std::vector<std::size_t>& rows, std::size_t j, double log_k,
                     double sigma, double scatter) const {
    constexpr double farthest = 8;
    constexpr int points = 240, closest = 12;
    constexpr double negligible = 30;
    double low = -farthest, high = farthest;
    Grid grid;
    // Refines around the mass of the density until it fills the grid.
    for (int zoom = 0; zoom < closest; ++zoom) {
      grid = grid_between(low, high, points, rows, j, log_k, sigma, scatter);
      if (j == 0) break;
      const double top = *std::max_element(grid.log_density.begin(), grid.log_density.end());
      if (top == -infinity) return infinity;  // the earlier rows are impossible already
      int first = points, last = 0;
      for (int i = 0; i <= points; ++i) {
        if (grid.log_density[static_cast<std::size_t>(i)] < top - negligible) continue;
        first = std::min(first, i);
        last = std::max(last, i);
      }
      if (last - first > points / 4) break;
      const double step = (high - low) / points;
      high = low + (last + 1) * step;
      low += (first - 1) * step;
    }
    const double top = *std::max_element(grid.log_density.begin(), grid.log_density.end());
    double below = 0, above = 0, sum = 0;
    for (std::size_t i = 0; i < grid.z.size(); ++i) {
      const double weight = std::exp(grid.log_density[i] - top);
      if (weight < 1e-15) continue;
      const double z = score(rows[j], log_k + scatter * grid.z[i], sigma);
      sum += weight;
      below += weight * normal_cdf(z);
      above += weight * normal_cdf(-z);
    }
    return normal_score(std::log(below / sum), std::log(above / sum));
  }

  Grid grid_between(double low, double high, int points, const std::vector<std::size_t>& rows,
                    std::size_t before, double log_k, double sigma, double scatter) const {
    Grid grid;
    for (int i = 0; i <= points; ++i) {
      const double z = low + (high - low) * i / points;
      double sum = -0.5 * z * z;
      for (std::size_t j = 0; j < before; ++j) {
        sum += log_density(rows[j], log_k + scatter * z, sigma);
      }
      grid.z.push_back(z);
      grid.log_density.push_back(sum);
    }
    return grid;
  }

  WearModel model_;
  std::vector<DepthFunction> curves_;
  std::vector<double> at_;                      // depth, or its logarithm for the lognormal family
  std::vector<std::vector<std::size_t>> rows_;  // of each bearing
};

}  // namespace

Scores wear_scores(const WearModel& model, const Inspections& inspections) {
  return BearingScores(model, inspections);
}

}  // namespace wearwell::bearing
