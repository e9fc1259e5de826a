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

/// What a study found, in the units that its user asked for: all that reports need. No physics, no
/// statistics. best(): by quadrature where there is one, else from the draws.

struct ExactSummary {
  double mean = 0, sd = 0, q05 = 0, q50 = 0, q95 = 0;
};

/// The meaning of a parameter of which a study says nothing but its name.
inline constexpr const char* meaning_not_stated = "parameter";

struct ParameterSummary {
  std::string name;
  std::string unit;
  // Of the draws; of least squares where nothing is drawn.
  double mean = 0, sd = 0, mcse = 0, q05 = 0, q50 = 0, q95 = 0;
  double ess_bulk = 0, ess_tail = 0, rhat = 0;
  std::optional<ExactSummary> exact;
  std::string meaning = {};  ///< "wear coefficient"
  std::string prior = {};    ///< in words
  bool prior_is_default = false;
  bool drawn = true;

  ExactSummary best() const { return exact ? *exact : ExactSummary{mean, sd, q05, q50, q95}; }
};

/// The worn volume (or whatever the study measures) at one point of its history.
struct PredictionSummary {
  std::string at_name;  ///< "cycles"
  double at = 0;
  std::string quantity;  ///< "volume"
  std::string unit;
  Prediction drawn;
  std::optional<Prediction> exact;
  std::optional<double> measured;  ///< when the data hold a measurement there
  /// Whose the mean with its interval is, and whose the measurement: "median bearing", "new bearing"
  /// where items differ; else empty.
  std::string mean_of = {}, measured_of = {};
  std::string at_unit = {};  ///< of `at`, where its name is not a unit: "h"

  /// What follows the number in a sentence: "at 5000 cycles", "at 5000 h".
  const std::string& at_word() const { return at_unit.empty() ? at_name : at_unit; }
  const Prediction& best() const { return exact ? *exact : drawn; }
  /// Of the same thing and of the same items, so that one table can hold both.
  bool is_like(const PredictionSummary& other) const {
    return quantity == other.quantity && unit == other.unit && mean_of == other.mean_of;
  }
};

/// A quantity derived from the parameters: a pressure, a length, a life.
struct QuantityQuantiles {
  double q05 = 0, q50 = 0, q95 = 0;
  double b1 = 0, b10 = 0, b50 = 0;  ///< of a life: reached by then with 1, 10, 50 %
  /// Of a property of all items, like the life by which 10 % have failed: what it is for the next
  /// item, with all that is unknown averaged in; and what it exceeds with a chosen probability.
  std::optional<double> predictive = {}, bound = {};
  /// Estimated, relative, the largest of these numbers: by how much they would change were they summed over all of the
  /// posterior (study/numerical_error.h). None where they are.
  std::optional<double> numerical_error = {};
};

struct QuantitySummary {
  std::string name;  ///< "life"
  std::string of;    ///< "median bearing", "new bearing"
  std::string at;    ///< under which conditions, in words
  std::string unit;
  bool is_life = false;
  QuantityQuantiles drawn;
  std::optional<QuantityQuantiles> exact;
  std::optional<double> credible_level = {};  ///< of the bound
  std::optional<double> safe_end = {};        ///< 0.05 or 0.95: the quantile to design with
  bool headline = false;                      ///< answers what was asked first

  const QuantityQuantiles& best() const { return exact ? *exact : drawn; }
};

/// One test against the distribution that the fit predicts of its life.
struct CoverageRow {
  std::size_t row = 0;  ///< of the data, from 1
  std::string label;    ///< the type of specimen; may be empty
  std::string outcome;  ///< "failure", "runout", "left" or "interval"
  double life = 0;
  std::optional<double> until;  ///< where an interval ends
  double probability = 0;       ///< of a life no longer than that
  double q05 = 0, q95 = 0, b10 = 0;

  bool failed() const { return outcome == "failure"; }
  bool inside() const { return q05 <= life && life <= q95; }  ///< the 90 % interval
  bool below_b10() const { return life < b10; }
};
struct CoverageTable {
  std::string unit;
  std::vector<CoverageRow> rows;
  std::size_t tests = 0;  ///< of the data: where they are more, rows are some of them, evenly
};

