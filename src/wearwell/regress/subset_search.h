#pragma once

#include <Eigen/Core>
#include <atomic>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "wearwell/regress/criterion.h"
#include "wearwell/regress/exhaustive.h"
#include "wearwell/regress/least_squares.h"

namespace wearwell {

/// Progress of a running search, at most some times a second.
struct SearchProgress {
  double best = 0;         ///< criterion of the best model so far
  double lower_bound = 0;  ///< no model is better than this
  double nodes = 0;        ///< visited branches; models of an exhaustive search
  double share = 0;        ///< share of an exhaustive search that is done; 0 if unknown
  double seconds = 0;
};

struct SearchSettings {
  Criterion criterion = Criterion::loo;
  int keep = 10;            ///< number of best models
  double near = 0;          ///< and all whose criterion is within this of the best: relative for
                            ///< loo (0.01: PRESS 1 % above), absolute for the others
  int near_most = 10'000;   ///< but never more than this
  std::vector<int> forced;  ///< terms of every model
  CloudKind cloud = CloudKind::none;  ///< if set, every model is evaluated; at most 25 free terms
  /// For loo: models of a larger PRESS are ignored. If none is smaller the result is empty.
  double press_at_most = std::numeric_limits<double>::infinity();
  /// An initial model, instead of a search for good ones. Changes only the time, not the result.
  std::vector<int> start;
  bool prove_sizes = false;  ///< the best of every size is proven, however bad: takes longer
  int threads = 0;           ///< 0: as many as the machine has cores, which is the maximum
  double seconds = std::numeric_limits<double>::infinity();  ///< time limit
  /// Number of branches after which to stop, give or take some hundred; deterministic on one
  /// thread.
  double most_nodes = std::numeric_limits<double>::infinity();
  const std::atomic<bool>* stop = nullptr;              ///< may be set while searching
  std::function<void(const SearchProgress&)> progress;  ///< called from any thread; may be empty
};

/// One submodel. Terms are columns, ascending.
struct SubsetModel {
  std::vector<int> terms;
  double criterion = 0;  ///< PRESS for loo
  double rss = 0;
  double press = 0;
  double r2 = 0;
  double r2p = 0;
};

struct SizeBest {
  std::optional<SubsetModel> model;  ///< empty: none can be fitted, or none was found
  bool proven = false;
};

struct SearchResult {
  std::vector<SubsetModel> models;  ///< best first; `keep`, or more with `near`
  std::vector<SizeBest> by_size;    ///< by number of terms, from 0
  /// True: the models are the best of all, in order. False: the search was stopped.
  bool certified = false;
  /// No model has a better criterion than this (for adjr2: none is higher). Equal to the best
  /// model's if certified.
  double lower_bound = 0;
  bool truncated = false;  ///< more than near_most models within `near`
  double nodes = 0;  ///< visited branches; models of an exhaustive search. Depends on threads.
  double seconds = 0;
  double submodels = 0;  ///< number of models, except the empty one
  Cloud cloud;
  std::vector<Dependence> dependences;  ///< among all columns; models with such terms are skipped
};

/// Finds the best subsets of the columns (rows x terms, at most 64) for `response`, exactly: branch
/// and bound with a certificate, or every model if a cloud is requested. Method and proofs:
/// subset_search.md.
///
/// Models are ordered by the criterion; those that agree to a relative 1e-10 are ties, ordered by
/// fewer terms, then by the first term where they differ. The models of a certified result do not
/// depend on the number of threads. Models with linearly dependent terms are skipped (columns that
/// orthogonalization, in the order of the search, shortens below `rank_tolerance`), and for loo
/// those where one row alone determines a coefficient.
///
/// Throws InputError for data that cannot be searched.
SearchResult search_subsets(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
                            const Eigen::VectorXd& weights, const SearchSettings& settings);

}  // namespace wearwell
