#pragma once

#include <vector>

#include "wearwell/regress/branch_and_bound.h"
#include "wearwell/regress/relaxation.h"

namespace wearwell {

/// Branches of a search by a criterion of the residual sum of squares, which decreases as terms are
/// added: every model of a branch has at least that of all its terms. Terms are removed one by one,
/// the most expensive to remove first, as in leaps (Furnival and Wilson 1974); see
/// subset_search.md.
class RssSearch final : public BranchSearch {
 public:
  RssSearch(const SearchProblem& problem, ModelPool& pool, Frontier& frontier);
  void offer_root(const Branch& root) override;
  double search(const Branch& branch) override;

 private:
  /// The models that contain all `fixed` and some of `free`; the model with all of `free` has been
  /// offered.
  struct Node {
    TermSet fixed = 0;
    int fixed_size = 0;
    std::vector<int> free;   ///< terms, in the order of the relaxation's columns
    Relaxation relaxation;   ///< fit of fixed and free
    std::vector<int> order;  ///< of free, the most expensive to remove first
  };

  bool start(Node& node, TermSet fixed, TermSet free);
  void dive(int depth);
  bool enter(Node& next, const Node& node, int i, const Branch& branch);

  const SearchProblem& problem_;
  ModelPool& pool_;
  Frontier& frontier_;
  std::vector<Node> nodes_;  ///< by depth
  int left_ = 0;             ///< nodes that may still be visited in this turn
  std::vector<double> work_;
  std::vector<double*> columns_;
};

}  // namespace wearwell
