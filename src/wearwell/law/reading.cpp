#include "wearwell/law/reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/law/rules.h"

namespace wearwell::law {
namespace {

constexpr int deepest = 200;  // brackets, signs and powers within each other

// Recursive descent; from loose to tight: or, and, not, a comparison, + -, * /, a sign in front, ^.
class Reader {
 public:
  Reader(Graph& graph, const Text& text, const std::vector<Token>& tokens, const Names& names)
      : graph_(graph),
        text_(text),
        tokens_(tokens),
        names_(names),
        rules_(graph, text, names.symbols) {}

  int run() {
    const Term all = alternative();
    if (here().kind != Token::end) leftover();
    rules_.demand_value(all);
    return all.node;
  }

 private:
  struct Deeper {
    explicit Deeper(Reader& reader) : reader_(reader) {
      if (++reader_.depth_ > deepest)
        complain(reader_.text_, reader_.here().at,
                 fmt::format("more than {} brackets or signs within each other", deepest),
                 "give parts of the expression names of their own");
    }
    ~Deeper() { --reader_.depth_; }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;
    Reader& reader_;
  };

  const Token& here() const { return tokens_[at_]; }
  const Token& ahead() const { return tokens_[std::min(at_ + 1, tokens_.size() - 1)]; }
  bool is_sign(const char* sign) const { return here().kind == Token::sign && here().text == sign; }
  bool is_word(const char* word) const { return here().kind == Token::name && here().text == word; }
  std::size_t end_of_last() const {
    const std::size_t next = here().at;
    std::size_t end = next;
    while (end > 0 && std::isspace(static_cast<unsigned char>(text_.text[end - 1])) != 0) --end;
    return end;
  }

  Term alternative() {
    Term left = conjunction();
    while (is_word("or")) {
      const std::size_t at = tokens_[at_++].at;
      left = rules_.logic(Op::either, left, conjunction(), at);
    }
    return left;
  }

  Term conjunction() {
    Term left = opposite();
    while (is_word("and")) {
      const std::size_t at = tokens_[at_++].at;
      left = rules_.logic(Op::both, left, opposite(), at);
    }
    return left;
  }

  Term opposite() {
    if (!is_word("not")) return comparison();
    const Deeper deeper(*this);
    const std::size_t at = tokens_[at_++].at;
    return rules_.opposite(opposite(), at);
  }

  bool is_comparison() const {
    return here().kind == Token::sign && (here().text[0] == '<' || here().text[0] == '>' ||
                                          here().text == "==" || here().text == "!=");
  }

  Term comparison() {
    const Term left = sum();
    if (!is_comparison()) return left;
    const Token& sign = tokens_[at_++];
    const Term right = sum();
    if (is_comparison())
      complain(text_, here().at, "two comparisons in one", "write: a < b and b < c");
    return rules_.comparison(sign.text, left, right, sign.at);
  }

  Term sum() {
    Term left = product();
    while (is_sign("+") || is_sign("-")) {
      const Token& sign = tokens_[at_++];
      left = rules_.sum(sign.text == "+" ? Op::add : Op::subtract, left, product(), sign.at);
    }
    return left;
  }

  Term product() {
    Term left = signed_();
    while (is_sign("*") || is_sign("/")) {
      const Token& sign = tokens_[at_++];
      left = rules_.product(sign.text == "*" ? Op::multiply : Op::divide, left, signed_(), sign.at);
    }
    return left;
  }

  Term signed_() {
    if (!is_sign("-") && !is_sign("+")) return power();
    const Deeper deeper(*this);
    const Token& sign = tokens_[at_++];
    Term operand = signed_();
    if (sign.text == "-") return rules_.negative(operand, sign.at);
    rules_.demand_value(operand);
    operand.at = sign.at;
    return operand;
  }

  Term power() {
    const Term base = primary();
    if (!is_sign("^")) return base;
    const Deeper deeper(*this);
    const std::size_t at = tokens_[at_++].at;
    return rules_.power(base, signed_(), at);
  }

  Term primary() {
    const Token& token = here();
    switch (token.kind) {
      case Token::number:
        return number();
      case Token::name:
        return name();
      case Token::quotation: {
        ++at_;
        Term term{-1, token.at, end_of_last(), Term::quotation};
        term.quoted = token.text;
        return term;
      }
      case Token::sign:
        if (token.text == "(") return brackets();
        break;
      case Token::unit:
      case Token::end:
        break;
    }
    expected();
  }

