#pragma once

#include <optional>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/bearing/bearing_data.h"

namespace wearwell {

/// What [predict] and else [conditions] say of bearings to come; nothing where neither does.
struct BearingAhead {
  std::optional<bearing::Contact> contact;
  std::optional<Quantity> radius, clearance, speed;
  std::optional<Quantity> pressure;  ///< that of a force on a length where these are given
  std::optional<Quantity> force;     ///< of a length that is not given
};

/// Throws InputError where the load is said in two ways or in half of one.
BearingAhead read_bearing_ahead(const TomlReader& predict, const BearingData& data);

}  // namespace wearwell
