#pragma once

#include <span>
#include <vector>

#include "wearwell/bayes/normal_score.h"

#include "wearwell/prob/response.h"
#include "wearwell/prob/response_block.h"

namespace wearwell::formula_model {

/// Paths whose increments are random and independent of each other: the path of a unit begins at 0 where its
/// mean does, and from row to row it grows by a random step of mean dm, the growth of slot `mean`.
///
///   wiener            normal with variance scale * dm, or the growth of sd^2
///   gamma             gamma with variance scale * dm: only upwards
///   inverse_gaussian  inverse Gaussian with variance scale * dm: only upwards
///
/// Each reading may have an error of its own, normal with standard deviation `noise`: then the path is hidden. Of
/// a Wiener process all is normal (Kalman's recursion); of the others see formula_hidden_path.h.
enum class Process { wiener, gamma, inverse_gaussian };

struct ProcessForm {
  Process process;
  bool by_sd = false;  ///< slot 1 is the standard deviation of the path, else scale
  /// As of a family, for the reader of slots; its `family` means nothing.
  ResponseForm form;
};
/// All there are; slots are mean, scale or sd, and noise. The Wiener process is there twice.
std::span<const ProcessForm> process_forms();

/// Where the path of a unit stands after its last row, given all of its readings: normal, or in
/// cells.
struct Standing {
  double mean = 0;      ///< slot `mean` there
  double at = 0;        ///< the path: its mean
  double variance = 0;  ///< and variance; 0 where readings have no error
  struct Cell {
    double at, share;
  };
  std::vector<Cell> cells = {};  ///< of a path that is hidden and not normal; shares sum to 1
  double width = 0;              ///< of each cell
};

/// The readings of one unit, along the axis.
struct ProcessRows {
  std::span<const double> reading;
  std::span<const double> mean, spread, noise;  ///< slots; `noise` may be empty
  /// log of what each reading is above the one before, if the caller keeps it.
  std::span<const double> log_growth = {};
};

/// log density of each reading given those before, which sum to the unit's; -infinity where there is none.
/// `slope` (empty: not wanted) has the derivatives of the sum by the slots, `slope[s * rows + i]`.
void process_terms(const ProcessForm& form, const ProcessRows& rows, std::span<double> value,
                   std::span<double> slope);
Standing standing(const ProcessForm& form, const ProcessRows& rows);
/// Where each reading lies among those that readings before it let expect.
void process_scores(const ProcessForm& form, const ProcessRows& rows,
                    std::vector<NormalScore>& scores);

}  // namespace wearwell::formula_model