  [[noreturn]] void expected() {
    const Token& token = here();
    if (token.kind == Token::end) {
      if (!open_.empty()) complain(text_, open_.back(), "a '(' is never closed");
      complain(text_, token.at, "the expression ends too early",
               "a number, a name or a bracket is missing");
    }
    if (token.text == ")" && at_ > 0 && tokens_[at_ - 1].text == "(")
      complain(text_, token.at, "nothing stands between the brackets");
    if (token.text == ")" && open_.empty()) complain(text_, token.at, "a ')' without a '('");
    if (token.text == "[") complain(text_, token.at, "a unit stands behind a number, as in 1 [mm]");
    complain(text_, token.at,
             fmt::format("'{}' where a number, a name or a bracket should be", token.text));
  }

  Term brackets() {
    const Deeper deeper(*this);
    const std::size_t open = tokens_[at_++].at;
    open_.push_back(open);
    Term term = alternative();
    if (is_sign(","))
      complain(text_, here().at, "a comma outside of a function",
               "the decimal sign is a point, a product is written with *");
    close(open);
    term.at = open;
    term.end = end_of_last();
    return term;
  }

  void close(std::size_t open) {
    if (!is_sign(")")) {
      if (here().kind == Token::end) complain(text_, open, "a '(' is never closed");
      leftover();
    }
    ++at_;
    open_.pop_back();
  }

  // What may not stand behind a complete expression.
  [[noreturn]] void leftover() {
    const Token& token = here();
    const std::string seen = printable(shortened(token.text, 30));
    if (token.kind == Token::sign && token.text == ")")
      complain(text_, token.at, "a ')' without a '('");
    if (token.kind == Token::sign && token.text == ",")
      complain(text_, token.at, "a comma outside of a function",
               "the decimal sign is a point, a product is written with *");
    if (token.kind == Token::sign && token.text == "[")
      complain(text_, token.at, "a unit stands behind a number only",
               "multiply by one of it: (...) * 1 [mm]");
    if (token.kind == Token::sign && token.text == "]")
      complain(text_, token.at, "a ']' without a '['");
    if (token.kind == Token::unit)
      complain(text_, token.at, "two units behind one number", "write one: 1 [N m]");
    complain(text_, token.at, fmt::format("a sign is missing before '{}'", seen),
             "a product is written with *");
  }

  Term number() {
    const Token& token = tokens_[at_++];
    Node node;
    node.value = token.value;
    if (here().kind == Token::unit) {
      const Token& unit = tokens_[at_++];
      const AnyUnit any = unit_of(unit, token.text);
      node.value = to_si(any.unit, token.value);
      node.powers = graph_.intern(any.powers);
      if (!std::isfinite(node.value))
        complain(text_, token.at, "a quantity that is infinite in SI");
    } else {
      node.any = token.value == 0;
    }
    return {graph_.add(node), token.at, end_of_last()};
  }

  AnyUnit unit_of(const Token& token, const std::string& number) {
    AnyUnit any;
    try {
      any = read_any_unit(token.text);
    } catch (const InputError& error) {
      complain(text_, token.at + 1, error.what());
    }
    if (any.unit.offset != 0) {
      double value = 0;
      value = std::stod(number);
      complain(text_, token.at,
               fmt::format("'{} [{}]' is a temperature, {:.6g} K, or a difference of {:.6g} K",
                           number, any.unit.text, to_si(any.unit, value), any.unit.scale * value),
               "write it in [K], or name it in [constants]");
    }
    return any;
  }

  Term name() {
    const Token& token = here();
    const Function* function = find_function(token.text);
    const bool called = ahead().kind == Token::sign && ahead().text == "(";
    if (function != nullptr) {
      if (!called)
        complain(text_, token.at, fmt::format("'{}' is a function", token.text),
                 fmt::format("its arguments stand in brackets: {}(...)", token.text));
      return call(*function);
    }
    if (token.text == "pi") {
      ++at_;
      return {graph_.constant(std::numbers::pi), token.at, end_of_last()};
    }
    if (is_word_of_language(token.text)) {
      complain(text_, token.at,
               fmt::format("'{}' where a number, a name or a bracket should be", token.text));
    }
    Term term = named(token);
    if (called) {
      complain(text_, ahead().at, fmt::format("'{}' is no function", token.text),
               fmt::format("a product is written {} * (...)", token.text));
    }
    return term;
  }

  Term call(const Function& function) {
    const Deeper deeper(*this);
    const std::size_t start = tokens_[at_++].at, open = tokens_[at_++].at;
    open_.push_back(open);
    std::vector<Term> arguments;
    if (!is_sign(")")) {
      arguments.push_back(alternative());
      while (is_sign(",")) {
        ++at_;
        arguments.push_back(alternative());
      }
    }
    close(open);
    if (arguments.empty()) complain(text_, start, fmt::format("{} has no argument", function.name));
    Term term = rules_.call(function, arguments, start);
    term.at = start;
    term.end = end_of_last();
    return term;
  }

