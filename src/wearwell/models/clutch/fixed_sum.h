#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "wearwell/models/clutch/clutch_sql.h"
#include "wearwell/models/clutch/wear_model.h"

namespace wearwell::clutch {

/// A whole number of 128 bits.
__extension__ typedef __int128 Wide;

/// Places in FixedTotals::counts: the statements' count_names.
enum FixedCount {
  counted,
  refused,
  repeated,
  outside_first,
  outside_any = 7,
  negative,
  fixed_counts
};
/// In FixedTotals::sums: the statements' sum_names; from `replicate_sums` on the replicates, with run-in, then
/// without.
enum FixedPlace {
  energy_sum,
  volume_sum,
  variance_sum,
  settled_sum,
  input_sums,
  replicate_sums = 8
};

/// The sums of ClutchSql's query for one unit, in the same units.
struct FixedTotals {
  std::array<std::int64_t, fixed_counts> counts{};
  std::vector<Wide> sums;
};

/// Cycles by column, SI and degrees Celsius, all valid by the statements' conditions. Consecutive
/// cycles of one unit are one segment.
struct FixedCycles {
  std::vector<double> slip_speed, torque, temperature, closing_time;
  std::vector<std::int64_t> energy;  ///< in FixedUnits::energy
  /// The unit's energy before the cycle: cell and place in it from -1 to 1 (FixedSum::place).
  std::vector<std::int64_t> cell;
  std::vector<double> at;
  std::vector<std::size_t> ends;  ///< of segments; the last is the number of rows

  std::size_t size() const { return energy.size(); }
  void clear();
};

/// The sums of ClutchSql's query in a built-in loop, measured as 30 times as fast as an engine's
/// expressions: rates of all replicates over vectors of rows, and run-in from a polynomial of
/// degree 8 for each cell of energy, within 1e-13 of it. The summand of a cycle depends only on the
/// cycle and its unit's energy before it, and is rounded to an integer: the order, the division and
/// the number of threads do not change a bit, and the sums are within 1e-12 of those of the
/// statements.
class FixedSum {
 public:
  /// Throws InputError if run-in decays within so little energy that the fixed point does not
  /// resolve it.
  FixedSum(const WearModel& model, bool replicates);
  ~FixedSum();

  const FixedUnits& units() const { return units_; }
  std::size_t sums() const { return replicate_sums + 2 * replicates_; }
  void place(Wide before, std::int64_t& cell, double& at) const;

  /// Storage of one thread.
  struct Workspace;
  std::shared_ptr<Workspace> workspace() const;
  /// Returns the totals of each segment, in order. Throws InputError ("out of range") if a summand
  /// does not fit.
  void add(const FixedCycles& cycles, Workspace& workspace,
           const std::function<void(std::size_t segment, const FixedTotals&)>& take) const;

 private:
  struct Plan;
  void careful(const FixedCycles& cycles, std::size_t first, std::size_t from, std::size_t to,
               Workspace& workspace) const;
  void quick(const FixedCycles& cycles, std::size_t first, std::size_t from, std::size_t to,
             Workspace& workspace) const;
  void middle(const FixedCycles& cycles, std::size_t first, std::size_t from, std::size_t to,
              Workspace& workspace) const;

  FixedUnits units_;
  std::size_t replicates_;
  int shift_ = 0;         ///< a cell is 2^shift units of energy
  double two_cells_ = 0;  ///< 2 of them, one spare
  std::unique_ptr<Plan> plan_;
};

}  // namespace wearwell::clutch
