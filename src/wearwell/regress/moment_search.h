#pragma once

#include <Eigen/Core>
#include <vector>

#include "wearwell/regress/branch_and_bound.h"
#include "wearwell/regress/relaxation.h"
#include "wearwell/regress/submodel.h"

namespace wearwell {

/// Branches of a search by leave-one-out with many rows: bounds use the moments of the rows
/// (row_moments.h), so that the cost of a node does not depend on the number of rows. Only models
/// that may belong in the pool are evaluated from the rows. The bounds are derived in
/// subset_search.md.
class MomentSearch final : public BranchSearch {
 public:
  MomentSearch(const SearchProblem& problem, ModelPool& pool, Frontier& frontier);
  void offer_root(const Branch& root) override;
  double search(const Branch& branch) override;

 private:
  /// A branch: the submodel's terms are fixed, its candidates free.
  struct Node {
    Submodel submodel;
    Relaxation relaxation;
    Eigen::MatrixXd weight;  ///< W of the fixed terms
    double bound = 0;
  };

  void dive(int depth);
  bool tighten(Node& node);
  bool fix(Node& node, TermSet terms);
  void join(const Node& from, int position, Node& to) const;
  void offer(const Node& node);
  void relax(Node& node);
  void remove(Node& node, int position);

  const SearchProblem& problem_;
  ModelPool& pool_;
  Frontier& frontier_;
  std::vector<Node> nodes_;  ///< by depth: the path from the branch to the present node
  int left_ = 0;             ///< nodes that may still be visited in this turn
  std::vector<double> weighted_;
  std::vector<double*> columns_;
};

}  // namespace wearwell
