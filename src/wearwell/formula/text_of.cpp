// Expressions as text.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/formula/graph.h"

namespace wearwell::formula {
namespace {

// The precedence of an operation.
enum Binding { loose, either_, both_, opposite_, compared, sum, product_, minus, raised_, tight };

struct Shape {
  Binding binding;
  const char* sign;  ///< infix operator
};

Shape shape_of(Op op) {
  switch (op) {
    case Op::add:
      return {sum, " + "};
    case Op::subtract:
      return {sum, " - "};
    case Op::multiply:
      return {product_, " * "};
    case Op::divide:
      return {product_, " / "};
    case Op::power:
    case Op::power_log:
    case Op::whole_power:
      return {raised_, "^"};
    case Op::negate:
      return {minus, "-"};
    case Op::less:
      return {compared, " < "};
    case Op::less_equal:
      return {compared, " <= "};
    case Op::equal:
      return {compared, " == "};
    case Op::unequal:
      return {compared, " != "};
    case Op::both:
      return {both_, " and "};
    case Op::either:
      return {either_, " or "};
    case Op::opposite:
      return {opposite_, "not "};
    default:
      return {tight, nullptr};
  }
}

constexpr std::size_t longest = 4000;  // limit, because shared subexpressions are repeated

class Printer {
 public:
  Printer(const Graph& graph, const Symbols& symbols) : graph_(graph), symbols_(symbols) {}

  // The depth of a graph is bounded, which bounds this recursion; the text is bounded too.
  void print(int at, Binding least) {
    if (out.size() > longest) return;
    const Node& node = graph_[at];
    if (node.a < 0) return leaf(node, least);
    const Shape shape = shape_of(node.op);
    if (shape.sign == nullptr) return call(node);
    const bool brackets = shape.binding < least;
    if (brackets) out += "(";
    operation(node, shape);
    if (brackets) out += ")";
  }

  std::string out;

 private:
  static Binding tighter(Binding binding) { return static_cast<Binding>(binding + 1); }

  void operation(const Node& node, const Shape& shape) {
    if (node.op == Op::negate || node.op == Op::opposite) {
      out += shape.sign;
      return print(node.a, shape.binding);
    }
    if (shape.binding == raised_) {
      print(node.a, tight);
      out += shape.sign;
      if (node.op != Op::whole_power) return print(node.b, minus);
      out += fmt::format("{}", node.value);
      return;
    }
    print(node.a, shape.binding == compared ? tighter(compared) : shape.binding);
    out += shape.sign;
    print(node.b, tighter(shape.binding));
  }

  void call(const Node& node) {
    if (node.op == Op::state) {
      out += symbols_state();
      return;
    }
    const auto at = std::find_if(functions().begin(), functions().end(),
                                 [&](const Function& each) { return each.op == node.op; });
    out += at == functions().end() ? "?" : at->name;
    out += "(";
    bool first = true;
    for (const int argument : {node.a, node.b, node.c}) {
      if (argument < 0) continue;
      if (!first) out += ", ";
      first = false;
      print(argument, loose);
    }
    out += ")";
  }

  void leaf(const Node& node, Binding least) {
    const auto index = static_cast<std::size_t>(node.index);
    switch (node.op) {
      case Op::constant:
        return number(node, least);
      case Op::column:
        out += symbols_.columns[index].name;
        return;
      case Op::label_is: {
        const LabelSymbol& label = symbols_.labels[index];
        const bool brackets = compared < least;
        out += fmt::format("{}{} == \"{}\"{}", brackets ? "(" : "", label.name,
                           label.levels[static_cast<std::size_t>(node.level)], brackets ? ")" : "");
        return;
      }
      case Op::parameter:
        return parameter(node);
      case Op::by_row:
        out += symbols_.parameters[index].name;
        return;
      case Op::pick:
        out += fmt::format("{}[{}]", symbols_.parameters[index].name,
                           symbols_.parameters[index].label);
        return;
      case Op::step:
        out += fmt::format("step({})", symbols_.columns[index].name);
        return;
      case Op::axis_now:
        out += symbols_.columns[index].name;
        return;
      default:
        out += symbols_state();
    }
  }

  void parameter(const Node& node) {
    const ParameterSymbol& symbol = symbols_.parameters[static_cast<std::size_t>(node.index)];
    out += symbol.name;
    if (symbol.scope != Scope::per_level) return;
    for (const LabelSymbol& label : symbols_.labels)
      if (label.name == symbol.label)
        out += fmt::format("[\"{}\"]", label.levels[static_cast<std::size_t>(node.level)]);
  }

  void number(const Node& node, Binding least) {
    if (node.truth) {  // known result
      const bool within = least > compared;
      out += fmt::format("{}1 == {}{}", within ? "(" : "", node.value, within ? ")" : "");
      return;
    }
    const bool brackets = std::signbit(node.value) && least > sum;
    const Powers& powers = graph_.dimension(node.powers);
    out += fmt::format("{}{:.6g}{}{}", brackets ? "(" : "", node.value,
                       powers.empty() ? "" : fmt::format(" [{}]", description(powers)),
                       brackets ? ")" : "");
  }

  std::string symbols_state() const { return graph_.state_name(); }

  const Graph& graph_;
  const Symbols& symbols_;
};

}  // namespace

std::string text_of(const Graph& graph, int node, const Symbols& symbols) {
  Printer printer(graph, symbols);
  printer.print(node, loose);
  if (printer.out.size() > longest) printer.out = printer.out.substr(0, longest) + "...";
  return std::move(printer.out);
}

}  // namespace wearwell::formula
