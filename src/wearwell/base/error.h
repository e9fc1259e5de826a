#pragma once

#include <stdexcept>

namespace wearwell {

/// The request or the data is wrong: exit code 2. The message names the offending file, row, column
/// or value, and what is allowed.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The machine failed (disk, memory, a missing library): exit code 3. The message names what failed.
struct MachineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace wearwell
