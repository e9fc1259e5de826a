#include "wearwell/formula/naming.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/formula/defined_functions.h"

namespace wearwell::formula {
namespace {

// Offers a guess only if it shares most letters.
std::string likely(const std::string& name, const std::vector<std::string>& known) {
  if (known.empty()) return {};
  const std::string nearest = nearest_name(name, known);
  const auto shared = std::count_if(name.begin(), name.end(),
                                    [&](char c) { return nearest.find(c) != nearest.npos; });
  const std::size_t longer = std::max(name.size(), nearest.size());
  if (2 * static_cast<std::size_t>(shared) < longer) return {};
  return fmt::format("did you mean '{}'?", nearest);
}

}  // namespace

Term Naming::leaf(Op op, std::size_t index, const Powers& powers, std::size_t at, int level) {
  Node node;
  node.op = op;
  node.index = static_cast<int>(index);
  node.level = level;
  node.powers = graph_.intern(powers);
  return {graph_.add(node), at, end_of_last()};
}

bool Naming::is_symbol(const std::string& name) const {
  const auto in = [&](const auto& list) {
    return std::any_of(list.begin(), list.end(),
                       [&](const auto& each) { return each.name == name; });
  };
  const Symbols& symbols = names_.symbols;
  return name == names_.state || names_.lines.contains(name) || in(symbols.parameters) ||
         in(symbols.columns) || in(symbols.constants) || in(symbols.labels) ||
         std::find(names_.all_lines.begin(), names_.all_lines.end(), name) !=
             names_.all_lines.end();
}

Term Naming::named(const Token& token) {
  const std::string& name = token.text;
  ++at_;
  const Symbols& symbols = names_.symbols;
  const auto index_of = [&](const auto& list) {
    const auto at =
        std::find_if(list.begin(), list.end(), [&](const auto& each) { return each.name == name; });
    return static_cast<std::size_t>(at - list.begin());
  };
  if (const std::size_t i = index_of(symbols.parameters); i < symbols.parameters.size())
    return parameter(i, token);
  const bool index = here().kind == Token::sign && here().text == "[";
  if (index && index_of(symbols.labels) == symbols.labels.size()) no_index(token);
  if (name == names_.state) return state(token);
  if (const auto line = names_.lines.find(name); line != names_.lines.end())
    return {line->second, token.at, end_of_last()};
  if (const std::size_t i = index_of(symbols.columns); i < symbols.columns.size())
    return column(i, token);
  if (const std::size_t i = index_of(symbols.constants); i < symbols.constants.size()) {
    const ConstantSymbol& symbol = symbols.constants[i];
    return {graph_.constant(symbol.value, graph_.intern(symbol.powers)), token.at, end_of_last()};
  }
  if (const std::size_t i = index_of(symbols.labels); i < symbols.labels.size()) {
    if (index) no_index(token);
    Term term{-1, token.at, end_of_last(), Term::label};
    term.label_index = static_cast<int>(i);
    return term;
  }
  unknown(token);
}

void Naming::no_index(const Token& token) {
  complain(text_, here().at,
           fmt::format("'{}' is not a parameter that varies by a label", token.text),
           "only a number can have a unit here; the unit of a column belongs in [data.columns]");
}

Term Naming::state(const Token& token) {
  if (names_.state_node < 0 && names_.in_rate) {
    complain(text_, token.at, fmt::format("the dimension of the state '{}' is unknown", token.text),
             fmt::format("state its beginning with a unit, for example \"{}(0)\" = \"0 [mm]\"",
                         token.text));
  }
  if (names_.state_node < 0)
    complain(text_, token.at,
             fmt::format("the beginning of the state '{}' uses the state itself", token.text));
  return {names_.state_node, token.at, end_of_last()};
}

Term Naming::column(std::size_t i, const Token& token) {
  const ColumnSymbol& symbol = names_.symbols.columns[i];
  if (names_.in_rate && static_cast<int>(i) == names_.axis)
    return leaf(Op::axis_now, i, symbol.powers, token.at);
  if (symbol.measured) {
    complain(text_, token.at,
             fmt::format("'{}' is the measured response, which a formula cannot use", token.text),
             "to use its measured values, read the column a second time under another name");
  }
  return leaf(Op::column, i, symbol.powers, token.at);
}

Term Naming::parameter(std::size_t i, const Token& token) {
  const ParameterSymbol& symbol = names_.symbols.parameters[i];
  const bool index = is_sign("[");
  if (symbol.scope != Scope::per_level) {
    if (index) no_index(token);
    return leaf(symbol.scope == Scope::one ? Op::parameter : Op::by_row, i, symbol.powers,
                token.at);
  }
  if (!index) {
    complain(text_, token.at, fmt::format("'{}' varies by '{}'", token.text, symbol.label),
             fmt::format("write {}[{}]", token.text, symbol.label));
  }
  ++at_;
  const Token& inside = tokens_[at_];
  if (inside.kind != Token::name && inside.kind != Token::quotation) {
    complain(text_, inside.at, "write a label, or one of its texts in quotes, in the brackets",
             fmt::format("write {}[{}]", token.text, symbol.label));
  }
  ++at_;
  if (!is_sign("]")) complain(text_, here().at, "a ']' is missing");
  ++at_;
  if (inside.kind == Token::quotation)
    return leaf(Op::parameter, i, symbol.powers, token.at, level_of(symbol.label, inside));
  if (inside.text != symbol.label) {
    complain(text_, inside.at,
             fmt::format("'{}' varies by '{}', not by '{}'", token.text, symbol.label, inside.text),
             fmt::format("write {}[{}]", token.text, symbol.label));
  }
  const auto& labels = names_.symbols.labels;
  const auto label = std::find_if(labels.begin(), labels.end(), [&](const LabelSymbol& each) {
    return each.name == symbol.label;
  });
  return leaf(Op::pick, i, symbol.powers, token.at, static_cast<int>(label - labels.begin()));
}

int Naming::level_of(const std::string& label, const Token& level) {
  for (const LabelSymbol& symbol : names_.symbols.labels) {
    if (symbol.name != label) continue;
    const auto at = std::find(symbol.levels.begin(), symbol.levels.end(), level.text);
    if (at != symbol.levels.end()) return static_cast<int>(at - symbol.levels.begin());
    complain(text_, level.at,
             fmt::format("no row has \"{}\" in '{}'", printable(shortened(level.text)), label),
             symbol.levels.empty()
                 ? ""
                 : fmt::format("did you mean \"{}\"?",
                               nearest_name(shortened(level.text), symbol.levels)));
  }
  complain(text_, level.at, fmt::format("there is no label '{}'", label));
}

void Naming::unknown(const Token& token) {
  const bool called = here().kind == Token::sign && here().text == "(";
  std::vector<std::string> known;
  const auto add = [&](const auto& list) {
    for (const auto& each : list) known.push_back(each.name);
  };
  if (called) {
    add(functions());
    add(defined_functions());
  } else {
    known = names_.all_lines;
    add(names_.symbols.columns);
    add(names_.symbols.labels);
    add(names_.symbols.parameters);
    add(names_.symbols.constants);
  }
  const std::string name = shortened(token.text);
  std::string hint = likely(name, known);
  if (name == "ln") hint = "write log for the natural logarithm";
  if (name == "power" && called) hint = "did you mean 'pow'?";
  if (name == "if") hint = "write where(condition, yes, no) for a choice";
  if (name == "e" && !called) hint = "write exp(1) for e";
  for (const LabelSymbol& label : names_.symbols.labels) {
    if (std::find(label.levels.begin(), label.levels.end(), token.text) != label.levels.end())
      hint = fmt::format("write a text of the label '{}' in quotes: \"{}\"", label.name, name);
  }
  complain(text_, token.at,
           fmt::format("'{}' is {}", name,
                       called ? "not a function"
                              : "not a column, label, parameter, constant or line of [formula]"),
           hint);
}

}  // namespace wearwell::formula
