#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace wearwell {

/// A script for bash: commands, options, the words an option takes, and files elsewhere.
std::string bash_completion(const CLI::App& app);

/// The same for zsh, as a file `_wearwell` of its fpath, with what each does.
std::string zsh_completion(const CLI::App& app);

}  // namespace wearwell
