#pragma once

namespace wearwell {

/// A smooth bijection between a parameter's support and the real line, on which samplers and
/// integrators work. `scale` is the parameter's magnitude: z changes by about 1 when the parameter
/// changes by this much.
class Transform {
 public:
  /// Support (lower, upper), possibly infinite; scale > 0.
  Transform(double lower, double upper, double scale);

  /// z of x. x must lie strictly inside the support.
  double to_real(double x) const;

  struct Point {
    double x;             ///< on the support (on its boundary if z is too extreme for doubles)
    double slope;         ///< dx/dz
    double log_jacobian;  ///< log |dx/dz|
    double log_jacobian_slope;  ///< d/dz log |dx/dz|
  };
  Point from_real(double z) const;
  /// Only the x.
  double natural(double z) const;

 private:
  enum class Kind { whole_line, above, below, between };
  /// Keeps the precision of the distance to the bound.
  double from_nearer_end(double z, double near) const {
    return z < 0 ? lower_ + scale_ * near : upper_ - scale_ * near;
  }
  Kind kind_;
  double lower_, upper_, scale_, log_scale_;
};

}  // namespace wearwell
