#include "wearwell/formula/rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"

namespace wearwell::formula {
namespace {

constexpr double largest_exponent = 100;  // limit for a quantity with a dimension

bool has_angle(const Powers& powers) {
  return powers == Powers{{"radian", 1}};
}

}  // namespace

std::string difference(const Powers& a, const Powers& b) {
  const Powers quotient_ab = quotient(a, b);
  Powers others = quotient_ab;
  others.erase("cycle");
  others.erase("radian");
  if (others.empty() && quotient_ab.contains("radian"))
    return "an angle is neither a count nor a pure number; multiply or divide by 1 [rad]";
  if (others.empty()) return "a count has its own dimension; multiply or divide by 1 [cycle]";
  return fmt::format("their ratio is {}; check for a missing factor or power",
                     description(quotient_ab));
}

std::string Rules::written(const Term& term) const {
  return printable(shortened(text_.text.substr(term.at, term.end - term.at), 48));
}

std::string Rules::dimension(const Term& term) const {
  return description(powers(term));
}

// A divisor that makes the term a pure number: "1 [N]".
std::string Rules::stand_in(const Term& term) const {
  return fmt::format("1 [{}]", description(powers(term)));
}

void Rules::demand_value(const Term& term) const {
  if (term.kind == Term::label) {
    const LabelSymbol& label = symbols_.labels[static_cast<std::size_t>(term.label_index)];
    complain(text_, term.at, fmt::format("'{}' is a label, not a number", label.name),
             label.levels.empty()
                 ? "compare it with one of its texts"
                 : fmt::format("compare it: {} == \"{}\"", label.name, label.levels.front()));
  }
  if (term.kind == Term::quotation)
    complain(text_, term.at, "a text in quotes is not a number",
             "it can only be compared with a label");
}

void Rules::demand_truth(const Term& term, const std::string& of) const {
  demand_value(term);
  if (node(term).truth) return;
  complain(text_, term.at,
           fmt::format("{} needs a condition, but '{}' is a number ({})", of, written(term),
                       dimension(term)),
           "compare it with another number, as in x > 0");
}

void Rules::demand_pure(const Term& term, const std::string& of, std::size_t at) const {
  demand_value(term);
  if (powers(term).empty()) return;
  complain(
      text_, at,
      fmt::format("{} needs a pure number, but '{}' is {}", of, written(term), dimension(term)),
      fmt::format("divide it by a quantity of its dimension, as in ({})/{}", written(term),
                  stand_in(term)));
}

// The common dimension of both.
int Rules::common(const Term& a, const Term& b, const std::string& what, std::size_t at) const {
  demand_value(a);
  demand_value(b);
  if (node(a).any) return node(b).powers;
  if (node(b).any || node(a).powers == node(b).powers) return node(a).powers;
  complain(text_, at,
           fmt::format("'{}' is {}, but '{}' is {}: they cannot be {}", written(a), dimension(a),
                       written(b), dimension(b), what),
           difference(powers(a), powers(b)));
}

Term Rules::made(Node made_node, const Term& a, const Term& b, std::size_t at) {
  const Term term{graph_.add(made_node), std::min(a.at, at), std::max({a.end, b.end})};
  const Node& result = graph_[term.node];
  bool constants = result.op != Op::constant && result.a >= 0 && result.op != Op::cum;
  for (const int from : {result.a, result.b, result.c})
    constants &= from < 0 || graph_[from].op == Op::constant;
  if (constants)
    complain(text_, at, fmt::format("'{}' is not a finite number", written(term)),
             result.op == Op::divide ? "it is a division by 0" : "");
  return term;
}

Term Rules::of(Op op, int powers, const Term& a, const Term& b, std::size_t at, bool truth) {
  Node result;
  result.op = op;
  result.a = a.node;
  result.b = b.node;
  result.powers = powers;
  result.truth = truth;
  return made(result, a, b, at);
}

Term Rules::sum(Op op, const Term& a, const Term& b, std::size_t at) {
  const int powers = common(a, b, op == Op::add ? "added" : "subtracted", at);
  return of(op, powers, a, b, at);
}

Term Rules::product(Op op, const Term& a, const Term& b, std::size_t at) {
  demand_value(a);
  demand_value(b);
  if (op == Op::divide && node(b).op == Op::constant && node(b).value == 0)
    complain(text_, at, fmt::format("'{}' is 0, so division by it is not possible", written(b)));
  const int powers =
      graph_.intern(op == Op::multiply ? formula::product(this->powers(a), this->powers(b))
                                       : quotient(this->powers(a), this->powers(b)));
  return of(op, bounded(powers, at), a, b, at);
}

// Limits the growth of fractional powers under repeated multiplication.
int Rules::bounded(int powers, std::size_t at) const {
  for (const auto& [base, exponent] : graph_.dimension(powers)) {
    if (std::abs(exponent.numerator()) > 1000 || exponent.denominator() > 64)
      complain(text_, at, "a dimension with powers above 1000 or below 1/64");
  }
  return powers;
}

Term Rules::power(const Term& base, const Term& exponent, std::size_t at) {
  demand_value(base);
  demand_pure(exponent, "an exponent", exponent.at);
  const Node power = node(exponent);
  const bool constant = power.op == Op::constant;
  const bool whole = constant && std::floor(power.value) == power.value &&
                     std::abs(power.value) <= largest_exponent;
  const Powers& base_powers = powers(base);
  if (!whole && !base_powers.empty()) {
    const bool half = constant && power.value == 0.5;
    const std::string why =
        constant
            ? (std::abs(power.value) > largest_exponent
                   ? fmt::format("an exponent above {}", largest_exponent)
                   : "a power that is not a whole number")
            : fmt::format("a power with '{}', which is not a fixed number,", written(exponent));
    complain(
        text_, at,
        fmt::format("{} needs a pure number, but '{}' is {}", why, written(base), dimension(base)),
        half ? fmt::format("write sqrt({}), or ({}/{})^0.5", written(base), written(base),
                           stand_in(base))
             : fmt::format("write ({}/{})^{}", written(base), stand_in(base), written(exponent)));
  }
  if (!whole) return of(Op::power, 0, base, exponent, at);
  Node result;
  result.op = Op::whole_power;
  result.a = base.node;
  result.value = power.value;
  result.powers = bounded(graph_.intern(raised(base_powers, static_cast<int>(power.value))), at);
  return made(result, base, exponent, at);
}

Term Rules::negative(const Term& a, std::size_t at) {
  demand_value(a);
  if (node(a).any) return {a.node, at, a.end};
  Node result;
  result.op = Op::negate;
  result.a = a.node;
  result.powers = node(a).powers;
  return made(result, a, a, at);
}

int Rules::label_is(const Term& label, const Term& level) {
  const auto index = static_cast<std::size_t>(label.label_index);
  const std::vector<std::string>& levels = symbols_.labels[index].levels;
  const auto found = std::find(levels.begin(), levels.end(), level.quoted);
  if (found == levels.end()) {
    complain(text_, level.at,
             fmt::format("no row has \"{}\" in '{}'", printable(shortened(level.quoted)),
                         symbols_.labels[index].name),
             levels.empty() ? ""
                            : fmt::format("did you mean \"{}\"?",
                                          nearest_name(shortened(level.quoted), levels)));
  }
  Node node;
  node.op = Op::label_is;
  node.index = label.label_index;
  node.level = static_cast<int>(found - levels.begin());
  node.truth = true;
  return graph_.add(node);
}

Term Rules::comparison(const std::string& sign, const Term& a, const Term& b, std::size_t at) {
  const bool labels = a.kind == Term::label || b.kind == Term::label;
  if (labels) {
    const Term& label = a.kind == Term::label ? a : b;
    const Term& other = a.kind == Term::label ? b : a;
    if (other.kind != Term::quotation) {
      complain(text_, other.at,
               fmt::format("the label '{}' can only be compared with a text", written(label)),
               fmt::format("write texts in quotes: {} == \"{}\"", written(label),
                           other.kind == Term::number ? written(other) : "..."));
    }
    if (sign != "==" && sign != "!=")
      complain(text_, at, fmt::format("a label is not a number: '{}' has no meaning", sign),
               "compare labels with == or !=");
    int node = label_is(label, other);
    if (sign == "!=") node = graph_.make(Op::opposite, 0, node, -1, -1, true);
    return {node, a.at, b.end};
  }
  common(a, b, "compared", at);
  const bool turned = sign == ">" || sign == ">=";
  const Op op = sign == "=="   ? Op::equal
                : sign == "!=" ? Op::unequal
                               : (sign.size() == 2 ? Op::less_equal : Op::less);
  Term term = turned ? of(op, 0, b, a, at, true) : of(op, 0, a, b, at, true);
  term.at = a.at;
  term.end = b.end;
  return term;
}

Term Rules::logic(Op op, const Term& a, const Term& b, std::size_t at) {
  const std::string sign = op == Op::both ? "'and'" : "'or'";
  demand_truth(a, sign);
  demand_truth(b, sign);
  return of(op, 0, a, b, at, true);
}

Term Rules::opposite(const Term& a, std::size_t at) {
  demand_truth(a, "'not'");
  Node result;
  result.op = Op::opposite;
  result.a = a.node;
  result.truth = true;
  return made(result, a, a, at);
}

Term Rules::call(const Function& function, const std::vector<Term>& arguments, std::size_t at,
                 std::size_t end) {
  const bool many = function.op == Op::min || function.op == Op::max;
  const auto given = static_cast<int>(arguments.size());
  if (many ? given < function.arguments : given != function.arguments) {
    complain(text_, at,
             fmt::format("{} needs {} argument{}, but has {}", function.name,
                         many ? "2 or more" : std::to_string(function.arguments),
                         function.arguments == 1 ? "" : "s", given));
  }
  const Term& a = arguments.front();
  Term last = arguments.back();
  last.end = end;  // messages quote the whole call
  const std::string name = function.name;
  Node result;
  result.op = function.op;
  result.a = a.node;
  switch (function.rule) {
    case Rule::power:
      return power(a, arguments[1], at);
    case Rule::pure:
      demand_pure(a, name, at);
      if (given == 2) {
        demand_pure(arguments[1], name, at);
        result.b = arguments[1].node;
      }
      break;
    case Rule::to_angle:
      demand_pure(a, name, at);
      result.powers = graph_.intern({{"radian", 1}});
      break;
    case Rule::angle:
      demand_value(a);
      if (!has_angle(powers(a)) && !node(a).any) {
        complain(text_, at,
                 fmt::format("{} needs an angle, but '{}' is {}", name, written(a), dimension(a)),
                 powers(a).empty()
                     ? fmt::format("if it is in radians, write {}({} * 1 [rad])", name, written(a))
                 : powers(a) == Powers{{"cycle", 1}}
                     ? fmt::format("one turn is 2*pi; write {}({} * 2*pi [rad] / 1 [cycle])", name,
                                   written(a))
                     : "");
      }
      break;
    case Rule::root:
      demand_value(a);
      result.powers = bounded(graph_.intern(raised(powers(a), Power(1, 2))), at);
      break;
    case Rule::cum:
      demand_value(a);
      if (node(a).moving)
        complain(text_, at, "cum sums over rows, but a rate is evaluated between rows");
      result.powers = node(a).powers;
      break;
    case Rule::same: {
      demand_value(a);
      result.powers = node(a).powers;
      if (!many) break;
      Term term = a;
      for (std::size_t i = 1; i < arguments.size(); ++i) {
        const int powers = common(term, arguments[i], "compared by " + name, at);
        term = of(function.op, powers, term, arguments[i], at);
      }
      return term;
    }
    case Rule::where:
      demand_truth(a, "where");
      result.powers = common(arguments[1], arguments[2], "the two results of one where", at);
      result.b = arguments[1].node;
      result.c = arguments[2].node;
      result.truth = node(arguments[1]).truth && node(arguments[2]).truth;
      break;
  }
  return made(result, a, last, at);
}

}  // namespace wearwell::formula
