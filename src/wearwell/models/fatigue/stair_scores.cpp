#include "wearwell/models/fatigue/stair_scores.h"

#include <cmath>
#include <numeric>
#include <span>

namespace wearwell::fatigue {
namespace {

constexpr double dependent = 1e-8;  // what is left of a direction that others hold already, squared

// Where a level lies in the distribution of the limit, and the score by w of one test there.
struct Place {
  double w, if_failed, if_survived;

  double information() const { return -if_failed * if_survived; }
};

Place place(StandardDistribution limit, double w) {
  const double density = log_density(limit, w);
  return {w, std::exp(density - log_cdf(limit, w)), -std::exp(density - log_survival(limit, w))};
}

struct Rows {
  std::vector<double> score, information;

  double dot(std::span<const double> a, std::span<const double> b) const {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += information[i] * a[i] * b[i];
    return sum;
  }
};

Rows rows_of(const StairOutcomes& outcomes, const std::vector<Place>& places) {
  Rows rows;
  for (std::size_t i = 0; i < outcomes.level.size(); ++i) {
    const Place& at = places[outcomes.level[i]];
    const double failures = outcomes.failures[i], tests = outcomes.tests[i];
    rows.score.push_back((failures > 0 ? failures * at.if_failed : 0) +
                         (tests > failures ? (tests - failures) * at.if_survived : 0));
    rows.information.push_back(tests > 0 ? tests * at.information() : 0);
  }
  return rows;
}

// The standardized score of each direction, orthogonal to all before it; 0 of one that those hold already.
std::vector<double> standardized(const Rows& rows, std::vector<std::vector<double>> directions) {
  std::vector<double> result, squares;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    std::vector<double>& own = directions[k];
    const double whole = rows.dot(own, own);
    for (std::size_t j = 0; j < k; ++j) {
      if (!(squares[j] > 0)) continue;
      const double part = rows.dot(own, directions[j]) / squares[j];
      for (std::size_t i = 0; i < own.size(); ++i) own[i] -= part * directions[j][i];
    }
    const double left = rows.dot(own, own);
    squares.push_back(left > dependent * whole ? left : 0);
    const double score = std::inner_product(own.begin(), own.end(), rows.score.begin(), 0.0);
    result.push_back(squares[k] > 0 ? score / std::sqrt(left) : 0);
  }
  return result;
}

}  // namespace

StairScores stair_scores(const StairDesign& design, const StairOutcomes& outcomes,
                         StandardDistribution limit, double location, double scale) {
  const StairOutcomes sums = by_level(outcomes, design.log10_stress.size());
  std::vector<Place> places;
  for (std::size_t l = 0; l < sums.level.size(); ++l) {
    const double w = (design.log10_stress[l] - location) / scale;
    places.push_back(sums.tests[l] > 0 ? place(limit, w) : Place{w, 0, 0});
  }
  const auto powers = [&](const StairOutcomes& of, int n) {
    std::vector<double> values;
    for (const std::size_t level : of.level) values.push_back(std::pow(places[level].w, n));
    return values;
  };
  const std::vector<double> shape = standardized(
      rows_of(sums, places), {powers(sums, 0), powers(sums, 1), powers(sums, 2), powers(sums, 3)});
  StairScores scores{shape[2], shape[3], 0};
  if (!design.up_and_down) return scores;
  std::vector<double> order(outcomes.level.size());
  std::iota(order.begin(), order.end(), 1.0);
  scores.later =
      standardized(rows_of(outcomes, places), {powers(outcomes, 0), powers(outcomes, 1), order})[2];
  return scores;
}

}  // namespace wearwell::fatigue
