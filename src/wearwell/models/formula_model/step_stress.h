#pragma once

#include <span>
#include <string>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_data.h"

namespace wearwell::formula_model {

/// A step-stress test: the rows of a specimen are its steps, each with its stress and the age at its end; the
/// last says how the test ended. The life follows cumulative exposure (Nelson 1980, IEEE Trans. Reliability
/// R-29, 103-108): what has been used up before a step counts as an age at the stress of that step at which
/// the same share would have failed. In a scale family that age is scale * sum(duration/scale) over the
/// steps before, and enters the likelihood as a negative threshold of the duration of the last step.
struct StepStress {
  std::string label;     ///< the column of the specimens
  std::string scale;     ///< expression of the parameter in proportion to which lives grow
  std::string duration;  ///< name of the column of durations, which no study can use
};

/// Reads `steps` of a likelihood; `scale` is its expression of `scale_parameter(family)`. Throws InputError
/// if the family has no such parameter.
StepStress read_step_stress(const TomlReader& likelihood, const std::string& family,
                            const std::string& scale);
/// The parameter of a family in proportion to which its values grow, all else fixed; empty if there is none.
std::string scale_parameter(const std::string& family);

/// The same for the key `key` of a likelihood by cumulative exposure; throws InputError if there is none, if the
/// study does not give it (`scale` is empty), or if the study has a threshold.
std::string scale_of_exposure(const TomlReader& likelihood, const std::string& key,
                              const std::string& family, const std::string& scale);

/// The expression of the threshold.
std::string threshold_of(const StepStress& steps);

/// Adds the column of durations. `life` is the measured column. Throws InputError that names the row: two steps
/// of a specimen with one end, an age that is not known.
void add_durations(const StepStress& steps, const std::string& life, FormulaData& data);

/// Whether a value of each row differs between the steps of any specimen.
bool changes_between_steps(const StepStress& steps, std::span<const double> values,
                           const FormulaData& data);

/// Keeps the last step of each specimen, with its duration in place of its age. Throws InputError that names the
/// row: a failure before the last step, an interval that begins before the last step.
Observed last_steps(const StepStress& steps, const std::string& life, const FormulaData& data,
                    const Observed& all);

}  // namespace wearwell::formula_model
