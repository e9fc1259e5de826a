#include "wearwell/models/formula_model/formula_sql.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/formula/written_graph.h"

namespace wearwell::formula_model {
namespace {

using fleet::Dialect;
using formula::Node;
using formula::Op;

/// Longer texts become a step of their own, even if they are used once.
constexpr std::size_t longest = 2000;

class Printer {
 public:
  Printer(const formula::WrittenGraph& written, const formula::Symbols& symbols, Dialect dialect)
      : graph_(written.graph),
        root_(written.roots.front()),
        symbols_(symbols),
        begin_(slots(symbols)),
        dialect_(dialect),
        text_(static_cast<std::size_t>(graph_.size())),
        drawn_(text_.size()),
        uses_(text_.size()) {}

  FormulaSql print() {
    const std::vector<bool> used = reachable(graph_, {root_});
    for (int i = 0; i <= root_; ++i)
      if (used[static_cast<std::size_t>(i)]) count_uses(graph_[i]);
    for (int i = 0; i <= root_; ++i)
      if (used[static_cast<std::size_t>(i)]) write(i);
    const auto list = [](const std::set<std::size_t>& from, std::vector<std::size_t>& to) {
      to.assign(from.begin(), from.end());
    };
    list(columns_, out_.columns);
    list(labels_, out_.labels);
    list(parameters_, out_.parameters);
    list(effects_, out_.effects);
    return std::move(out_);
  }

 private:
  bool clickhouse() const { return dialect_ == Dialect::clickhouse; }
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  const std::string& of(int i) const { return text_[at(i)]; }

  /// Operations whose SQL repeats an operand.
  static bool repeats(Op op) {
    switch (op) {
      case Op::power:
      case Op::power_log:
      case Op::exp:
      case Op::log:
      case Op::log10:
      case Op::sqrt:
      case Op::log1p:
      case Op::expm1:
      case Op::growth:
      case Op::tanh:
      case Op::min:
      case Op::max:
        return true;
      default:
        return false;
    }
  }

  void count_uses(const Node& node) {
    for (const int each : {node.a, node.b, node.c})
      if (each >= 0) uses_[at(each)] += repeats(node.op) ? 2 : 1;
  }

  std::string choose(const std::string& condition, const std::string& yes,
                     const std::string& no) const {
    if (clickhouse()) return fmt::format("if({}, {}, {})", condition, yes, no);
    return fmt::format("case when {} then {} else {} end", condition, yes, no);
  }
  std::string nothing() const { return clickhouse() ? "nan" : "null"; }
  /// For engines that abort a statement where a result is not a number.
  std::string where(const std::string& condition, const std::string& yes) const {
    return clickhouse() ? yes : choose(condition, yes, nothing());
  }

  std::string drawn(int i, const std::string& name) {
    drawn_[at(i)].insert(name);
    return name;
  }

  std::string exp(const std::string& x) const {
    if (dialect_ != Dialect::postgresql) return fmt::format("exp({})", x);
    // Such an engine aborts a statement where a result underflows or overflows a double.
    return fmt::format("case when {0} < -745e0 then 0e0 when {0} < 709.7e0 then exp({0}) end", x);
  }

  std::string power(const std::string& exponent, const std::string& log) const {
    return choose(exponent + " = 0e0", "1e0", exp("(" + exponent + " * " + log + ")"));
  }

