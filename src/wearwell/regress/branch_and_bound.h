#pragma once

#include "wearwell/regress/frontier.h"
#include "wearwell/regress/model_pool.h"

namespace wearwell {

/// Searches every model of `root`, with which the frontier was made, and cuts branches whose bound
/// exceeds the pool's limit. When it returns with an empty frontier, the pool's result is proven.
/// Rethrows the exception of a thread.
void branch_and_bound(const SearchProblem& problem, ModelPool& pool, Frontier& frontier,
                      const Branch& root, int threads);

/// The part of branch and bound that depends on the criterion. One per thread.
class BranchSearch {
 public:
  virtual ~BranchSearch() = default;
  /// Offers the model of the first branch; search() assumes that the creator of a branch has
  /// offered it.
  virtual void offer_root(const Branch& root) = 0;
  /// Searches the branch; returns the unsearched part to the frontier after some hundred nodes, or
  /// when the search is stopped. Returns the number of nodes visited.
  virtual double search(const Branch& branch) = 0;
};

}  // namespace wearwell
