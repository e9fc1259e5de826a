#pragma once

#include <span>
#include <vector>

#include "wearwell/latent/unit_integral.h"

namespace wearwell::formula_model {

/// A distribution of a unit's effects as lines of nodes: along each line some parameter changes in
/// even steps, so that a density can be interpolated through them (`CellMixture::add_curve`). A
/// line of one node is a point.
struct EffectLines {
  std::vector<double> z;          ///< nodes x effects
  std::vector<double> share;      ///< of each node; sum to 1
  std::vector<std::size_t> ends;  ///< of each line: one past its last node
  std::size_t count() const { return share.size(); }

  /// Appends a line; both arguments have one entry per node: weights and values.
  template <class Visit>
  void each(std::span<const double> value, const Visit& visit) const {
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
      visit(std::span(share).subspan(begin, end - begin), value.subspan(begin, end - begin));
      begin = end;
    }
  }
};

/// Values of a unit's effects, with weights that sum to 1: a trapezoidal rule over the standard
/// normal distribution, cut at `reach`, with an error of e^-80 for smooth functions.
struct NormalNodes {
  /// With steps of 0.5 for one effect, 0.75 for two.
  NormalNodes(std::size_t effects, double reach)
      : NormalNodes(effects, reach, effects > 1 ? 0.75 : 0.5) {}
  NormalNodes(std::size_t effects, double reach, double step);
  std::vector<double> z;  ///< nodes x effects
  std::vector<double> weight;
};

/// Effects of a new unit, none, one or two: standard normal, up to `reach`. With two effects the
/// lines run along the first, or in the turned direction.
EffectLines lines_of_new_unit(std::size_t effects, double step = 0.25, double reach = 8.25);

/// For two effects: fills `turned` with lines along `direction`, in which the requested quantity
/// changes; it is nearly constant across lines. Any length; zero and NaN mean the diagonal.
void turn(const EffectLines& lines, const double direction[2], EffectLines& turned);

/// Of a unit of the study: the nodes of the integral over its effects. With two effects they are
/// points, of which there are many.
void lines_of_seen_unit(const latent::UnitIntegrals& integrals, std::size_t unit,
                        std::size_t effects, EffectLines& lines);

}  // namespace wearwell::formula_model
