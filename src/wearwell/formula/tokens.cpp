#include "wearwell/formula/tokens.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::formula {
namespace {

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

class Lexer {
 public:
  explicit Lexer(const Text& text) : text_(text), all_(text.text) {}

  std::vector<Token> run() {
    if (all_.size() > longest_expression) {
      throw InputError(
          fmt::format("{}: the expression has {} characters, but at most {} are allowed; write "
                      "parts of it as separate lines",
                      text_.where, all_.size(), longest_expression));
    }
    for (skip(); at_ < all_.size(); skip()) found_.push_back(next());
    if (found_.empty())
      complain(text_, 0, "the expression is empty", "write a number, a name or a formula");
    found_.push_back({Token::end, all_.size(), "", 0});
    return std::move(found_);
  }

 private:
  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < all_.size() ? all_[at_ + ahead] : '\0';
  }

  void skip() {
    while (at_ < all_.size() && std::isspace(static_cast<unsigned char>(all_[at_])) != 0) ++at_;
  }

  Token next() {
    const char c = peek();
    if (is_digit(c) || (c == '.' && is_digit(peek(1)))) return number();
    if (is_letter(c)) return name();
    if (c == '"' || c == '\'') return quoted(c);
    if (c == '[' && !found_.empty() && found_.back().kind == Token::number) return unit();
    return sign();
  }

  Token number() {
    Token token{Token::number, at_, "", 0};
    const char* begin = all_.data() + at_;
    const auto [end, failure] = std::from_chars(begin, all_.data() + all_.size(), token.value);
    const auto length = static_cast<std::size_t>(end - begin);
    token.text = all_.substr(at_, length);
    if (failure == std::errc::result_out_of_range)
      complain(text_, at_, fmt::format("'{}' is too large or too small", shortened(token.text)));
    at_ += length;
    if (is_letter(peek())) {
      std::size_t last = at_;
      while (last < all_.size() && (is_letter(all_[last]) || is_digit(all_[last]))) ++last;
      const std::string word = all_.substr(at_, last - at_);
      complain(text_, at_,
               fmt::format("'{}{}' is neither a number nor a name", token.text, shortened(word)),
               fmt::format("write a product as {} * {}, a unit as {} [{}]", token.text,
                           shortened(word), token.text, shortened(word)));
    }
    if (peek() == '.' || peek() == ',') comma_in_number(token.text);
    return token;
  }

  void comma_in_number(const std::string& before) {
    if (peek() == '.') complain(text_, at_, "a number with two decimal points");
    if (is_digit(peek(1)) && brackets_ == 0) {
      complain(text_, at_, "a comma in a number",
               fmt::format("use a point as the decimal sign: {}.{}", before, peek(1)));
    }
  }

  Token name() {
    const std::size_t start = at_;
    while (at_ < all_.size() && (is_letter(all_[at_]) || is_digit(all_[at_]))) ++at_;
    return {Token::name, start, all_.substr(start, at_ - start), 0};
  }

  Token quoted(char mark) {
    const std::size_t start = at_, close = all_.find(mark, at_ + 1);
    if (close == all_.npos) complain(text_, start, "a quotation is not closed");
    at_ = close + 1;
    return {Token::quotation, start, all_.substr(start + 1, close - start - 1), 0};
  }

  Token unit() {
    const std::size_t start = at_, close = all_.find(']', at_);
    if (close == all_.npos) complain(text_, start, "a unit is not closed", "a ']' is missing");
    at_ = close + 1;
    return {Token::unit, start, all_.substr(start + 1, close - start - 1), 0};
  }

  Token sign() {
    static constexpr std::string_view two[] = {"<=", ">=", "==", "!=", "**",
                                               "&&", "||", "<>", "=<", "=>"};
    for (const std::string_view each : two) {
      if (std::string_view(all_).substr(at_, 2) == each) return sign_of(each);
    }
    static constexpr std::string_view one = "+-*/^()[],<>=!";
    const char c = peek();
    if (one.find(c) == one.npos) unknown();
    if (c == '(') ++brackets_;
    if (c == ')' && brackets_ > 0) --brackets_;
    return sign_of(std::string_view(all_).substr(at_, 1));
  }

  Token sign_of(std::string_view sign) {
    const std::size_t start = at_;
    at_ += sign.size();
    if (sign == "**") complain(text_, start, "'**' is not an operator", "write a power with ^");
    if (sign == "<>") complain(text_, start, "'<>' is not an operator", "write: !=");
    if (sign == "=<") complain(text_, start, "'=<' is not an operator", "write: <=");
    if (sign == "=>") complain(text_, start, "'=>' is not an operator", "write: >=");
    if (sign == "&&") complain(text_, start, "'&&' is not an operator", "write: and");
    if (sign == "||") complain(text_, start, "'||' is not an operator", "write: or");
    if (sign == "!") complain(text_, start, "'!' is not an operator", "write: not");
    if (sign == "=")
      complain(text_, start, "'=' is not an operator here", "write a comparison with ==");
    return {Token::sign, start, std::string(sign), 0};
  }

  [[noreturn]] void unknown() {
    std::size_t end = at_ + 1;
    while (end < all_.size() && (static_cast<unsigned char>(all_[end]) & 0xc0) == 0x80) ++end;
    const std::string seen = all_.substr(at_, end - at_);
    struct Hint {
      std::string_view sign, hint;
    };
    static constexpr Hint hints[] = {{"·", "write a product with *"},
                                     {"×", "write a product with *"},
                                     {"⋅", "write a product with *"},
                                     {"−", "this is not the keyboard minus; write -"},
                                     {"–", "this is not the keyboard minus; write -"},
                                     {"÷", "write a quotient with /"},
                                     {"²", "write a square as ^2"},
                                     {"³", "write a cube as ^3"},
                                     {"{", "use round brackets: ( )"},
                                     {"}", "use round brackets: ( )"},
                                     {"≤", "write <="},
                                     {"≥", "write >="},
                                     {"%", "write a percentage with a unit: 5 [%]"},
                                     {":", "write a quotient with /"},
                                     {";", "an expression must be one formula"}};
    std::string hint =
        "an expression consists of letters a-z, digits and + - * / ^ ( ) [ ] , < > = ! \" _";
    for (const Hint& each : hints)
      if (each.sign == seen) hint = each.hint;
    complain(text_, at_, fmt::format("'{}' is not allowed in an expression", printable(seen)),
             hint);
  }

  const Text& text_;
  const std::string& all_;
  std::size_t at_ = 0;
  int brackets_ = 0;
  std::vector<Token> found_;
};

}  // namespace

std::vector<Token> tokens_of(const Text& text) {
  return Lexer(text).run();
}

}  // namespace wearwell::formula
