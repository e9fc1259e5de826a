#include <fmt/format.h>

#include <algorithm>

#include "wearwell/formula/dimension.h"
#include "wearwell/formula/rules.h"

namespace wearwell::formula {

void Rules::check_arguments(const DefinedFunction& function, const std::vector<Term>& arguments,
                            std::size_t start) const {
  std::string list;
  for (const auto& each : function.arguments) list += (list.empty() ? "" : ", ") + each.name;
  if (arguments.size() != function.arguments.size())
    complain(text_, start,
             fmt::format("{} needs {} arguments, but has {}", function.name,
                         function.arguments.size(), arguments.size()),
             fmt::format("write {}({})", function.name, list));
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const auto& [name, like] = function.arguments[i];
    const auto before = std::find_if(function.arguments.begin(), function.arguments.begin() + i,
                                     [&](const auto& each) { return each.name == like; });
    const auto other = static_cast<std::size_t>(before - function.arguments.begin());
    if (other < i) {
      common(arguments[other], arguments[i], "arguments of " + function.name, arguments[i].at);
    } else if (like == "1") {
      demand_pure(arguments[i], fmt::format("{} of {}", name, function.name), arguments[i].at);
    } else {
      demand_value(arguments[i]);
      if (!like.empty())
        demand_unit(arguments[i], like, fmt::format("{} of {}", name, function.name));
    }
  }
}

void Rules::demand_unit(const Term& term, const std::string& unit, const std::string& of) const {
  const Powers wanted = read_any_unit(unit).powers;
  if (node(term).any || powers(term) == wanted) return;
  const bool per_mole = powers(term) == quotient(wanted, read_any_unit("mol").powers);
  complain(text_, term.at,
           fmt::format("{} needs {}, but '{}' is {}", of, description(wanted), written(term),
                       dimension(term)),
           per_mole ? fmt::format("divide it by 6.02214076e23 [1/mol]: {}/6.02214076e23 [1/mol]",
                                  written(term))
                    : "");
}

}  // namespace wearwell::formula
