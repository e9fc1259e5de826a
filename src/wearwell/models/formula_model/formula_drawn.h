#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/bayes/log_density.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/effect_lines.h"
#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/predict/prediction.h"

namespace wearwell {
struct PosteriorStudy;
}

/// Random effects that are drawn with the parameters of a study: those of every label except the
/// units' label, and those of the units that are not integrated out. For k of each operator,
/// lognormal with median k_middle,
///
///   k = k_middle exp(log_sd z[operator]),   z[operator] ~ N(0, 1),
///
/// is substituted into the formula's lines, so that a program has a parameter for each level
/// (non-centered; Papaspiliopoulos, Roberts and Skold 2007, Statistical Science 22, 59-73). One
/// further level, `new operator`, has no rows: its z is drawn from N(0, 1) by the posterior itself,
/// and predictions for a new level use it.
namespace wearwell::formula_model {

/// A parameter under [random_effects.LABEL], as written.
struct WrittenEffect {
  std::string name, scatter;
  bool lognormal;
};
struct WrittenEffects {
  std::string label;
  std::vector<WrittenEffect> effects;
  std::optional<std::string> correlation;  ///< of two
};

/// The label that identifies units: `data.rows_of`, or the one nested in all others (a machine is
/// of one material). Throws InputError.
std::size_t label_of_units(const TomlReader& root, const FormulaData& data,
                           const std::vector<WrittenEffects>& random_effects);

/// Adds the parameters of these effects, after all others. Throws InputError.
void add_drawn_effects(const TomlReader& root, const std::vector<WrittenEffects>& written,
                       FormulaModel& model);

/// Substitutes them into the lines and the symbols of rows.
void put_drawn_effects_in_rows(FormulaModel& model);

/// The value of a parameter with a drawn effect at a level of its label (the one past the last is a
/// new level), all other effects at their medians; SI, from the study's parameters.
Function drawn_value(std::shared_ptr<const FormulaModel> model, std::size_t effect,
                     std::size_t level);

/// Throws InputError if effects are drawn or failure modes compete: `what`, for example "tracked", is
/// not supported for such a model.
void refuse_unsupported(const FormulaModel& model, const std::string& what);

/// Adds the values for each observed level and for a new one to the study's quantities.
void tell_drawn_effects(std::shared_ptr<const FormulaModel> model, PosteriorStudy& study);

/// New units of a model with some drawn effects: the study's parameters with these effects at each
/// node of their distribution. For other models only the parameters.
class NewUnits {
 public:
  explicit NewUnits(const FormulaModel& model);
  std::size_t count() const { return nodes_.weight.size(); }
  double share(std::size_t i) const { return nodes_.weight[i]; }  ///< of a node; they sum to 1
  /// Valid until the next call.
  const double* at(std::size_t i, const double* x, std::size_t parameters);

 private:
  std::vector<std::size_t> place_;  // among the parameters
  NormalNodes nodes_;               // of these
  std::vector<double> moved_;
};

/// The contribution of each unit's rows to the likelihood at x if it is left out: log p(rows | x),
/// with its drawn effects integrated out again. `each` gives log p(rows | x) of all units with the
/// effects in x, and `likelihood` the sum and gradient.
std::vector<double> without_drawn_effects(
    const FormulaModel& model, std::span<const double> x, const LogDensity& likelihood,
    const std::function<std::vector<double>(std::span<const double> x)>& each);

}  // namespace wearwell::formula_model
