#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "wearwell/formula/tape.h"

namespace wearwell::formula {

/// The shape of a rate, g(y), at several states at once. For one thread.
class RateShape {
 public:
  static constexpr std::size_t lanes = 16;
  using Lanes = std::array<double, lanes>;

  explicit RateShape(const StatePlan& plan);
  void set_input(std::size_t j, double value);
  /// g of each; valid until the next call.
  const double* operator()(const Lanes& state);
  /// Call after it: the derivatives of each by its state and by an input.
  void differentiate();
  const double* by_state() const { return adjoint(state_); }
  const double* by_input(std::size_t j) const {
    return adjoint(first_input_ + static_cast<int>(j));
  }

 private:
  double* number(int i) { return &numbers_[static_cast<std::size_t>(i) * lanes]; }
  const double* adjoint(int i) const { return &adjoints_[static_cast<std::size_t>(i) * lanes]; }
  double* adjoint(int i) { return &adjoints_[static_cast<std::size_t>(i) * lanes]; }

  std::vector<Step> steps_;
  std::vector<double> numbers_, adjoints_;
  int state_, first_input_, result_;
};

/// One solution of y' = g(y), y(0) = anchor, for t >= 0, as polynomials on panels, each the
/// collocation at 16 Chebyshev nodes (Newton's method; a panel is as long as its last coefficients
/// allow, about 1e-13 of y). All paths with a rate proportional to g follow it; t is the sum of
/// factor times step. It is extended on request, in panels that do not depend on the requests.
class Trajectory {
 public:
  explicit Trajectory(const StatePlan& plan);

  /// Restarts. `inputs` are those of the plan; only the inputs of the shape matter.
  void begin(double anchor, const std::vector<double>& inputs);
  bool is(double anchor, const std::vector<double>& inputs) const;

  /// Extends it to t; false if it ends before t.
  bool reach(double t);
  /// Whether it ends because y diverges; otherwise its continuation is unknown.
  bool blows_up() const { return blown_; }
  double sign() const { return direction_; }

  // For values of t within reach.
  double state(double t) const;
  double rate_at_anchor() const { return rate_; }  ///< g at the anchor
  /// g, and the derivatives of y(t) by the inputs of the shape.
  void slopes(double t, double& rate, std::vector<double>& by_input);

  /// The t at which y is reached; NaN if it is not.
  double place(double y);

 private:
  using Lanes = RateShape::Lanes;
  using Powers =
      std::array<double, RateShape::lanes + 1>;  // coefficients of a polynomial in -1 .. 1
  struct Slope {
    Powers powers;
    double last;  // at the end
  };
  struct Panel {
    double begin, length, first, last;  // in t; y at its ends
    double left, size;                  // last and largest coefficients of g
    Powers y, g;
    Lanes nodes;                // y there
    std::vector<Slope> slopes;  // by each input
  };
  bool extend();
  bool rises_steeply() const;
  void first_step();
  bool solve(double y0, double g0, double bend, double length, Panel& panel);
  void find_slopes(std::size_t panel);
  std::size_t panel_of(double t) const;
  double end() const {
    return panels_ == 0 ? 0 : panel_[panels_ - 1].begin + panel_[panels_ - 1].length;
  }

  RateShape shape_;
  std::vector<bool> counts_;  // inputs of the shape
  double anchor_ = 0, rate_ = 0, direction_ = 1, step_ = 0;
  std::vector<double> inputs_;
  std::vector<Panel> panel_;
  std::size_t panels_ = 0, sloped_ = 0;
  mutable std::size_t last_ = 0;
  bool ended_ = true, blown_ = false;
};

}  // namespace wearwell::formula
