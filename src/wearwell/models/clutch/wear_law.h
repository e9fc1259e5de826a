#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "wearwell/models/clutch/operating_point.h"

namespace wearwell::clutch {

/// x^n of a term, n >= 0.
inline double power(double x, int n) {
  double result = 1;
  for (; n > 0; --n) result *= x;
  return result;
}

/// Run-in (Haramina et al. 2025, section 3.2): w(Ec) = w0 + w1 exp(-Ec/eps1) + w2 exp(-Ec/eps2)
/// over the energy Ec that a plate has absorbed. g = w/w0 is at least 1.
struct RunIn {
  double slow = 0;         ///< w1/w0
  double fast = 0;         ///< w2/w0
  double slow_energy = 1;  ///< eps1, J
  double fast_energy = 1;  ///< eps2, J

  double g(double energy) const {
    return 1 + slow * std::exp(-energy / slow_energy) + fast * std::exp(-energy / fast_energy);
  }
  /// Integral of g from 0 to `energy`, J.
  double integral(double energy) const {
    return energy - slow * slow_energy * std::expm1(-energy / slow_energy) -
           fast * fast_energy * std::expm1(-energy / fast_energy);
  }
  /// Mean of g while the energy goes from `from` to `to`.
  double mean(double from, double to) const {
    return to > from ? (integral(to) - integral(from)) / (to - from) : g(from);
  }
};

/// The dependence of the scatter of one cycle's wear rate on its conditions (Table 6).
enum class ScatterKind {
  exponential,  ///< p1 exp(p2 w)
  linear,       ///< p1 + p2 w
  quadratic,    ///< p1 + p2 w + p3 w^2
  conditions    ///< p1 + p2 Td + p3 omega0 + p4 Mz + p5 t2
};
inline constexpr std::array<ScatterKind, 4> scatter_kinds = {
    ScatterKind::exponential, ScatterKind::linear, ScatterKind::quadratic, ScatterKind::conditions};

/// sigma_w, m^3/J. Parameters in SI (p2 of `conditions` by degree).
struct ScatterLaw {
  ScatterKind kind = ScatterKind::linear;
  std::vector<double> p;

  /// The value of the formula, which may be negative far from the data.
  double formula(double w, const OperatingPoint& at) const {
    switch (kind) {
      case ScatterKind::exponential:
        return p[0] * std::exp(p[1] * w);
      case ScatterKind::linear:
        return p[0] + p[1] * w;
      case ScatterKind::quadratic:
        return p[0] + w * (p[1] + w * p[2]);
      case ScatterKind::conditions:
        break;
    }
    return p[0] + p[1] * at.temperature + p[2] * at.slip_speed + p[3] * at.torque +
           p[4] * at.closing_time;
  }
};

/// Number of parameters.
int size_of(ScatterKind kind);
const char* name_of(ScatterKind kind);
/// "p1 + p2 w"
const char* formula_of(ScatterKind kind);
/// Throws InputError for another name.
ScatterKind read_scatter_kind(const std::string& name);

/// The units of reported energies and wear rates, in J and m^3/J.
inline constexpr double MJ = 1e6;
inline constexpr double mm3_per_MJ = 1e-15;

}  // namespace wearwell::clutch
