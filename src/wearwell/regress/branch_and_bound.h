#pragma once

#include "wearwell/regress/frontier.h"
#include "wearwell/regress/model_pool.h"

namespace wearwell {

/// Searches every model of `root`, with which the frontier was made, cutting branches whose bound
/// exceeds what the pool wants. When it returns with nothing left in the frontier, the pool holds
/// what it promises. Throws what a thread threw.
void branch_and_bound(const SearchProblem& problem, ModelPool& pool, Frontier& frontier,
                      const Branch& root, int threads);

/// The part of branch and bound that knows a criterion. One for each thread.
class BranchSearch {
 public:
  virtual ~BranchSearch() = default;
  /// Offers the model of the first branch that search() leaves to whoever made the branch.
  virtual void offer_root(const Branch& root) = 0;
  /// Searches the branch; gives back to the frontier what it did not get to after some hundred
  /// nodes, or when the search is stopped. Returns the nodes that it looked at.
  virtual double search(const Branch& branch) = 0;
};

}  // namespace wearwell
