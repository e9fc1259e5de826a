#include "wearwell/formula/regroup.h"

#include <algorithm>
#include <array>
#include <utility>

#include "wearwell/formula/linear_rate.h"
#include "wearwell/formula/rate_factor.h"

namespace wearwell::formula {
namespace {

// The cost class of a factor: constant, once for all data, once per call, once per level of a
// label, once per row, or within a path.
enum Class { known, of_data, of_parameters, of_labels, of_rows, of_state, classes };

class Regrouping {
 public:
  Regrouping(const Graph& from, const std::vector<int>& roots, int axis, Graph& to)
      : from_(from),
        to_(to),
        axis_(axis),
        image_(static_cast<std::size_t>(from.size()), -1),
        uses_(static_cast<std::size_t>(from.size())) {
    needed_ = reachable(from, roots);
    for (int i = 0; i < from.size(); ++i) {
      if (!needed_[static_cast<std::size_t>(i)]) continue;
      for (const int argument : {from[i].a, from[i].b, from[i].c})
        if (argument >= 0) ++uses_[static_cast<std::size_t>(argument)];
    }
    for (const int root : roots) ++uses_[static_cast<std::size_t>(root)];
  }

  void run() {
    for (int i = 0; i < from_.size(); ++i)
      if (needed_[static_cast<std::size_t>(i)]) image_[static_cast<std::size_t>(i)] = image_of(i);
  }

  int image(int i) const { return image_[static_cast<std::size_t>(i)]; }

 private:
  static bool is_product(Op op) {
    return op == Op::multiply || op == Op::divide || op == Op::negate;
  }

  Class class_of(int node) const {
    const Node& each = to_[node];
    if (each.op == Op::constant) return known;
    if (each.moving) return of_state;
    if (!each.parametric) return of_data;
    if (!each.rows) return of_parameters;
    return each.by_label >= 0 ? of_labels : of_rows;
  }

  int image_of(int i) {
    const Node& node = from_[i];
    if (is_product(node.op) && node.parametric) return product(i);
    Node copy = node;
    const auto mapped = [&](int argument) { return argument < 0 ? -1 : image(argument); };
    copy.a = mapped(node.a);
    copy.b = mapped(node.b);
    copy.c = mapped(node.c);
    copy.powers = 0;  // already checked
    copy.any = false;
    if (node.op == Op::power && !to_[copy.a].parametric && !to_[copy.a].moving &&
        to_[copy.b].parametric) {
      copy.op = Op::power_log;
      copy.c = to_.make(Op::log, 0, copy.a);
    }
    if (node.op == Op::state) {
      if (const auto linear = linear_rate(to_, copy.b)) return recurrence(*linear, copy.a);
      copy.b = factored_rate(to_, copy.b);
    }
    return to_.add(copy);
  }

  // Between two rows y' = A + B y with constant A and B: y grows by exp(B h) and gains A h growth(B
  // h).
  int recurrence(const LinearRate& rate, int beginning) {
    Node step;
    step.op = Op::step;
    step.index = axis_;
    const int h = to_.add(step);
    const int exponent = to_.make(Op::multiply, 0, rate.slope, h);
    int gain = -1;
    if (rate.constant >= 0)
      gain = to_.make(Op::multiply, 0, to_.make(Op::multiply, 0, rate.constant, h),
                      to_.make(Op::growth, 0, exponent));
    return to_.make(Op::recurrence, 0, to_.make(Op::exp, 0, exponent), beginning, gain);
  }

  // Factors above (0) and below (1) the line, by class.
  using Factors = std::array<std::array<std::vector<int>, classes>, 2>;

  // Flattens nested products unless they are shared.
  void gather(int i, bool below, bool& negative, Factors& factors) {
    std::vector<std::pair<int, bool>> open = {{i, below}};
    while (!open.empty()) {
      const auto [at, under] = open.back();
      open.pop_back();
      const Node& node = from_[at];
      const bool own = at == i || (uses_[static_cast<std::size_t>(at)] == 1 && node.parametric);
      if (!is_product(node.op) || !own) {
        const int factor = image(at);
        factors[under][class_of(factor)].push_back(factor);
        continue;
      }
      if (node.op == Op::negate) negative = !negative;
      if (node.op != Op::negate) open.emplace_back(node.b, under != (node.op == Op::divide));
      open.emplace_back(node.a, under);
    }
  }

  int times(int a, int b) {
    if (a < 0) return b;
    return b < 0 ? a : to_.make(Op::multiply, 0, a, b);
  }

  int product_of(const std::vector<int>& factors) {
    int result = -1;
    for (const int each : factors) result = times(result, each);
    return result;
  }

  int product(int i) {
    bool negative = false;
    Factors factors;
    gather(i, false, negative, factors);
    // From constant to most variable.
    int result = -1;
    const auto join = [&](std::initializer_list<Class> group) {
      int above = -1, below = -1;
      for (const Class each : group) {
        above = times(above, product_of(factors[0][each]));
        below = times(below, product_of(factors[1][each]));
      }
      if (below >= 0) above = to_.make(Op::divide, 0, above < 0 ? to_.constant(1) : above, below);
      result = times(result, above);
    };
    const auto any = [&](Class each) {
      return !factors[0][each].empty() || !factors[1][each].empty();
    };
    const Class first = any(of_parameters) ? of_parameters : any(of_labels) ? of_labels : of_data;
    join({known, first});
    for (const Class each : {of_labels, of_data})
      if (each != first) join({each});
    for (const Class each : {of_rows, of_state}) {
      result = times(result, product_of(factors[0][each]));
      if (const int below = product_of(factors[1][each]); below >= 0)
        result = to_.make(Op::divide, 0, result < 0 ? to_.constant(1) : result, below);
    }
    return negative ? to_.make(Op::negate, 0, result) : result;
  }

  const Graph& from_;
  Graph& to_;
  int axis_;
  std::vector<int> image_, uses_;
  std::vector<bool> needed_;
};

}  // namespace

std::vector<int> regrouped(const Graph& from, const std::vector<int>& roots, int axis, Graph& to) {
  Regrouping regrouping(from, roots, axis, to);
  regrouping.run();
  std::vector<int> images;
  images.reserve(roots.size());
  for (const int root : roots) images.push_back(regrouping.image(root));
  return images;
}

}  // namespace wearwell::formula
