#pragma once

#include <cmath>
#include <functional>
#include <memory>

#include "wearwell/bayes/log_density.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/models/recurrence/recurrence_data.h"

namespace wearwell::recurrence {

/// What a repair does. Power law (Crow-AMSAA): minimal repair, a unit is as bad as old; its failures are a Poisson process
/// with mean M_T (t/T)^beta until age t. Renewal: perfect repair, as good as new; the times between failures are independent
/// with a Weibull distribution.
enum class ProcessKind { power_law, renewal };

struct Process {
  ProcessKind kind = ProcessKind::power_law;
  double reference = 1;  ///< T [SI], of the power law
  double rounding = 0;   ///< of ages [SI]

  bool minimal_repair() const { return kind == ProcessKind::power_law; }

  /// Expected number of failures of one unit from age 0 to `age` under the power law; x = beta, M_T.
  template <class T>
  T mean_by(const T* x, double age) const {
    using std::exp;
    if (!(age > 0)) return T(0.0);
    return x[1] * exp(x[0] * std::log(age / reference));
  }
  /// Failures per unit of age under the power law.
  double intensity(const double* x, double age) const { return x[0] * mean_by(x, age) / age; }
};

/// The likelihood of the gaps; parameters beta and M_T, or beta and eta [SI]. Its factors are the gaps in their order: the
/// density of a failure, or the probability of none, given the unit's past, so that factors of both processes are comparable.
/// The density of a second failure within one rounded age is the mean density over the rounding step.
std::shared_ptr<const LogDensity> process_likelihood(const Process& process,
                                                     const RecurrenceData& data);

/// The normal scores of the gaps. A second failure within one rounded age has an interval.
Scores process_scores(const Process& process, const RecurrenceData& data);

}  // namespace wearwell::recurrence
