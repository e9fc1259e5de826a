#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <vector>

#include "wearwell/formula/reading.h"
#include "wearwell/formula/rules.h"

namespace wearwell::formula {

/// The tokens of an expression with a position, and the meaning of its names.
class Naming {
 protected:
  Naming(Graph& graph, const Text& text, const std::vector<Token>& tokens, const Names& names)
      : graph_(graph),
        text_(text),
        tokens_(tokens),
        names_(names),
        rules_(graph, text, names.symbols) {}

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

  /// Whether the study gives this name a meaning.
  bool is_symbol(const std::string& name) const;

  /// Reads the name at the position and moves past it and its index.
  Term named(const Token& token);

  Graph& graph_;
  const Text& text_;
  const std::vector<Token>& tokens_;
  const Names& names_;
  Rules rules_;
  std::size_t at_ = 0;

 private:
  Term leaf(Op op, std::size_t index, const Powers& powers, std::size_t at, int level = -1);
  [[noreturn]] void no_index(const Token& token);
  Term state(const Token& token);
  Term column(std::size_t i, const Token& token);
  Term parameter(std::size_t i, const Token& token);
  int level_of(const std::string& label, const Token& level);
  [[noreturn]] void unknown(const Token& token);
};

}  // namespace wearwell::formula
