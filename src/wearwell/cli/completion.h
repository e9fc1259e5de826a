#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace wearwell {

/// A completion script for bash: commands, options, the choices of an option, and files elsewhere.
std::string bash_completion(const CLI::App& app);

/// The same for zsh, as a file `_wearwell` of its fpath, with descriptions.
std::string zsh_completion(const CLI::App& app);

}  // namespace wearwell
