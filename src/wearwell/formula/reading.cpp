#include "wearwell/formula/reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/formula/defined_functions.h"
#include "wearwell/formula/naming.h"
#include "wearwell/formula/rules.h"

namespace wearwell::formula {
namespace {

constexpr int deepest = 200;  // nested brackets, signs and powers
// Recursive descent, from lowest to highest precedence: or, and, not, comparison, + -, * /, unary
// sign, ^.
class Reader : Naming {
 public:
  Reader(Graph& graph, const Text& text, const std::vector<Token>& tokens, const Names& names)
      : Naming(graph, text, tokens, names) {}

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
                 fmt::format("more than {} nested brackets or signs", deepest),
                 "write parts of the expression as separate lines");
    }
    ~Deeper() { --reader_.depth_; }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;
    Reader& reader_;
  };

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
      complain(text_, here().at, "two comparisons in one expression", "write: a < b and b < c");
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
      if (!open_.empty()) complain(text_, open_.back(), "a '(' is not closed");
      complain(text_, token.at, "the expression ends too early",
               "a number, a name or a bracket is missing");
    }
    if (token.text == ")" && at_ > 0 && tokens_[at_ - 1].text == "(")
      complain(text_, token.at, "the brackets are empty");
    if (token.text == ")" && open_.empty()) complain(text_, token.at, "a ')' without a '('");
    if (token.text == "[") complain(text_, token.at, "write a unit after a number, as in 1 [mm]");
    complain(text_, token.at,
             fmt::format("'{}' instead of a number, a name or a bracket", token.text));
  }

  Term brackets() {
    const Deeper deeper(*this);
    const std::size_t open = tokens_[at_++].at;
    open_.push_back(open);
    Term term = alternative();
    if (is_sign(","))
      complain(text_, here().at, "a comma outside a function",
               "use a point as the decimal sign and * for a product");
    close(open);
    term.at = open;
    term.end = end_of_last();
    return term;
  }

  void close(std::size_t open) {
    if (!is_sign(")")) {
      if (here().kind == Token::end) complain(text_, open, "a '(' is not closed");
      leftover();
    }
    ++at_;
    open_.pop_back();
  }

  // Errors after a complete expression.
  [[noreturn]] void leftover() {
    const Token& token = here();
    const std::string seen = printable(shortened(token.text, 30));
    if (token.kind == Token::sign && token.text == ")")
      complain(text_, token.at, "a ')' without a '('");
    if (token.kind == Token::sign && token.text == ",")
      complain(text_, token.at, "a comma outside a function",
               "use a point as the decimal sign and * for a product");
    if (token.kind == Token::sign && token.text == "[")
      complain(text_, token.at, "only a number can have a unit",
               "multiply by one of it: (...) * 1 [mm]");
    if (token.kind == Token::sign && token.text == "]")
      complain(text_, token.at, "a ']' without a '['");
    if (token.kind == Token::unit)
      complain(text_, token.at, "two units after one number", "write one: 1 [N m]");
    const bool like_unit =
        token.kind == Token::name && at_ > 0 && tokens_[at_ - 1].kind == Token::number;
    complain(text_, token.at, fmt::format("a sign is missing before '{}'", seen),
             like_unit ? fmt::format("write a product as {0} * {1}, a unit as {0} [{1}]",
                                     tokens_[at_ - 1].text, seen)
                       : "write a product with *");
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
        complain(text_, token.at, "a quantity that is infinite in SI units");
    } else {
      node.any = token.value == 0;
    }
    return {graph_.add(node), token.at, end_of_last()};
  }

  AnyUnit unit_of(const Token& token, const std::string& number) {
    AnyUnit any;
    if (token.text.find_first_not_of(" ") == token.text.npos)
      complain(text_, token.at, "brackets without a unit", "a pure number has none");
    try {
      any = read_any_unit(token.text);
    } catch (const InputError& error) {
      complain(text_, token.at + 1, error.what());
    }
    if (any.unit.offset != 0) {
      double value = 0;
      value = std::stod(number);
      complain(text_, token.at,
               fmt::format(
                   "'{} [{}]' is ambiguous: a temperature, {:.6g} K, or a difference of {:.6g} K",
                   number, any.unit.text, to_si(any.unit, value), any.unit.scale * value),
               "write it in [K], or define it in [constants]");
    }
    return any;
  }

  Term name() {
    const Token& token = here();
    const Function* function = find_function(token.text);
    const DefinedFunction* defined = find_defined_function(token.text);
    const bool called = ahead().kind == Token::sign && ahead().text == "(";
    const bool reserved = is_word_of_language(token.text);
    if (called && !reserved && (function != nullptr || defined != nullptr) && is_symbol(token.text))
      complain(text_, token.at,
               fmt::format("'{}' is a function, but this study uses the name itself", token.text),
               fmt::format("rename it to call the function, or write a product as {} * (...)",
                           token.text));
    if ((called || reserved) && (function != nullptr || defined != nullptr)) {
      if (!called)
        complain(text_, token.at, fmt::format("'{}' is a function", token.text),
                 fmt::format("write its arguments in brackets: {}(...)", token.text));
      return function != nullptr ? call(*function) : call(*defined);
    }
    if (token.text == "pi") {
      ++at_;
      return {graph_.constant(std::numbers::pi), token.at, end_of_last()};
    }
    if (reserved) {
      complain(text_, token.at,
               fmt::format("'{}' instead of a number, a name or a bracket", token.text));
    }
    Term term = named(token);
    if (called) {
      complain(text_, ahead().at, fmt::format("'{}' is not a function", token.text),
               fmt::format("write a product as {} * (...)", token.text));
    }
    return term;
  }

  Term call(const Function& function) {
    const std::size_t start = here().at;
    const std::vector<Term> arguments = read_arguments(function.name);
    Term term = rules_.call(function, arguments, start, end_of_last());
    term.at = start;
    term.end = end_of_last();
    return term;
  }

  // Its body, with the arguments for the names in it.
  Term call(const DefinedFunction& function) {
    const std::size_t start = here().at;
    const std::vector<Term> arguments = read_arguments(function.name);
    rules_.check_arguments(function, arguments, start);
    static const Symbols no_symbols;
    Names names{no_symbols};
    bool constants = true;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      names.lines[function.arguments[i].name] = arguments[i].node;
      constants = constants && graph_[arguments[i].node].op == Op::constant;
    }
    const Text body{function.name, function.body};
    const Term term{read_expression(graph_, body, tokens_of(body), names), start, end_of_last()};
    if (constants && graph_[term.node].op != Op::constant)
      complain(text_, start, fmt::format("{} is not a finite number", function.name));
    return term;
  }

  std::vector<Term> read_arguments(const std::string& name) {
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
    if (arguments.empty()) complain(text_, start, fmt::format("{} has no argument", name));
    return arguments;
  }

  int depth_ = 0;
  std::vector<std::size_t> open_;
};

}  // namespace

int read_expression(Graph& graph, const Text& text, const std::vector<Token>& tokens,
                    const Names& names) {
  return Reader(graph, text, tokens, names).run();
}

}  // namespace wearwell::formula
