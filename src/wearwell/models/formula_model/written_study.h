#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/formula/program.h"
#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_drawn.h"
#include "wearwell/models/formula_model/ramp_stress.h"
#include "wearwell/models/formula_model/step_stress.h"
#include "wearwell/models/formula_model/subpopulations.h"
#include "wearwell/models/formula_model/written_mixture.h"

namespace wearwell::formula_model {

/// The expressions of a study as texts, before its table is read: the use of a name determines what it means.
struct WrittenStudy {
  std::vector<formula::Line> lines;  ///< of [formula]
  std::vector<WrittenLikelihood> likelihoods;
  std::vector<WrittenLikelihood> of_modes;           ///< of failure modes with a table of their own
  std::vector<WrittenLikelihood> of_subpopulations;  ///< likewise
  std::optional<WrittenLikelihood> use_rate;
  std::optional<Subpopulations> subpopulations;
  std::optional<StepStress> steps;
  std::optional<RampStress> ramp;
  std::vector<WrittenEffects> effects;  ///< of [random_effects]
  std::vector<std::string> texts;       ///< all expressions

  bool measures(const std::string& column) const;
  /// Whether paths are integrated out themselves: then effects of their units are drawn.
  bool has_hidden_paths() const;
};

/// Names under [data.columns] that qualify an observation.
inline const std::vector<std::string> qualifying_columns = {"status", "lower", "upper", "entry",
                                                            "count"};

/// Reads all expressions. Throws InputError that names the key.
WrittenStudy read_written_study(const TomlReader& root, const Source& source);

/// Parameters with a value for each level of a label, and the label: k[material].
std::map<std::string, std::string> indexed_parameters(const WrittenStudy& study);

/// The columns whose cells are labels, by their use in expressions.
std::vector<std::string> label_names(const TomlReader& root, const WrittenStudy& study);

}  // namespace wearwell::formula_model
