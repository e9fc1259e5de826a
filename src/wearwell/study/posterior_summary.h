#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/bayes/draws.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/loo.h"
#include "wearwell/infer/trust.h"
#include "wearwell/predict/prediction.h"
#include "wearwell/present/section.h"
#include "wearwell/study/plots.h"

namespace wearwell {

/// The results of a study in the user's units: everything that reports need, without physics or
/// statistics. best() returns the quadrature value if available, else that of the draws.

struct ExactSummary {
  double mean = 0, sd = 0, q05 = 0, q50 = 0, q95 = 0;
};

/// The meaning of a parameter for which a study states only a name.
inline constexpr const char* meaning_not_stated = "parameter";

struct ParameterSummary {
  std::string name;
  std::string unit;
  // From the draws, or from least squares if nothing is drawn.
  double mean = 0, sd = 0, mcse = 0, q05 = 0, q50 = 0, q95 = 0;
  double ess_bulk = 0, ess_tail = 0, rhat = 0;
  std::optional<ExactSummary> exact;
  std::string meaning = {};  ///< "wear coefficient"
  std::string prior = {};    ///< as text
  bool prior_is_default = false;
  bool drawn = true;

  ExactSummary best() const { return exact ? *exact : ExactSummary{mean, sd, q05, q50, q95}; }
};

/// The measured quantity (a worn volume, for example) at one point of its history.
struct PredictionSummary {
  std::string at_name;  ///< "cycles"
  double at = 0;
  std::string quantity;  ///< "volume"
  std::string unit;
  Prediction drawn;
  std::optional<Prediction> exact;
  std::optional<double> measured;  ///< the measurement in the data at this point, if any
  /// The items of the mean with its interval and of the measurement: "median bearing", "new
  /// bearing" if items vary; else empty.
  std::string mean_of = {}, measured_of = {};
  std::string at_unit = {};  ///< of `at`, if its name is not a unit: "h"

  /// The word after the number in a sentence: "at 5000 cycles", "at 5000 h".
  const std::string& at_word() const { return at_unit.empty() ? at_name : at_unit; }
  const Prediction& best() const { return exact ? *exact : drawn; }
  /// Whether both describe the same quantity of the same items and fit into one table.
  bool is_like(const PredictionSummary& other) const {
    return quantity == other.quantity && unit == other.unit && mean_of == other.mean_of;
  }
};

/// The bounds of a quantity that are reported at a level: one bound, or both ends of the central interval.
enum class BoundSides { lower, upper, both };
inline bool has_lower(BoundSides sides) {
  return sides != BoundSides::upper;
}
inline bool has_upper(BoundSides sides) {
  return sides != BoundSides::lower;
}

/// How much of a mean comes from the upper tail (study/mean_tail.h).
struct MeanTail {
  double highest =
      0;  ///< the share of the posterior mean that the highest 1 % of the posterior carries
  /// Of a mean life: the longest observed life, in its unit, and the share of the mean that comes from
  /// lives beyond it, averaged over the posterior.
  std::optional<double> longest = {}, beyond = {};
};

/// A quantity derived from the parameters: a pressure, a length, a life.
struct QuantityQuantiles {
  double q05 = 0, q50 = 0, q95 = 0;
  double b1 = 0, b10 = 0, b50 = 0;  ///< of a life: its 1, 10 and 50 % quantiles
  /// For a property of the population, such as the life by which 10 % have failed: the predictive
  /// value for the next item, and the bound exceeded with a chosen probability.
  std::optional<double> predictive = {}, bound = {};
  /// The bound that lies above the value with a chosen probability.
  std::optional<double> upper_bound = {};
  /// Estimated largest relative change of these numbers if they were summed over the whole
  /// posterior (study/numerical_error.h). Empty if they are.
  std::optional<double> numerical_error = {};
  std::optional<double> mean = {};         ///< of a function of the parameters: its posterior mean
  std::optional<MeanTail> mean_tail = {};  ///< of a mean life, or of `mean`
};

struct QuantitySummary {
  std::string name;  ///< "life"
  std::string of;    ///< "median bearing", "new bearing"
  std::string at;    ///< the conditions, as text
  std::string unit;
  bool is_life = false;
  QuantityQuantiles drawn;
  std::optional<QuantityQuantiles> exact;
  std::optional<double> credible_level = {};  ///< of the bounds
  std::optional<double> safe_end = {};        ///< 0.05 or 0.95: the quantile to design with
  bool headline = false;                      ///< one of the main answers of the study
  BoundSides sides = BoundSides::lower;       ///< of both, credible_level is that of the interval

