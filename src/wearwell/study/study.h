#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "wearwell/base/monitor.h"
#include "wearwell/infer/fit.h"
#include "wearwell/study/result.h"

namespace wearwell {

/// How to draw, as far as somebody said; the rest are the method's defaults.
struct SamplerChoice {
  std::optional<Method> method;
  std::optional<int> chains, warmup, draws;
  std::optional<std::uint64_t> seed;

  bool any() const { return method || chains || warmup || draws || seed; }
};

/// How to run a study.
struct RunOptions {
  SamplerChoice sampler = {};  ///< before what the study file says
  bool report = true;          ///< computes the sections of the report as well
};

/// A study file, read and checked with its data: what every command works on, whatever the trade.
class Study {
 public:
  virtual ~Study() = default;

  /// What will be fitted, in words and units. Throws InputError where running it would.
  virtual std::string description() const = 0;

  /// Fits, checks and predicts. One seed gives the same numbers to the bit, however many threads
  /// there are. Throws InputError when data and options do not go together, and `Cancelled`.
  virtual Result run(const RunOptions& options, const Monitor& monitor) const = 0;

 protected:
  Study() = default;
  Study(const Study&) = default;
  Study(Study&&) = default;
  Study& operator=(const Study&) = default;
  Study& operator=(Study&&) = default;
};

}  // namespace wearwell
