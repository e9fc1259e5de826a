#include "wearwell/formula/graph.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/formula/kernels.h"

namespace wearwell::formula {

std::size_t Graph::Hash::operator()(const Node& node) const {
  std::uint64_t hash = 0x9e3779b97f4a7c15u;
  const auto mix = [&](std::uint64_t x) {
    hash = (hash ^ x) * 0xff51afd7ed558ccdu;
    hash ^= hash >> 32;
  };
  mix(static_cast<std::uint64_t>(node.op));
  for (const int i : {node.a, node.b, node.c, node.index, node.level, node.powers})
    mix(static_cast<std::uint64_t>(i));
  mix(std::bit_cast<std::uint64_t>(node.value));
  mix(node.any);
  mix(node.truth);
  return static_cast<std::size_t>(hash);
}

bool Graph::Same::operator()(const Node& a, const Node& b) const {
  return a.op == b.op && a.a == b.a && a.b == b.b && a.c == b.c && a.index == b.index &&
         a.level == b.level && a.powers == b.powers && a.any == b.any && a.truth == b.truth &&
         std::bit_cast<std::uint64_t>(a.value) == std::bit_cast<std::uint64_t>(b.value);
}

Graph::Graph() {
  intern({});
}

int Graph::intern(const Powers& powers) {
  const auto [at, is_new] = interned_.emplace(powers, static_cast<int>(dimensions_.size()));
  if (is_new) dimensions_.push_back(powers);
  return at->second;
}

void Graph::derive(Node& node) const {
  switch (node.op) {
    case Op::column:
    case Op::label_is:
    case Op::step:
      node.rows = true;
      break;
    case Op::by_row:
    case Op::pick:
      node.rows = node.parametric = true;
      break;
    case Op::parameter:
      node.parametric = true;
      break;
    case Op::state_now:
      node.moving = node.parametric = node.rows = true;
      break;
    case Op::axis_now:
      node.moving = node.rows = true;
      break;
    case Op::cum:
    case Op::recurrence:
      node.rows = node.by_path = true;
      break;
    case Op::state:
      node.rows = node.by_path = node.parametric = true;
      break;
    default:
      break;
  }
  node.by_label = node.op == Op::pick ? node.level : -1;
  bool other_rows = node.op == Op::cum || node.op == Op::state || node.op == Op::recurrence;
  for (const int argument : {node.a, node.b, node.c}) {
    if (argument < 0) continue;
    const Node& from = (*this)[argument];
    if (from.rows) {
      other_rows |= from.by_label < 0 || (node.by_label >= 0 && node.by_label != from.by_label);
      node.by_label = from.by_label;
    }
    node.rows |= from.rows;
    node.parametric |= from.parametric;
    node.by_path |= from.by_path;
    node.moving |= from.moving;
    node.depth = std::max(node.depth, from.depth + 1);
  }
  if (other_rows) node.by_label = -1;
  if (node.op == Op::state) node.moving = false;
}

int Graph::folded(const Node& node) {
  double arguments[3] = {};
  const int from[3] = {node.a, node.b, node.c};
  for (int i = 0; i < 3; ++i) {
    if (from[i] < 0) continue;
    const Node& each = (*this)[from[i]];
    if (each.op != Op::constant) return -1;
    arguments[i] = each.value;
  }
  Node constant;
  constant.value = value_of(node.op, arguments[0], arguments[1], arguments[2], node.value);
  constant.powers = node.powers;
  constant.truth = node.truth;
  // A result that is not a number is not folded, so that a message can name the expression.
  return std::isfinite(constant.value) ? add(constant) : -1;
}

int Graph::add(Node node) {
  const bool leaf = node.a < 0;
  if (!leaf && node.op != Op::cum && node.op != Op::state && node.op != Op::recurrence) {
    if (const int constant = folded(node); constant >= 0) return constant;
  }
  if (const auto at = known_.find(node); at != known_.end()) return at->second;
  derive(node);
  node.origin = origin_;
  if (node.depth > most_depth) throw InputError("an expression is more than 1000 operations deep");
  if (size() >= most_nodes) throw InputError("the formulas have more than 200000 operations");
  const int at = size();
  nodes_.push_back(node);
  known_.emplace(node, at);
  return at;
}

int Graph::constant(double value, int powers) {
  Node node;
  node.value = value;
  node.powers = powers;
  return add(node);
}

int Graph::make(Op op, int powers, int a, int b, int c, bool truth) {
  Node node;
  node.op = op;
  node.a = a;
  node.b = b;
  node.c = c;
  node.powers = powers;
  node.truth = truth;
  return add(node);
}

std::vector<bool> reachable(const Graph& graph, const std::vector<int>& roots) {
  std::vector<bool> found(static_cast<std::size_t>(graph.size()));
  for (const int root : roots) found[static_cast<std::size_t>(root)] = true;
  for (int i = graph.size(); i-- > 0;) {
    if (!found[static_cast<std::size_t>(i)]) continue;
    for (const int from : {graph[i].a, graph[i].b, graph[i].c})
      if (from >= 0) found[static_cast<std::size_t>(from)] = true;
  }
  return found;
}

}  // namespace wearwell::formula
