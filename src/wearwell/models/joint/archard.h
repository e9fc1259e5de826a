#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "wearwell/bayes/log_density.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/bayes/observation.h"

namespace wearwell::joint {

/// Archard's law for the worn volume of a joint (An et al. 2011, eqs. 4 and 6):
///
///   V = V0 + k W (W / W_ref)^(exponent - 1)
///
/// with W the friction work, the integral of force over slip. V0 (default 0) and the exponent
/// (default 1, Archard) are parameters only if the study has them. W_ref keeps k a wear coefficient
/// for any exponent: k is the mean one up to W_ref.
struct Archard {
  bool has_constant = false;
  bool has_exponent = false;
  double reference_work = 1;  ///< W_ref in J, > 0

  /// Parameters in order: k [m^3/(N m)], sigma [m^3], V0 [m^3] if any, exponent if any.
  int dimension() const { return 2 + has_constant + has_exponent; }

  /// Mean worn volume [m^3] at friction work `work` [J] >= 0.
  template <class T>
  T mean_volume(const T* x, double work) const {
    using std::pow;
    T volume = x[0] * work;
    if (has_exponent && work > 0) volume *= pow(work / reference_work, x[dimension() - 1] - 1.0);
    if (has_constant) volume += x[2];
    return volume;
  }

  /// Friction work [J] at which the mean worn volume reaches `limit` [m^3]: 0 if it starts above,
  /// infinity if never.
  double work_at(const double* x, double limit) const;
};

/// Inspections of one joint, in SI; one entry each.
struct Inspections {
  std::vector<double> work;    ///< friction work until the inspection, J
  std::vector<double> volume;  ///< worn volume, m^3
};

/// The likelihood of (k, sigma, ...) of an Archard law for the first `count` inspections.
std::shared_ptr<const LogDensity> archard_likelihood(const Archard& law, ObservationFamily family,
                                                     const Inspections& inspections,
                                                     std::size_t count);

/// The score of each inspection in the distribution of its measurement.
Scores archard_scores(const Archard& law, ObservationFamily family, const Inspections& inspections);

/// Least-squares k (V0 = 0, exponent 1) and the standard deviation about it: start values of
/// searches.
struct LeastSquares {
  double k;
  double sigma;
};
LeastSquares least_squares(const Inspections& inspections);

}  // namespace wearwell::joint
