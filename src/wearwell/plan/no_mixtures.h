#pragma once

#include <fmt/format.h>

#include <string>

#include "wearwell/input/toml_reader.h"

namespace wearwell::plan {

/// Throws InputError where a study of lives has subpopulations or shares that never fail or are dead on arrival, or step-stress tests: tests of such
/// kinds cannot be planned. `command` is "wearwell plan next".
inline void refuse_mixtures(const TomlReader& root, const std::string& command) {
  if (root.text("model").value_or("") != "formula") return;
  const std::string why = fmt::format(
      "is not possible with `{}`; plan with a study of one population in which every part can fail",
      command);
  if (root.has("subpopulations")) root.fail("subpopulations", why);
  if (root.has("use_rate"))
    root.fail("use_rate",
              fmt::format("is not possible with `{}`: a test has a use, not an age; plan with a "
                          "study of the life in use alone",
                          command));
  const auto likelihoods = root.table("likelihood");
  for (const std::string& column : likelihoods ? likelihoods->keys() : std::vector<std::string>()) {
    const TomlReader own = likelihoods->required_table(column);
    for (const char* key : {"share_defective", "share_dead_on_arrival"})
      if (own.has(key)) own.fail(key, why);
    if (own.has("steps")) own.fail("steps", fmt::format("is not possible with `{}`", command));
  }
}

}  // namespace wearwell::plan
