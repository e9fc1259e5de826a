#pragma once

namespace wearwell {

/// What a LogDensity is besides where one evaluation takes about as long as thousands of others (paths integrated out
/// within it): quadrature in more than two dimensions is then not for it, and polynomials in its place are worth trying.
class SlowDensity {
 public:
  virtual ~SlowDensity() = default;
};

}  // namespace wearwell
