#pragma once

#include <functional>
#include <stdexcept>
#include <stop_token>
#include <string_view>

namespace wearwell {

/// How far long work is.
struct Step {
  std::string_view what;  ///< the steps: "iterations"
  long long done = 0;
  long long total = 0;  ///< 0 where it is not known
  double seconds = 0;   ///< since the work began
};

/// What a caller gives to long work: where it reports to, how it is stopped, and how many threads it
/// may use. Results never depend on any of them.
struct Monitor {
  std::function<void(const Step&)> progress = {};  ///< called by one thread at a time; may be empty
  std::stop_token stop = {};                       ///< once requested, the work throws `Cancelled`
  int threads = 0;                                 ///< 0: all
};

/// The caller asked the work to stop. Nothing was written.
struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("stopped before it was done") {}
};

}  // namespace wearwell
