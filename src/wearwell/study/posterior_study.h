#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/bayes/log_density.h"
#include "wearwell/bayes/observation.h"
#include "wearwell/bayes/parameter.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/fit_check.h"
#include "wearwell/infer/profile.h"
#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/predict/prediction.h"
#include "wearwell/study/density_unit.h"
#include "wearwell/study/posterior_summary.h"
#include "wearwell/study/sense.h"
#include "wearwell/study/study.h"
#include "wearwell/study/units_check.h"

namespace wearwell {

/// A measurement to predict, past or future. Functions take natural parameters and give SI.
struct PredictionRequest {
  std::string at_name;  ///< "cycles"
  double at = 0;
  std::string quantity;  ///< "volume"
  Unit unit;
  Function mean;  ///< of the parameters, SI
  Function sd;
  ObservationFamily family = ObservationFamily::normal;
  std::optional<double> measured;  ///< SI
  ItemFunction item =
      {};  ///< scatter between items: the mean is that of one item, the prediction interval too
  /// The items of the mean and of the prediction interval, if these are not the same: "median
  /// bearing".
  std::string mean_of = {}, measured_of = {};
  std::string at_unit = {};  ///< of `at`, if its name is not a unit: "h"
  /// For an observed item: the posterior with the item's own unknowns after the parameters; `mean`
  /// and `sd` are functions of both. Else null. Requests of one item share it.
  std::shared_ptr<const std::function<WeightedDraws(const WeightedDraws& draws)>> with_item = {};
};

/// A life to predict: when a failure threshold is reached.
struct LifeRequest {
  Unit unit;              ///< of the life
  std::string unit_name;  ///< "cycles"
  Quantity limit;
  double now = 0;   ///< the last inspection; 0 for a new item
  double risk = 0;  ///< tolerated at the next inspection
  std::function<LifeDistribution(const WeightedDraws& draws)> distribution;
  std::string of = {};  ///< "new bearing", if items vary
};

/// A quantity that is a monotone function of one positive unknown, its driver: a depth, a pressure
/// or a life from a wear rate.
struct QuantityRequest {
  std::string name;  ///< "life"
  std::string of;    ///< "median bearing"; "new bearing" if the driver is that of a new item
  std::string at;    ///< the conditions, as text
  Unit unit;
  bool increasing = true;
  bool is_life = false;                        ///< then B1, B10 and B50 are reported as well
  std::function<double(double driver)> value;  ///< SI
  Function driver;
  Function scatter;  ///< standard deviation of ln driver between items, for one not yet seen; else
                     ///< empty
  std::optional<double> credible_level = {};  ///< of `QuantityQuantiles::bound`
  /// The conservative quantile for design: 0.05 of a life, 0.95 of a required length.
  std::optional<double> safe_end = {};
  bool headline = false;   ///< one of the main answers of the study
  bool with_mean = false;  ///< the posterior mean is reported, too
  BoundSides sides =
      BoundSides::lower;  ///< which bounds; of both, credible_level is that of the interval
};

/// The predictive distribution of a life, SI, from where it counts on, given that the unit has survived until there.
struct PredictiveLife {
  LifeDistribution distribution;
  double survival = 1;  ///< the predictive probability that it has survived until there
  std::optional<double> numerical_error =
      {};  ///< QuantityQuantiles::numerical_error, of its quantiles
};

/// Quantities without a single driver, computed together from the points of a posterior, SI.
struct QuantityGroup {
  std::vector<QuantityRequest> requests;  ///< without driver
  std::function<std::vector<QuantityQuantiles>(const WeightedDraws& draws)> from_draws;
  /// The distribution of each life among the requests, in their order; empty without lives.
  std::function<std::vector<PredictiveLife>(const WeightedDraws& draws)> lives = {};
};

/// A quantity whose maximum likelihood estimate and profile interval are reported.
struct ProfileRequest {
  std::string name, of, at;
  Unit unit;
  ProfiledQuantity quantity;
  std::function<double(double)> si;  ///< from the scale on which it is profiled; increasing
};

inline constexpr int max_chains = 1000;  ///< each stage of a study has this many random streams
inline constexpr std::size_t most_stages = 300;  ///< limit for updates by single data sets
inline constexpr int min_draws = 10;             ///< diagnostics need at least these
inline constexpr int max_iterations = 10'000'000;

/// A study of a posterior as the engine sees it: parameters with priors, a likelihood of the first
/// data sets, and what to predict. Numbers are in SI.
struct PosteriorStudy : Study {
  std::string description() const override;
  Result run(const RunOptions& options, const Monitor& monitor) const override;

