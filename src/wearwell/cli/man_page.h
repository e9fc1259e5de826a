#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace wearwell {

/// wearwell(1), in the language of man(7): every command with its options, as in `--help`.
std::string man_page(const CLI::App& app, const std::string& version);

}  // namespace wearwell
