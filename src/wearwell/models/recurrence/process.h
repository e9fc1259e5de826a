#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "wearwell/bayes/log_density.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/models/recurrence/recurrence_data.h"

namespace wearwell::recurrence {

/// What a repair does. Power law (Crow-AMSAA): minimal repair, a unit is as bad as old; its failures are a Poisson process
/// with mean M_T (t/T)^beta until age t. Renewal: perfect repair, as good as new; the times between failures are independent
/// with a Weibull distribution. Phases: minimal repair with a constant intensity in each phase of a test, which changes where
/// delayed fixes are made between phases (MIL-HDBK-189C, 5.4).
enum class ProcessKind { power_law, renewal, phases };

/// The cumulative hazard of a renewal process, `gap` after a repair; x = beta, eta.
template <class T>
T weibull_hazard(const T* x, double gap) {
  using std::exp, std::log;
  if (!(gap > 0)) return T(0.0);
  return exp(x[0] * (std::log(gap) - log(x[1])));
}

struct Process {
  ProcessKind kind = ProcessKind::power_law;
  double reference = 1;  ///< T [SI], of the power law
  double rounding = 0;   ///< of ages [SI]
  std::vector<double> phase_ends =
      {};  ///< of phases: ages at which all but the last end [SI], ascending

  bool minimal_repair() const { return kind != ProcessKind::renewal; }
  std::size_t parameters() const { return kind == ProcessKind::phases ? phase_ends.size() + 1 : 2; }
  /// The phase of a failure at this age; one at the end of a phase belongs to it.
  std::size_t phase_at(double age) const {
    return static_cast<std::size_t>(std::lower_bound(phase_ends.begin(), phase_ends.end(), age) -
                                    phase_ends.begin());
  }
  /// How much of the ages from 0 to `age` lies in a phase.
  double time_in_phase(std::size_t phase, double age) const {
    const double begin = phase > 0 ? phase_ends[phase - 1] : 0;
    const double end = phase < phase_ends.size() ? phase_ends[phase] : age;
    return std::max(0.0, std::min(age, end) - begin);
  }

  /// Expected number of failures of one unit from age 0 to `age` under minimal repair; x = beta, M_T, or the mean time between
  /// failures of each phase.
  template <class T>
  T mean_by(const T* x, double age) const {
    using std::exp;
    if (!(age > 0)) return T(0.0);
    if (kind == ProcessKind::phases) {
      T sum(0.0);
      for (std::size_t k = 0; k < parameters(); ++k) sum += time_in_phase(k, age) / x[k];
      return sum;
    }
    return x[1] * exp(x[0] * std::log(age / reference));
  }
  /// Failures per unit of age from `age` on, under minimal repair: at the end of a phase those of the next.
  double intensity(const double* x, double age) const {
    if (kind != ProcessKind::phases) return x[0] * mean_by(x, age) / age;
    const auto ended = std::upper_bound(phase_ends.begin(), phase_ends.end(), age);
    return 1 / x[ended - phase_ends.begin()];
  }
};

/// The likelihood of the gaps; parameters beta and M_T, beta and eta [SI], or a mean time between failures of each phase [SI]. Its factors are the gaps in their order: the
/// density of a failure, or the probability of none, given the unit's past, so that factors of both processes are comparable.
/// The density of a second failure within one rounded age is the mean density over the rounding step. A gap of grouped data has
/// the Poisson probability of its number of failures (Crow 1982; MIL-HDBK-189C, 6.2.4).
std::shared_ptr<const LogDensity> process_likelihood(const Process& process,
                                                     const RecurrenceData& data);

/// The normal scores of the gaps. A second failure within one rounded age has an interval.
Scores process_scores(const Process& process, const RecurrenceData& data);

}  // namespace wearwell::recurrence
