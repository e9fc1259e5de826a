#pragma once

#include <cstdint>

#include "wearwell/base/progress.h"

namespace wearwell {

/// The number of draws, and their random numbers.
struct RunSettings {
  int chains = 4;
  int warmup = 1000;  ///< iterations per chain that adapt the sampler and are discarded
  int draws = 1000;   ///< kept per chain
  std::uint64_t seed = 1;
  std::uint64_t first_stream = 0;  ///< of the seed; chain c uses stream first_stream + c
  Progress* progress = nullptr;    ///< receives every iteration; may be null
};

}  // namespace wearwell
