#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "wearwell/base/monitor.h"
#include "wearwell/infer/fit.h"
#include "wearwell/study/result.h"

namespace wearwell {

/// The user's settings of the sampler; the rest are the method's defaults.
struct SamplerChoice {
  std::optional<Method> method;
  std::optional<int> chains, warmup, draws;
  std::optional<std::uint64_t> seed;

  bool any() const { return method || chains || warmup || draws || seed; }
};

/// How to run a study.
struct RunOptions {
  SamplerChoice sampler = {};  ///< takes precedence over the study file
  bool report = true;          ///< also compute the sections of the report
};

/// A study file, read and checked with its data, for any model. All commands use this interface.
class Study {
 public:
  virtual ~Study() = default;

  /// Describes the fit and its units. Throws InputError where `run` would.
  virtual std::string description() const = 0;

  /// Fits, checks and predicts. One seed gives identical numbers for any number of threads. Throws
  /// InputError if data and options are inconsistent, and `Cancelled`.
  virtual Result run(const RunOptions& options, const Monitor& monitor) const = 0;

 protected:
  Study() = default;
  Study(const Study&) = default;
  Study(Study&&) = default;
  Study& operator=(const Study&) = default;
  Study& operator=(Study&&) = default;
};

}  // namespace wearwell
