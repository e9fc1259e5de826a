#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "wearwell/formula/tape.h"

namespace wearwell::formula {

/// Values for the rows of a call, or a single number.
struct Values {
  const double* at = nullptr;
  bool uniform = false;
  double operator[](std::size_t i) const { return at[uniform ? 0 : i]; }
};

/// The inputs of a state for the rows of a call.
struct StateRows {
  const double* axis = nullptr;          ///< sorted within a path
  const std::uint8_t* starts = nullptr;  ///< 1 at the beginning of a path
  const double* from = nullptr;  ///< beginning on the axis, at the first row; null: from the
                                 ///< formula
  std::size_t count = 0;
  Values beginning;            ///< read at the first row of a path
  Values anchor;               ///< the beginning in the formula, also for continued paths
  std::vector<Values> inputs;  ///< as StatePlan::inputs; valid up to their row
};

/// The destinations of a state's adjoint contributions; null if not needed. A uniform argument has
/// a single number.
struct StateAdjoints {
  double* beginning = nullptr;
  std::vector<double*> inputs;
};

/// Integrates a state's rate from row to row (Fehlberg 7(8), to a relative 1e-11 a step), and its
/// sensitivities backward. If the rate is a factor times a shape that depends only on the state,
/// rows share trajectories (trajectory.h) and use steps only beyond them. For one thread; allocates
/// only for new or longer trajectories.
class StateSolver {
 public:
  StateSolver(const StatePlan& plan, const StateStart& start);
  StateSolver(StateSolver&&) noexcept;
  StateSolver& operator=(StateSolver&&) noexcept;
  ~StateSolver();

  /// The state at each row. Infinite from the row before which it diverges to the end of its path;
  /// NaN if its rate cannot be computed or needs more than 20000 steps.
  void forward(const StateRows& rows, double* state);

  /// Adds the contributions of the state's adjoints.
  void reverse(const StateRows& rows, const double* state, const double* adjoint,
               StateAdjoints& to);

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace wearwell::formula