  std::string leaf(int i, const Node& node) {
    const std::size_t index = node.index < 0 ? 0 : at(node.index);
    const auto parameter = [&](std::size_t family_parameter) {
      parameters_.insert(family_parameter);
      return drawn(i, fmt::format("formula_p{}", family_parameter));
    };
    const auto label = [&](std::size_t l) {
      labels_.insert(l);
      return fmt::format("formula_l{}", l);
    };
    switch (node.op) {
      case Op::constant:
        return fleet::number(node.value);
      case Op::column:
        columns_.insert(index);
        return fmt::format("formula_x{}", index);
      case Op::parameter:
        return parameter(begin_[index] + (node.level < 0 ? 0 : at(node.level)));
      case Op::by_row: {
        std::size_t effect = 0;
        for (std::size_t s = 0; s < index; ++s)
          effect += symbols_.parameters[s].scope == formula::Scope::per_row;
        effects_.insert(effect);
        return drawn(i, fmt::format("formula_e{}", effect));
      }
      case Op::label_is:
        return choose(label(index) + " = " + level(index, at(node.level)), "1e0", "0e0");
      default:
        break;
    }
    // pick: the value for the row's label.
    const std::size_t l = at(node.level);
    std::string text = nothing();
    for (std::size_t k = symbols_.labels[l].levels.size(); k-- > 0;)
      text = choose(label(l) + " = " + level(l, k), parameter(begin_[index] + k), text);
    return text;
  }

  std::string level(std::size_t label, std::size_t k) const {
    return fleet::literal(dialect_, symbols_.labels[label].levels[k]);
  }

  std::string unary(const Node& node) const {
    const std::string& a = of(node.a);
    const auto call = [&](const char* name) { return fmt::format("{}({})", name, a); };
    switch (node.op) {
      case Op::negate:
        return "-" + a;
      case Op::opposite:
        return choose(a + " <> 0e0", "0e0", "1e0");
      case Op::whole_power:
        return fmt::format("power({}, {}e0)", a, static_cast<long>(node.value));
      case Op::exp:
        return exp(a);
      case Op::log:
        return where(a + " > 0e0", call("ln"));
      case Op::log10:
        return where(a + " > 0e0", call("log10"));
      case Op::sqrt:
        return where(a + " >= 0e0", call("sqrt"));
      case Op::abs:
        return call("abs");
      case Op::tanh:
        // ClickHouse 18.16 lacks the function.
        return !clickhouse() ? call("tanh")
                             : choose(fmt::format("abs({}) < 1e-4", a),
                                      fmt::format("{0} * (1e0 - {0} * {0} / 3e0)", a),
                                      fmt::format("1e0 - 2e0 / (exp(2e0 * {}) + 1e0)", a));
      case Op::sin:
        return call("sin");
      case Op::cos:
        return call("cos");
      case Op::atan:
        return call("atan");
      case Op::erf:
        if (clickhouse()) return call("erf");
        lacks("erf");
      case Op::erfc:
        if (clickhouse()) return call("erfc");
        lacks("erfc");
      case Op::gamma:
        if (dialect_ == Dialect::postgresql) lacks("gamma");
        return call(clickhouse() ? "tgamma" : "gamma");
      case Op::lgamma:
        if (dialect_ == Dialect::postgresql) lacks("lgamma");
        return call("lgamma");
      case Op::digamma:
        lacks("digamma");
      case Op::probit:
        lacks("a normal quantile");
      // Kahan's form, which keeps full precision near 0 (Goldberg, ACM Computing Surveys 23, 1991,
      // theorem 4).
      case Op::log1p:
        return where(a + " > -1e0",
                     choose(fmt::format("1e0 + {} = 1e0", a), a,
                            fmt::format("ln(1e0 + {0}) * {0} / ((1e0 + {0}) - 1e0)", a)));
      // Otherwise the difference keeps at least eleven digits.
      case Op::expm1:
        return choose(fmt::format("abs({}) < 1e-5", a),
                      fmt::format("{0} * (1e0 + {0} * (0.5e0 + {0} / 6e0))", a), exp(a) + " - 1e0");
      case Op::growth:
        return choose(fmt::format("abs({}) < 1e-5", a),
                      fmt::format("1e0 + {0} * (0.5e0 + {0} / 6e0)", a),
                      "(" + exp(a) + " - 1e0) / " + a);
      default:
        return "";
    }
  }

  [[noreturn]] void lacks(const char* function) const {
    throw InputError(fmt::format("the formula uses {}, which {} does not have", function,
                                 fleet::name_of(dialect_)));
  }

