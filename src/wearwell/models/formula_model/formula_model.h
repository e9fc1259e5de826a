#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/bayes/parameter.h"
#include "wearwell/formula/program.h"
#include "wearwell/models/formula_model/failure_modes.h"
#include "wearwell/models/formula_model/formula_data.h"
#include "wearwell/models/formula_model/formula_process.h"
#include "wearwell/models/formula_model/ramp_stress.h"
#include "wearwell/models/formula_model/step_stress.h"
#include "wearwell/models/formula_model/subpopulations.h"
#include "wearwell/prob/life_mixture.h"

namespace wearwell::formula_model {

/// A parameter with a random effect that is integrated out: k of each unit is k exp(s z), or k + s
/// z, z ~ N(0, 1).
struct Effect {
  std::string name;
  std::size_t symbol = 0;     ///< among Symbols::parameters
  std::size_t parameter = 0;  ///< its median, among the parameters of the study
  bool lognormal = false;
};

/// A random effect of a label that is drawn with the study's parameters instead of integrated out:
/// for each observed level, and for a new one, the deviation from the median is a parameter of its
/// own, standard normal (non-centered).
struct DrawnEffect {
  std::string name;     ///< the parameter: "k"
  std::string label;    ///< "operator"
  std::string scatter;  ///< as written
  bool lognormal = false;
  std::string z;           ///< name of its parameters in expressions: "k_operator_z"
  std::size_t first = 0;   ///< of its levels, among the parameters of the study
  std::size_t seen = 0;    ///< levels; the parameter after theirs is that of a new level
  std::size_t middle = 0;  ///< among the parameters of the study
  std::optional<std::string> correlation = {};  ///< with the previous one, as written
};

/// One measured column with the distribution of its scatter.
struct Measured {
  std::string column;
  std::string mode;  ///< the failure mode whose life this is; empty without failure modes
  Unit unit;
  formula::Powers powers;
  const ResponseForm* form = nullptr;
  const ProcessForm* process =
      nullptr;                        ///< set if its increments are random; `form` is then its form
  std::optional<std::string> trials;  ///< the column of their numbers
  std::vector<formula::Wanted> wanted;  ///< the given distribution parameters, as expressions
  /// Of the form, for each of `wanted`; with shares or subpopulations of `life`, whose first is the form.
  std::vector<std::size_t> family_parameter;
  formula::Program program;  ///< outputs as `wanted`
  Observed observed;
  LifeMixture life;  ///< its distribution: the form's family, or a mixture
  /// Set if the observations are ages at a report: a life and a delay.
  std::optional<ReportingDelay> reporting = {};
};

/// Lives in use of units of which each is used at its own rate (use_rate_model.h): measured[0] is the life in use and
/// measured[1] the rate, both of rows with a known use; measured[2], if there are such rows, the age where the use is unknown.
struct UseRate {
  static constexpr const char* name =
      "use_rate";  ///< the table of the study, and the column of rates

  std::string age;  ///< the column of ages
  Measured
      in_time;  ///< the life in calendar time, with the observations of rows with an unknown use
};

/// A formula study, read and compiled; data in SI.
struct FormulaModel {
  std::vector<formula::Line> written;  ///< lines of [formula], for functions of the parameters
  std::vector<formula::Line> lines;    ///< with substituted drawn effects: for row outputs
  formula::Symbols symbols;            ///< the study's own parameters: medians of random effects
  formula::Symbols row_symbols;        ///< the same with random effects given by row
  std::vector<Measured> measured;
  std::vector<Parameter> parameters;  ///< the study's: slots(symbols)
  /// Parameters of `row_symbols` among the study's.
  std::vector<std::size_t> shared;

  std::vector<Effect> effects;       ///< none, one or two
  std::optional<std::string> label;  ///< the label of the units; empty without random effects
  /// The scatter of each effect, and for two correlated ones their correlation, from the study's
  /// parameters.
  formula::Program population;
  bool correlated = false;

  std::vector<DrawnEffect> drawn;
  /// Their scatters, then the correlations of those that follow another.
  formula::Program drawn_scatter;

  /// The life is a mixture of these.
  std::optional<Subpopulations> subpopulations;

  std::optional<UseRate> use_rate;

  /// With failure modes measured[k] is the life of mode k.
  std::optional<FailureModes> modes;
  Observed lives;                   ///< of the parts, by row, if there are modes
  std::vector<JointFailure> joint;  ///< what `measured` lacks

  std::optional<StepStress>
      steps;                       ///< of a step-stress test: the last of `wanted` is its threshold
  std::optional<RampStress> ramp;  ///< of a ramp test: likewise

  FormulaData data;
  /// Rows in the order of the programs: unit by unit, along the axis.
  std::vector<std::size_t> order;
  std::vector<std::size_t> unit_of_row;  ///< by the table's rows; all 0 for a single unit
  std::vector<std::string> units;        ///< their labels; one without a name if there are none
  std::optional<std::string> along;      ///< the axis of wear and life

  /// Whether lives follow cumulative exposure: the last of `wanted` is a threshold.
  bool has_exposure() const { return steps || ramp; }
  bool has_random_effects() const { return !effects.empty(); }
  /// Whether effects of this label are drawn.
  bool is_drawn(const std::string& of) const;
  /// Whether the units have drawn effects; those are integrated out when a unit is left out.
  bool draws_units() const { return label && is_drawn(*label); }
  /// Index in the outputs of `drawn_scatter` of the correlation of an effect that follows.
  std::size_t drawn_correlation(std::size_t effect) const;
  bool has_process() const;
  /// Whether a process is observed with errors and is not normal (formula_hidden_path.h): then all
  /// effects are drawn.
  bool has_hidden_paths() const;
  /// Whether the likelihood's factors are units, not rows: if units vary, or a reading depends on
  /// earlier ones.
  bool by_unit() const { return has_random_effects() || has_process(); }
};

/// The population at one point of the parameters.
struct Population {
  double middle[2] = {}, scatter[2] = {};
  double correlation = 0;

  /// The value of effect i of a unit at z (of all effects), and its derivatives by the standard
  /// normal z.
  double value(const FormulaModel& model, std::size_t i, const double* z) const;
};

/// Evaluates the population; one thread uses it at a time.
class PopulationAt {
 public:
  explicit PopulationAt(const FormulaModel& model);
  Population operator()(const double* x);
  /// Adds the derivatives by medians, scatters and the correlation to `gradient`, after a call at
  /// the same x.
  void add_gradient(const double* x, const Population& by, std::span<double> gradient);

 private:
  const FormulaModel* model_;
  formula::Data data_;
  formula::Workspace workspace_;
};

}  // namespace wearwell::formula_model
