#include "wearwell/formula/words.h"

#include <algorithm>
#include <array>

namespace wearwell::formula {

const std::vector<Function>& functions() {
  static const std::vector<Function> all = {
      {"exp", Op::exp, 1, Rule::pure},
      {"log", Op::log, 1, Rule::pure},
      {"log10", Op::log10, 1, Rule::pure},
      {"log1p", Op::log1p, 1, Rule::pure},
      {"expm1", Op::expm1, 1, Rule::pure},
      {"sqrt", Op::sqrt, 1, Rule::root},
      {"abs", Op::abs, 1, Rule::same},
      {"min", Op::min, 2, Rule::same},
      {"max", Op::max, 2, Rule::same},
      {"pow", Op::power, 2, Rule::power},
      {"erf", Op::erf, 1, Rule::pure},
      {"erfc", Op::erfc, 1, Rule::pure},
      {"probit", Op::probit, 1, Rule::pure},
      {"gamma", Op::gamma, 1, Rule::pure},
      {"lgamma", Op::lgamma, 1, Rule::pure},
      {"digamma", Op::digamma, 1, Rule::pure},
      {"tanh", Op::tanh, 1, Rule::pure},
      {"sin", Op::sin, 1, Rule::angle},
      {"cos", Op::cos, 1, Rule::angle},
      {"atan", Op::atan, 1, Rule::to_angle},
      {"where", Op::where, 3, Rule::where},
      {"cum", Op::cum, 1, Rule::cum},
      {"standard_gamma_cdf", Op::gamma_cdf, 2, Rule::pure},
      {"standard_gamma_survival", Op::gamma_survival, 2, Rule::pure},
      {"standard_gamma_quantile", Op::gamma_quantile, 2, Rule::pure},
      {"standard_inverse_gaussian_cdf", Op::inverse_gaussian_cdf, 2, Rule::pure},
      {"standard_inverse_gaussian_survival", Op::inverse_gaussian_survival, 2, Rule::pure},
      {"standard_inverse_gaussian_quantile", Op::inverse_gaussian_quantile, 2, Rule::pure},
      {"standard_generalized_gamma_cdf", Op::generalized_gamma_cdf, 2, Rule::pure},
      {"standard_generalized_gamma_pdf", Op::generalized_gamma_pdf, 2, Rule::pure},
      {"standard_generalized_gamma_quantile", Op::generalized_gamma_quantile, 2, Rule::pure},
      {"standard_student_t_cdf", Op::student_t_cdf, 2, Rule::pure},
      {"standard_student_t_quantile", Op::student_t_quantile, 2, Rule::pure}};
  return all;
}

const Function* find_distribution_function(Op op) {
  if (op < Op::gamma_cdf || op > Op::student_t_quantile) return nullptr;
  const auto at = std::find_if(functions().begin(), functions().end(),
                               [&](const Function& each) { return each.op == op; });
  return &*at;
}

const Function* find_function(std::string_view name) {
  const auto at = std::find_if(functions().begin(), functions().end(),
                               [&](const Function& each) { return name == each.name; });
  return at == functions().end() ? nullptr : &*at;
}

bool is_word_of_language(std::string_view name) {
  constexpr std::array others = {"and", "or", "not", "pi"};
  // Names that studies use for parameters; only a call is the function.
  constexpr std::array free = {"erfc", "probit", "gamma", "lgamma", "digamma"};
  const auto among = [&](const auto& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const Function* function = find_function(name);
  return among(others) || (function != nullptr && !among(free) &&
                           find_distribution_function(function->op) == nullptr);
}

}  // namespace wearwell::formula
