#pragma once

#include <span>
#include <vector>

#include "wearwell/latent/unit_integral.h"

namespace wearwell::formula_model {

/// A law of a unit's effects as lines of nodes: along each of them even steps of some parameter, so that a
/// density can be drawn through them (`CellMixture::add_curve`). A line of one node is a point.
struct EffectLines {
  std::vector<double> z;          ///< nodes x effects
  std::vector<double> share;      ///< of each node; sum to 1
  std::vector<std::size_t> ends;  ///< of each line: the node behind its last
  std::size_t count() const { return share.size(); }

  /// What line after line has, of as many numbers as there are nodes: its shares and its numbers.
  template <class Visit>
  void each(std::span<const double> value, const Visit& visit) const {
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
      visit(std::span(share).subspan(begin, end - begin), value.subspan(begin, end - begin));
      begin = end;
    }
  }
};

/// Places of a unit's effects, with weights that sum to 1: a trapezoidal rule over the standard normal
/// law, cut at `reach`, whose error is e^-80 of a smooth function.
struct NormalNodes {
  NormalNodes(std::size_t effects, double reach);
  std::vector<double> z;  ///< nodes x effects
  std::vector<double> weight;
};

/// Effects of a unit not yet seen, none, one or two: standard normal, as far as `reach`. Of two the lines lie along the
/// first, or as they are turned.
EffectLines lines_of_new_unit(std::size_t effects, double step = 0.25, double reach = 8.25);

/// Of two effects: fills `turned` with lines along `direction`, that in which what is asked for changes: across it
/// one line after the other tells the same. Any length; zero and no number are the diagonal.
void turn(const EffectLines& lines, const double direction[2], EffectLines& turned);

/// Of a unit seen: the nodes on which its effects were integrated out. Of two effects points, which are many.
void lines_of_seen_unit(const latent::UnitIntegrals& integrals, std::size_t unit,
                        std::size_t effects, EffectLines& lines);

}  // namespace wearwell::formula_model
