#pragma once

#include <algorithm>
#include <string>

namespace wearwell::prognosis {

/// "machines" of the noun "machine", "batches" of "batch", "units with mode 1 alone" of "unit with
/// mode 1 alone".
inline std::string plural(const std::string& noun) {
  const std::size_t end = std::min({noun.find(" with "), noun.find(" without "), noun.size()});
  const std::string word = noun.substr(0, end);
  const bool hissing =
      word.ends_with("ch") || word.ends_with("sh") || word.ends_with("s") || word.ends_with("x");
  return word + (hissing ? "es" : "s") + noun.substr(end);
}

}  // namespace wearwell::prognosis
