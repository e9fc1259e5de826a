#pragma once

#include <Eigen/Dense>

#include "wearwell/infer/nuts.h"

namespace wearwell {

/// Nesterov's dual averaging of the log step size towards a target acceptance (Hoffman and Gelman
/// 2014, eq. 6).
class DualAveraging {
 public:
  explicit DualAveraging(double target_accept) : target_(target_accept) {}

  /// Restarts around `step_size`.
  void restart(double step_size);

  /// The next step size to try, after a transition with this acceptance.
  double update(double accept_stat);

  /// The averaged step size, for sampling.
  double adapted() const;

 private:
  double target_;
  double mu_ = 0, error_ = 0, log_average_ = 0;
  int count_ = 0;
};

/// Stan's warm-up: a fast interval, slow windows that double and estimate the metric, and a last
/// fast interval.
template <int N>
class WindowedWarmup {
 public:
  WindowedWarmup(int iterations, double target_accept);

  /// Adapts `nuts` after warm-up transition `iteration` (0-based).
  void adapt(int iteration, const NutsStep& step, Nuts<N>& nuts, Rng& rng);

  /// Sets the averaged step size at the end of warm-up.
  void finish(Nuts<N>& nuts) const { nuts.step_size = step_size_.adapted(); }

 private:
  int initial_, last_, window_, window_end_, iterations_;
  DualAveraging step_size_;
  bool started_ = false;
  // Welford's moments of the window.
  long count_ = 0;
  SmallVector<N> mean_;
  SmallMatrix<N> squares_;
};

}  // namespace wearwell
