#include "wearwell/infer/loo_of_many.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "wearwell/base/stop_scope.h"
#include "wearwell/infer/left_out.h"
#include "wearwell/infer/pareto_smoothing.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr double numbers_wanted = 4e7, fewest_draws = 100, most_draws = 400;
constexpr std::size_t most_smoothed = 1000;

// Evenly chosen among all.
WeightedDraws thinned(const WeightedDraws& draws, std::size_t terms) {
  const double wanted =
      std::clamp(numbers_wanted / static_cast<double>(terms), fewest_draws, most_draws);
  const auto count = std::min(draws.values.rows(), static_cast<Eigen::Index>(wanted));
  WeightedDraws few;
  few.values.resize(count, draws.values.cols());
  for (Eigen::Index i = 0; i < count; ++i)
    few.values.row(i) = draws.values.row(i * draws.values.rows() / count);
  few.weights = Eigen::VectorXd::Constant(count, 1 / static_cast<double>(count));
  return few;
}

// The most influential terms: lpd - elpd is about the variance of log p.
std::vector<std::size_t> most_uneven(const std::vector<LooTerm>& terms) {
  std::vector<std::size_t> order(terms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t count = std::min(most_smoothed, order.size());
  const auto moved = [&](std::size_t i) { return terms[i].lpd - terms[i].elpd; };
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      return moved(a) != moved(b) ? moved(a) > moved(b) : a < b;
                    });
  order.resize(count);
  return order;
}

}  // namespace

Loo loo_of_many(const LogDensity& likelihood, const WeightedDraws& draws, std::size_t terms,
                double efficiency, const Scores* scores) {
  constexpr Eigen::Index part = 50;
  const WeightedDraws few = thinned(draws, terms);
  const Eigen::Index count = few.values.rows();
  const double log_count = std::log(static_cast<double>(count));
  const std::vector<LeftOut> sums = left_out(likelihood, few, terms, scores, part);
  const std::vector<int> counts = likelihood.pointwise_counts();
  Loo loo;
  loo.threshold = khat_threshold(static_cast<double>(count));
  loo.terms.resize(terms);
  for (std::size_t i = 0; i < terms; ++i) {
    LooTerm& term = loo.terms[i];
    term.elpd = sums[i].elpd();
    term.lpd = sums[i].lpd();
    term.khat = -std::numeric_limits<double>::infinity();
    if (!counts.empty()) term.count = counts[i];
    if (scores) term.tail = sums[i].tail();
  }

  const std::vector<std::size_t> smoothed = most_uneven(loo.terms);
  std::vector<bool> apart(terms);
  for (const std::size_t i : smoothed) apart[i] = true;
  // Smooths weights by column; adds the influence of all other terms for each draw.
  Eigen::MatrixXd log_p(count, static_cast<Eigen::Index>(smoothed.size()));
  std::vector<std::vector<NormalScore>> z(scores ? static_cast<std::size_t>(count) : 0);
  Eigen::VectorXd influences = Eigen::VectorXd::Zero(count);
  tbb::parallel_for(Eigen::Index{0}, count, [&](Eigen::Index s) {
    check_stop();
    const Eigen::VectorXd x = few.values.row(s);
    const std::vector<double> each = likelihood.pointwise(view(x));
    for (std::size_t i = 0; i < terms; ++i) {
      if (!apart[i])
        influences[s] += influence(loo.terms[i], -log_count - each[i] - sums[i].log_sum(), each[i]);
    }
    for (std::size_t c = 0; c < smoothed.size(); ++c)
      log_p(s, static_cast<Eigen::Index>(c)) = each[smoothed[c]];
    if (!scores) return;
    const std::vector<NormalScore> all = (*scores)(x.data());
    for (const std::size_t i : smoothed) z[static_cast<std::size_t>(s)].push_back(all[i]);
  });
  for (std::size_t c = 0; c < smoothed.size(); ++c) {
    auto column = log_p.col(static_cast<Eigen::Index>(c));
    leave_out_smoothed(loo.terms[smoothed[c]], column,
                       scores ? [&](std::size_t s) { return z[s][c]; } : ScoreAt());
    influences += column;
  }
  loo.error = influences.norm() / std::sqrt(efficiency);
  return loo;
}

}  // namespace wearwell
