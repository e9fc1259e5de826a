#pragma once

#include <set>
#include <string>
#include <vector>

#include "wearwell/formula/written_graph.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell::formula_model {

/// A column or label of the table whose value changes during a test.
struct ChangingStress {
  std::string name;
  int index = -1;  ///< among the columns of the symbols, or among their labels
  bool label = false;
};

/// Whether the expression of this node depends on it, directly or by other lines.
bool depends_on(const formula::Graph& graph, int root, const ChangingStress& stress);

/// Cumulative exposure (step_stress.h, ramp_stress.h) needs a distribution of which only the scale changes during
/// the test: throws InputError at `key` of the likelihood if a parameter depends on the stress that is
/// not among those that `may` (places in `wanted`: the scale, and the threshold of the exposure).
void require_scale_alone(const TomlReader& likelihood, const char* key, const std::string& scale,
                         const formula::WrittenGraph& written,
                         const std::vector<formula::Wanted>& wanted,
                         const std::set<std::size_t>& may, const ChangingStress& stress);

}  // namespace wearwell::formula_model
