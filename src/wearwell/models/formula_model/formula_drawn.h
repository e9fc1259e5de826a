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

/// Effects that are drawn with the parameters of a study: those of every label but that of the units, and of the
/// units those beyond what is integrated out. k of each operator, lognormal about k_middle, is
///
///   k = k_middle exp(log_sd z[operator]),   z[operator] ~ N(0, 1),
///
/// which is written into the law's lines, so that a program sees a parameter for each level (non-centred; Papaspiliopoulos,
/// Roberts and Skold 2007, Statistical Science 22, 59-73). One level more, `new operator`, is no row's: its z is drawn from
/// N(0, 1) by the posterior itself, and what is told of a new one is told at it.
namespace wearwell::formula_model {

/// A parameter under [random_effects.LABEL], as it is written.
struct WrittenEffect {
  std::string name, scatter;
  bool lognormal;
};
struct WrittenEffects {
  std::string label;
  std::vector<WrittenEffect> effects;
  std::optional<std::string> correlation;  ///< of two
};

/// Which of several labels says of which unit a row is: `data.rows_of`, or that which lies within all others (a machine
/// is of one material). Throws InputError.
std::size_t label_of_units(const TomlReader& root, const FormulaData& data,
                           const std::vector<WrittenEffects>& random_effects);

/// Adds the parameters of these effects, behind all others. Throws InputError.
void add_drawn_effects(const TomlReader& root, const std::vector<WrittenEffects>& written,
                       FormulaModel& model);

/// Puts them into the lines and the symbols of rows.
void put_drawn_effects_in_rows(FormulaModel& model);

/// What a drawn effect's parameter is at a level of its label (that behind the last is a new one), all other effects at
/// their middles; SI, of the study's parameters.
Function drawn_value(std::shared_ptr<const FormulaModel> model, std::size_t effect,
                     std::size_t level);

/// Throws InputError where effects are drawn: `what`, "followed on line", is not for such a law.
void refuse_drawn_effects(const FormulaModel& model, const std::string& what);

/// Adds these of each level that was seen and of a new one to what the study tells.
void tell_drawn_effects(std::shared_ptr<const FormulaModel> model, PosteriorStudy& study);

/// New units of a law where some of their effects are drawn: the study's parameters with these at each node of their
/// law. Elsewhere the parameters alone.
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

/// What each unit's rows add to the likelihood at x where it is left out: log p(rows | x), with those of its effects that
/// are drawn integrated out again. `each` gives log p(rows | x) of all units with them as x says, and `likelihood` its
/// sum and gradient.
std::vector<double> without_drawn_effects(
    const FormulaModel& model, std::span<const double> x, const LogDensity& likelihood,
    const std::function<std::vector<double>(std::span<const double> x)>& each);

}  // namespace wearwell::formula_model
