#pragma once

#include <map>
#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// One forecast, held against what came.
struct Hindcast {
  std::string unit;
  std::size_t readings = 0;          ///< that it was made with
  double at = 0;                     ///< where the unit stood, SI
  double life = 0;                   ///< where along the axis it ended, SI
  double q05 = 0, q50 = 0, q95 = 0;  ///< where it was expected to end, SI
  double place = 0;                  ///< of the life in what was expected: a probability
  bool held() const { return q05 <= life && life <= q95; }
};

/// How forecasts of one age held.
struct HeldAt {
  std::string age;  ///< "5 to 9 readings"
  std::size_t units = 0, forecasts = 0, held = 0;
  double width = 0;  ///< median of the interval's width over what remained
  double error = 0;  ///< median distance of the life from the middle, over what remained
  double low = 0,
         high = 0;  ///< share that would hold 90 %, by chance: of so many independent units
};

struct Backtest {
  std::vector<Hindcast> hindcasts;  ///< by unit, in the order of its readings
  std::vector<HeldAt> ages;         ///< by readings so far, then of all
  std::size_t readings = 0, units = 0, repeated = 0, refused = 0, contradicting = 0,
              without_life = 0;
  std::string first_refused = {};
};

/// Follows each unit of `readings` from its first on, as it would have been followed on line, in the order in which the rows stand, and holds
/// every forecast of its remaining useful life against where its life ended. Columns are those of the study, by the headings of the study's
/// names with units ("wear [um]", "wear_um"), and a column of units, named as the study calls them. A row that is the same as
/// one before counts once. Throws InputError naming column and row.
Backtest backtest(const Tracker& tracker, const Table& readings,
                  const std::map<std::string, double>& lives);

/// Where lives ended, of a table with a column of units and one `life` with its unit. SI.
std::map<std::string, double> lives_by_unit(const Tracker& tracker, const Table& table);

}  // namespace wearwell::prognosis
