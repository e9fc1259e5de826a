#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace wearwell::formula_model {

/// Distance of each unit's readings from its path: S_u, the sum over its rows of (reading -
/// path)^2.
class Mismatch {
 public:
  virtual ~Mismatch() = default;
  virtual std::size_t units() const = 0;
  /// Of each unit with its own x (its effect, or the logarithm of it) and the shared theta;
  /// infinite if there is no path.
  virtual void operator()(double theta, std::span<const double> x, std::span<double> sums) = 0;
};

/// Range of the search: plausible x and theta.
struct MismatchDomain {
  double x_low, x_high;
  double theta_low, theta_high;  ///< equal if nothing is shared
  double freedom;                ///< readings less number of fitted values
};

/// S_u as polynomials in x on panels, and in theta, wherever the likelihood is non-negligible for
/// errors of about the estimated size: within 20 and more widths of the best x of each unit, which
/// moves with theta. Immutable.
class MismatchTable {
 public:
  /// Empty if S is not smooth enough, nothing scatters, or the readings do not determine theta or
  /// x. Errors are below 1e-8 of twice the variance of a reading, also between the nodes.
  static std::shared_ptr<const MismatchTable> make(Mismatch& mismatch,
                                                   const MismatchDomain& domain);

  static constexpr std::size_t terms = 14;  // of a polynomial on a panel
  static constexpr std::size_t map_orders =
      7;  // of the center and the width of a unit's x, in theta

  std::size_t units() const { return units_; }
  bool holds(double theta) const { return theta >= theta_low_ && theta <= theta_high_; }

 private:
  friend class MismatchSlice;
  friend class MismatchMaker;
  using Span = std::vector<double>;  // a Chebyshev series in theta

  double unit_place(double theta) const;  // of theta in -1 .. 1

  std::size_t units_ = 0, panels_ = 0, orders_ = 1;
  double theta_low_ = 0, theta_high_ = 0;
  std::vector<Span> center_, half_, best_;  // of each unit's x
  std::vector<double> coefficients_;        // unit, panel, order in theta, term
};

/// A table at one theta; one thread uses it at a time.
class MismatchSlice {
 public:
  explicit MismatchSlice(std::shared_ptr<const MismatchTable> table);

  /// False if the table does not cover theta; the functions below are then invalid.
  bool move(double theta);

  double low(std::size_t unit) const { return at_[unit].center - at_[unit].half; }
  double high(std::size_t unit) const { return at_[unit].center + at_[unit].half; }
  /// Approximate position of the minimum of S.
  double best(std::size_t unit) const { return at_[unit].best; }
  bool holds(std::size_t unit, double x) const { return x >= low(unit) && x <= high(unit); }

  /// S, and its derivatives by x, at an x inside the table.
  struct Place {
    double value, slope, bend;
  };
  double value(std::size_t unit, double x);
  Place place(std::size_t unit, double x);
  /// Its derivative by theta, at fixed x.
  double by_theta(std::size_t unit, double x);

 private:
  struct Frame {
    double center = 0, half = 1, best = 0, center_slope = 0, half_slope = 0;
  };
  struct Spot {
    std::size_t panel;
    double t, s;  // in the panel and in the whole range, -1 .. 1
  };
  Spot spot(std::size_t unit, double x) const;
  const double* polynomial(std::size_t unit, std::size_t panel);
  const double* theta_polynomial(std::size_t unit, std::size_t panel);

  std::shared_ptr<const MismatchTable> table_;
  double theta_;
  bool inside_ = false;
  std::vector<double> order_,
      order_slope_;  // Chebyshev polynomials of theta, and their derivatives
  std::vector<Frame> at_;
  std::vector<double> collapsed_, collapsed_slope_;
  std::vector<std::uint8_t> fresh_, fresh_slope_;  // by unit and panel
};

}  // namespace wearwell::formula_model
