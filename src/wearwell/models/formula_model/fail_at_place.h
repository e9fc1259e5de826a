#pragma once

#include <string>

#include "wearwell/input/toml_reader.h"

namespace wearwell {

/// Reports an error in an expression of a study, whose message begins with a place such as "[formula]
/// wear: " or "[random_effects.machine] k log_sd: ", at that key, and names the key once. At `table` if the
/// study has no such key.
[[noreturn]] void fail_at_place(const TomlReader& root, const TomlReader& table,
                                const std::string& message);

}  // namespace wearwell