  std::string title, model, equation;
  TextFile file;              ///< the study file, as it was read
  std::string data_file;      ///< as the study file names it
  std::string data_sha1;      ///< of the file when it was read
  std::size_t data_rows = 0;  ///< data sets; the posterior can be updated after each
  /// The observed values, row by row in SI: the arguments of the likelihood's density.
  std::vector<double> observed;
  DensityUnit density;                   ///< unit of reported log densities
  std::vector<DataColumn> data_columns;  ///< for the check of units
  TableLayout data_layout;
  std::string observation = "row";  ///< the unit of the likelihood's factors: "row", "bearing"
  std::vector<Parameter> parameters;
  /// The likelihood of the first `rows` data sets, of natural parameters in the order of `parameters`.
  std::function<std::shared_ptr<const LogDensity>(std::size_t rows)> likelihood;
  std::optional<FitData> fit_data;  ///< for the check of fit
  std::vector<Reach> reaches;       ///< how far predictions extrapolate beyond the data
  bool stages = false;              ///< also compute the posterior after 1, 2, ... data sets
  std::vector<PredictionRequest> predictions;
  /// Additional predictions at the stage after `rows` data sets: that inspection and the next.
  std::function<std::vector<PredictionRequest>(std::size_t rows)> stage_predictions;
  std::vector<QuantityRequest> quantities;
  std::vector<QuantityGroup> quantity_groups;
  std::vector<ProfileRequest> profiled;
  std::optional<LifeRequest> life;
  /// The fitted formula as a clause: "S_f = 2010 MPa N^-0.12"; may be empty.
  std::function<std::string(const WeightedDraws&)> curve;
  std::vector<PredictionRequest> history;  ///< a curve along the whole history, past and future
  std::vector<double> history_at;  ///< position of each data set along it; if empty, where it was
                                   ///< measured
  std::string history_note;        ///< remarks on that curve
  std::optional<PointwiseTable> pointwise;
  std::string quantity;                 ///< the measured quantity: "worn volume"
  std::vector<std::string> data_notes;  ///< remarks on the data, as sentences
  NothingSeen nothing_seen;             ///< set if no failure or wear was observed
  std::vector<std::string> meanings;    ///< of the parameters: "wear coefficient"
  /// What the application checks beside the engine's checks, and shows in each section of the
  /// report; both may be empty.
  std::function<std::vector<Check>(const Fit&)> checks;
  std::function<CoverageTable(const WeightedDraws&)> coverage;  ///< of single tests; may be empty
  std::function<std::map<std::string, std::vector<html::Figure>>(const Fit&)> figures;
  std::function<PresetAddition(const Fit&)> addition;  ///< may be empty
  SamplerChoice sampler;                               ///< as the study file says
  NutsSettings nuts;
  MetropolisSettings metropolis;
  /// ln of the joint prior over the product of the parameters' priors, where an order of parameters
  /// restricts it.
  double log_prior_constant = 0;
  /// Why not all that is asked can be computed, if so: thrown before anything is fitted. Other users
  /// of the study, such as a tracker of one of its units, need not ask for it.
  std::optional<InputError> refusal;
};

/// What an application reads of a study file and its data, beyond what all studies of a posterior have.
using ReadPreset = void (*)(const TomlReader& root, const Source& source, PosteriorStudy& study);

/// Reads title, data, stages and sampler, and with `read_preset` the rest. Throws InputError that names
/// file, line, column and key of the study, or file, row and column of the data.
std::unique_ptr<const Study> read_posterior_study(const TomlReader& root, const Source& source,
                                                  ReadPreset read_preset);

}  // namespace wearwell
