#pragma once

#include <string>
#include <vector>

#include "wearwell/formula/program.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/formula_model/formula_data.h"

namespace wearwell::formula_model {

/// A test under a stress that rises (or falls) in proportion to time, with a row for each specimen: stress =
/// start + rate * time. The life follows cumulative exposure, as in a step-stress test (step_stress.h; Nelson
/// 1990, Accelerated Testing, ch. 10): a specimen has failed by t with the probability that the standard life
/// has ended by w(t) = integral from 0 to t of du/scale(stress(u)). The equivalent age scale(stress(t)) * w(t)
/// enters the likelihood as t minus a threshold; the density then has the factor 1/scale(stress(t)) = dw/dt.
struct RampStress {
  std::string stress;       ///< its name in expressions, without a column in the table
  std::string start, rate;  ///< each a name under data.columns or a quantity
  std::string parameter;    ///< of the family: that in proportion to which lives grow
  bool closed = false;      ///< the scale is a power of the stress: no quadrature

  // Columns that no study can use.
  static constexpr const char *duration = "duration_of_ramp", *begin = "start_of_ramp";
};

/// Reads the table `ramp` of a likelihood. Throws InputError if the family has no scale.
RampStress read_ramp_stress(const TomlReader& likelihood, const std::string& family,
                            const std::string& scale);

/// Adds the stress at the end of each row, with the unit of the start, and the columns of `RampStress`. `life`
/// is the measured column. Throws InputError: unknown names, dimensions that do not fit, empty cells.
void add_ramp(const TomlReader& likelihood, const RampStress& ramp, const std::string& life,
              FormulaData& data);

/// Adds the lines of the exposure to `lines` and returns the threshold. `wanted` are the parameters of the
/// family, `scale` the index of `ramp.parameter` among them. In closed form if the scale is a power of the
/// stress in every point of the parameters, else by a Gauss-Legendre rule of 32 nodes, graded towards both
/// ends: relative error below 1e-9 where the scale changes by a factor of e^150 or less along the ramp, 1e-7
/// up to e^300. Throws InputError if another parameter depends on the stress, or the scale does not.
std::string threshold_of(const TomlReader& likelihood, RampStress& ramp,
                         std::vector<formula::Line>& lines,
                         const std::vector<formula::Wanted>& wanted, std::size_t scale,
                         const formula::Symbols& symbols);

/// Refuses observations whose stress at failure is not known.
void require_exact_failures(const FormulaData& data, const std::string& life,
                            const Observed& observed);

}  // namespace wearwell::formula_model
