#include "wearwell/models/formula_model/c_likelihood.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/formula/c_text.h"

namespace wearwell::formula_model {
std::size_t measured_column(const FormulaModel& model, std::size_t m) {
  const auto at = std::find_if(model.data.numbers.begin(), model.data.numbers.end(),
                               [&](const auto& c) { return c.name == model.measured[m].column; });
  return static_cast<std::size_t>(at - model.data.numbers.begin());
}

void refuse_formula(const FormulaModel& model) {
  for (const char* name : {"status", "lower", "upper", "entry", "count"})
    if (model.data.number(name) || model.data.label(name))
      throw InputError(
          fmt::format("the study has a column '{}': C export supports exact readings only, not "
                      "censored, truncated or counted ones",
                      name));
  for (const Measured& each : model.measured) {
    if (each.process)
      throw InputError(
          fmt::format("'{}' has random increments ({}); C export does not support such processes",
                      each.column, each.form->name));
    if (each.trials || !each.form->c_density)
      throw InputError(
          fmt::format("'{}' is of the {} family; C export supports normal and lognormal only",
                      each.column, each.form->name));
  }
}

void add_likelihood(const FormulaModel& model, std::string& functions, std::string& sum,
                    std::string& measured) {
  for (std::size_t m = 0; m < model.measured.size(); ++m) {
    const Measured& each = model.measured[m];
    std::string family_parameter[most_response_parameters] = {"0", "0", "0"};
    for (std::size_t o = 0; o < each.wanted.size(); ++o) {
      const std::string name = fmt::format(
          "measured_{}_{}", m, each.form->family_parameters[each.family_parameter[o]].name);
      functions += formula::c_function(model.lines, each.wanted[o], model.row_symbols, name);
      family_parameter[each.family_parameter[o]] = name + "(number, label, parameter, effect)";
    }
    const std::size_t column = measured_column(model, m);
    sum += fmt::format(
        "  if (!isnan(number[{}])) {{ /* {} */\n    const double y = number[{}];\n"
        "    const double a = {};\n    const double b = {};\n    double value;\n    {{\n{}    }}\n"
        "    sum += isfinite(value) ? value : -INFINITY;\n  }}\n",
        column, each.column, column, family_parameter[0], family_parameter[1],
        each.form->c_density);
    measured += fmt::format("{}!isnan(at->number[{}])", m == 0 ? "" : " || ", column);
  }
}

}  // namespace wearwell::formula_model
