#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "wearwell/base/rng.h"

namespace wearwell {

/// The sampled rows of `count`, in order: all of them up to `most`, else a random sample of this size (selection sampling,
/// Knuth 1997, sec. 3.4.2).
inline std::vector<std::size_t> row_sample(std::size_t count, std::size_t most, Rng lots) {
  std::vector<std::size_t> chosen;
  std::size_t wanted = std::min(count, most);
  for (std::size_t i = 0; i < count && wanted > 0; ++i) {
    if (lots.uniform() * static_cast<double>(count - i) < static_cast<double>(wanted)) {
      chosen.push_back(i);
      --wanted;
    }
  }
  return chosen;
}

}  // namespace wearwell