/// Where the likelihood is not far below its maximum (infer/profile.h). An open end is NaN, and
/// says why.
struct ProfileSummary {
  double level = 0;
  double lower = 0, upper = 0;
  std::string lower_open, upper_open;
};

/// A quantity that follows from the parameters, where the likelihood is highest.
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
  double standard_error = 0;                ///< NaN where a bound holds the parameter
  std::string at;                           ///< "inside", "lower bound" or "upper bound"
  std::optional<ProfileSummary> profile{};  ///< at the maximum of the likelihood
};

/// Where the posterior is highest in the parameters' own units.
struct ModeSummary {
  std::string
      problem;  ///< why there is no mode; empty when there is one, else nothing below is set
  std::vector<ModeParameter> parameters;
  std::string density_unit{};       ///< in which data are for what follows: "km"
  double log_likelihood = 0;        ///< natural logarithm, data in `density_unit`
  double log_posterior = 0;         ///< up to a constant where a prior is improper
  double aic = 0, bic = 0;          ///< of the likelihood there
  bool maximum_likelihood = false;  ///< all priors are flat or uniform, so it is that as well
  double observations = 0;          ///< of which BIC takes the logarithm
  int starts = 0, reached = 0;      ///< searches, and how many ended here
  std::vector<ModeQuantity> quantities{};  ///< at the maximum of the likelihood

  /// Any of the profiles; none where the mode is not that of the likelihood.
  std::optional<ProfileSummary> profile() const {
    return parameters.empty() ? std::nullopt : parameters.front().profile;
  }
};

/// Leave-one-out cross-validation (infer/loo.h).
struct LooSummary {
  std::string observation;  ///< what is left out: "row", "bearing"
  Loo loo;                  ///< data in `density_unit`
  std::string density_unit = {};
};

struct LifeSummary {
  std::string unit;  ///< "cycles"
  double limit = 0;  ///< what is reached
  std::string limit_unit;
  double now = 0;  ///< the last inspection
  double risk = 0;
  Life drawn;
  std::optional<Life> exact;
  std::string of = {};  ///< "new bearing", where items differ

  const Life& best() const { return exact ? *exact : drawn; }

  /// The limit is passed by now with a larger probability than the risk that is tolerated.
  bool passed_beyond_risk() const { return best().passed > risk; }
};

/// Whether lives in this unit are counted, and have no fraction: cycles, not hours.
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

/// Of the numbers that are called exact.
struct QuadratureSummary {
  double tolerance = 0;  ///< that was asked for: of mass and second moments, relative
  double reached = 0;    ///< estimated
  std::size_t nodes = 0;
};

/// What a trade adds to its result beside what all studies have.
struct PresetAddition {
  nlohmann::ordered_json body = {};  ///< keys of summary.json
  /// At the end of the section of the report that has this id.
  std::map<std::string, std::vector<present::Block>> blocks = {};
  std::string text = {};  ///< for a terminal, after the design values; lines end with newlines
};

/// Where no failure or no wear was observed: what then rests on the prior.
struct NothingSeen {
  std::string check;   ///< its name: "no-failures"; empty where something was observed
  std::string clause;  ///< without capital and full stop, for people
  std::string advice;
};

struct PosteriorSummary {
  std::string version;
  std::string title, model, equation, data_file;
  std::size_t data_rows = 0;
  std::vector<std::string> data_remarks = {};  ///< `Header::Data::remarks`
  std::string method;  ///< that made the draws: "exact" (quadrature), "nuts" or "metropolis"
  std::string method_note = {};  ///< why it is not the one that was asked for; empty where it is
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

  std::optional<Plots> plots{};  ///< when a report was asked for

  std::string density_unit{};      ///< of log densities: that of the response, "km"
  std::string data_fingerprint{};  ///< of what was observed: equal for the same data
  std::optional<ModeSummary> mode{};
  std::optional<LooSummary> loo{};  ///< of a proper posterior
  std::optional<QuadratureSummary> quadrature{};
  std::string quantity{};  ///< what is measured and predicted, "worn volume"
  std::string curve{};     ///< the law with its numbers, a clause; empty where it has no use
  std::shared_ptr<const Fit> fit{};  ///< nodes and pooled draws, for what is asked later; no draws
  PresetAddition added{};
  NothingSeen nothing_seen{};
};

}  // namespace wearwell
