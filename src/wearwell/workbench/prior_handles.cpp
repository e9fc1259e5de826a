#include "wearwell/workbench/prior_handles.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/math/root.h"
#include "wearwell/prob/family_form.h"
#include "wearwell/workbench/study_form.h"

namespace wearwell::workbench {
namespace {

constexpr double spread_tail = 0.95, most_logarithm = 690;

// Of logarithms. Three digits are written.
constexpr Closeness near_enough{.absolute = 1e-9, .relative = 1e-9};

// The parameters of a family that its handles change, by their indices.
struct Movable {
  std::optional<std::size_t> location, spread;
};

std::optional<std::size_t> first_of_kind(const ResponseForm& form, ParameterKind kind,
                                         std::optional<std::size_t> except) {
  for (std::size_t i = 0; i < form.family_parameters.size(); ++i) {
    const ParameterForm& each = form.family_parameters[i];
    if (each.kind == kind && i != except && each.name != "threshold") return i;
  }
  return {};
}

Movable movable_of(const ResponseForm& form) {
  Movable found;
  for (const ParameterKind kind :
       {ParameterKind::location, ParameterKind::scale, ParameterKind::number})
    if (!found.location) found.location = first_of_kind(form, kind, {});
  for (const ParameterKind kind : {ParameterKind::scale, ParameterKind::number})
    if (!found.spread) found.spread = first_of_kind(form, kind, found.location);
  return found;
}

// The family by two numbers: `location` moves it and `spread` widens or narrows it, both alone.
class MovableFamily {
 public:
  MovableFamily(const Distribution& prior, const Movable& movable)
      : prior_(prior), movable_(movable), is_beta_(prior.family.id == ResponseFamily::beta) {
    const auto& given = prior.family.parameter;
    if (is_beta_) {
      spread = given[0] + given[1];
      location = given[0] / spread;
    } else {
      location = given[*movable.location];
      if (movable.spread) spread = given[*movable.spread];
    }
  }

  double location = 0, spread = 1;

  Family family() const {
    Family family = prior_.family;
    if (is_beta_) {
      family.parameter[0] = location * spread;
      family.parameter[1] = (1 - location) * spread;
      return family;
    }
    family.parameter[*movable_.location] = location;
    if (movable_.spread) family.parameter[*movable_.spread] = spread;
    return family;
  }

  // NaN where the family has no probability between its bounds.
  double quantile_at(double p) const {
    try {
      return quantile(make_distribution(family(), prior_.lower, prior_.upper), p);
    } catch (const InputError&) {
    } catch (const std::runtime_error&) {  // of Boost's quantiles
    }
    return std::nan("");
  }

  // Whether the median could be placed at `median` by the location.
  bool place_median(double median, bool is_location) {
    const auto misfit = [&](double x) {
      location = from_scale(x, is_location);
      return quantile_at(0.5) - median;
    };
    const double guess = to_scale(location, is_location);
    if (is_location) {
      const double width = std::abs(quantile_at(spread_tail) - quantile_at(0.5));
      const double step = std::max(std::abs(median - quantile_at(0.5)), 0.1 * width);
      location = solve_increasing(misfit, guess, step, {.absolute = 1e-7 * width});
    } else {
      location = from_scale(
          solve_increasing(misfit, guess, 0.1, near_enough, -most_logarithm, most_logarithm),
          false);
    }
    const double reached = quantile_at(0.5);
    return std::abs(reached - median) <= 1e-3 * std::abs(quantile_at(spread_tail) - reached);
  }

  // The location on a scale without bounds: a real number, the logarithm of a positive one, the logit
  // of a beta prior's mean.
  double to_scale(double x, bool is_location) const {
    return is_beta_ ? std::log(x / (1 - x)) : is_location ? x : std::log(x);
  }
  double from_scale(double x, bool is_location) const {
    return is_beta_ ? 1 / (1 + std::exp(-x)) : is_location ? x : std::exp(x);
  }

