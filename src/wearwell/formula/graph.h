#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "wearwell/formula/symbols.h"
#include "wearwell/formula/words.h"

namespace wearwell::formula {

/// One operation of the expressions of a study; equal operations share a node.
struct Node {
  Op op = Op::constant;
  int a = -1, b = -1, c = -1;  ///< operands, which are earlier nodes; -1 for none
  int index = -1;              ///< of a column, label, slot, or parameter by row
  int level = -1;              ///< label_is, parameter: the level; pick: the label
  double value =
      0;           ///< of a constant; the exponent of whole_power; of cum: whole_step, if it is one
  int powers = 0;  ///< its dimension: index into Graph::dimension
  bool truth = false;  ///< true or false, as 1 or 0
  bool any = false;    ///< a literal 0, which fits any dimension
  // Derived:
  bool rows = false;        ///< varies from row to row
  bool parametric = false;  ///< depends on parameters
  bool by_path = false;     ///< depends on previous rows
  bool moving = false;      ///< within a rate: depends on the state or the axis
  int by_label = -1;        ///< the label whose level alone determines the value; -1 for none
  int depth = 0;
  int origin = -1;  ///< the text of its first occurrence
};

/// For a `cum` that sums whole steps along the axis: a longer step equals two shorter ones.
inline constexpr double whole_step = 1;

/// Typed expressions of a study, hash-consed; a node comes after its operands. Constants are
/// folded. Size and depth are bounded.
class Graph {
 public:
  static constexpr int most_nodes = 200000, most_depth = 1000;

  Graph();

  /// Returns an existing equal node or adds the node, with its derived properties. Throws
  /// InputError if the bounds are exceeded.
  int add(Node node);
  int constant(double value, int powers = 0);
  int make(Op op, int powers, int a, int b = -1, int c = -1, bool truth = false);

  int intern(const Powers& powers);
  const Powers& dimension(int powers) const {
    return dimensions_[static_cast<std::size_t>(powers)];
  }

  const Node& operator[](int i) const { return nodes_[static_cast<std::size_t>(i)]; }
  int size() const { return static_cast<int>(nodes_.size()); }

  /// The origin of nodes added from now on.
  void set_origin(int origin) { origin_ = origin; }

  /// The name of the state; empty without one.
  const std::string& state_name() const { return state_name_; }
  void set_state_name(std::string name) { state_name_ = std::move(name); }

 private:
  struct Hash {
    std::size_t operator()(const Node& node) const;
  };
  struct Same {
    bool operator()(const Node& a, const Node& b) const;
  };
  int folded(const Node& node);
  void derive(Node& node) const;

  std::vector<Node> nodes_;
  std::unordered_map<Node, int, Hash, Same> known_;
  std::vector<Powers> dimensions_;
  std::map<Powers, int> interned_;
  int origin_ = -1;
  std::string state_name_;
};

/// Marks the nodes that `roots` depend on.
std::vector<bool> reachable(const Graph& graph, const std::vector<int>& roots);

/// An expression as text, with lines expanded: "k * (force * distance) / area".
std::string text_of(const Graph& graph, int node, const Symbols& symbols);

}  // namespace wearwell::formula
