#include "wearwell/input/prior.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "wearwell/base/error.h"

namespace wearwell {
namespace {

// Unique names, in the order of the list.
const std::vector<std::string>& names() {
  static const auto all = [] {
    std::vector<std::string> found;
    for (const ResponseForm& form : prior_forms()) {
      if (found.empty() || found.back() != form.name) found.emplace_back(form.name);
    }
    found.emplace_back("default");
    return found;
  }();
  return all;
}

// Families on the whole real line, including flat and uniform.
std::vector<std::string> names_of_logarithms() {
  std::vector<std::string> found;
  for (const ResponseForm& form : prior_forms()) {
    if (!form.positive) found.emplace_back(form.name);
  }
  return found;
}

// Reads one prior and keeps the unit of its quantities.
class PriorReader {
 public:
  PriorReader(const TomlReader& table, const ParameterSpec& spec) : table_(table), spec_(spec) {
    if (const auto unit = table_.text("unit")) {
      try {
        unit_ = read_unit(*unit, spec_.si);
      } catch (const InputError& error) {
        table_.fail("unit", error.what());
      }
      if (!spec_.varies_between_units) refuse_offset(*unit_);
    }
  }

  double bound(const char* key, double none) {
    const auto value = table_.quantity(key, spec_.si);
    return value ? keep(key, *value) : none;
  }

  Family family(const std::string& distribution) {
    const ResponseForm& form = stated_form(distribution);
    refuse_form(form);
    of_factors_ = form.positive;
    Family family{form.family};
    for (std::size_t i = 0; i < form.family_parameters.size(); ++i) {
      const std::string key(form.family_parameters[i].name);
      if (form.family_parameters[i].optional && !table_.has(key)) continue;
      family.parameter[i] = parameter(key.c_str(), form.family_parameters[i].kind);
    }
    return family;
  }

  Unit unit() const {
    if (unit_) return *unit_;
    if (may_be_plain(spec_.si)) return Unit{"1", 1, 0};
    table_.fail("", fmt::format("no quantity of this {} has a unit; add unit = \"{}\" or "
                                "another unit of its dimension",
                                spec_.varies_between_units ? "distribution" : "prior", spec_.si));
  }

 private:
  // The parameter form whose parameters are given; else the form with the most given parameters,
  // for the message about missing ones.
  const ResponseForm& stated_form(const std::string& distribution) const {
    // Does not use table_.has, which would mark keys of other forms as used.
    const std::vector<std::string> keys = table_.keys();
    const auto has = [&](std::string_view key) {
      return std::find(keys.begin(), keys.end(), key) != keys.end();
    };
    if (const ResponseForm* form = given_form(prior_forms(), distribution, has)) return *form;
    const ResponseForm* nearest = nullptr;
    std::ptrdiff_t most = -1;
    for (const ResponseForm& form : prior_forms()) {
      if (form.name != distribution) continue;
      const std::ptrdiff_t given = std::count_if(
          form.family_parameters.begin(), form.family_parameters.end(),
          [&](const ParameterForm& family_parameter) { return has(family_parameter.name); });
      if (given >= most) nearest = &form;
      most = std::max(most, given);
    }
    return *nearest;
  }

  void refuse_form(const ResponseForm& form) const {
    if (form.family == ResponseFamily::uniform) {
      for (const char* end : {"lower", "upper"}) {
        if (!table_.has(end))
          table_.fail(end, "is missing; a uniform distribution needs both bounds");
      }
    }
    if (is_logarithm(spec_.si) && form.positive) {
      table_.fail("distribution", fmt::format("of a logarithm must be {}, not {}",
                                              fmt::join(names_of_logarithms(), ", "), form.name));
    }
    if (form.family == ResponseFamily::beta && spec_.si != "1") {
      table_.fail("distribution",
                  "a beta distribution lies between 0 and 1; use it only for a plain number");
    }
  }

  // For a logarithm, scale parameters are plain numbers.
  double parameter(const char* key, ParameterKind kind) {
    const bool dimensional = kind == ParameterKind::location ||
                             (kind == ParameterKind::scale && !is_logarithm(spec_.si));
    const bool difference = spec_.varies_between_units && kind == ParameterKind::scale;
    const double value = !dimensional ? table_.required_quantity(key, "1").si()
                         : difference ? keep_difference(table_.required_quantity(key, spec_.si))
                                      : keep(key, table_.required_quantity(key, spec_.si));
    const bool positive = kind == ParameterKind::scale || kind == ParameterKind::number;
    if (positive && !(value > 0)) table_.fail(key, "must be positive");
    return value;
  }

  // A standard deviation of 5 degC is 5 K. The factors of a positive family have no such reading.
  double keep_difference(const Quantity& quantity) {
    if (of_factors_) refuse_offset(quantity.unit);
    if (!unit_) unit_ = quantity.unit;
    return quantity.value * quantity.unit.scale;
  }

