#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <utility>
#include <vector>

#include "wearwell/base/error.h"

namespace wearwell {

/// Several problems of one input, each a message as that of InputError; what() has them below each
/// other.
struct InputErrors : InputError {
  explicit InputErrors(std::vector<std::string> messages)
      : InputError(fmt::format("{}", fmt::join(messages, "\n"))), all(std::move(messages)) {}
  std::vector<std::string> all;
};

}  // namespace wearwell
