#include "wearwell/regress/moment_search.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace wearwell {
namespace {

using Index = Eigen::Index;

/// Nodes after which a thread returns its branch, so that others find work and the branches with
/// the smallest bounds come first.
constexpr int nodes_per_turn = 500;

Eigen::Map<const Eigen::VectorXd> coordinates(const double* values, Index dimension) {
  return {values, dimension};
}

}  // namespace

MomentSearch::MomentSearch(const SearchProblem& problem, ModelPool& pool, Frontier& frontier)
    : problem_(problem), pool_(pool), frontier_(frontier), nodes_(problem.terms + 1) {}

void MomentSearch::offer_root(const Branch& root) {
  Node& node = nodes_[0];
  node.submodel.start(problem_, root.fixed);
  node.weight.setIdentity(problem_.moments.dimension(), problem_.moments.dimension());
  if (root.fixed != 0 && fix(node, root.fixed)) offer(node);
}

double MomentSearch::search(const Branch& branch) {
  left_ = nodes_per_turn;
  Node& root = nodes_[0];
  root.bound = branch.bound;
  root.submodel.start(problem_, branch.fixed | branch.free);
  root.weight.setIdentity(problem_.moments.dimension(), problem_.moments.dimension());
  if (!fix(root, branch.fixed)) return 0;
  dive(0);
  return nodes_per_turn - left_;
}

/// All models of the branch except the fixed one, which has been offered.
void MomentSearch::dive(int depth) {
  Node& node = nodes_[depth];
  Submodel& submodel = node.submodel;
  if (submodel.count() > 0) relax(node);
  while (submodel.count() > 0) {
    if (left_ == 0 || frontier_.stopped()) {
      frontier_.give_back({submodel.model(), submodel.candidates(), node.bound});
      return;
    }
    --left_;
    if (!tighten(node)) return;
    int most_expensive = 0;
    for (int t = 1; t < submodel.count(); ++t) {
      if (node.relaxation.cost(t) > node.relaxation.cost(most_expensive)) most_expensive = t;
    }
    Node& with = nodes_[depth + 1];
    with.bound = node.bound;
    join(node, most_expensive, with);
    offer(with);
    dive(depth + 1);
    remove(node, most_expensive);
  }
}

/// Fixes candidates that every model of interest contains, until nothing changes. False if no model
/// of interest is left.
bool MomentSearch::tighten(Node& node) {
  Submodel& submodel = node.submodel;
  while (submodel.count() > 0) {
    const double limit =
        pool_.limit(submodel.model_size() + 1, submodel.model_size() + submodel.count());
    if (node.bound > limit) return false;
    node.relaxation.analyse();
    TermSet needed = 0;
    for (int t = 0; t < submodel.count(); ++t) {
      if (node.relaxation.rss() + node.relaxation.cost(t) > limit) needed |= bit(submodel.term(t));
    }
    if (needed == 0) return true;
    if (!fix(node, needed)) return false;
    offer(node);
    if (submodel.count() > 0) relax(node);
  }
  return false;
}

/// Adds all `terms` to the model. False if no model can contain them all.
bool MomentSearch::fix(Node& node, TermSet terms) {
  const Submodel& submodel = node.submodel;
  while (terms != 0) {
    int position = 0;
    while (position < submodel.count() && !(terms & bit(submodel.term(position)))) ++position;
    if (position == submodel.count()) return false;  // it depends on the others
    terms &= ~bit(submodel.term(position));
    join(node, position, node);
  }
  return true;
}

/// Makes `to`, which may be `from`, the branch of `from` whose models contain the candidate.
void MomentSearch::join(const Node& from, int position, Node& to) const {
  const Eigen::VectorXd column =
      coordinates(from.submodel.column(position), problem_.moments.dimension()).normalized();
  to.weight = from.weight;
  problem_.moments.add_leverage(column, to.weight);
  to.submodel.join(from.submodel, position);
}

/// With a lower bound of the model's PRESS: the pool evaluates the models that pass it.
void MomentSearch::offer(const Node& node) {
  const auto residuals = coordinates(node.submodel.residuals(), problem_.moments.dimension());
  pool_.offer(node.submodel.model(), node.submodel.model_size(),
              residuals.dot(node.weight * residuals));
}

void MomentSearch::relax(Node& node) {
  const Submodel& submodel = node.submodel;
  const int rows = submodel.rows(), count = submodel.count();
  const Index dimension = problem_.moments.dimension();
  const Eigen::LLT<Eigen::MatrixXd> root(node.weight);  // at least the identity
  weighted_.assign(static_cast<std::size_t>(count + 1) * static_cast<std::size_t>(rows), 0.0);
  columns_.clear();
  const auto weigh = [&](const double* from, double* to) {
    Eigen::Map<Eigen::VectorXd>(to, dimension) = root.matrixU() * coordinates(from, dimension);
  };
  for (int t = 0; t < count; ++t) {
    columns_.push_back(weighted_.data() + t * rows);
    weigh(submodel.column(t), columns_.back());
  }
  double* const response = weighted_.data() + count * rows;
  weigh(submodel.residuals(), response);
  node.relaxation.factor(columns_, response, rows);
  node.bound = std::max(node.bound, node.relaxation.rss());
}

/// Every model without this candidate.
void MomentSearch::remove(Node& node, int position) {
  node.submodel.remove(position);
  if (node.submodel.count() == 0) return;
  if (node.relaxation.dependent()) {
    relax(node);
  } else {
    node.relaxation.drop(position);
    node.bound = std::max(node.bound, node.relaxation.rss());
  }
}

}  // namespace wearwell
