#include "wearwell/formula/defined_functions.h"

#include <algorithm>

namespace wearwell::formula {
namespace {

// One family: the location or scale parameter has the dimension of x, a second one that of x as well
// or none. Bodies are functions of x, or of p.
struct Family {
  std::string name, first, second;
  bool second_pure;
  std::string cdf, survival, pdf, quantile;
};

const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {"normal", "mean", "sd", false, "0.5*erfc((mean - x)/sd/sqrt(2))",
       "0.5*erfc((x - mean)/sd/sqrt(2))", "exp(-((x - mean)/sd)^2/2)/(sd*sqrt(2*pi))",
       "mean + sd*probit(p)"},
      {"lognormal", "median", "log_sd", true,
       "where(x > 0, 0.5*erfc(log(median/x)/log_sd/sqrt(2)), 0)",
       "where(x > 0, 0.5*erfc(log(x/median)/log_sd/sqrt(2)), 1)",
       "where(x > 0, exp(-(log(x/median)/log_sd)^2/2)/(log_sd*sqrt(2*pi))/x, 0)",
       "median*exp(log_sd*probit(p))"},
      {"weibull", "scale", "shape", true, "where(x > 0, -expm1(-(x/scale)^shape), 0)",
       "where(x > 0, exp(-(x/scale)^shape), 1)",
       "where(x > 0, shape*(x/scale)^shape*exp(-(x/scale)^shape)/x, 0)",
       "scale*(-log1p(-p))^(1/shape)"},
      {"exponential", "mean", "", true, "where(x > 0, -expm1(-x/mean), 0)",
       "where(x > 0, exp(-x/mean), 1)", "where(x > 0, exp(-x/mean)/mean, 0)", "-mean*log1p(-p)"},
      {"loglogistic", "scale", "shape", true, "where(x > 0, 1/(1 + (x/scale)^(-shape)), 0)",
       "where(x > 0, 1/(1 + (x/scale)^shape), 1)",
       "where(x > 0, shape/x/(2 + (x/scale)^shape + (x/scale)^(-shape)), 0)",
       "scale*(p/(1 - p))^(1/shape)"},
      {"smallest_extreme_value", "location", "scale", false, "-expm1(-exp((x - location)/scale))",
       "exp(-exp((x - location)/scale))",
       "exp((x - location)/scale - exp((x - location)/scale))/scale",
       "location + scale*log(-log1p(-p))"},
      {"largest_extreme_value", "location", "scale", false, "exp(-exp((location - x)/scale))",
       "-expm1(-exp((location - x)/scale))",
       "exp((location - x)/scale - exp((location - x)/scale))/scale",
       "location - scale*log(-log(p))"}};
  return all;
}

void add_families(std::vector<DefinedFunction>& all) {
  for (const Family& family : families()) {
    const auto add = [&](const std::string& what, const DefinedFunction::Argument& of,
                         const std::string& body) {
      DefinedFunction function{
          family.name + "_" + what, {of, {family.first, of.name == "x" ? "x" : ""}}, body};
      if (!family.second.empty())
        function.arguments.push_back({family.second, family.second_pure ? "1" : family.first});
      all.push_back(std::move(function));
    };
    add("cdf", {"x"}, family.cdf);
    add("survival", {"x"}, family.survival);
    add("pdf", {"x"}, family.pdf);
    add("quantile", {"p", "1"}, family.quantile);
  }
}

// Boltzmann's constant: CODATA 2018.
constexpr const char* arrhenius =
    "exp(energy/8.617333262e-5 [eV/K]*(1/temperature - 1/reference_temperature))";

void add_relations(std::vector<DefinedFunction>& all) {
  using Arguments = std::vector<DefinedFunction::Argument>;
  const Arguments heat = {{"temperature", "K"}, {"reference_temperature", "K"}, {"energy", "eV"}};
  const auto with_heat = [&](Arguments arguments) {
    arguments.insert(arguments.end(), heat.begin(), heat.end());
    return arguments;
  };
  const std::string by_heat = std::string("*") + arrhenius;
  all.push_back({"arrhenius", heat, arrhenius});
  all.push_back({"eyring", heat, "reference_temperature/temperature" + by_heat});
  const Arguments stress = {{"stress"}, {"reference_stress", "stress"}, {"exponent", "1"}};
  const std::string power = "(reference_stress/stress)^exponent";
  all.push_back({"inverse_power", stress, power});
  all.push_back({"voltage_temperature", with_heat(stress), power + by_heat});
  all.push_back({"peck",
                 with_heat({{"humidity", "1"}, {"reference_humidity", "1"}, {"exponent", "1"}}),
                 "(reference_humidity/humidity)^exponent" + by_heat});
  const Arguments range = {{"range"}, {"reference_range", "range"}, {"exponent", "1"}};
  const std::string cycles = "(reference_range/range)^exponent";
  all.push_back({"coffin_manson", range, cycles});
  Arguments solder = range;
  solder.insert(solder.end(),
                {{"frequency"}, {"reference_frequency", "frequency"}, {"frequency_exponent", "1"}});
  all.push_back({"norris_landzberg", with_heat(solder),
                 cycles + "*(frequency/reference_frequency)^frequency_exponent" + by_heat});
}

}  // namespace

const std::vector<DefinedFunction>& defined_functions() {
  static const std::vector<DefinedFunction> all = [] {
    std::vector<DefinedFunction> list;
    add_families(list);
    add_relations(list);
    return list;
  }();
  return all;
}

const DefinedFunction* find_defined_function(std::string_view name) {
  const auto at = std::find_if(defined_functions().begin(), defined_functions().end(),
                               [&](const DefinedFunction& each) { return name == each.name; });
  return at == defined_functions().end() ? nullptr : &*at;
}

}  // namespace wearwell::formula
