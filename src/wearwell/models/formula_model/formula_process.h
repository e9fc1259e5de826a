#pragma once

#include <span>
#include <vector>

#include "wearwell/bayes/normal_score.h"

#include "wearwell/prob/response.h"
#include "wearwell/prob/response_block.h"

namespace wearwell::formula_model {

/// Paths with independent random increments: the path of a unit starts at 0 where its mean does,
/// and from row to row it grows by a random step of mean dm, the growth of the parameter `mean`.
///
///   wiener            normal with variance scale * dm, or the growth of sd^2
///   gamma             gamma with variance scale * dm: only upwards
///   inverse_gaussian  inverse Gaussian with variance scale * dm: only upwards
///
/// Each reading may have an independent error, normal with standard deviation `noise`: then the
/// path is hidden. For a Wiener process everything is normal (Kalman's recursion); for the others
/// see formula_hidden_path.h.
enum class Process { wiener, gamma, inverse_gaussian };

struct ProcessForm {
  Process process;
  bool by_sd = false;  ///< parameter 1 is the standard deviation of the path, else scale
  /// In the form of a family, for the reader of parameters; its `family` is unused.
  ResponseForm form;
};
/// All processes; parameters are mean, scale or sd, and noise. The Wiener process occurs twice.
std::span<const ProcessForm> process_forms();

/// The state of a unit's path after its last row, given all its readings: normal, or in cells.
struct Standing {
  double mean = 0;      ///< parameter `mean` there
  double at = 0;        ///< the path: its mean
  double variance = 0;  ///< and variance; 0 where readings have no error
  struct Cell {
    double at, share;
  };
  std::vector<Cell> cells = {};  ///< of a hidden path that is not normal; weights sum to 1
  double width = 0;              ///< of each cell
};

/// The readings of one unit, along the axis.
struct ProcessRows {
  std::span<const double> reading;
  std::span<const double> mean, spread, noise;  ///< distribution parameters; `noise` may be empty
  /// log of each reading's increment, if the caller caches it.
  std::span<const double> log_growth = {};
};

/// log density of each reading given the earlier ones, which sum to the unit's; -infinity if it has
/// none. `slope` (may be empty) has the derivatives of the sum by the distribution parameters,
/// `slope[s * rows + i]`.
void process_terms(const ProcessForm& form, const ProcessRows& rows, std::span<double> value,
                   std::span<double> slope);
Standing standing(const ProcessForm& form, const ProcessRows& rows);
/// The predictive score of each reading, given the earlier ones.
void process_scores(const ProcessForm& form, const ProcessRows& rows,
                    std::vector<NormalScore>& scores);

}  // namespace wearwell::formula_model
