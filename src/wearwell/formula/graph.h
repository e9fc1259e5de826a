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

/// One operation of all that is written in a study; equal ones are one.
struct Node {
  Op op = Op::constant;
  int a = -1, b = -1, c = -1;  ///< the nodes it works on, all before it; -1 for none
  int index = -1;              ///< of a column, label, slot, or parameter by row
  int level = -1;              ///< label_is, parameter: the level; pick: the label
  double value =
      0;           ///< of a constant; the exponent of whole_power; of cum: whole_step, if it is one
  int powers = 0;  ///< its dimension: index into Graph::dimension
  bool truth = false;  ///< true or false, as 1 or 0
  bool any = false;    ///< the number 0 as written, which fits any dimension
  // What follows from these:
  bool rows = false;        ///< differs from row to row
  bool parametric = false;  ///< depends on parameters
  bool by_path = false;     ///< depends on rows before its own
  bool moving = false;      ///< within a rate: depends on the state or the axis
  int by_label = -1;        ///< the label whose texts alone tell its rows apart; -1 for none
  int depth = 0;
  int origin = -1;  ///< the text in which it was first met
};

/// Of a `cum` that sums up whole steps along the axis, of which a longer one is as good as two.
inline constexpr double whole_step = 1;

/// Typed expressions of a study, hash-consed: a node stands behind those that it works on. Constants
/// are folded. Bounded in size and depth, whatever is written.
class Graph {
 public:
  static constexpr int most_nodes = 200000, most_depth = 1000;

  Graph();

  /// The node, or the one that there is already; what follows from its arguments is filled in.
  /// Throws InputError where the bounds are exceeded.
  int add(Node node);
  int constant(double value, int powers = 0);
  int make(Op op, int powers, int a, int b = -1, int c = -1, bool truth = false);

  int intern(const Powers& powers);
  const Powers& dimension(int powers) const {
    return dimensions_[static_cast<std::size_t>(powers)];
  }

  const Node& operator[](int i) const { return nodes_[static_cast<std::size_t>(i)]; }
  int size() const { return static_cast<int>(nodes_.size()); }

  /// Of nodes that are added from now on.
  void set_origin(int origin) { origin_ = origin; }

  /// Of the state; empty without one.
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

/// The nodes that `roots` depend on, as a mark for each node of the graph.
std::vector<bool> reachable(const Graph& graph, const std::vector<int>& roots);

/// An expression as text, names of lines written out: "k * (force * distance) / area".
std::string text_of(const Graph& graph, int node, const Symbols& symbols);

}  // namespace wearwell::formula
