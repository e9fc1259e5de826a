#include "wearwell/models/bearing/bearing_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"

namespace wearwell::bearing {

namespace {

Contact read_contact(const std::string& name) {
  const std::string choice = "stationary (a scar in the bushing), journal or bushing (even wear)";
  if (name.empty()) throw InputError("--contact is missing; it is one of " + choice);
  const auto contact = contact_named(name);
  if (!contact) {
    throw InputError(fmt::format("--contact: '{}' is not one of {}; did you mean {}?", name, choice,
                                 nearest_name(name, contact_names())));
  }
  return *contact;
}

Uncertain read_input(const InputOption& option, const std::string& text) {
  try {
    const Uncertain value = read_uncertain(text, option.si);
    if (!(value.mean > 0)) throw InputError(fmt::format("'{}' must be positive", value.text));
    if (!std::isfinite(value.mean) || !std::isfinite(value.sd))
      throw InputError(fmt::format("'{}' is not a finite number in SI units", value.text));
    return value;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", option.flag, error.what()));
  }
}

}  // namespace

Bearing UncertainBearing::mean() const {
  Bearing result;
  result.contact = contact;
  for (const Given& g : given) result.*(g.option->input) = g.option->factor * g.value.centre;
  return result;
}

bool UncertainBearing::is_exact() const {
  return std::all_of(given.begin(), given.end(), [](const Given& g) {
    return g.value.distribution == Uncertain::Distribution::exact;
  });
}

const std::string& BearingInputs::text(Input input) const {
  const auto found = std::find_if(input_options.begin(), input_options.end(),
                                  [&](const InputOption& o) { return o.input == input; });
  return texts[static_cast<std::size_t>(found - input_options.begin())];
}

UncertainBearing BearingInputs::read() const {
  UncertainBearing result;
  result.contact = read_contact(contact);
  for (std::size_t i = 0; i < input_options.size(); ++i) {
    if (texts[i].empty()) continue;
    for (const UncertainBearing::Given& other : result.given) {
      if (other.option->input == input_options[i].input)
        throw InputError(fmt::format("{} and {} are both given; keep one of them",
                                     input_options[i].flag, other.option->flag));
    }
    result.given.push_back({&input_options[i], read_input(input_options[i], texts[i])});
  }
  return result;
}

}  // namespace wearwell::bearing
