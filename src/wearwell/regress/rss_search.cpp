#include "wearwell/regress/rss_search.h"

#include <algorithm>
#include <numeric>

namespace wearwell {
namespace {

/// Nodes after which a thread gives its branch back, so that others find work and the branches
/// with the smallest bounds come first.
constexpr int nodes_per_turn = 1000;

}  // namespace

RssSearch::RssSearch(const SearchProblem& problem, ModelPool& pool, Frontier& frontier)
    : problem_(problem), pool_(pool), frontier_(frontier), nodes_(problem.terms + 1) {}

void RssSearch::offer_root(const Branch& branch) {
  const auto set = branch.fixed | branch.free;
  if (start(nodes_[0], branch.fixed, branch.free))
    pool_.offer(set, static_cast<int>(terms_of(set).size()), nodes_[0].relaxation.rss());
}

double RssSearch::search(const Branch& branch) {
  left_ = nodes_per_turn;
  if (start(nodes_[0], branch.fixed, branch.free)) dive(0);
  return nodes_per_turn - left_;
}

/// Fits all of the branch's terms. False if the fixed ones depend on each other.
bool RssSearch::start(Node& node, TermSet fixed, TermSet free) {
  node.fixed = fixed;
  node.free = terms_of(free);
  std::vector<int> terms = terms_of(fixed);
  node.fixed_size = static_cast<int>(terms.size());
  terms.insert(terms.end(), node.free.begin(), node.free.end());
  const int rows = problem_.stored;
  work_.resize((terms.size() + 1) * rows);
  columns_.clear();
  double* place = work_.data();
  for (const int term : terms) {
    std::copy_n(problem_.columns.col(term).data(), rows, place);
    columns_.push_back(place);
    place += rows;
  }
  std::copy_n(problem_.response.data(), rows, place);
  node.relaxation.factor(columns_, place, rows);
  for (int j = 0; j < node.fixed_size; ++j) {
    if (node.relaxation.depends(j)) return false;
  }
  node.relaxation.fix(node.fixed_size);
  return true;
}

/// All models of the branch except the largest, which has been offered.
void RssSearch::dive(int depth) {
  --left_;
  Node& node = nodes_[depth];
  const int count = static_cast<int>(node.free.size());
  const int size = node.fixed_size + count;
  Relaxation& fit = node.relaxation;
  fit.analyse();
  TermSet all = node.fixed;
  for (const int term : node.free) all |= bit(term);
  if (size > 1) {
    for (int t = 0; t < count; ++t)
      pool_.offer(all & ~bit(node.free[t]), size - 1, fit.rss() + fit.cost(t));
  }

  // Branch i removes the i-th most expensive term and keeps those before it. It removes another
  // one, too: the models without just one term have been offered.
  node.order.resize(count);
  std::iota(node.order.begin(), node.order.end(), 0);
  std::sort(node.order.begin(), node.order.end(), [&](int a, int b) {
    return fit.cost(a) != fit.cost(b) ? fit.cost(a) > fit.cost(b) : a < b;
  });
  Branch branch{node.fixed, all & ~node.fixed, 0};
  for (int i = 0; i + 1 < count && size > 2; ++i) {
    const TermSet out = bit(node.free[node.order[i]]);
    branch.free &= ~out;
    const double rss = fit.rss() + fit.cost(node.order[i]);
    const int smallest = std::max(node.fixed_size + i, 1);
    branch.bound = problem_.score.of(rss, smallest);
    if (!(rss > pool_.limit(smallest, size - 2))) {
      if (left_ == 0 || frontier_.stopped()) {
        frontier_.give_back(branch);
      } else if (enter(nodes_[depth + 1], node, i, branch)) {
        dive(depth + 1);
      }
    }
    branch.fixed |= out;
  }
}

/// Makes `next` the node of `branch`, the i-th of `node`.
bool RssSearch::enter(Node& next, const Node& node, int i, const Branch& branch) {
  if (node.relaxation.dependent()) return start(next, branch.fixed, branch.free);
  const std::span<const int> order = std::span(node.order).subspan(i);
  next.fixed = branch.fixed;
  next.fixed_size = node.fixed_size + i;
  next.free.clear();
  for (const int t : order.subspan(1)) next.free.push_back(node.free[t]);
  next.relaxation.drop_first(node.relaxation, order);
  return true;
}

}  // namespace wearwell
