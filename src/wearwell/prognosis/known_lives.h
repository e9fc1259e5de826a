#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/input/table.h"
#include "wearwell/prognosis/replacement.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// A unit that runs.
struct KnownUnit {
  std::string name;
  double now = 0;           ///< where it stands along the axis, SI; NaN where that is not known
  double passed = 0;        ///< the probability that its limit is behind it
  WeightedLives remaining;  ///< from now on, given that it is not, SI
  /// The same population by population, asked for where units are counted; none where this is all there is.
  std::function<std::optional<InPopulations>()> in_populations = {};
};

/// Lives that decisions are made upon: of a new unit, and of those that run.
struct KnownLives {
  std::string title;          ///< what they are from
  std::string noun = "unit";  ///< what a unit is: "machine"
  std::string axis = "life";  ///< along which life is counted: "distance"
  Unit unit;                  ///< of the axis, as shown
  bool trusted = true;        ///< the fit that they come from
  PopulationLives fresh;      ///< of a new one; none where it is not known
  std::vector<KnownUnit> units;
  std::vector<double> populations =
      {};  ///< that units may share: their weights; none: not told apart
};

/// Lives as a table has them: a column `life`, with its unit in the heading ("life [h]"), and, where there are such,
/// `weight` of each (1 without), `unit` (a name, whose rows are what remains to it; empty: of a new one) and `population` (rows that
/// hold if units are of that one; of running units in all populations or in none). "inf" is a life that never ends. Throws InputError
/// naming row, column and value.
KnownLives lives_of_table(const Table& table);

/// Lives of the units that a study has seen, and of a new one, averaged over what is not known of the population.
KnownLives lives_of_tracker(const Tracker& tracker, const std::string& title, bool trusted);

/// A new unit's lives alone, to which units can be added.
KnownLives lives_of_new(const Tracker& tracker, const std::string& title, bool trusted);
/// `unit` is kept, to be asked population by population with what it has read since the study.
KnownUnit known_unit(const std::string& name, std::shared_ptr<const TrackedUnit> unit,
                     History history = {});

/// A name that none of the study's units has.
std::string new_name(const Tracker& tracker);

}  // namespace wearwell::prognosis
