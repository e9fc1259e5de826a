#include "wearwell/formula/by_row_degree.h"

#include <algorithm>
#include <vector>

namespace wearwell::formula {
namespace {

ByRowDegree degree_of(const Node& node, ByRowDegree a, ByRowDegree b, ByRowDegree c) {
  constexpr ByRowDegree none = ByRowDegree::none, other = ByRowDegree::other;
  if (node.op == Op::by_row) return ByRowDegree::linear;
  if (std::max({a, b, c}) == none) return none;
  switch (node.op) {
    case Op::add:
    case Op::subtract:
    case Op::negate:
      return std::max(a, b);
    case Op::multiply:
      return std::min(a, b) == none ? std::max(a, b) : other;
    case Op::divide:
      return b == none ? a : other;
    case Op::where:
      return a == none ? std::max(b, c) : other;
    default:
      return other;
  }
}

}  // namespace

ByRowDegree by_row_degree(const Graph& graph, int root) {
  const std::vector<bool> within = reachable(graph, {root});
  std::vector<ByRowDegree> degree(static_cast<std::size_t>(graph.size()), ByRowDegree::none);
  const auto at = [&](int i) {
    return i < 0 ? ByRowDegree::none : degree[static_cast<std::size_t>(i)];
  };
  for (int i = 0; i <= root; ++i) {
    if (!within[static_cast<std::size_t>(i)]) continue;
    const Node& node = graph[i];
    degree[static_cast<std::size_t>(i)] = degree_of(node, at(node.a), at(node.b), at(node.c));
  }
  return at(root);
}

}  // namespace wearwell::formula
