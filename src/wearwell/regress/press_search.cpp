#include "wearwell/regress/press_search.h"

#include <algorithm>
#include <cmath>

#include "wearwell/regress/row_kernels.h"

namespace wearwell {
namespace {

using namespace row_kernels;

/// Nodes after which a thread returns its branch, so that others find work and the branches with
/// the smallest bounds come first.
constexpr int nodes_per_turn = 500;

/// Rows are weighted with 1 / (1 - leverage), but at most with this: a smaller weight only weakens
/// the bound, a larger one would lose the other rows in rounding.
constexpr double most_scale = 1e4;

}  // namespace

PressSearch::PressSearch(const SearchProblem& problem, ModelPool& pool, Frontier& frontier)
    : problem_(problem), pool_(pool), frontier_(frontier), nodes_(problem.terms + 1) {}

void PressSearch::offer_root(const Branch& root) {
  nodes_[0].submodel.start(problem_, root.fixed);
  if (root.fixed != 0 && fix(nodes_[0], root.fixed)) offer(nodes_[0]);
}

double PressSearch::search(const Branch& branch) {
  left_ = nodes_per_turn;
  Node& root = nodes_[0];
  root.bound = branch.bound;
  root.submodel.start(problem_, branch.fixed | branch.free);
  root.dual_bound = 0;
  if (!fix(root, branch.fixed)) return 0;
  dive(0);
  return nodes_per_turn - left_;
}

/// All models of the branch except the fixed one, which has been offered.
void PressSearch::dive(int depth) {
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
    const int position = choose(node);
    Node& with = nodes_[depth + 1];
    with.bound = node.bound_with[position];
    with.submodel.join(submodel, position);
    if (with.submodel.estimable()) {
      offer(with);
      with.dual = node.dual;
      with.dual_bound = node.dual_bound;
      screen(with);
      dive(depth + 1);
    }
    remove(node, position);
  }
}

/// Fixes candidates that every model of interest contains, and removes those that none contains,
/// until nothing changes. False if no model of interest is left.
bool PressSearch::tighten(Node& node) {
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
    if (needed != 0) {
      if (!fix(node, needed)) return false;
      offer(node);
      screen(node);
      if (submodel.count() > 0) relax(node);
      continue;
    }

    bound_inclusions(node);
    bool removed = false;
    for (int t = submodel.count() - 1; t >= 0; --t) {
      if (node.bound_with[t] > limit) {
        remove(node, t);
        removed = true;
      }
    }
    if (!removed) return true;
  }
  return false;
}

/// Adds all `terms` to the model. False if no model can contain them all.
bool PressSearch::fix(Node& node, TermSet terms) {
  Submodel& submodel = node.submodel;
  while (terms != 0) {
    int position = 0;
    while (position < submodel.count() && !(terms & bit(submodel.term(position)))) ++position;
    if (position == submodel.count()) return false;  // it depends on the others
    terms &= ~bit(submodel.term(position));
    submodel.join(submodel, position);
  }
  return submodel.estimable();
}

void PressSearch::offer(const Node& node) {
  pool_.offer(node.submodel.model(), node.submodel.model_size(), node.submodel.error());
}

void PressSearch::relax(Node& node) {
  const Submodel& submodel = node.submodel;
  const int rows = submodel.rows(), count = submodel.count();
  node.scale.resize(rows);
  for (int i = 0; i < rows; ++i)
    node.scale[i] = std::min(1 / submodel.complements()[i], most_scale);
  weighted_.resize(static_cast<std::size_t>(count + 1) * static_cast<std::size_t>(rows));
  columns_.clear();
  for (int t = 0; t < count; ++t) {
    columns_.push_back(weighted_.data() + t * rows);
    multiply(submodel.column(t), node.scale.data(), columns_.back(), rows);
  }
  double* const response = weighted_.data() + count * rows;
  multiply(submodel.residuals(), node.scale.data(), response, rows);
  node.relaxation.factor(columns_, response, rows);
  node.bound = std::max(node.bound, node.relaxation.rss());
}

/// Finds the dual point of the node's relaxation, and with it the bounds of models with one more
/// term.
void PressSearch::bound_inclusions(Node& node) {
  const Submodel& submodel = node.submodel;
  const int rows = submodel.rows(), count = submodel.count();
  node.dual.assign(submodel.residuals(), submodel.residuals() + rows);
  double* const dual = node.dual.data();
  for (int t = 0; t < count; ++t)
    subtract(dual, node.relaxation.coefficient(t), submodel.column(t), dual, rows);
  multiply(dual, node.scale.data(), dual, rows);
  node.dual_bound = dot(dual, dual, rows);
  multiply(dual, node.scale.data(), dual, rows);
  node.bound_with.resize(count);
  for (int t = 0; t < count; ++t) node.bound_with[t] = std::max(node.bound, bound_with(node, t));
}

/// Bound of the models that contain candidate t, by the node's dual point.
double PressSearch::bound_with(const Node& node, int t) const {
  const Submodel& submodel = node.submodel;
  return node.dual_bound * node.dual_bound /
         weighted_complement(node.dual.data(), submodel.complements(), submodel.column(t),
                             1 / submodel.length2(t), submodel.rows());
}

/// Removes candidates that no model of interest contains, by an older dual point: cheap, and it
/// makes the relaxation smaller.
void PressSearch::screen(Node& node) const {
  Submodel& submodel = node.submodel;
  if (node.dual_bound == 0 || submodel.count() == 0) return;
  const double limit =
      pool_.limit(submodel.model_size() + 1, submodel.model_size() + submodel.count());
  for (int t = submodel.count() - 1; t >= 0; --t) {
    if (bound_with(node, t) > limit) submodel.remove(t);
  }
}

/// Every model without this candidate.
void PressSearch::remove(Node& node, int position) {
  node.submodel.remove(position);
  node.bound_with.erase(node.bound_with.begin() + position);
  if (node.submodel.count() == 0) return;
  if (node.relaxation.dependent()) {
    relax(node);
  } else {
    node.relaxation.drop(position);
    node.bound = std::max(node.bound, node.relaxation.rss());
  }
}

/// The candidate whose decision raises the bounds of both branches most.
int PressSearch::choose(const Node& node) const {
  const double bound = node.relaxation.rss();
  int best = 0;
  double most = -1;
  for (int t = 0; t < node.submodel.count(); ++t) {
    const double gain =
        (node.relaxation.cost(t) + 1e-9 * bound) * (node.bound_with[t] - bound + 1e-9 * bound);
    if (gain > most) {
      most = gain;
      best = t;
    }
  }
  return best;
}

}  // namespace wearwell
