#pragma once

#include <functional>
#include <stdexcept>
#include <stop_token>
#include <string_view>

namespace wearwell {

/// The progress of a long computation.
struct Step {
  std::string_view what;  ///< the steps, "iterations", or the part of the work, "leave-one-out"
  long long done = 0;     ///< 0: a part begins
  long long total = 0;    ///< 0 if unknown
  double seconds = 0;     ///< since the start of this part of the work
};

/// The caller's control of a long computation: progress reports, stop request and number of
/// threads. Results do not depend on them.
struct Monitor {
  std::function<void(const Step&)> progress = {};  ///< called by one thread at a time; may be empty
  std::stop_token stop = {};                       ///< once requested, the work throws `Cancelled`
  int threads = 0;                                 ///< 0: all
};

/// The caller requested a stop. Nothing was written.
struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("stopped before completion") {}
};

}  // namespace wearwell
