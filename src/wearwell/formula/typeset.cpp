#include "wearwell/formula/typeset.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "wearwell/formula/tokens.h"
#include "wearwell/formula/words.h"

namespace wearwell::formula {
namespace {

using Elements = std::vector<MathElement>;

constexpr int deepest_typeset = 200;  // as the reader of expressions

constexpr std::pair<std::string_view, std::string_view> greek_letters[] = {
    {"alpha", "α"}, {"beta", "β"},  {"gamma", "γ"}, {"delta", "δ"}, {"epsilon", "ε"},
    {"zeta", "ζ"},  {"eta", "η"},   {"theta", "θ"}, {"kappa", "κ"}, {"lambda", "λ"},
    {"mu", "μ"},    {"nu", "ν"},    {"xi", "ξ"},    {"pi", "π"},    {"rho", "ρ"},
    {"sigma", "σ"}, {"tau", "τ"},   {"phi", "φ"},   {"chi", "χ"},   {"psi", "ψ"},
    {"omega", "ω"}, {"Gamma", "Γ"}, {"Delta", "Δ"}, {"Theta", "Θ"}, {"Lambda", "Λ"},
    {"Sigma", "Σ"}, {"Phi", "Φ"},   {"Psi", "Ψ"},   {"Omega", "Ω"}};

MathElement row_of(Elements children) {
  return {"mrow", "", std::move(children)};
}
MathElement sign_element(std::string text) {
  return {"mo", std::move(text)};
}

MathElement bracketed(Elements inside) {
  inside.insert(inside.begin(), sign_element("("));
  inside.push_back(sign_element(")"));
  return row_of(std::move(inside));
}

MathElement identifier(std::string_view word) {
  const auto* const greek = std::find_if(std::begin(greek_letters), std::end(greek_letters),
                                         [&](const auto& each) { return each.first == word; });
  if (greek != std::end(greek_letters)) return {"mi", std::string(greek->second)};
  const bool is_number =
      !word.empty() &&
      std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return {is_number ? "mn" : "mi", std::string(word)};
}

// An operand, and whether it is an expression in brackets, which fractions and roots need not show.
struct Piece {
  MathElement shown;
  bool in_brackets = false;
  MathElement bare = {};  ///< without the brackets

  MathElement within() const { return in_brackets ? bare : shown; }
};

class Typesetter {
 public:
  explicit Typesetter(const Text& text) : text_(text), tokens_(tokens_of(text)) {}

  MathElement run() {
    Piece all = infix(0);
    if (here().kind != Token::end) wrong("is not expected here");
    return std::move(all.shown);
  }

 private:
  const Token& here() const { return tokens_[at_]; }
  bool is_sign(std::string_view sign) const {
    return here().kind == Token::sign && here().text == sign;
  }
  bool is_word(std::string_view word) const {
    return here().kind == Token::name && here().text == word;
  }
  [[noreturn]] void wrong(const std::string& what) const {
    if (here().kind == Token::end) complain(text_, here().at, "the expression ends too early");
    complain(text_, here().at, "'" + here().text + "' " + what);
  }
  void expect(std::string_view sign) {
    if (!is_sign(sign)) wrong("instead of '" + std::string(sign) + "'");
    ++at_;
  }

  struct Deeper {
    explicit Deeper(Typesetter& setter) : setter_(setter) {
      if (++setter_.depth_ > deepest_typeset)
        complain(setter_.text_, setter_.here().at, "more than 200 nested brackets or signs");
    }
    ~Deeper() { --setter_.depth_; }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;
    Typesetter& setter_;
  };

  // From lowest to highest precedence, as the reader of expressions.
  static int precedence(const Token& token) {
    if (token.kind == Token::name) return token.text == "or" ? 1 : token.text == "and" ? 2 : 0;
    if (token.kind != Token::sign) return 0;
    if (token.text == "+" || token.text == "-") return 5;
    if (token.text == "*" || token.text == "/") return 6;
    const bool compares =
        token.text[0] == '<' || token.text[0] == '>' || token.text == "==" || token.text == "!=";
    return compares ? 4 : 0;
  }

  static std::string sign_of(const std::string& sign) {
    static constexpr std::pair<std::string_view, std::string_view> signs[] = {
        {"-", "−"}, {"*", "⋅"}, {"<=", "≤"}, {">=", "≥"}, {"==", "="}, {"!=", "≠"}};
    for (const auto& [written, shown] : signs)
      if (written == sign) return std::string(shown);
    return sign;
  }

  // Sums and products of any length are one row, so that elements nest no deeper than brackets.
  Piece infix(int least) {
    Piece left = operand(least);
    int row_level = 0, fractions = 0;
    for (int level = precedence(here()); level > least; level = precedence(here())) {
      const Token sign = tokens_[at_++];
      Piece right = infix(level);
      if (sign.text == "/") {
        if (++fractions > deepest_typeset) complain(text_, sign.at, "more than 200 quotients");
        left = {{"mfrac", "", {left.within(), right.within()}}};
        row_level = 0;
        continue;
      }
      MathElement between = sign.kind == Token::name
                                ? MathElement{"mtext", "\u00a0" + sign.text + "\u00a0"}
                                : sign_element(sign_of(sign.text));
      if (row_level != level) left = {row_of({std::move(left.shown)})};
      left.shown.children.push_back(std::move(between));
      left.shown.children.push_back(std::move(right.shown));
      row_level = level;
    }
    return left;
  }

  Piece operand(int least) {
    if (least >= 3 || !is_word("not")) return prefix();
    const Deeper deeper(*this);
    ++at_;
    return {row_of({{"mtext", "not\u00a0"}, infix(3).shown})};
  }