  void refuse_offset(const Unit& unit) const {
    if (unit.offset != 0 && spec_.varies_between_units) {
      table_.fail("", fmt::format("{} of a value in {} can be read two ways: of the temperature in "
                                  "{} or of that in {}; write it in {}",
                                  table_.required_text("distribution"), unit.text, spec_.si,
                                  unit.text, spec_.si));
    }
    if (unit.offset != 0 && !is_logarithm(spec_.si)) {
      table_.fail("", fmt::format("unit '{}' has an offset; write the parameter in '{}'", unit.text,
                                  spec_.si));
    }
  }

  double keep(const char* key, const Quantity& quantity) {
    if (!spec_.varies_between_units || of_factors_) refuse_offset(quantity.unit);
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
  bool of_factors_ =
      false;  // the family is of positive values, so that units with an offset do not fit
};

// A value strictly inside the support; the guess if possible.
double start_inside(const Distribution& distribution, double guess) {
  if (distribution.lower < guess && guess < distribution.upper) return guess;
  if (std::isfinite(distribution.lower) && std::isfinite(distribution.upper))
    return 0.5 * (distribution.lower + distribution.upper);
  if (distribution.proper) return quantile(distribution, 0.5);
  const bool from_lower = std::isfinite(distribution.lower);
  const double bound = from_lower ? distribution.lower : distribution.upper;
  const double step = std::max(std::abs(guess), std::abs(bound));
  return from_lower ? bound + step : bound - step;
}

double spread(const Distribution& distribution, double start) {
  if (distribution.proper)
    return 0.5 * (quantile(distribution, 0.84) - quantile(distribution, 0.16));
  return start != 0 ? std::abs(start) : 1;
}

struct StatedPrior {
  std::string distribution;
  Family family;
  double lower, upper;
  Unit unit;
};

// `fail(key, message)` reports an error of the stated prior, or of the default.
Parameter make_parameter(const ParameterSpec& spec, const StatedPrior& stated, const auto& fail) {
  Parameter parameter{spec.name, spec.si, stated.unit, stated.distribution, {}};
  parameter.natural_lower = spec.natural_lower;
  parameter.natural_upper = spec.natural_upper;
  if (!(stated.lower < stated.upper)) {
    fail("upper",
         fmt::format("the lower bound {:.6g} is not below the upper bound {:.6g}",
                     from_si(parameter.unit, stated.lower), from_si(parameter.unit, stated.upper)));
  }
  try {
    parameter.prior = make_distribution(stated.family, std::max(stated.lower, spec.natural_lower),
                                        std::min(stated.upper, spec.natural_upper));
  } catch (const InputError& error) {
    fail("", error.what());
  }
  try {
    parameter.start = start_inside(parameter.prior, spec.guess);
    parameter.scale = spread(parameter.prior, parameter.start);
  } catch (const std::runtime_error&) {  // of Boost's quantiles
    fail("", "the distribution is too wide or too narrow: its quantiles are not finite");
  }
  if (!(parameter.prior.lower < parameter.start && parameter.start < parameter.prior.upper)) {
    fail("", fmt::format("no number lies between the bounds {:.17g} and {:.17g} {}",
                         from_si(parameter.unit, parameter.prior.lower),
                         from_si(parameter.unit, parameter.prior.upper), parameter.unit.text));
  }
  if (!(parameter.scale > 0 && std::isfinite(parameter.scale))) {
    fail("",
         "the distribution is too wide or too narrow: its spread is not a positive finite number");
  }
  return parameter;
}

// `table` lacks the prior, under `key` or as a whole.
Parameter default_parameter(const TomlReader& table, const char* key, const ParameterSpec& spec) {
  if (!spec.fallback) {
    table.fail(
        key, fmt::format("no prior for {}; write {} = {{ distribution = \"flat\", unit = \"{}\" }} "
                         "if you have no prior knowledge",
                         spec.name, spec.name, spec.si));
  }
  const DefaultPrior& prior = *spec.fallback;
  Parameter parameter = make_parameter(
      spec,
      {prior.distribution, prior.family, prior.lower, std::numeric_limits<double>::infinity(),
       read_unit(prior.unit, spec.si)},
      [&](const char*, const std::string& message) {
        table.fail(key,
                   fmt::format("the data do not determine a default prior of {}: {}; state a prior",
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
  const auto distribution = table->choice("distribution", names());
  if (!distribution) table->fail("distribution", "is missing");
  if (*distribution == "default") {
    if (!spec.fallback)
      table->fail("distribution",
                  fmt::format("{} has no default {}", spec.name,
                              spec.varies_between_units ? "distribution" : "prior"));
    return default_parameter(*table, "distribution", spec);
  }
  PriorReader reader(*table, spec);
  const Family family = reader.family(*distribution);
  const ResponseForm& form = form_of(family.id);
  const bool shifted =
      form.family_parameters.size() > 0 && form.family_parameters.back().name == "threshold";
  const double least = form.positive && !shifted ? 0 : -std::numeric_limits<double>::infinity();
  const double lower = std::max(least, reader.bound("lower", least));
  const double upper = reader.bound("upper", std::numeric_limits<double>::infinity());
  return make_parameter(
      spec, {*distribution, family, lower, upper, reader.unit()},
      [&](const char* key, const std::string& message) { table->fail(key, message); });
}

}  // namespace wearwell
