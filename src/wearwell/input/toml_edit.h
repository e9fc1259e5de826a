#pragma once

#include <string>
#include <utility>
#include <vector>

#include "wearwell/input/text_file.h"

namespace wearwell {

/// The study with new values (TOML text) for keys of [predict]; everything else is unchanged.
/// Throws InputError if [predict] is not a table with its own heading.
TextFile with_predict(const TextFile& study,
                      const std::vector<std::pair<std::string, std::string>>& keys);

}  // namespace wearwell