  [[noreturn]] static void refuse_rows_before() {
    throw InputError(
        "the formula depends on earlier rows (cum, step, a state given by its rate); SQL export "
        "does not support such paths");
  }

  std::string binary(const Node& node) const {
    if (node.b < 0) refuse_rows_before();
    if (const formula::Function* function = formula::find_distribution_function(node.op))
      lacks(function->name);
    const auto sign = [&](const char* between) {
      return fmt::format("{} {} {}", of(node.a), between, of(node.b));
    };
    const auto truth = [&](const std::string& condition) {
      return choose(condition, "1e0", "0e0");
    };
    const std::string &a = of(node.a), &b = of(node.b);
    switch (node.op) {
      case Op::add:
        return sign("+");
      case Op::subtract:
        return sign("-");
      case Op::multiply:
        return sign("*");
      case Op::divide:
        return clickhouse() || graph_[node.b].op == Op::constant
                   ? sign("/")
                   : fmt::format("{} / nullif({}, 0e0)", a, b);
      case Op::power:
        return where(fmt::format("{} > 0e0 or {} = 0e0", a, b), power(b, "ln(" + a + ")"));
      case Op::power_log:
        return power(b, of(node.c));
      case Op::min:
        return choose(a + " < " + b, a, choose(b + " <= " + a, b, nothing()));
      case Op::max:
        return choose(a + " > " + b, a, choose(b + " >= " + a, b, nothing()));
      case Op::less:
        return truth(sign("<"));
      case Op::less_equal:
        return truth(sign("<="));
      case Op::equal:
        return truth(sign("="));
      case Op::unequal:
        return truth(sign("<>"));
      case Op::both:
        return truth(fmt::format("{} <> 0e0 and {} <> 0e0", a, b));
      case Op::either:
        return truth(fmt::format("{} <> 0e0 or {} <> 0e0", a, b));
      case Op::where:
        return choose(a + " <> 0e0", b, of(node.c));
      default:
        refuse_rows_before();
    }
  }

  void write(int i) {
    const Node& node = graph_[i];
    std::string& text = text_[at(i)];
    bool is_leaf = false;
    switch (node.op) {
      case Op::constant:
      case Op::column:
      case Op::parameter:
      case Op::by_row:
        is_leaf = true;
        [[fallthrough]];
      case Op::label_is:
      case Op::pick:
        text = leaf(i, node);
        break;
      default:
        text = unary(node);
        if (text.empty()) text = binary(node);
    }
    for (const int each : {node.a, node.b, node.c})
      if (each >= 0) drawn_[at(i)].insert(drawn_[at(each)].begin(), drawn_[at(each)].end());
    if (i != root_ && (is_leaf || (uses_[at(i)] < 2 && text.size() < longest))) {
      if (!is_leaf) text = "(" + text + ")";
      return;
    }
    std::set<std::string>& names = drawn_[at(i)];
    const std::string name = i == root_ ? "formula_value" : fmt::format("formula_v{}", i);
    out_.steps.push_back({name, text, {names.begin(), names.end()}});
    if (!names.empty()) names = {name};
    text = name;
  }

  const formula::Graph& graph_;
  int root_;
  const formula::Symbols& symbols_;
  std::vector<std::size_t> begin_;
  Dialect dialect_;
  std::vector<std::string> text_;
  std::vector<std::set<std::string>> drawn_;
  std::vector<int> uses_;
  std::set<std::size_t> columns_, labels_, parameters_, effects_;
  FormulaSql out_;
};

}  // namespace

FormulaSql formula_sql(const std::vector<formula::Line>& model, const formula::Wanted& wanted,
                       const formula::Symbols& symbols, fleet::Dialect dialect) {
  const formula::WrittenGraph written = formula::written_graph(model, {wanted}, symbols);
  return Printer(written, symbols, dialect).print();
}

}  // namespace wearwell::formula_model
