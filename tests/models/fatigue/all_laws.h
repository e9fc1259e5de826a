#pragma once

#include <vector>

#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// Laws whose curve has a knee, a limit or a form of its own, or whose scatter grows.
inline std::vector<SnLaw> bent_laws() {
  std::vector<SnLaw> laws;
  for (const auto family : {LifeFamily::log10_normal, LifeFamily::weibull}) {
    SnLaw law;
    law.family = family;
    law.curve = SnCurve::knee;
    laws.push_back(law);
    law.second_slope = SecondSlope::haibach;
    laws.push_back(law);
    law.second_slope = SecondSlope::infinite;
    for (const auto limit :
         {StandardDistribution::normal, StandardDistribution::smallest_extreme_value}) {
      law.limit = limit;
      laws.push_back(law);
    }
    for (const auto curve : {SnCurve::stromeyer, SnCurve::bastenaire, SnCurve::strain_life}) {
      SnLaw other;
      other.family = family;
      other.curve = curve;
      laws.push_back(other);
    }
    SnLaw growing;
    growing.family = family;
    growing.scatter_grows = true;
    laws.push_back(growing);
    growing.curve = SnCurve::knee;
    laws.push_back(growing);
  }
  return laws;
}

/// Plausible parameters of one of them for stresses of 200 to 500 MPa, moved by a share `shift` of what
/// they may be moved.
inline std::vector<double> plausible_bent(const SnLaw& law, double shift) {
  std::vector<double> x;
  switch (law.curve) {
    case SnCurve::basquin:
      x = {9.35 + 0.05 * shift, -0.15 - 0.01 * shift};
      break;
    case SnCurve::knee:
      x = {6 + 0.5 * shift, 5.9 + 0.1 * shift};
      if (!law.limit) x.push_back(8.45 + 0.02 * shift);
      if (law.curve_dimension() == 4) x.push_back(15 + 2 * shift);
      break;
    case SnCurve::stromeyer:
      x = {9.6 + 0.05 * shift, -0.25 - 0.01 * shift, 8.1 + 0.03 * shift};
      break;
    case SnCurve::strain_life:
      x = {9 + 0.05 * shift, -0.09 - 0.01 * shift, 11.3 + 0.1 * shift, -0.6 - 0.02 * shift};
      break;
    case SnCurve::bastenaire:
      x = {5.9 + 0.1 * shift, 8.3 + 0.1 * shift, 0.8 + 0.1 * shift, 8.1 + 0.03 * shift};
  }
  if (law.has_strength()) x.push_back(9 + 0.1 * shift);
  x.push_back(0.3 * (1 + 0.3 * shift));
  if (law.scatter_grows) x.push_back(0.1 * (1.5 + shift));
  if (law.limit) x.insert(x.end(), {8.45 + 0.02 * shift, 0.06 * (1 + 0.2 * shift)});
  return x;
}

}  // namespace wearwell::fatigue