 private:
  Distribution prior_;
  Movable movable_;
  bool is_beta_;
};

[[noreturn]] void refuse_place(const TomlReader& prior, const ParameterSpec& spec,
                               const char* quantity, double at, const Unit& unit) {
  prior.fail("distribution", fmt::format("no {} prior of {} with these bounds has {} {:.6g}{}",
                                         prior.required_text("distribution"), spec.name, quantity,
                                         at, unit.text == "1" ? "" : " " + unit.text));
}

// The decimal place of the third digit.
double third_place(double size) {
  return std::pow(10.0, std::floor(std::log10(std::abs(size))) - 2);
}

std::string rounded_text(double x, double place) {
  const double value = std::round(x / place) * place;
  const double magnitude = std::abs(value);
  if (value == 0 || (magnitude >= 1e-4 && magnitude < 1e7)) {
    const int decimals = std::max(0, -static_cast<int>(std::round(std::log10(place))));
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (decimals > 0) text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
  }
  const double digits = std::log10(magnitude / place) + 1;
  std::string text = fmt::format("{:.{}g}", value, std::clamp(static_cast<int>(digits), 3, 15));
  for (const std::string_view more : {"e+0", "e+"}) {
    if (const std::size_t at = text.find(more); at != text.npos) text.replace(at, more.size(), "e");
  }
  return text;
}

// Behind the number of a quantity: " mm" of "1.2e3 mm".
std::string_view behind_number(std::string_view quantity) {
  double number = 0;
  const std::size_t first = std::min(quantity.find_first_not_of(" +"), quantity.size());
  const auto [end, error] =
      std::from_chars(quantity.data() + first, quantity.data() + quantity.size(), number);
  return quantity.substr(static_cast<std::size_t>(end - quantity.data()));
}

// Writes values of one prior into the text, each in the unit that stands there.
class PriorWriter {
 public:
  PriorWriter(std::string text, const TomlReader& prior, const ParameterSpec& spec)
      : text_(std::move(text)), prior_(prior), spec_(spec) {}

  // `size`, in SI: the magnitude whose third digit is the last one written. A value that differs by less
  // stays as it stands.
  void write(const std::string& key, bool dimensional, double si, double size) {
    const Quantity written = prior_.required_quantity(key, dimensional ? spec_.si : "1");
    const double value = from_si(written.unit, si);
    const double place = third_place(size / written.unit.scale);
    if (!std::isfinite(value) || !(place > 0)) prior_.fail(key, "would not be a finite number");
    if (std::abs(value - written.value) < 0.5 * place) return;
    const std::string path = fmt::format("prior.{}.{}", spec_.name, key);
    std::string text = rounded_text(value, place);
    if (prior_.is_text(key)) text += behind_number(prior_.required_text(key));
    text_ = with_value(text_, path, text);
    paths_.push_back(path);
  }

  const std::string& text() const { return text_; }
  const std::vector<std::string>& paths() const { return paths_; }

