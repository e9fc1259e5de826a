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

/// A B-life, SI: the life by which a share of new units has failed.
struct FittedBLife {
  double predictive =
      0;  ///< by which this share is expected to have failed, averaged over the posterior
  double bound = 0;                            ///< the lower bound of the life by which it has
  std::optional<double> numerical_error = {};  ///< of both, relative (study/numerical_error.h)
};

/// A running unit.
struct KnownUnit {
  std::string name;
  double now = 0;           ///< position on the axis, SI; NaN if unknown
  double passed = 0;        ///< the probability that it has passed its threshold
  WeightedLives remaining;  ///< from now on, given that it has not, SI
  /// The same by population, evaluated when units are counted; empty if there is only the mixture.
  std::function<std::optional<InPopulations>()> in_populations = {};
  bool by_age = false;  ///< nothing but its age is known of it
};

/// The lives that decisions rest on: of a new unit, and of running ones.
struct KnownLives {
  std::string title;          ///< name of their source
  std::string noun = "unit";  ///< noun for a unit: "machine"
  std::string axis = "life";  ///< axis of life: "distance"
  Unit unit;                  ///< of the axis, as shown
  bool trusted = true;        ///< the underlying fit
  PopulationLives fresh;      ///< of a new unit; empty if unknown
  /// The same over fewer points of the posterior, which show how far results depend on their number; empty if the
  /// populations are the whole posterior.
  PopulationLives fewer = {};
  std::vector<KnownUnit> units;
  std::vector<double> populations =
      {};  ///< weights of populations that units may share; empty: not distinguished
  /// A B-life over the whole posterior, with its lower bound at a level (fitted_b_life.h), if a study measures
  /// lives; else, or where it is none, `fresh` has the populations that are known.
  std::function<std::optional<FittedBLife>(double share, double level)> b_life = {};
};

/// Lives from a table: a column `life`, with its unit in the heading ("life [h]"), and optionally
/// `weight` (default 1), `unit` (a name, whose rows are its remaining useful life; empty: a new
/// unit) and `population` (rows that hold if units are of that population; for running units in all
/// populations or none). "inf" is a life that never ends. Throws InputError naming row, column and
/// value.
KnownLives lives_of_table(const Table& table);

/// Lives of the units of a study, and of a new one, averaged over the uncertainty of the
/// population.
KnownLives lives_of_tracker(const Tracker& tracker, const std::string& title, bool trusted);

/// Only the lives of a new unit, to which units can be added.
KnownLives lives_of_new(const Tracker& tracker, const std::string& title, bool trusted);
/// `unit` must outlive this: it is evaluated by population, with its readings since the study.
KnownUnit known_unit(const std::string& name, std::shared_ptr<const TrackedUnit> unit,
                     History history = {});

/// A name that no unit of the study has.
std::string new_name(const Tracker& tracker);

}  // namespace wearwell::prognosis
