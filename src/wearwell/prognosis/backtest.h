#pragma once

#include <map>
#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// One forecast with the observed outcome.
struct Hindcast {
  std::string unit;
  std::size_t readings = 0;          ///< number of readings it was made with
  double at = 0;                     ///< position of the unit on the axis, SI
  double life = 0;                   ///< observed end on the axis, SI
  double q05 = 0, q50 = 0, q95 = 0;  ///< predicted end on the axis, SI
  double place = 0;                  ///< cdf of the predicted life at the observed end
  bool held() const { return q05 <= life && life <= q95; }
};

/// Coverage of forecasts in one age group.
struct HeldAt {
  std::string age;  ///< "5 to 9 readings"
  std::size_t units = 0, forecasts = 0, held = 0;
  double width = 0;  ///< median of the interval's width over the true remaining useful life
  double error = 0;  ///< median error of the predicted median over the true remaining useful life
  double low = 0,
         /// range of the coverage of a correct 90 % interval by chance, for this number of
      /// independent units
      high = 0;
};

struct Backtest {
  std::vector<Hindcast> hindcasts;  ///< by unit, in the order of its readings
  std::vector<HeldAt> ages;         ///< by number of readings, then over all
  std::size_t readings = 0, units = 0, repeated = 0, refused = 0, contradicting = 0,
              without_life = 0;
  std::string first_refused = {};
};

/// Tracks each unit of `readings` from its first reading on, in the order of the rows, as the
/// monitor does, and compares every forecast of its remaining useful life with the observed end.
/// Columns are those of the study, found by the study's names with units ("wear [um]", "wear_um"),
/// and a column of units with the study's name. A row that equals an earlier one counts once.
/// Throws InputError naming column and row.
Backtest backtest(const Tracker& tracker, const Table& readings,
                  const std::map<std::string, double>& lives);

/// The same with `lives` as a table (lives_by_unit). Throws InputError also if no unit of `readings`
/// has a known end there.
Backtest backtest(const Tracker& tracker, const Table& readings, const Table& lives);

/// Observed ends from a table with a column of units and a column `life` with its unit. SI.
std::map<std::string, double> lives_by_unit(const Tracker& tracker, const Table& table);

}  // namespace wearwell::prognosis
