#pragma once

#include <vector>

#include "wearwell/regress/branch_and_bound.h"
#include "wearwell/regress/relaxation.h"
#include "wearwell/regress/submodel.h"

namespace wearwell {

/// Branches of a search by leave-one-out. The bounds are derived in subset_search.md.
class PressSearch final : public BranchSearch {
 public:
  PressSearch(const SearchProblem& problem, ModelPool& pool, Frontier& frontier);
  void offer_root(const Branch& root) override;
  double search(const Branch& branch) override;

 private:
  /// A branch with the data of its bound: the submodel's terms are fixed, its candidates free.
  struct Node {
    Submodel submodel;
    Relaxation relaxation;
    std::vector<double> scale;       ///< by row: 1 / (1 - leverage), the root of its weight
    std::vector<double> dual;        ///< by row: a dual point of this node's or an earlier bound
    double dual_bound = 0;           ///< the bound that it proves; 0 without one
    std::vector<double> bound_with;  ///< by candidate: bound of the models that contain it
    double bound = 0;
  };

  void dive(int depth);
  bool tighten(Node& node);
  bool fix(Node& node, TermSet terms);
  void offer(const Node& node);
  void relax(Node& node);
  void bound_inclusions(Node& node);
  double bound_with(const Node& node, int t) const;
  void screen(Node& node) const;
  void remove(Node& node, int position);
  int choose(const Node& node) const;

  const SearchProblem& problem_;
  ModelPool& pool_;
  Frontier& frontier_;
  std::vector<Node> nodes_;  ///< by depth: the path from the branch to the present node
  int left_ = 0;             ///< nodes that may still be visited in this turn
  std::vector<double> weighted_;
  std::vector<double*> columns_;
};

}  // namespace wearwell
