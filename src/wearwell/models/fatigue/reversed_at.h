#pragma once

#include <cmath>

#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// log10 of S_f/Pa under one stress at successive points. Lattice nodes come along lines on which
/// the strength is often constant: then the value is reused. `law` must outlive it.
class ReversedAt {
 public:
  ReversedAt(const SnLaw& law, const Stress& stress) : law_(law), stress_(stress) {}

  double operator()(const double* x) {
    const double strength = law_.has_strength() ? x[law_.strength_index()] : 0,
                 gamma = law_.has_gamma() ? x[law_.gamma_index()] : 0;
    if (strength != strength_ || gamma != gamma_) {
      strength_ = strength;
      gamma_ = gamma;
      value_ = law_.log10_reversed(x, stress_);
    }
    return value_;
  }

 private:
  const SnLaw& law_;
  Stress stress_;
  double strength_ = std::nan(""), gamma_ = strength_, value_ = strength_;
};

}  // namespace wearwell::fatigue