 private:
  std::string text_;
  const TomlReader& prior_;
  const ParameterSpec& spec_;
  std::vector<std::string> paths_;
};

bool is_bound(std::string_view handle) {
  return handle == "lower" || handle == "upper";
}

void move_bound(PriorWriter& writer, const TomlReader& prior, const Parameter& parameter,
                std::string_view handle, double si) {
  if (!is_flat(parameter.prior) || !prior.has(handle))
    prior.fail("distribution", "has no bound that could be moved");
  const double other = handle == "lower" ? parameter.prior.upper : parameter.prior.lower;
  const bool inside = handle == "lower" ? si < other : si > other;
  if (!inside) prior.fail(handle, "would not leave the prior a range");
  writer.write(std::string(handle), true, si, std::abs(other - si));
}

void write_family(PriorWriter& writer, const ParameterSpec& spec, const Movable& movable,
                  const MovableFamily& moved, bool both) {
  const ResponseForm& form = form_of(moved.family().id);
  const Family family = moved.family();
  const double width = std::abs(moved.quantile_at(spread_tail) - moved.quantile_at(0.5));
  for (const auto& index : {movable.location, movable.spread}) {
    if (!index || (!both && index == movable.spread)) continue;
    const ParameterForm& each = form.family_parameters[*index];
    const double value = family.parameter[*index];
    const double size = each.kind == ParameterKind::location ? width
                        : each.kind == ParameterKind::scale  ? std::min(width, value)
                                                             : value;
    const bool dimensional = each.kind == ParameterKind::location ||
                             (each.kind == ParameterKind::scale && !is_logarithm(spec.si));
    writer.write(std::string(each.name), dimensional, value, size);
  }
}

// The prior of the family with its median or its 95 % quantile at `si`.
void move_quantile(PriorWriter& writer, const TomlReader& prior, const ParameterSpec& spec,
                   const Parameter& parameter, std::string_view handle, double si) {
  const ResponseForm& form = form_of(parameter.prior.family.id);
  const Movable movable = movable_of(form);
  if (!movable.location || !parameter.prior.proper || is_flat(parameter.prior) ||
      (handle == "spread" && !movable.spread))
    prior.fail("distribution", fmt::format("has no {} that could be moved", handle));
  const bool is_location =
      form.family_parameters[*movable.location].kind == ParameterKind::location;
  const bool is_beta = parameter.prior.family.id == ResponseFamily::beta;
  MovableFamily moved(parameter.prior, movable);
  const double at = from_si(parameter.unit, si);
  if (handle == "location") {
    if (!moved.place_median(si, is_location))
      refuse_place(prior, spec, "the median", at, parameter.unit);
    write_family(writer, spec, movable, moved, is_beta);
    return;
  }
  const double median = moved.quantile_at(0.5), start = std::log(moved.spread);
  const auto tail = [&](double log_spread) {
    MovableFamily tried = moved;
    tried.spread = std::exp(log_spread);
    return tried.place_median(median, is_location) ? tried.quantile_at(spread_tail) : std::nan("");
  };
  const double direction = tail(start + 0.05) > tail(start - 0.05) ? 1 : -1;
  const double found =
      si > median ? direction * solve_increasing([&](double x) { return tail(direction * x) - si; },
                                                 direction * start, 0.1, near_enough,
                                                 -most_logarithm, most_logarithm)
                  : std::nan("");
  moved.spread = std::exp(found);
  if (!std::isfinite(moved.spread) || !moved.place_median(median, is_location) ||
      std::abs(moved.quantile_at(spread_tail) - si) > 1e-3 * (si - median))
    refuse_place(prior, spec, "this median and the 95 % quantile", at, parameter.unit);
  write_family(writer, spec, movable, moved, true);
}

}  // namespace

std::vector<PriorHandle> prior_handles(const TomlReader& study, const Parameter& parameter) {
  const auto priors = study.table("prior");
  const auto prior = priors ? priors->table(parameter.name) : std::nullopt;
  if (!prior || parameter.is_default || !parameter.prior.proper || parameter.unit.offset != 0)
    return {};
  const auto shown = [&](double si) { return from_si(parameter.unit, si); };
  std::vector<PriorHandle> handles;
  if (is_flat(parameter.prior)) {
    if (prior->has("lower")) handles.push_back({"lower", shown(parameter.prior.lower)});
    if (prior->has("upper")) handles.push_back({"upper", shown(parameter.prior.upper)});
    return handles;
  }
  const Movable movable = movable_of(form_of(parameter.prior.family.id));
  if (movable.location) handles.push_back({"location", shown(quantile(parameter.prior, 0.5))});
  if (movable.location && movable.spread)
    handles.push_back({"spread", shown(quantile(parameter.prior, spread_tail))});
  return handles;
}

MovedPrior moved_prior(const std::string& text, const ParameterSpec& spec, std::string_view handle,
                       double at) {
  const auto priors_of = [](const std::string& of) {
    return TomlReader::parse({"the study", of}).required_table("prior");
  };
  const TomlReader priors = priors_of(text);
  const TomlReader prior = priors.required_table(spec.name);
  const Parameter parameter = read_prior(priors, spec);
  if (parameter.is_default || parameter.unit.offset != 0)
    prior.fail("distribution", "has no values that could be moved");
  PriorWriter writer(text, prior, spec);
  const double si = to_si(parameter.unit, at);
  if (is_bound(handle)) {
    move_bound(writer, prior, parameter, handle, si);
  } else if (handle == "location" || handle == "spread") {
    move_quantile(writer, prior, spec, parameter, handle, si);
  } else {
    throw InputError(fmt::format("\"handle\": {} is none of location, spread, lower, upper",
                                 printable(shortened(std::string(handle)))));
  }
  return {writer.text(), writer.paths(), read_prior(priors_of(writer.text()), spec)};
}

}  // namespace wearwell::workbench
