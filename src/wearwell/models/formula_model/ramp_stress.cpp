#include "wearwell/models/formula_model/ramp_stress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/formula/tokens.h"
#include "wearwell/formula/written_graph.h"
#include "wearwell/input/columns.h"
#include "wearwell/math/quadrature.h"
#include "wearwell/models/formula_model/exposure_parameters.h"
#include "wearwell/models/formula_model/step_stress.h"

namespace wearwell::formula_model {
namespace {

using formula::Op;
using formula::Token;

constexpr int ramp_nodes = 32;

// A start or a rate: its values by row, in SI.
struct OfRamp {
  formula::AnyUnit unit;
  std::vector<double> values;
};

OfRamp of_ramp(const TomlReader& table, const char* key, const std::string& text,
               const FormulaData& data) {
  if (const NumberColumn* column = data.number(text)) {
    data.require_complete(*column);
    return {column->unit, column->values};
  }
  try {
    const formula::AnyQuantity given = formula::read_any_quantity(text);
    return {{given.quantity.unit, given.powers},
            std::vector<double>(data.table.rows, given.quantity.si())};
  } catch (const InputError&) {
    table.fail(key, fmt::format("'{}' is neither a numeric column under data.columns nor a "
                                "quantity with its unit, as \"0 kV\"",
                                text));
  }
}

// The expression with other texts for some names.
std::string renamed(const std::string& text, const std::map<std::string, std::string>& names) {
  std::string result;
  std::size_t from = 0;
  for (const Token& token : formula::tokens_of({"", text})) {
    if (token.kind != Token::name) continue;
    const auto other = names.find(token.text);
    if (other == names.end()) continue;
    result += text.substr(from, token.at - from) + other->second;
    from = token.at + token.text.size();
  }
  return result + text.substr(from);
}

bool names_any(const std::string& text, const std::set<std::string>& names) {
  const std::vector<Token> tokens = formula::tokens_of({"", text});
  return std::any_of(tokens.begin(), tokens.end(), [&](const Token& each) {
    return each.kind == Token::name && names.count(each.text) > 0;
  });
}

// The lines of [formula] by the stress, directly or by other lines.
std::set<std::string> lines_by_stress(const std::string& stress,
                                      const std::vector<formula::Line>& lines) {
  std::set<std::string> by_stress = {stress};
  for (std::size_t before = 0; before != by_stress.size();) {
    before = by_stress.size();
    for (const formula::Line& line : lines)
      if (names_any(line.text, by_stress)) by_stress.insert(line.name);
  }
  by_stress.erase(stress);
  return by_stress;
}

// The scale with another stress, whose lines have copies with this ending.
std::string at_stress(const std::string& scale, const RampStress& ramp, const std::string& other,
                      const std::set<std::string>& by_stress, const std::string& ending,
                      std::vector<formula::Line>& lines) {
  std::map<std::string, std::string> names = {{ramp.stress, other}};
  for (const std::string& each : by_stress) names[each] = each + ending;
  const std::vector<formula::Line> written = lines;
  for (const formula::Line& line : written)
    if (by_stress.count(line.name) > 0)
      lines.push_back({line.name + ending, renamed(line.text, names)});
  return renamed(scale, names);
}

// What an expression is as a function of a column.
struct ByColumn {
  bool depends = false;
  bool power = true;  ///< a constant, or a constant times a power of it
};

ByColumn by_column(const formula::Graph& graph, int root, int column) {
  std::vector<ByColumn> all(static_cast<std::size_t>(root) + 1);
  const auto at = [&](int i) -> ByColumn {
    return i < 0 ? ByColumn() : all[static_cast<std::size_t>(i)];
  };
  for (int i = 0; i <= root; ++i) {
    const formula::Node& node = graph[i];
    ByColumn& here = all[static_cast<std::size_t>(i)];
    here.depends = (node.op == Op::column && node.index == column) || at(node.a).depends ||
                   at(node.b).depends || at(node.c).depends;
    if (!here.depends) continue;
    switch (node.op) {
      case Op::column:
        break;
      case Op::multiply:
      case Op::divide:
      case Op::negate:
      case Op::sqrt:
      case Op::whole_power:
        here.power = at(node.a).power && at(node.b).power;
        break;
      case Op::power:
        here.power = at(node.a).power && !at(node.b).depends;
        break;
      default:
        here.power = false;
    }
  }
  return all.back();
}

// The mean over the ramp of scale(stress at its end)/scale(stress), for scale = c * stress^-n.
std::string closed_mean(const std::string& scale, const std::string& at_double,
                        const RampStress& ramp, std::vector<formula::Line>& lines) {
  lines.push_back({"ramp_exponent", fmt::format("log(({})/({}))/log(2)", scale, at_double)});
  return fmt::format(
      "where({0} == {1}, 1, where({0} > 0, expm1((ramp_exponent + 1)*log({0}/{1}))/"
      "((ramp_exponent + 1)*expm1(log({0}/{1}))), "
      "where(ramp_exponent > -1, 1/(ramp_exponent + 1), 1e300)))",
      RampStress::begin, ramp.stress);
}

// The same of any scale.
std::string mean_by_quadrature(const std::string& scale, const RampStress& ramp,
                               const std::set<std::string>& by_stress,
                               std::vector<formula::Line>& lines) {
  static const GaussLegendre rule = gauss_legendre(ramp_nodes);
  std::string sum;
  for (int k = 0; k < ramp_nodes; ++k) {
    // Place 3 u^2 - 2 u^3 of u in [0, 1]: a power of the stress from 0 becomes smooth.
    const auto i = static_cast<std::size_t>(k);
    const double u = 0.5 * (1 + rule.node[i]), place = u * u * (3 - 2 * u);
    const double weight = 3 * u * (1 - u) * rule.weight[i];
    const std::string stress =
        fmt::format("({0} + {1:.17g}*({2} - {0}))", RampStress::begin, place, ramp.stress);
    const std::string ending = fmt::format("__ramp_{}", k + 1);
    const std::string other = at_stress(scale, ramp, stress, by_stress, ending, lines);
    lines.push_back({"ramp_scale" + ending, other});
    sum += fmt::format("{}{:.17g}/ramp_scale{}", k > 0 ? " + " : "", weight, ending);
  }
  return fmt::format("({})*({})", scale, sum);
}

}  // namespace

RampStress read_ramp_stress(const TomlReader& likelihood, const std::string& family,
                            const std::string& scale) {
  RampStress ramp;
  ramp.parameter = scale_of_exposure(likelihood, "ramp", family, scale);
  const TomlReader table = likelihood.required_table("ramp");
  ramp.stress = table.required_text("stress");
  ramp.start = table.required_text("start");
  ramp.rate = table.required_text("rate");
  return ramp;
}

void add_ramp(const TomlReader& likelihood, const RampStress& ramp, const std::string& life,
              FormulaData& data) {
  const TomlReader table = likelihood.required_table("ramp");
  for (const std::string& name :
       {ramp.stress, std::string(RampStress::duration), std::string(RampStress::begin)}) {
    if (!data.number(name) && !data.label(name)) continue;
    table.fail(
        "stress",
        name == ramp.stress
            ? fmt::format("'{}' follows from start, rate and {}; remove it from data.columns", name,
                          life)
            : fmt::format("data.columns.{}: this name has a meaning in a study of ramps; "
                          "give the column another one",
                          name));
  }
  const NumberColumn ages = *data.number(life);
  data.require_complete(ages);
  OfRamp start = of_ramp(table, "start", ramp.start, data);
  const OfRamp rate = of_ramp(table, "rate", ramp.rate, data);
  if (product(rate.unit.powers, ages.unit.powers) != start.unit.powers)
    table.fail("rate", fmt::format("{} times {} is {}, but the start of the stress is {}",
                                   description(rate.unit.powers), description(ages.unit.powers),
                                   description(product(rate.unit.powers, ages.unit.powers)),
                                   description(start.unit.powers)));
  std::vector<double> end(data.table.rows);
  for (std::size_t row = 0; row < end.size(); ++row)
    end[row] = start.values[row] + rate.values[row] * ages.values[row];
  data.numbers.push_back({ramp.stress, ages.column, start.unit, std::move(end)});
  data.numbers.push_back({RampStress::begin, ages.column, start.unit, std::move(start.values)});
  data.numbers.push_back({RampStress::duration, ages.column, ages.unit, ages.values});
}

std::string threshold_of(const TomlReader& likelihood, RampStress& ramp,
                         std::vector<formula::Line>& lines,
                         const std::vector<formula::Wanted>& wanted, std::size_t scale,
                         const formula::Symbols& symbols) {
  const formula::WrittenGraph written = formula::written_graph(lines, wanted, symbols);
  const auto column =
      static_cast<int>(std::find_if(symbols.columns.begin(), symbols.columns.end(),
                                    [&](const auto& each) { return each.name == ramp.stress; }) -
                       symbols.columns.begin());
  for (const int root : written.roots)
    if (written.graph[root].by_path)
      likelihood.fail("ramp", "is not possible with expressions that depend on earlier rows");
  require_scale_alone(likelihood, "ramp", ramp.parameter, written, wanted, {scale},
                      {ramp.stress, column});
  if (!depends_on(written.graph, written.roots[scale], {ramp.stress, column}))
    likelihood.fail("ramp", fmt::format("{} of '{}' does not depend on '{}'", ramp.parameter,
                                        likelihood.required_text(ramp.parameter), ramp.stress));
  const std::set<std::string> by_stress = lines_by_stress(ramp.stress, lines);
  for (const std::string& each : by_stress)
    if (each.find('(') != each.npos)
      likelihood.fail("ramp",
                      fmt::format("is not possible with the state {} by '{}'", each, ramp.stress));
  ramp.closed = by_column(written.graph, written.roots[scale], column).power;
  const std::string text = wanted[scale].text;
  std::string mean;
  if (ramp.closed) {
    const std::string other =
        at_stress(text, ramp, fmt::format("(2*{})", ramp.stress), by_stress, "__ramp", lines);
    mean = closed_mean(text, other, ramp, lines);
  } else {
    mean = mean_by_quadrature(text, ramp, by_stress, lines);
  }
  return fmt::format("{}*(1 - {})", RampStress::duration, mean);
}

void require_exact_failures(const FormulaData& data, const std::string& life,
                            const Observed& observed) {
  for (std::size_t i = 0; i < observed.rows.size(); ++i) {
    const Censoring seen = observed.responses[i].seen;
    if (seen == Censoring::none || seen == Censoring::right) continue;
    throw InputError(
        fmt::format("{}: the time of failure under a ramp must be known, because the "
                    "stress at failure follows from it; this row has an interval",
                    place(data.table, data.number(life)->column, observed.rows[i])));
  }
}

}  // namespace wearwell::formula_model
