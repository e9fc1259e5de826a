#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wearwell::formula {

/// A function that is written in the language itself: of distributions, and of lives under stress.
struct DefinedFunction {
  struct Argument {
    std::string name;
    /// Its dimension: that of an earlier argument of this name, or of this unit ("1" for a pure
    /// number); any if empty.
    std::string like = {};
  };
  std::string name;
  std::vector<Argument> arguments;
  std::string body;
};

/// FAMILY_cdf, FAMILY_survival, FAMILY_pdf and FAMILY_quantile for each family of continuous
/// measurements and lives, with the parameters of docs/reference/distributions.md; and the ratios of a life to that under reference conditions by the usual relations between life and
/// stress (Meeker and Escobar 1998, ch. 18; Norris and Landzberg 1969; Peck 1986).
const std::vector<DefinedFunction>& defined_functions();
const DefinedFunction* find_defined_function(std::string_view name);

}  // namespace wearwell::formula
