#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wearwell::formula {

/// A function that is written in the language itself: of distributions.
struct DefinedFunction {
  struct Argument {
    std::string name;
    bool pure = true;  ///< a pure number; the others share one dimension
  };
  std::string name;
  std::vector<Argument> arguments;
  std::string body;
};

/// FAMILY_cdf, FAMILY_survival, FAMILY_pdf and FAMILY_quantile for each family whose functions are
/// elementary or of the normal distribution, with the parameters of docs/reference/distributions.md.
const std::vector<DefinedFunction>& defined_functions();
const DefinedFunction* find_defined_function(std::string_view name);

}  // namespace wearwell::formula
