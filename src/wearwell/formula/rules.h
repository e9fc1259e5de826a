#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "wearwell/formula/complaint.h"
#include "wearwell/formula/defined_functions.h"
#include "wearwell/formula/graph.h"

namespace wearwell::formula {

/// A parsed part of an expression.
struct Term {
  enum Kind : unsigned char { number, label, quotation };
  int node = -1;       ///< of a number
  std::size_t at = 0;  ///< its first byte
  std::size_t end = 0;
  Kind kind = number;
  int label_index = -1;  ///< of a label
  std::string quoted = {};
};

/// The typing rules: every operation checks the types and dimensions of its terms and throws
/// InputError with a caret at `at`, the position of the operator or function.
class Rules {
 public:
  Rules(Graph& graph, const Text& text, const Symbols& symbols)
      : graph_(graph), text_(text), symbols_(symbols) {}

  Term sum(Op op, const Term& a, const Term& b, std::size_t at);
  Term product(Op op, const Term& a, const Term& b, std::size_t at);
  Term power(const Term& base, const Term& exponent, std::size_t at);
  Term negative(const Term& a, std::size_t at);
  Term comparison(const std::string& sign, const Term& a, const Term& b, std::size_t at);
  Term logic(Op op, const Term& a, const Term& b, std::size_t at);
  Term opposite(const Term& a, std::size_t at);
  /// `end`: the position after the closing bracket.
  Term call(const Function& function, const std::vector<Term>& arguments, std::size_t at,
            std::size_t end);

  /// Refuses arguments of another number or dimension.
  void check_arguments(const DefinedFunction& function, const std::vector<Term>& arguments,
                       std::size_t start) const;

  /// Refuses a label or text used as a number.
  void demand_value(const Term& term) const;

 private:
  const Node& node(const Term& term) const { return graph_[term.node]; }
  const Powers& powers(const Term& term) const { return graph_.dimension(node(term).powers); }
  std::string written(const Term& term) const;
  std::string dimension(const Term& term) const;
  std::string stand_in(const Term& term) const;

  void demand_truth(const Term& term, const std::string& of) const;
  void demand_pure(const Term& term, const std::string& of, std::size_t at) const;
  void demand_unit(const Term& term, const std::string& unit, const std::string& of) const;
  int common(const Term& a, const Term& b, const std::string& what, std::size_t at) const;
  int bounded(int powers, std::size_t at) const;
  int label_is(const Term& label, const Term& level);
  Term made(Node node, const Term& a, const Term& b, std::size_t at);
  Term of(Op op, int powers, const Term& a, const Term& b, std::size_t at, bool truth = false);

  Graph& graph_;
  const Text& text_;
  const Symbols& symbols_;
};

/// A hint for unequal dimensions: "their ratio is m/s; check for a missing factor or power".
std::string difference(const Powers& a, const Powers& b);

}  // namespace wearwell::formula