  Term leaf(Op op, std::size_t index, const Powers& powers, std::size_t at, int level = -1) {
    Node node;
    node.op = op;
    node.index = static_cast<int>(index);
    node.level = level;
    node.powers = graph_.intern(powers);
    return {graph_.add(node), at, end_of_last()};
  }

  Term named(const Token& token) {
    const std::string& name = token.text;
    ++at_;
    const Symbols& symbols = names_.symbols;
    const auto index_of = [&](const auto& list) {
      const auto at = std::find_if(list.begin(), list.end(),
                                   [&](const auto& each) { return each.name == name; });
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

  [[noreturn]] void no_index(const Token& token) {
    complain(text_, here().at,
             fmt::format("'{}' is no parameter that differs by a label", token.text),
             "a unit stands behind a number only, and the unit of a column in [data.columns]");
  }

  Term state(const Token& token) {
    if (names_.state_node < 0)
      complain(text_, token.at, fmt::format("the state '{}' in its own beginning", token.text));
    return {names_.state_node, token.at, end_of_last()};
  }

  Term column(std::size_t i, const Token& token) {
    const ColumnSymbol& symbol = names_.symbols.columns[i];
    if (names_.in_rate && static_cast<int>(i) == names_.axis)
      return leaf(Op::axis_now, i, symbol.powers, token.at);
    if (symbol.measured) {
      complain(text_, token.at,
               fmt::format("'{}' is what is measured, and no law may lean on it", token.text),
               "to use its values as they are, read the column a second time under another name");
    }
    return leaf(Op::column, i, symbol.powers, token.at);
  }

  Term parameter(std::size_t i, const Token& token) {
    const ParameterSymbol& symbol = names_.symbols.parameters[i];
    const bool index = is_sign("[");
    if (symbol.scope != Scope::per_level) {
      if (index) no_index(token);
      return leaf(symbol.scope == Scope::one ? Op::parameter : Op::by_row, i, symbol.powers,
                  token.at);
    }
    if (!index) {
      complain(text_, token.at, fmt::format("'{}' differs by '{}'", token.text, symbol.label),
               fmt::format("write {}[{}]", token.text, symbol.label));
    }
    ++at_;
    const Token& inside = tokens_[at_];
    if (inside.kind != Token::name && inside.kind != Token::quotation) {
      complain(text_, inside.at, "a label, or one of its texts in quotes, stands in the brackets",
               fmt::format("write {}[{}]", token.text, symbol.label));
    }
    ++at_;
    if (!is_sign("]")) complain(text_, here().at, "a ']' is missing");
    ++at_;
    if (inside.kind == Token::quotation)
      return leaf(Op::parameter, i, symbol.powers, token.at, level_of(symbol.label, inside));
    if (inside.text != symbol.label) {
      complain(
          text_, inside.at,
          fmt::format("'{}' differs by '{}', not by '{}'", token.text, symbol.label, inside.text),
          fmt::format("write {}[{}]", token.text, symbol.label));
    }
    return leaf(Op::pick, i, symbol.powers, token.at);
  }

  int level_of(const std::string& label, const Token& level) {
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

  [[noreturn]] void unknown(const Token& token) {
    const std::string name = shortened(token.text);
    std::vector<std::string> known = names_.all_lines;
    const auto add = [&](const auto& list) {
      for (const auto& each : list) known.push_back(each.name);
    };
    add(names_.symbols.columns);
    add(names_.symbols.labels);
    add(names_.symbols.parameters);
    add(names_.symbols.constants);
    const bool called = here().kind == Token::sign && here().text == "(";
    if (called)
      for (const Function& each : functions()) known.push_back(each.name);
    std::string hint;
    if (name == "ln") hint = "the natural logarithm is log";
    if (name == "e") hint = "e is exp(1)";
    if (hint.empty() && !known.empty())
      hint = fmt::format("did you mean '{}'?", nearest_name(name, known));
    complain(text_, token.at,
             fmt::format(
                 "'{}' is {}", name,
                 called ? "no function" : "no column, label, parameter, constant or line of [law]"),
             hint);
  }

  Graph& graph_;
  const Text& text_;
  const std::vector<Token>& tokens_;
  const Names& names_;
  Rules rules_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::vector<std::size_t> open_;
};

}  // namespace

int read_expression(Graph& graph, const Text& text, const std::vector<Token>& tokens,
                    const Names& names) {
  return Reader(graph, text, tokens, names).run();
}

}  // namespace wearwell::law
