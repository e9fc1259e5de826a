#include "wearwell/prob/transform.h"

#include <cmath>

namespace wearwell {

Transform::Transform(double lower, double upper, double scale)
    : lower_(lower), upper_(upper), scale_(scale) {
  const bool has_lower = std::isfinite(lower), has_upper = std::isfinite(upper);
  kind_ = has_lower && has_upper ? Kind::between
          : has_lower            ? Kind::above
          : has_upper            ? Kind::below
                                 : Kind::whole_line;
  if (kind_ == Kind::between) scale_ = upper - lower;
  log_scale_ = std::log(scale_);
}

double Transform::to_real(double x) const {
  switch (kind_) {
    case Kind::above:
      return std::log((x - lower_) / scale_);
    case Kind::below:
      return std::log((upper_ - x) / scale_);
    case Kind::between:
      return std::log((x - lower_) / (upper_ - x));
    case Kind::whole_line:
      break;
  }
  return x / scale_;
}

Transform::Point Transform::from_real(double z) const {
  switch (kind_) {
    case Kind::above: {
      const double step = scale_ * std::exp(z);
      return {lower_ + step, step, log_scale_ + z, 1};
    }
    case Kind::below: {
      const double step = scale_ * std::exp(z);
      return {upper_ - step, -step, log_scale_ + z, 1};
    }
    case Kind::between: {
      const double e = std::exp(-std::abs(z));
      const double near = e / (1 + e), far = 1 / (1 + e);
      const double x = from_nearer_end(z, near);
      const double log_jacobian = log_scale_ - std::abs(z) - 2 * std::log(1 + e);
      const double slope = scale_ * near * far;
      return {x, slope, log_jacobian, z < 0 ? far - near : near - far};
    }
    case Kind::whole_line:
      break;
  }
  return {scale_ * z, scale_, log_scale_, 0};
}

double Transform::natural(double z) const {
  switch (kind_) {
    case Kind::above:
      return lower_ + scale_ * std::exp(z);
    case Kind::below:
      return upper_ - scale_ * std::exp(z);
    case Kind::between: {
      const double e = std::exp(-std::abs(z));
      return from_nearer_end(z, e / (1 + e));
    }
    case Kind::whole_line:
      break;
  }
  return scale_ * z;
}

}  // namespace wearwell
