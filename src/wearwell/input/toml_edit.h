#pragma once

#include <string>
#include <utility>
#include <vector>

#include "wearwell/input/text_file.h"

namespace wearwell {

/// The study with other values of keys of [predict], each written as TOML writes it: everything else stays as and
/// where it was. Throws InputError where [predict] is not a table under a heading of its own.
TextFile with_predict(const TextFile& study,
                      const std::vector<std::pair<std::string, std::string>>& keys);

}  // namespace wearwell
