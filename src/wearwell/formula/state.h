#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "wearwell/formula/tape.h"

namespace wearwell::formula {

/// An array over the rows of a call, or one number for all.
struct Values {
  const double* at = nullptr;
  bool uniform = false;
  double operator[](std::size_t i) const { return at[uniform ? 0 : i]; }
};

/// What a state runs on: the rows of a call.
struct StateRows {
  const double* axis = nullptr;          ///< sorted within a path
  const std::uint8_t* starts = nullptr;  ///< 1 where a path begins
  const double* from = nullptr;  ///< where on the axis, at its first row; null: as the law says
  std::size_t count = 0;
  Values beginning;  ///< taken from the first row of a path
  Values anchor;     ///< where paths begin by the law, also one that goes on from elsewhere
  std::vector<Values> inputs;  ///< as StatePlan::inputs; they hold up to their row
};

/// Where adjoints of a state go; null where nobody takes them. They are added to; of an argument
/// that is uniform, to one number.
struct StateAdjoints {
  double* beginning = nullptr;
  std::vector<double*> inputs;
};

/// Integrates a state's rate from row to row (Fehlberg 7(8), to a relative 1e-11 a step), and its
/// sensitivities backwards. Where the rate is a factor times a shape that depends on the state alone, rows
/// run along trajectories that they share (trajectory.h); by steps only beyond these. One thread's own; it
/// allocates only for more trajectories, or longer ones, than ever before.
class StateSolver {
 public:
  StateSolver(const StatePlan& plan, const StateStart& start);
  StateSolver(StateSolver&&) noexcept;
  StateSolver& operator=(StateSolver&&) noexcept;
  ~StateSolver();

  /// The state at each row. Infinite where it grows without bound before the row, and from there to
  /// the end of its path; NaN where its rate cannot be computed or takes more than 20000 steps.
  void forward(const StateRows& rows, double* state);

  /// Adds what the adjoints of the state give.
  void reverse(const StateRows& rows, const double* state, const double* adjoint,
               StateAdjoints& to);

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace wearwell::formula
