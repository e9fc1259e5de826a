#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "wearwell/models/clutch/lanes.h"
#include "wearwell/models/clutch/wear_law.h"

namespace wearwell::clutch {
struct FixedCycles;
}

/// The loops of FixedSum.
namespace wearwell::clutch::fixed_kernels {

/// Rows whose rates are computed at once: they stay in the first-level cache.
inline constexpr std::size_t block = 128, block_vectors = block / lanes::count;
/// Of run-in within a cell: a cell is at most a quarter of the shortest decay, so the error is
/// below (1/8)^9/9! = 2e-14.
inline constexpr std::size_t degree = 8;

/// Powers of temperature and torque, together 1 to 3.
inline constexpr std::size_t terms = 9;
std::size_t term(int temperature, int torque);

/// One polynomial, Horner's rule in the slip distance.
struct Rate {
  struct Term {
    std::size_t term = 0;
    double coefficient = 0;
  };
  struct Level {
    double constant = 0;
    std::vector<Term> terms;
  };
  std::size_t speed = 0, time = 0;  ///< of the exponents
  std::vector<Level> levels;        ///< highest power of the distance first
  double scale = 0;                 ///< half, over the unit of volume
  double most = 0;                  ///< settled volume, in units, of the rows of add_run
};

struct Plan {
  std::size_t models = 0, stride = 0;  ///< the model and its replicates; padded to whole vectors
  std::vector<double> speed_powers, time_powers;
  std::vector<Rate> rates;
  std::vector<double> slow, fast, slow_step, fast_step;  ///< run-in; decay over half a cell
  std::array<double, 4> from{}, to{}, input_scale{};
  double energy_unit = 1, variance_scale = 1;
  ScatterLaw scatter;
  double scatter_floor = 0;
};

/// Run-in of all models within one cell of energy: coefficients by power, then by model.
struct Cell {
  std::int64_t number = -1;
  std::vector<double> c;
};

struct Workspace {
  void prepare(const Plan& plan);
  const double* settled_of(std::size_t model) const {
    return settled[model * (block_vectors + 1)].x;
  }
  const Cell& cell(const Plan& plan, std::int64_t number);

  std::vector<lanes::Line> speed, time;  ///< powers, block_vectors each
  std::vector<lanes::Line> term;         ///< as above
  std::vector<lanes::Line> settled;      ///< by model, each with a spare vector
  /// Of the block's rows: rate and variance of the model, its run-in, the place in the cell.
  alignas(64) std::array<double, block + lanes::count> w{}, variance{}, g{}, at{};
  /// Sums by model: of rows added one by one, and in parts of rows added in runs.
  std::vector<long long> row_volumes, row_settleds;
  std::vector<lanes::WholeLine> volumes, settleds;
  bool has_runs = false;  ///< the parts are not all zero
  /// Adds them to `with_run_in` and `without`, from the first replicate on, and resets to zero.
  template <class Sum>
  void take_sums(std::size_t replicates, Sum* with_run_in, Sum* without) {
    for (std::size_t b = 1; b <= replicates; ++b) {
      with_run_in[b - 1] += row_volumes[b];
      without[b - 1] += row_settleds[b];
      if (!has_runs) continue;
      long long with = 0, plain = 0;
      for (const long long x : volumes[b].x) with += x;
      for (const long long x : settleds[b].x) plain += x;
      with_run_in[b - 1] += with;
      without[b - 1] += plain;
      volumes[b] = settleds[b] = {};
    }
    std::fill(row_volumes.begin(), row_volumes.end(), 0);
    std::fill(row_settleds.begin(), row_settleds.end(), 0);
    has_runs = false;
  }
  std::vector<Cell> cells;
  std::vector<double> one_row;
};

/// Rates and settled volumes of rows [first, first + rows) of all models, and the scatter of the
/// model. False if one is too large or not a number, so that every summand must be checked.
bool find_rates(const Plan& plan, const FixedCycles& cycles, std::size_t first, std::size_t rows,
                Workspace& workspace);
/// Adds rows [from, to) of the block, all of one cell, to the sums of the replicates; g of the model.
void add_run(const Plan& plan, const Cell& cell, std::size_t from, std::size_t to,
             Workspace& workspace);
/// Of rows [from, to): sums of the inputs, and counts of those outside the range.
void add_inputs(const Plan& plan, const FixedCycles& cycles, std::size_t from, std::size_t to,
                long long* sums, std::int64_t* counts);

}  // namespace wearwell::clutch::fixed_kernels
