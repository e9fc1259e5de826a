#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"

namespace wearwell::formula_model {

/// The subpopulations that the lives of a table come from, unknown which: a mixture (prob/life_mixture.h;
/// Meeker and Escobar 1998, sec. 5.12). They are named in the order of their median lives.
struct Subpopulations {
  static constexpr const char* label = "subpopulation";  ///< in expressions: "scale[subpopulation]"

  std::vector<std::string> names;
  /// The share of each as an expression; of one there is none: it has the rest.
  std::vector<std::optional<std::string>> share;
  /// Whether their distributions would be the same after an exchange of names: then the order of the median lives tells
  /// them apart (subpopulation_order.h).
  bool exchangeable = false;

  std::size_t rest() const;
};

/// Reads [subpopulations]. Throws InputError that names the key.
std::optional<Subpopulations> read_subpopulations(const TomlReader& root);

/// The names of the subpopulations with a distribution of their own: tables [subpopulations.NAME].
std::vector<std::string> subpopulations_with_tables(const TomlReader& section,
                                                    const Subpopulations& subpopulations);

}  // namespace wearwell::formula_model
