#include "wearwell/regress/subset_search.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <thread>

#include "wearwell/base/error.h"
#include "wearwell/math/constants.h"
#include "wearwell/regress/branch_and_bound.h"
#include "wearwell/regress/seed_models.h"

namespace wearwell {
namespace {

constexpr int most_free_for_points = 25, most_free_for_bins = 30;

TermSet read_terms(const char* what, const std::vector<int>& chosen, int terms) {
  TermSet set = 0;
  for (const int term : chosen) {
    if (term < 0 || term >= terms)
      throw InputError(fmt::format("{} term {} is not one of the {} terms", what, term, terms));
    set |= bit(term);
  }
  return set;
}

void check(const SearchSettings& settings, int free) {
  if (settings.keep < 1) throw InputError(fmt::format("keep is {}; need 1", settings.keep));
  if (!(settings.near >= 0))
    throw InputError(fmt::format("near is {}; it must not be negative", settings.near));
  const int most = settings.cloud == CloudKind::points ? most_free_for_points : most_free_for_bins;
  if (settings.cloud != CloudKind::none && free > most)
    throw InputError(
        fmt::format("the cloud of {} free terms has 2^{} models; at most 2^{}", free, free, most));
}

/// A lower bound of the score of all models: the residual sum of squares of all terms, which also
/// bounds PRESS, at the smallest size.
double least_score(const SearchProblem& problem, TermSet forced) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(problem.columns);
  const Eigen::VectorXd rotated = qr.householderQ().transpose() * problem.response;
  const double rss = rotated.tail(rotated.size() - qr.rank()).squaredNorm();
  const int smallest = std::max<int>(1, static_cast<int>(terms_of(forced).size()));
  return problem.score.of(rss, smallest) * (1 - bound_slack);
}

SubsetModel describe(const ScoredModel& model, const SearchProblem& problem,
                     const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
                     const Eigen::VectorXd& weights) {
  SubsetModel described;
  described.terms = terms_of(model.set);
  described.criterion = problem.score.value(model.score);
  // The search has determined the rank; rounding must not change that here.
  const auto fit = fit_least_squares(columns(Eigen::all, described.terms), response, weights, {},
                                     0.5 * rank_tolerance);
  described.rss = fit.rss;
  described.press = fit.press;
  described.r2 = fit.r2;
  described.r2p = fit.r2p;
  return described;
}

// The models that the pool has kept; `open`: the smallest score of what was not searched.
void tell_models(const ModelPool& pool, double open, bool all_sizes_proven,
                 const SearchProblem& problem, const Eigen::MatrixXd& columns,
                 const Eigen::VectorXd& response, const Eigen::VectorXd& weights,
                 SearchResult& result) {
  const auto best = pool.best();
  result.certified = open == infinity;
  result.lower_bound =
      problem.score.value(best.empty() ? open : std::min(open, best.front().score));
  result.truncated = pool.truncated();
  for (const auto& model : best)
    result.models.push_back(describe(model, problem, columns, response, weights));
  // All models up to this score have been kept.
  const double known = std::min(open, pool.threshold());
  for (const auto& model : pool.best_by_size()) {
    SizeBest of_size;
    if (model) of_size.model = describe(*model, problem, columns, response, weights);
    of_size.proven = result.certified && all_sizes_proven;
    if (model && model->score <= known) of_size.proven = true;
    result.by_size.push_back(of_size);
  }
}

}  // namespace

SearchResult search_subsets(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
                            const Eigen::VectorXd& weights, const SearchSettings& settings) {
  const bool exhaustive = settings.cloud != CloudKind::none;
  const SearchProblem problem(columns, response, weights, settings.criterion, exhaustive);
  const TermSet forced = read_terms("forced", settings.forced, problem.terms);
  const TermSet free = every_term(problem.terms) & ~forced;
  const int free_count = static_cast<int>(terms_of(free).size());
  check(settings, free_count);
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int threads = settings.threads > 0 ? std::min(settings.threads, cores) : cores;

  ModelPool pool(problem, {static_cast<std::size_t>(settings.keep), settings.near,
                           static_cast<std::size_t>(std::max(settings.near_most, settings.keep)),
                           settings.prove_sizes || exhaustive,
                           problem.leave_one_out ? settings.press_at_most : infinity});
  const Branch root{forced, free, least_score(problem, forced)};
  SearchControl::Report report;
  if (settings.progress) {
    report = [&](double nodes, double bound, double share, double seconds) {
      const double best = pool.best_score();
      settings.progress({problem.score.value(best), problem.score.value(std::min(bound, best)),
                         nodes, share, seconds});
    };
  }
  SearchControl control({settings.seconds, settings.stop}, report);

  SearchResult result;
  if (settings.start.empty()) {
    seed_models(problem, pool, forced);
  } else {
    const TermSet start = read_terms("start", settings.start, problem.terms) | forced;
    pool.offer(start, static_cast<int>(terms_of(start).size()), 0);
  }
  pool.end_seeding();
  double open = infinity;  // the smallest score of what was not searched
  if (exhaustive) {
    const SearchProblem rows =
        problem.leave_one_out ? problem
                              : SearchProblem(columns, response, weights, Criterion::loo, true);
    result.cloud = exhaustive_search(rows, pool, root, settings.cloud, control, threads);
    result.nodes = result.cloud.models;
    if (!result.cloud.complete) open = root.bound;
  } else {
    Frontier frontier(root, threads, control, settings.most_nodes);
    branch_and_bound(problem, pool, frontier, root, threads);
    result.nodes = frontier.nodes();
    open = frontier.bound() * (1 - bound_slack);
  }

  const bool limited = problem.leave_one_out && settings.press_at_most < infinity;
  if (pool.best().empty() && open == infinity && !limited)
    throw InputError("no model of these terms can be fitted to these rows");
  result.submodels = std::ldexp(1.0, free_count) - (forced == 0 ? 1 : 0);
  tell_models(pool, open, settings.prove_sizes || exhaustive, problem, columns, response, weights,
              result);
  result.dependences = find_dependences(columns);
  result.seconds = control.seconds();
  return result;
}

}  // namespace wearwell