  bool is_bounded() const { return best().bound || best().upper_bound; }
  const QuantityQuantiles& best() const { return exact ? *exact : drawn; }
};

/// One test compared with its predicted distribution of life.
struct CoverageRow {
  std::size_t row = 0;  ///< of the data, from 1
  std::string label;    ///< the type of specimen; may be empty
  std::string outcome;  ///< "failure", "runout", "left" or "interval"
  double life = 0;
  std::optional<double> until;  ///< end of an interval
  double probability = 0;       ///< of a life up to this one
  double q05 = 0, q95 = 0, b10 = 0;

  bool failed() const { return outcome == "failure"; }
  bool inside() const { return q05 <= life && life <= q95; }  ///< the 90 % interval
  bool below_b10() const { return life < b10; }
};
struct CoverageTable {
  std::string unit;
  std::vector<CoverageRow> rows;
  std::size_t tests = 0;  ///< tests in the data; if more than rows, the rows are evenly chosen
};

/// A profile likelihood interval (infer/profile.h). An open end is NaN, with its reason.
struct ProfileSummary {
  double level = 0;
  double lower = 0, upper = 0;
  std::string lower_open, upper_open;
};

/// A quantity derived from the parameters, at the maximum of the likelihood.
struct ModeQuantity {
  std::string name, of, at, unit;
  double value = 0;
  ProfileSummary profile;
};

/// One parameter at the mode of the posterior (infer/constrained_mode.h).
struct ModeParameter {
  std::string name;
  std::string unit;
  double value = 0;
  double standard_error = 0;                ///< NaN if the parameter is at a bound
  std::string at;                           ///< "inside", "lower bound" or "upper bound"
  std::optional<ProfileSummary> profile{};  ///< at the maximum of the likelihood
};

/// The mode of the posterior in the parameters' own units.
struct ModeSummary {
  std::string problem;  ///< why there is no mode; if not empty, nothing below is set
  std::vector<ModeParameter> parameters;
  std::string density_unit{};       ///< unit of the data for the log densities below: "km"
  double log_likelihood = 0;        ///< natural logarithm, data in `density_unit`
  double log_posterior = 0;         ///< up to a constant if a prior is improper
  double aic = 0, bic = 0;          ///< of the likelihood at the mode
  bool maximum_likelihood = false;  ///< all priors are flat or uniform, so the mode is the maximum
                                    ///< likelihood estimate
  double observations = 0;          ///< number in BIC
  int starts = 0, reached = 0;      ///< searches, and those that ended at this mode
  std::vector<ModeQuantity> quantities{};  ///< at the maximum of the likelihood

  /// Any of the profiles; none if the mode is not that of the likelihood.
  std::optional<ProfileSummary> profile() const {
    return parameters.empty() ? std::nullopt : parameters.front().profile;
  }
};

/// Leave-one-out cross-validation (infer/loo.h).
struct LooSummary {
  std::string observation;  ///< the unit left out: "row", "bearing"
  Loo loo;                  ///< data in `density_unit`
  std::string density_unit = {};
};

struct LifeSummary {
  std::string unit;  ///< "cycles"
  double limit = 0;  ///< the limit that is reached
  std::string limit_unit;
  double now = 0;  ///< the last inspection
  double risk = 0;
  Life drawn;
  std::optional<Life> exact;
  std::string of = {};  ///< "new bearing", if items vary

