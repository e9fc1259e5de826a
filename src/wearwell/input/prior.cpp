#include "wearwell/input/prior.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "wearwell/base/error.h"

namespace wearwell {
namespace {

const std::vector<std::string> laws = {
    "flat",  "uniform",       "normal",    "lognormal", "half-normal", "half-cauchy", "exponential",
    "gamma", "inverse-gamma", "student-t", "beta",      "jeffreys",    "default"};

// Reads one prior, and remembers the unit it was written in.
class PriorReader {
 public:
  PriorReader(const TomlReader& table, const ParameterSpec& spec) : table_(table), spec_(spec) {
    if (const auto unit = table_.text("unit")) {
      try {
        unit_ = read_unit(*unit, spec_.si);
      } catch (const InputError& error) {
        table_.fail("unit", error.what());
      }
      refuse_offset(*unit_);
    }
  }

  double dimensional(const char* key) { return keep(key, table_.required_quantity(key, spec_.si)); }
  // Standard deviations and scales: of a logarithm they are plain numbers.
  double size(const char* key) { return is_logarithm(spec_.si) ? plain(key) : dimensional(key); }
  double plain(const char* key) { return table_.required_quantity(key, "1").si(); }
  double bound(const char* key, double none) {
    const auto value = table_.quantity(key, spec_.si);
    return value ? keep(key, *value) : none;
  }

  Family family(const std::string& law) {
    if (law == "flat") return Flat{};
    if (law == "uniform") {
      for (const char* end : {"lower", "upper"}) {
        if (!table_.has(end)) table_.fail(end, "is missing: a uniform law has both bounds");
      }
      return Uniform{};
    }
    if (is_logarithm(spec_.si) && law != "normal" && law != "student-t") {
      table_.fail("law",
                  fmt::format("of a logarithm must be flat, uniform, normal or student-t, not "
                              "{}",
                              law));
    }
    if (law == "normal") return Normal{dimensional("mean"), size("sd")};
    if (law == "lognormal") return lognormal();
    if (law == "half-normal") return Normal{0, dimensional("scale")};
    if (law == "half-cauchy") return StudentT{1, 0, dimensional("scale")};
    if (law == "exponential") return Gamma{1, dimensional("mean")};
    if (law == "gamma") return Gamma{plain("shape"), dimensional("scale")};
    if (law == "inverse-gamma") return InverseGamma{plain("shape"), dimensional("scale")};
    if (law == "student-t") {
      return StudentT{plain("df"), dimensional("location"), size("scale")};
    }
    if (law == "beta" && spec_.si != "1") {
      table_.fail("law", "a beta law lies between 0 and 1: it is only for a plain number");
    }
    if (law == "beta") return Beta{plain("alpha"), plain("beta")};
    return Jeffreys{};
  }

  Unit unit() const {
    if (unit_) return *unit_;
    if (may_be_plain(spec_.si)) return Unit{"1", 1, 0};
    table_.fail(
        "",
        fmt::format("no quantity here has a unit; add unit = \"{}\", or any other of its dimension",
                    spec_.si));
  }

 private:
  Family lognormal() {
    if (table_.has("median") || table_.has("log_sd")) {
      const double median = dimensional("median");
      if (!(median > 0)) table_.fail("median", "must be positive for a lognormal law");
      return Lognormal{std::log(median), plain("log_sd")};
    }
    const double mean = dimensional("mean"), sd = dimensional("sd");
    if (!(mean > 0)) table_.fail("mean", "must be positive for a lognormal law");
    if (!(sd > 0)) table_.fail("sd", "must be positive");
    const LognormalByMoments<double> law(mean, sd);
    return Lognormal{law.eta, law.zeta};
  }

  void refuse_offset(const Unit& unit) const {
    if (unit.offset != 0 && !is_logarithm(spec_.si)) {
      table_.fail("", fmt::format("unit '{}' has an offset; write the parameter in '{}'", unit.text,
                                  spec_.si));
    }
  }

  double keep(const char* key, const Quantity& quantity) {
    refuse_offset(quantity.unit);
    if (unit_ && !is_logarithm(spec_.si)) {
      try {
        refuse_two_readings(quantity, *unit_);
      } catch (const InputError& error) {
        table_.fail(key, error.what());
      }
    }
    if (!unit_) unit_ = quantity.unit;
    return quantity.si();
  }

