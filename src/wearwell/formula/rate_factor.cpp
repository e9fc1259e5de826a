#include "wearwell/formula/rate_factor.h"

namespace wearwell::formula {
namespace {

class Factors {
 public:
  explicit Factors(Graph& graph) : graph_(graph) {}

  RateParts of(int node) {
    const Node each = graph_[node];
    if (!each.moving) return {node, -1};
    switch (each.op) {
      case Op::negate: {
        const RateParts inner = of(each.a);
        return {inner.factor, graph_.make(Op::negate, 0, inner.shape)};
      }
      case Op::multiply: {
        const RateParts a = of(each.a), b = of(each.b);
        return {times(a.factor, b.factor), times(a.shape, b.shape)};
      }
      case Op::divide: {
        const RateParts a = of(each.a), b = of(each.b);
        return {over(a.factor, b.factor), over(a.shape, b.shape)};
      }
      default:
        return {-1, node};
    }
  }

  int times(int a, int b) {
    if (a < 0) return b;
    return b < 0 ? a : graph_.make(Op::multiply, 0, a, b);
  }

 private:
  int over(int a, int b) {
    if (b < 0) return a;
    return graph_.make(Op::divide, 0, a < 0 ? graph_.constant(1) : a, b);
  }

  Graph& graph_;
};

}  // namespace

int factored_rate(Graph& graph, int rate) {
  if (!graph[rate].moving) return rate;
  Factors factors(graph);
  const RateParts parts = factors.of(rate);
  return factors.times(parts.factor, parts.shape);
}

RateParts rate_parts(const Graph& graph, int rate) {
  const Node& node = graph[rate];
  if (node.op != Op::multiply || graph[node.a].moving == graph[node.b].moving) return {-1, rate};
  return graph[node.a].moving ? RateParts{node.b, node.a} : RateParts{node.a, node.b};
}

}  // namespace wearwell::formula
