#include "wearwell/regress/nested.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "wearwell/base/error.h"
#include "wearwell/base/workers.h"
#include "wearwell/regress/k_fold.h"
#include "wearwell/regress/least_squares.h"

namespace wearwell {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Limit of rows times branches for one search: seconds, for hard data.
constexpr double most_rows_of_nodes = 4e6;
/// With more rows the cost of a branch does not grow (moment_search.h).
constexpr double most_rows = 2000;

std::vector<Index> others(Index rows, const std::vector<Index>& out) {
  std::vector<bool> left(static_cast<std::size_t>(rows), true);
  for (const Index row : out) left[static_cast<std::size_t>(row)] = false;
  std::vector<Index> kept;
  for (Index row = 0; row < rows; ++row) {
    if (left[static_cast<std::size_t>(row)]) kept.push_back(row);
  }
  return kept;
}

}  // namespace

Nested nested_of(const VectorXd& response, const VectorXd& weights, const VectorXd& predicted,
                 int folds) {
  Nested nested;
  nested.folds = folds;
  const auto n = static_cast<double>(response.size());
  const Eigen::ArrayXd w = weights.size() > 0 ? weights : VectorXd::Ones(response.size());
  const double mean = (w * response.array()).sum() / w.sum();
  const double total = (w * (response.array() - mean).square()).sum();
  const Eigen::ArrayXd loss = w * (response - predicted).array().square();
  nested.r2 = 1 - loss.sum() / total;
  nested.r2_error = std::sqrt(n / (n - 1) * (loss - loss.mean()).square().sum()) / total;
  nested.rmse = std::sqrt(loss.sum() / w.sum());
  return nested;
}

Nested nested_search(const Eigen::MatrixXd& columns, const VectorXd& response,
                     const VectorXd& weights, const SearchSettings& settings, int folds,
                     std::uint64_t seed) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto left = [&] {
    return settings.seconds - std::chrono::duration<double>(Clock::now() - start).count();
  };
  const Index n = response.size();
  folds = static_cast<int>(std::min<Index>(folds, n));
  const auto parts = random_folds(n, folds, seed, 0);
  VectorXd predicted(n);
  std::vector<std::string> problems(parts.size());
  std::atomic<int> unproven = 0;
  const auto solve = [&](int fold) {
    const auto at = static_cast<std::size_t>(fold);
    const std::vector<Index> rows = others(n, parts[at]);
    SearchSettings own;
    own.criterion = settings.criterion;
    own.forced = settings.forced;
    own.keep = 1;
    own.threads = 1;
    own.stop = settings.stop;
    own.seconds = std::max(0.0, left());
    own.most_nodes = most_rows_of_nodes / std::min(static_cast<double>(n), most_rows);
    try {
      const Eigen::MatrixXd seen = columns(rows, Eigen::all);
      const VectorXd y = response(rows),
                     w = weights.size() > 0 ? VectorXd(weights(rows)) : VectorXd();
      const SearchResult found = search_subsets(seen, y, w, own);
      if (found.models.empty() || left() <= 0 || (settings.stop && *settings.stop)) {
        problems[at] = "it was stopped";
        return;
      }
      if (!found.certified) ++unproven;
      const std::vector<int>& terms = found.models.front().terms;
      const LinearFit fit =
          fit_least_squares(seen(Eigen::all, terms), y, w, {}, 0.5 * rank_tolerance);
      predicted(parts[at]) = columns(parts[at], terms) * fit.coefficients;
    } catch (const InputError& error) {
      problems[at] =
          fmt::format("without {} of the {} rows: {}", parts[at].size(), n, error.what());
    }
  };
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  run_tasks(folds, settings.threads > 0 ? std::min(settings.threads, cores) : cores, solve);
  for (const std::string& problem : problems) {
    if (problem.empty()) continue;
    Nested none;
    none.problem = problem;
    return none;
  }
  Nested nested = nested_of(response, weights, predicted, folds);
  nested.unproven = unproven;
  return nested;
}

}  // namespace wearwell
