#pragma once

#include <string>

#include "wearwell/input/toml_reader.h"

namespace wearwell {

/// Refuses a study for what is wrong with one of its laws' texts, whose message begins with a place, as "[formula] wear: "
/// or "[random_effects.machine] k log_sd: ": at that key, which is named once. At `table` where the study has no such key.
[[noreturn]] void fail_at_place(const TomlReader& root, const TomlReader& table,
                                const std::string& message);

}  // namespace wearwell
