#pragma once

#include <algorithm>
#include <string>

namespace wearwell::prognosis {

/// "machines" of the noun "machine", "units with mode 1 alone" of "unit with mode 1 alone".
inline std::string plural(const std::string& noun) {
  const std::size_t end = std::min({noun.find(" with "), noun.find(" without "), noun.size()});
  return noun.substr(0, end) + "s" + noun.substr(end);
}

}  // namespace wearwell::prognosis
