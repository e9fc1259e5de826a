#include "wearwell/formula/linear_rate.h"

#include <vector>

namespace wearwell::formula {
namespace {

class Parts {
 public:
  explicit Parts(Graph& graph) : graph_(graph) {}

  std::optional<LinearRate> of(int rate) {
    const std::vector<bool> within = reachable(graph_, {rate});
    const int size = graph_.size();
    parts_.resize(static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i) {
      if (!within[static_cast<std::size_t>(i)]) continue;
      if (!graph_[i].moving) {
        at(i) = {i, -1};
      } else if (!combine(i)) {
        return {};
      }
    }
    return at(rate);
  }

 private:
  LinearRate& at(int i) { return parts_[static_cast<std::size_t>(i)]; }

  int sum(Op op, int a, int b) {
    if (b < 0) return a;
    if (a < 0) return op == Op::add ? b : graph_.make(Op::negate, 0, b);
    return graph_.make(op, 0, a, b);
  }
  int scaled(Op op, int a, int by) { return a < 0 ? -1 : graph_.make(op, 0, a, by); }

  bool combine(int i) {
    const Node node = graph_[i];
    switch (node.op) {
      case Op::state_now:
        at(i) = {-1, graph_.constant(1)};
        return true;
      case Op::add:
      case Op::subtract:
        at(i) = {sum(node.op, at(node.a).constant, at(node.b).constant),
                 sum(node.op, at(node.a).slope, at(node.b).slope)};
        return true;
      case Op::negate:
        at(i) = {sum(Op::subtract, -1, at(node.a).constant),
                 sum(Op::subtract, -1, at(node.a).slope)};
        return true;
      case Op::multiply: {
        if (graph_[node.a].moving && graph_[node.b].moving) return false;
        const int state = graph_[node.a].moving ? node.a : node.b;
        const int by = state == node.a ? node.b : node.a;
        at(i) = {scaled(Op::multiply, at(state).constant, by),
                 scaled(Op::multiply, at(state).slope, by)};
        return true;
      }
      case Op::divide:
        if (graph_[node.b].moving) return false;
        at(i) = {scaled(Op::divide, at(node.a).constant, node.b),
                 scaled(Op::divide, at(node.a).slope, node.b)};
        return true;
      default:
        return false;
    }
  }

  Graph& graph_;
  std::vector<LinearRate> parts_;
};

}  // namespace

std::optional<LinearRate> linear_rate(Graph& graph, int rate) {
  return Parts(graph).of(rate);
}

}  // namespace wearwell::formula
