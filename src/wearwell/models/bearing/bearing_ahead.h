#pragma once

#include <optional>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/bearing/bearing_data.h"

namespace wearwell {

/// The bearing of the predictions, from [predict] with [conditions] as default; empty if neither
/// describes one.
struct BearingAhead {
  std::optional<bearing::Contact> contact;
  std::optional<Quantity> radius, clearance, speed;
  std::optional<Quantity> pressure;  ///< that of a force on a length if these are given
  std::optional<Quantity> force;     ///< of a length that is not given
};

/// Throws InputError if the load is overdetermined or incomplete.
BearingAhead read_bearing_ahead(const TomlReader& predict, const BearingData& data);

}  // namespace wearwell
