#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/progress.h"
#include "wearwell/infer/check.h"
#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/clutch/closing.h"
#include "wearwell/models/clutch/cycle_sum.h"
#include "wearwell/models/clutch/life.h"
#include "wearwell/models/clutch/tribometer.h"
#include "wearwell/models/clutch/wear_model.h"
#include "wearwell/regress/nested.h"
#include "wearwell/study/units_check.h"

namespace wearwell::clutch {

/// A study file of `model = "clutch-wear"`, read and checked.
struct ClutchStudy {
  std::filesystem::path file;
  std::string file_text;  ///< content when it was read
  std::string title;
  /// The source of the campaign: a rig's files or a simulation.
  std::vector<std::filesystem::path> files;  ///< that were read
  std::vector<std::string> sha1s;            ///< of each, when it was read
  std::vector<TableLayout> layouts;          ///< of each; of a rig only
  bool simulated = false;
  std::optional<Truth> truth;            ///< of a simulated campaign
  std::vector<DataColumn> data_columns;  ///< of a rig's tables, as read
  /// A rig's tables in the form of `Source::tables`, to continue from; empty where that is
  /// impossible: one comes from sql, or two are in one file.
  std::map<std::string, Table> tables;
  bool carried = true;  ///< whether they are available
  Campaign campaign;
  std::vector<Realized> realized;  ///< likewise
  std::vector<double> plate_factors;
  std::vector<Sample> traces;  ///< may be empty
  double worn_out = 0;         ///< m^3
  std::vector<double> exponents;
  int replicates = 50;
  std::uint64_t seed = 1;
  std::vector<double> levels;  ///< shares of worn_out
  std::vector<std::pair<std::string, OperatingPoint>> life_points;
};

/// Throws InputError.
ClutchStudy read_clutch_study(const TomlReader& root, const Source& source);
ClutchStudy read_clutch_study(const std::filesystem::path& file);

/// A sequence of changing conditions, predicted and weighed.
struct SequenceResult {
  std::string name;
  int plate = 0;
  struct Weighing {
    long long cycle = 0;
    double energy = 0;             ///< J
    double measured = 0;           ///< m^3
    double predicted = 0, sd = 0;  ///< m^3; by the scatter of cycles
    double full_sd = 0;
    std::optional<double> realized;
  };
  std::vector<Weighing> weighings;

  double final_error() const { return weighings.back().predicted / weighings.back().measured - 1; }
};

/// For a prediction with this relative error: "1.4 % below the measured wear".
std::string error_text(double share);

/// Best R2p with a surrogate: of all points, and the mean over the temperature levels (Table A1).
struct SurrogateResult {
  Surrogate surrogate = Surrogate::distance;
  PairBest best;
  std::vector<double> levels;  ///< temperature, degrees Celsius
  std::vector<double> r2p;     ///< at each level
  double mean_r2p = 0;
};

struct NamedLife {
  std::string name;
  OperatingPoint at;
  Life life;
};

struct ClutchResult {
  std::string version;
  std::vector<std::string> plate_names;  ///< as in Campaign
  std::vector<Closing> closings;
  WornBlocks blocks;
  RunInFit run_in;
  WearPoints points, held_out;
  std::array<double, 4> correlations{};
  ExponentSearch search;
  std::vector<SurrogateResult> surrogates;
  std::vector<WearMap> maps;  ///< selected, linear, full cubic, temperature
  Nested nested;              ///< of the whole search
  ScatterSearch scatter;
  Validation validation;
  WearModel model;
  AveragingEffect averaging;
  std::vector<SequenceResult> sequences;
  std::vector<NamedLife> lives;
  std::vector<Check> checks;
  bool trusted = true;
  double seconds = 0;

  std::string plate_name(int plate) const {
    return plate_names.empty() ? std::to_string(plate)
                               : plate_names.at(static_cast<std::size_t>(plate - 1));
  }
  const ScatterFit& scatter_fit() const { return scatter.candidates[scatter.best]; }
};

/// All steps before the search: closings, blocks, run-in and points. Throws InputError if the
/// campaign cannot be fitted.
ClutchResult prepare_campaign(const ClutchStudy& study);
/// The cycles as read, to find wrong units.
std::vector<DataColumn> cycle_columns(const Campaign& campaign);

/// Weighed blocks of design points, of the given use, compensated for run-in and plate.
WearPoints wear_points(const Campaign& campaign, const std::vector<WornBlock>& blocks,
                       const RunInFit& run_in, bool held_out);

/// A life outside the calibrated range by more of its widths is not trusted.
inline constexpr double farthest_outside = 0.5;
/// A 95 % interval wider than this share of the volume gives a warning; wider than the volume, it
/// fails.
inline constexpr double half_the_volume = 0.5;

/// Whether the operating points of lives are in the calibrated range, and whether their volumes
/// have informative intervals.
Check extrapolation_check(const WearModel& model, const std::vector<NamedLife>& lives);
Check sense_check(const std::vector<NamedLife>& lives);

/// Features, run-in, map, scatter, validation, prediction and life in one go. `threads`: 0 for all;
/// the result does not depend on it. `progress`, if given, counts exact searches.
ClutchResult run_clutch_study(const ClutchStudy& study, int threads = 0,
                              Progress* progress = nullptr);

}  // namespace wearwell::clutch
