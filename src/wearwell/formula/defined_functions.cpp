#include "wearwell/formula/defined_functions.h"

#include <algorithm>

namespace wearwell::formula {
namespace {

// A parameter of a family: in the unit of x, or a pure number.
struct FamilyParameter {
  std::string name;
  bool pure = false;
};

// One family. Bodies are functions of x, or of p.
struct Family {
  std::string name;
  std::vector<FamilyParameter> parameters;
  std::string cdf, survival, pdf, quantile;
};

std::vector<Family> of_the_normal() {
  return {{"normal",
           {{"mean"}, {"sd"}},
           "0.5*erfc((mean - x)/sd/sqrt(2))",
           "0.5*erfc((x - mean)/sd/sqrt(2))",
           "exp(-((x - mean)/sd)^2/2)/(sd*sqrt(2*pi))",
           "mean + sd*probit(p)"},
          {"lognormal",
           {{"median"}, {"log_sd", true}},
           "where(x > 0, 0.5*erfc(log(median/x)/log_sd/sqrt(2)), 0)",
           "where(x > 0, 0.5*erfc(log(x/median)/log_sd/sqrt(2)), 1)",
           "where(x > 0, exp(-(log(x/median)/log_sd)^2/2)/(log_sd*sqrt(2*pi))/x, 0)",
           "median*exp(log_sd*probit(p))"},
          {"log10_normal",
           {{"median"}, {"log10_sd", true}},
           "where(x > 0, 0.5*erfc(log10(median/x)/log10_sd/sqrt(2)), 0)",
           "where(x > 0, 0.5*erfc(log10(x/median)/log10_sd/sqrt(2)), 1)",
           "where(x > 0, exp(-(log10(x/median)/log10_sd)^2/2)/(log(10)*log10_sd*sqrt(2*pi))/x, 0)",
           "median*exp(log(10)*log10_sd*probit(p))"},
          {"birnbaum_saunders",
           {{"scale"}, {"shape", true}},
           "where(x > 0, 0.5*erfc((sqrt(scale/x) - sqrt(x/scale))/shape/sqrt(2)), 0)",
           "where(x > 0, 0.5*erfc((sqrt(x/scale) - sqrt(scale/x))/shape/sqrt(2)), 1)",
           "where(x > 0, exp(-((sqrt(x/scale) - sqrt(scale/x))/shape)^2/2)*"
           "(sqrt(x/scale) + sqrt(scale/x))/(2*shape*sqrt(2*pi))/x, 0)",
           // Neither sum cancels.
           "scale*where(p > 0.5, (sqrt((0.5*shape*probit(p))^2 + 1) + 0.5*shape*probit(p))^2, "
           "(sqrt((0.5*shape*probit(p))^2 + 1) - 0.5*shape*probit(p))^-2)"}};
}

std::vector<Family> of_extreme_values() {
  return {{"weibull",
           {{"scale"}, {"shape", true}},
           "where(x > 0, -expm1(-(x/scale)^shape), 0)",
           "where(x > 0, exp(-(x/scale)^shape), 1)",
           "where(x > 0, shape*(x/scale)^shape*exp(-(x/scale)^shape)/x, 0)",
           "scale*(-log1p(-p))^(1/shape)"},
          {"exponential",
           {{"mean"}},
           "where(x > 0, -expm1(-x/mean), 0)",
           "where(x > 0, exp(-x/mean), 1)",
           "where(x > 0, exp(-x/mean)/mean, 0)",
           "-mean*log1p(-p)"},
          {"loglogistic",
           {{"scale"}, {"shape", true}},
           "where(x > 0, 1/(1 + (x/scale)^(-shape)), 0)",
           "where(x > 0, 1/(1 + (x/scale)^shape), 1)",
           "where(x > 0, shape/x/(2 + (x/scale)^shape + (x/scale)^(-shape)), 0)",
           "scale*(p/(1 - p))^(1/shape)"},
          {"frechet",
           {{"scale"}, {"shape", true}},
           "where(x > 0, exp(-(x/scale)^(-shape)), 0)",
           "where(x > 0, -expm1(-(x/scale)^(-shape)), 1)",
           "where(x > 0, shape*exp(-shape*log(x/scale) - (x/scale)^(-shape))/x, 0)",
           "scale*(-log(p))^(-1/shape)"},
          {"smallest_extreme_value",
           {{"location"}, {"scale"}},
           "-expm1(-exp((x - location)/scale))",
           "exp(-exp((x - location)/scale))",
           "exp((x - location)/scale - exp((x - location)/scale))/scale",
           "location + scale*log(-log1p(-p))"},
          {"largest_extreme_value",
           {{"location"}, {"scale"}},
           "exp(-exp((location - x)/scale))",
           "-expm1(-exp((location - x)/scale))",
           "exp((location - x)/scale - exp((location - x)/scale))/scale",
           "location - scale*log(-log(p))"},
          {"exponentiated_weibull",
           {{"scale"}, {"shape", true}, {"exponent", true}},
           "where(x > 0, (-expm1(-(x/scale)^shape))^exponent, 0)",
           "where(x > 0, -expm1(exponent*log1p(-exp(-(x/scale)^shape))), 1)",
           "where(x > 0, exponent*shape*(x/scale)^shape*exp(-(x/scale)^shape)*"
           "(-expm1(-(x/scale)^shape))^(exponent - 1)/x, 0)",
           "scale*(-where(p^(1/exponent) < 0.5, log1p(-p^(1/exponent)), "
           "log(-expm1(log(p)/exponent))))^(1/shape)"}};
}

// By operations of their own (distribution_functions.h).
std::vector<Family> of_incomplete_integrals() {
  return {{"gamma",
           {{"shape", true}, {"scale"}},
           "where(x > 0, standard_gamma_cdf(x/scale, shape), 0)",
           "where(x > 0, standard_gamma_survival(x/scale, shape), 1)",
           "where(x > 0, exp(shape*log(x/scale) - x/scale - lgamma(shape))/x, 0)",
           "scale*standard_gamma_quantile(p, shape)"},
          {"inverse_gaussian",
           {{"mean"}, {"shape"}},
           "where(x > 0, standard_inverse_gaussian_cdf(x/mean, shape/mean), 0)",
           "where(x > 0, standard_inverse_gaussian_survival(x/mean, shape/mean), 1)",
           "where(x > 0, sqrt(shape/(2*pi*x))*exp(-shape/x*((x - mean)/mean)^2/2)/x, 0)",
           "mean*standard_inverse_gaussian_quantile(p, shape/mean)"},
          {"generalized_gamma",
           {{"scale"}, {"sigma", true}, {"lambda", true}},
           "where(x > 0, standard_generalized_gamma_cdf(log(x/scale)/sigma, lambda), 0)",
           "where(x > 0, standard_generalized_gamma_cdf(log(scale/x)/sigma, -lambda), 1)",
           "where(x > 0, standard_generalized_gamma_pdf(log(x/scale)/sigma, lambda)/sigma/x, 0)",
           "scale*exp(sigma*standard_generalized_gamma_quantile(p, lambda))"},
          {"student_t",
           {{"df", true}, {"location"}, {"scale"}},
           "standard_student_t_cdf((x - location)/scale, df)",
           "standard_student_t_cdf((location - x)/scale, df)",
           "exp(lgamma((df + 1)/2) - lgamma(df/2) - (df + 1)/2*log1p(((x - location)/scale)^2/df))/"
           "(scale*sqrt(df*pi))",
           "location + scale*standard_student_t_quantile(p, df)"}};
}

void add_family(std::vector<DefinedFunction>& all, const Family& family) {
  const auto add = [&](const std::string& what, const DefinedFunction::Argument& of,
                       const std::string& body) {
    DefinedFunction function{family.name + "_" + what, {of}, body};
    std::string like = of.name == "x" ? "x" : "";  // the quantile has the unit of the parameters
    for (const FamilyParameter& each : family.parameters) {
      function.arguments.push_back({each.name, each.pure ? "1" : like});
      if (like.empty() && !each.pure) like = each.name;
    }
    all.push_back(std::move(function));
  };
  add("cdf", {"x"}, family.cdf);
  add("survival", {"x"}, family.survival);
  add("pdf", {"x"}, family.pdf);
  add("quantile", {"p", "1"}, family.quantile);
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
    for (const auto& families : {of_the_normal(), of_extreme_values(), of_incomplete_integrals()})
      for (const Family& family : families) add_family(list, family);
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