  const Life& best() const { return exact ? *exact : drawn; }

  /// The probability that the limit is already passed exceeds the tolerated risk.
  bool passed_beyond_risk() const { return best().passed > risk; }
};

/// Whether lives in this unit are whole numbers: cycles, not hours.
inline bool is_count(const std::string& unit) {
  return unit == "cycles" || unit == "revolutions" || unit == "cycle" || unit == "rev";
}

/// "12 %", "less than 0.01 %".
inline std::string probability_text(double p) {
  constexpr double least = 1e-4;
  if (std::isnan(p)) return "unknown";
  if (p < least) return "less than 0.01 %";
  if (p > 1 - least) return "more than 99.99 %";
  return p > 0.99 ? fmt::format("{:.2f} %", 100 * p) : fmt::format("{:.2g} %", 100 * p);
}

/// The posterior after the first `rows` data sets.
struct StageSummary {
  std::size_t rows = 0;
  std::vector<ParameterSummary> parameters;
  std::vector<PredictionSummary> predictions;
  std::vector<Check> checks;
  bool trusted = true;
};

/// k = V/(F s) of one measurement, as Tables 2 and 3 of An et al. (2011).
struct PointwiseRow {
  double cycles = 0, force = 0, slip = 0, volume = 0, k = 0;
};
struct PointwiseTable {
  std::string volume_unit, force_unit, slip_unit, k_unit;
  std::vector<PointwiseRow> rows;
};

/// The accuracy of the numbers that are called exact.
struct QuadratureSummary {
  double tolerance = 0;  ///< requested, relative, of mass and second moments
  double reached = 0;    ///< estimated
  std::size_t nodes = 0;
};

/// The model's additions to the common result.
struct PresetAddition {
  nlohmann::ordered_json body = {};  ///< keys of summary.json
  /// At the end of the section of the report that has this id.
  std::map<std::string, std::vector<present::Block>> blocks = {};
  std::string text = {};  ///< for a terminal, after the design values; each line ends with a
                          ///< newline
};

/// States which results rest on the prior if no failure or no wear was observed.
struct NothingSeen {
  std::string check;   ///< its name: "no-failures"; empty otherwise
  std::string clause;  ///< message without capital and full stop
  std::string advice;
};

struct PosteriorSummary {
  std::string version;
  std::string title, model, equation, data_file;
  std::size_t data_rows = 0;
  std::vector<std::string> data_remarks = {};  ///< `Header::Data::remarks`
  std::string method;            ///< of the draws: "exact" (quadrature), "nuts" or "metropolis"
  std::string method_note = {};  ///< why it differs from the requested method; empty if it does not
  int chains = 0, warmup = 0, draws = 0;
  std::uint64_t seed = 0;
  std::vector<ParameterSummary> parameters;
  std::vector<StageSummary> stages;
  std::vector<PredictionSummary> predictions;
  std::vector<QuantitySummary> quantities;
  std::optional<LifeSummary> life;
  std::optional<PointwiseTable> pointwise;
  std::optional<CoverageTable> coverage;
  std::optional<double> log_evidence;  ///< natural logarithm, data in `density_unit`
  std::vector<Check> checks;
  bool trusted = true;

  Draws posterior_draws;  ///< in the parameters' units

  std::optional<Plots> plots{};  ///< if a report is requested

  std::string density_unit{};      ///< of log densities: that of the response, "km"
  std::string data_fingerprint{};  ///< of the observed values: equal for the same data
  std::optional<ModeSummary> mode{};
  std::optional<LooSummary> loo{};  ///< of a proper posterior
  std::optional<QuadratureSummary> quadrature{};
  std::string quantity{};            ///< the measured quantity, "worn volume"
  std::string curve{};               ///< the fitted formula as a clause; empty if of no use
  std::shared_ptr<const Fit> fit{};  ///< nodes and pooled draws for later requests; without chains
  PresetAddition added{};
  NothingSeen nothing_seen{};
};

}  // namespace wearwell
