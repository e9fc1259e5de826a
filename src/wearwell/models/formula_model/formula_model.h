#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/bayes/parameter.h"
#include "wearwell/formula/program.h"
#include "wearwell/models/formula_model/formula_data.h"
#include "wearwell/models/formula_model/formula_process.h"
#include "wearwell/prob/response.h"

namespace wearwell::formula_model {

/// A parameter that differs from unit to unit, about the one of its name: k of each is k exp(s z), or
/// k + s z, z ~ N(0, 1).
struct Effect {
  std::string name;
  std::size_t symbol = 0;     ///< among Symbols::parameters
  std::size_t parameter = 0;  ///< its middle, among the parameters of the study
  bool lognormal = false;
};

/// A parameter that differs from level to level of a label, drawn with the study's parameters where it is not
/// integrated out: of each level that was seen, and of a new one, how far it lies from the middle is a parameter
/// of its own, standard normal (non-centred).
struct DrawnEffect {
  std::string name;     ///< what differs: "k"
  std::string label;    ///< "operator"
  std::string scatter;  ///< as it is written
  bool lognormal = false;
  std::string z;           ///< of its parameters, as expressions call them: "k_operator_z"
  std::size_t first = 0;   ///< of its levels, among the parameters of the study
  std::size_t seen = 0;    ///< levels; the parameter behind theirs is that of a new one
  std::size_t middle = 0;  ///< among the parameters of the study
  std::optional<std::string> correlation = {};  ///< with the one before, as it is written
};

/// One measured column with the law of its scatter.
struct Measured {
  std::string column;
  Unit unit;
  formula::Powers powers;
  const ResponseForm* form = nullptr;
  const ProcessForm* process =
      nullptr;                        ///< where its increments are random; then `form` is its form
  std::optional<std::string> trials;  ///< the column of their numbers
  std::vector<formula::Wanted> wanted;  ///< the slots that are given, as expressions
  std::vector<std::size_t> slot;        ///< of the form, for each of `wanted`
  formula::Program program;             ///< outputs as `wanted`
  Observed observed;
};

/// A study of a law in the user's own words, read and compiled; data in SI.
struct FormulaModel {
  std::vector<formula::Line> written;  ///< lines of [formula], for functions of the parameters
  std::vector<formula::Line>
      lines;                     ///< with those that put drawn effects in: for what differs by row
  formula::Symbols symbols;      ///< of the study's parameters as they are: middles of what differs
  formula::Symbols row_symbols;  ///< the same with what differs from unit to unit given by row
  std::vector<Measured> measured;
  std::vector<Parameter> parameters;  ///< the study's: slots(symbols)
  /// Parameters of `row_symbols` among the study's.
  std::vector<std::size_t> shared;

  std::vector<Effect> effects;       ///< none, one or two
  std::optional<std::string> label;  ///< whose levels the units are; none where nothing differs
  /// The scatter of each effect, and where there are two that are correlated, their correlation: of
  /// the study's parameters.
  formula::Program population;
  bool correlated = false;

  std::vector<DrawnEffect> drawn;
  /// Their scatters, then the correlations of those that follow another.
  formula::Program drawn_scatter;

  FormulaData data;
  /// Rows in the order in which programs see them: unit by unit, along the axis.
  std::vector<std::size_t> order;
  std::vector<std::size_t> unit_of_row;  ///< by the table's rows; all 0 where there is one
  std::vector<std::string> units;        ///< their labels; one without a name where there are none
  std::optional<std::string> along;      ///< the column that is the axis of wear and life

  bool has_random_effects() const { return !effects.empty(); }
  /// Whether effects of this label are drawn.
  bool is_drawn(const std::string& of) const;
  /// Whether such of the units are; then those of a unit are integrated out where it is left out.
  bool draws_units() const { return label && is_drawn(*label); }
  /// Where among the outputs of `drawn_scatter` the correlation stands of an effect that follows.
  std::size_t drawn_correlation(std::size_t effect) const;
  bool has_process() const;
  /// Whether such is seen through errors of readings and is not normal (formula_hidden_path.h): then all effects are drawn.
  bool has_hidden_paths() const;
  /// Whether the likelihood's factors are units, not rows: where they differ, or a row's reading depends
  /// on those before it.
  bool by_unit() const { return has_random_effects() || has_process(); }
};

/// The population at one point of the parameters.
struct Population {
  double middle[2] = {}, scatter[2] = {};
  double correlation = 0;

  /// What effect i of a unit is at z (of all effects), and its derivatives by the standard normal z.
  double value(const FormulaModel& model, std::size_t i, const double* z) const;
};

/// Evaluates the population; one thread's.
class PopulationAt {
 public:
  explicit PopulationAt(const FormulaModel& model);
  Population operator()(const double* x);
  /// Adds to `gradient` what derivatives by middles, scatters and the correlation come to, after a
  /// call at the same x.
  void add_gradient(const double* x, const Population& by, std::span<double> gradient);

 private:
  const FormulaModel* model_;
  formula::Data data_;
  formula::Workspace workspace_;
};

}  // namespace wearwell::formula_model