  Piece prefix() {
    if (!is_sign("-") && !is_sign("+")) return power();
    const Deeper deeper(*this);
    const std::string sign = tokens_[at_++].text;
    return {row_of({sign_element(sign_of(sign)), prefix().shown})};
  }

  Piece power() {
    Piece base = primary();
    if (!is_sign("^")) return base;
    const Deeper deeper(*this);
    ++at_;
    MathElement below = alone(base) ? std::move(base.shown) : bracketed({std::move(base.shown)});
    return {{"msup", "", {std::move(below), prefix().within()}}};
  }

  // Whether a power of it is read as a power of the whole: not exp(x)^2, 2 [mm]^2, 1e3^2.
  static bool alone(const Piece& base) {
    const std::string& tag = base.shown.tag;
    return base.in_brackets || tag == "mi" || tag == "mn" || tag == "msub" || tag == "msqrt";
  }

  Piece primary() {
    const Deeper deeper(*this);
    const Token token = here();
    if (is_sign("(")) {
      ++at_;
      MathElement inside = infix(0).shown;
      expect(")");
      return {bracketed({inside}), true, inside};
    }
    if (token.kind == Token::number) return {number()};
    if (token.kind == Token::quotation) {
      ++at_;
      return {{"mtext", token.text}};
    }
    if (token.kind != Token::name || precedence(token) > 0 || token.text == "not")
      wrong("instead of a number, a name or a bracket");
    ++at_;
    if (is_sign("(")) return {call(token.text)};
    if (is_sign("[")) return {indexed(token.text)};
    return {typeset_name(token.text)};
  }

  MathElement number() {
    MathElement digits = power_of_ten(tokens_[at_++].text);
    if (here().kind != Token::unit) return digits;
    return row_of({std::move(digits), {"mtext", "\u00a0" + tokens_[at_++].text}});
  }

  // 1e-6 is 10 raised to -6, 2.5e3 is 2.5 times 10 cubed.
  static MathElement power_of_ten(const std::string& text) {
    const std::size_t at = text.find_first_of("eE");
    if (at == text.npos) return {"mn", text};
    std::string digits = text.substr(at + 1);
    const bool negative = digits.starts_with('-');
    digits.erase(0, digits.find_first_of("123456789") == digits.npos
                        ? digits.size() - 1
                        : digits.find_first_of("123456789"));
    MathElement exponent{"mn", digits};
    if (negative) exponent = row_of({sign_element("−"), exponent});
    MathElement ten{"msup", "", {{"mn", "10"}, std::move(exponent)}};
    const std::string before = text.substr(0, at);
    if (before == "1") return ten;
    return row_of({{"mn", before}, sign_element("×"), std::move(ten)});
  }

  MathElement indexed(const std::string& name) {
    ++at_;
    const Token label = here();
    if (label.kind != Token::name && label.kind != Token::quotation)
      wrong("instead of the name of a label");
    ++at_;
    expect("]");
    MathElement index =
        label.kind == Token::name ? typeset_name(label.text) : MathElement{"mtext", label.text};
    return {"msub", "", {typeset_name(name), std::move(index)}};
  }

  std::vector<Piece> arguments() {
    expect("(");
    std::vector<Piece> found;
    do {
      if (!found.empty()) ++at_;
      found.push_back(infix(0));
    } while (is_sign(","));
    expect(")");
    return found;
  }

  MathElement call(const std::string& name) {
    const std::vector<Piece> found = arguments();
    if (name == "sqrt" && found.size() == 1) return {"msqrt", "", {found[0].within()}};
    if (name == "exp" && found.size() == 1) return {"msup", "", {{"mi", "e"}, found[0].within()}};
    if (name == "abs" && found.size() == 1)
      return row_of({sign_element("|"), found[0].within(), sign_element("|")});
    if (name == "d" && found.size() == 1) return row_of({{"mi", "d"}, found[0].within()});
    Elements inside;
    for (const Piece& each : found) {
      if (!inside.empty()) inside.push_back(sign_element(","));
      inside.push_back(each.shown);
    }
    MathElement function{"mi", name == "log" ? "ln" : name == "gamma" ? "Γ" : name};
    if (name == "log10") function = {"msub", "", {{"mi", "log"}, {"mn", "10"}}};
    return row_of({std::move(function), sign_element("\u2061"), bracketed(std::move(inside))});
  }

  const Text& text_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

void add_escaped(const std::string& text, std::string& out) {
  for (const char each : text) {
    if (each == '&')
      out += "&amp;";
    else if (each == '<')
      out += "&lt;";
    else if (each == '>')
      out += "&gt;";
    else
      out += each;
  }
}

void add_markup(const MathElement& element, std::string& out) {
  out += "<" + element.tag + ">";
  add_escaped(element.text, out);
  for (const MathElement& each : element.children) add_markup(each, out);
  out += "</" + element.tag + ">";
}

}  // namespace

MathElement typeset_name(const std::string& name) {
  const std::size_t at = name.find('_');
  if (at == name.npos || at == 0 || at + 1 == name.size()) return identifier(name);
  Elements below;
  for (std::size_t from = at + 1; from <= name.size();) {
    const std::size_t end = std::min(name.find('_', from), name.size());
    if (!below.empty()) below.push_back(sign_element(","));
    below.push_back(identifier(std::string_view(name).substr(from, end - from)));
    from = end + 1;
  }
  return {"msub",
          "",
          {identifier(std::string_view(name).substr(0, at)),
           below.size() == 1 ? below[0] : row_of(below)}};
}

MathElement typeset(const Text& text) {
  return Typesetter(text).run();
}

std::string mathml(const MathElement& element) {
  std::string out;
  add_markup(element, out);
  return out;
}

}  // namespace wearwell::formula
