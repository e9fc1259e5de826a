#include "wearwell/formula/c_text.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/formula/written_graph.h"

namespace wearwell::formula {
namespace {

// Helper functions that C lacks, written before the text (c_helpers).
std::string expression_of(const Node& node, const std::vector<std::string>& name) {
  if (const Function* function = find_distribution_function(node.op))
    throw InputError(fmt::format("the formula uses {}, which C does not have", function->name));
  const auto of = [&](int i) -> const std::string& { return name[static_cast<std::size_t>(i)]; };
  const auto unary = [&](const char* function) {
    return fmt::format("{}({})", function, of(node.a));
  };
  const auto binary = [&](const char* sign) {
    return fmt::format("{} {} {}", of(node.a), sign, of(node.b));
  };
  const auto truth = [&](const char* sign) {
    return fmt::format("({}) ? 1.0 : 0.0", binary(sign));
  };
  switch (node.op) {
    case Op::add:
      return binary("+");
    case Op::subtract:
      return binary("-");
    case Op::multiply:
      return binary("*");
    case Op::divide:
      return binary("/");
    case Op::negate:
      return "-" + of(node.a);
    case Op::power:
      return fmt::format("formula_power({}, log({}))", of(node.b), of(node.a));
    case Op::power_log:
      return fmt::format("formula_power({}, {})", of(node.b), of(node.c));
    case Op::whole_power:
      return fmt::format("formula_whole_power({}, {})", of(node.a), static_cast<long>(node.value));
    case Op::exp:
      return unary("exp");
    case Op::log:
      return unary("log");
    case Op::log10:
      return unary("log10");
    case Op::sqrt:
      return unary("sqrt");
    case Op::abs:
      return unary("fabs");
    case Op::erf:
      return unary("erf");
    case Op::erfc:
      return unary("erfc");
    case Op::gamma:
      return unary("tgamma");
    case Op::lgamma:
      return unary("lgamma");
    case Op::probit:
    case Op::digamma:
      throw InputError(fmt::format("the formula uses {}, which C does not have",
                                   node.op == Op::probit ? "a normal quantile" : "digamma"));
    case Op::tanh:
      return unary("tanh");
    case Op::sin:
      return unary("sin");
    case Op::cos:
      return unary("cos");
    case Op::atan:
      return unary("atan");
    case Op::log1p:
      return unary("log1p");
    case Op::expm1:
      return unary("expm1");
    case Op::growth:
      return unary("formula_growth");
    case Op::min:
      return fmt::format("formula_min({}, {})", of(node.a), of(node.b));
    case Op::max:
      return fmt::format("formula_max({}, {})", of(node.a), of(node.b));
    case Op::less:
      return truth("<");
    case Op::less_equal:
      return truth("<=");
    case Op::equal:
      return truth("==");
    case Op::unequal:
      return truth("!=");
    case Op::both:
      return fmt::format("({} != 0 && {} != 0) ? 1.0 : 0.0", of(node.a), of(node.b));
    case Op::either:
      return fmt::format("({} != 0 || {} != 0) ? 1.0 : 0.0", of(node.a), of(node.b));
    case Op::opposite:
      return fmt::format("({} != 0) ? 0.0 : 1.0", of(node.a));
    case Op::where:
      return fmt::format("({} != 0) ? {} : {}", of(node.a), of(node.b), of(node.c));
    default:
      throw InputError(
          "the formula depends on previous rows (cum, step, a state with a rate) and cannot be "
          "exported to C");
  }
}

}  // namespace

std::string c_number(double x) {
  if (std::isnan(x)) return "NAN";
  if (std::isinf(x)) return x > 0 ? "INFINITY" : "(-INFINITY)";
  std::string text = fmt::format("{}", x);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return std::signbit(x) ? "(" + text + ")" : text;
}

// Shared subexpressions are computed once.
std::string c_function(const std::vector<Line>& law, const Wanted& wanted, const Symbols& symbols,
                       const std::string& function) {
  const WrittenGraph written = written_graph(law, {wanted}, symbols);
  const Graph& graph = written.graph;
  const int root = written.roots.front();
  std::vector<std::size_t> begin = slots(symbols);
  std::vector<std::size_t> effect(symbols.parameters.size(), 0);
  for (std::size_t i = 0, next = 0; i < symbols.parameters.size(); ++i)
    if (symbols.parameters[i].scope == Scope::per_row) effect[i] = next++;
  const std::vector<bool> used = reachable(graph, {root});
  std::vector<std::string> name(static_cast<std::size_t>(graph.size()));
  std::string body;
  for (int i = 0; i <= root; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!used[at]) continue;
    const Node& node = graph[i];
    const auto index = static_cast<std::size_t>(node.index);
    switch (node.op) {
      case Op::constant:
        name[at] = c_number(node.value);
        continue;
      case Op::column:
        name[at] = fmt::format("number[{}]", index);
        continue;
      case Op::label_is:
        name[at] = fmt::format("(label[{}] == {} ? 1.0 : 0.0)", index, node.level);
        continue;
      case Op::parameter:
        name[at] =
            fmt::format("parameter[{}]",
                        begin[index] + static_cast<std::size_t>(node.level < 0 ? 0 : node.level));
        continue;
      case Op::pick:
        name[at] = fmt::format("parameter[{} + label[{}]]", begin[index], node.level);
        continue;
      case Op::by_row:
        name[at] = fmt::format("effect[{}]", effect[index]);
        continue;
      default:
        name[at] = fmt::format("v{}", i);
        body += fmt::format("  const double v{} = {};\n", i, expression_of(node, name));
    }
  }
  return fmt::format(
      "static double {}(const double *number, const int *label, const double *parameter,\n"
      "                 const double *effect) {{\n{}  (void)number, (void)label, (void)parameter, "
      "(void)effect;\n  return {};\n}}\n",
      function, body, name[static_cast<std::size_t>(root)]);
}

std::string c_helpers(std::string_view functions) {
  static constexpr std::pair<std::string_view, std::string_view> all[] = {
      {"formula_power(", R"(static double formula_power(double exponent, double log_base) {
  return exponent == 0 ? 1 : exp(exponent * log_base);
}
)"},
      {"formula_whole_power(", R"(static double formula_whole_power(double base, long exponent) {
  unsigned long n = exponent < 0 ? (unsigned long)(-exponent) : (unsigned long)exponent;
  double result = 1;
  for (; n > 0; n >>= 1, base *= base)
    if (n & 1u) result *= base;
  return exponent < 0 ? 1 / result : result;
}
)"},
      {"formula_growth(",
       "static double formula_growth(double x) { return x == 0 ? 1 : expm1(x) / x; }\n"},
      {"formula_min(",
       "static double formula_min(double a, double b) { return (a < b || a != a) ? a : b; }\n"},
      {"formula_max(",
       "static double formula_max(double a, double b) { return (a > b || a != a) ? a : b; }\n"}};
  std::string helpers;
  for (const auto& [call, definition] : all)
    if (functions.find(call) != functions.npos) helpers += definition;
  return helpers;
}

}  // namespace wearwell::formula