  const TomlReader& table_;
  const ParameterSpec& spec_;
  std::optional<Unit> unit_;
};

// A value strictly inside the support, the guess where that is possible.
double start_inside(const Law& law, double guess) {
  if (law.lower < guess && guess < law.upper) return guess;
  if (std::isfinite(law.lower) && std::isfinite(law.upper)) return 0.5 * (law.lower + law.upper);
  if (law.proper) return quantile(law, 0.5);
  const bool from_lower = std::isfinite(law.lower);
  const double bound = from_lower ? law.lower : law.upper;
  const double step = std::max(std::abs(guess), std::abs(bound));
  return from_lower ? bound + step : bound - step;
}

double spread(const Law& law, double start) {
  if (law.proper) return 0.5 * (quantile(law, 0.84) - quantile(law, 0.16));
  return start != 0 ? std::abs(start) : 1;
}

struct StatedPrior {
  std::string law;
  Family family;
  double lower, upper;
  Unit unit;
};

// `fail(key, message)` refuses what the study says, or the default where it says nothing.
Parameter make_parameter(const ParameterSpec& spec, const StatedPrior& stated, const auto& fail) {
  Parameter parameter{spec.name, spec.si, stated.unit, stated.law, {}};
  parameter.natural_lower = spec.natural_lower;
  parameter.natural_upper = spec.natural_upper;
  if (!(stated.lower < stated.upper)) {
    fail("upper",
         fmt::format("the lower bound {:.6g} is not below the upper bound {:.6g}",
                     from_si(parameter.unit, stated.lower), from_si(parameter.unit, stated.upper)));
  }
  try {
    parameter.prior = make_law(stated.family, std::max(stated.lower, spec.natural_lower),
                               std::min(stated.upper, spec.natural_upper));
  } catch (const InputError& error) {
    fail("", error.what());
  }
  try {
    parameter.start = start_inside(parameter.prior, spec.guess);
    parameter.scale = spread(parameter.prior, parameter.start);
  } catch (const std::runtime_error&) {  // of Boost's quantiles
    fail("", "the law is so wide or so narrow that its quantiles are no finite numbers");
  }
  if (!(parameter.prior.lower < parameter.start && parameter.start < parameter.prior.upper)) {
    fail("", fmt::format("no number lies between the bounds {:.17g} and {:.17g} {}",
                         from_si(parameter.unit, parameter.prior.lower),
                         from_si(parameter.unit, parameter.prior.upper), parameter.unit.text));
  }
  if (!(parameter.scale > 0 && std::isfinite(parameter.scale))) {
    fail("", "the law is so wide or so narrow that its spread is no number to count with");
  }
  return parameter;
}

// `table` is where the study says nothing of it, under `key` or as a whole.
Parameter default_parameter(const TomlReader& table, const char* key, const ParameterSpec& spec) {
  if (!spec.fallback) {
    table.fail(key,
               fmt::format("no prior for {}; write {} = {{ law = \"flat\", unit = \"{}\" }} if "
                           "nothing is known",
                           spec.name, spec.name, spec.si));
  }
  const DefaultPrior& prior = *spec.fallback;
  Parameter parameter =
      make_parameter(spec,
                     {prior.law, prior.family, prior.lower, std::numeric_limits<double>::infinity(),
                      read_unit(prior.unit, spec.si)},
                     [&](const char*, const std::string& message) {
                       table.fail(key, fmt::format("the data have no size for a default prior of "
                                                   "{}: {}; state one",
                                                   spec.name, message));
                     });
  parameter.is_default = true;
  return parameter;
}

}  // namespace

double rounded_up(double x) {
  if (!(x > 0) || !std::isfinite(x)) return x;
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (x <= digit * power * (1 + 1e-12)) return digit * power;
  }
  return 10 * power;
}

Parameter read_prior(const TomlReader& root, const std::optional<TomlReader>& priors,
                     const ParameterSpec& spec) {
  return priors ? read_prior(*priors, spec) : default_parameter(root, "prior", spec);
}

Parameter read_prior(const TomlReader& priors, const ParameterSpec& spec) {
  const auto table = priors.table(spec.name);
  if (!table) return default_parameter(priors, "", spec);
  const auto law = table->choice("law", laws);
  if (!law) table->fail("law", "is missing");
  if (*law == "default") {
    if (!spec.fallback) table->fail("law", fmt::format("{} has no default prior", spec.name));
    return default_parameter(*table, "law", spec);
  }
  PriorReader reader(*table, spec);
  const Family family = reader.family(*law);
  const double least = law->starts_with("half-") ? 0 : -std::numeric_limits<double>::infinity();
  const double lower = std::max(least, reader.bound("lower", least));
  const double upper = reader.bound("upper", std::numeric_limits<double>::infinity());
  return make_parameter(
      spec, {*law, family, lower, upper, reader.unit()},
      [&](const char* key, const std::string& message) { table->fail(key, message); });
}

}  // namespace wearwell
