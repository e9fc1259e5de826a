#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace wearwell {

/// "wearwell clutch life", as a user calls a command.
std::string full_name(const CLI::App& command);

/// The commands of `parent` that are shown, in the order in which they were added.
std::vector<const CLI::App*> commands_of(const CLI::App& parent);

/// The options and arguments of a command that its help shows.
std::vector<const CLI::Option*> options_of(const CLI::App& command);

/// Throws InputError with the nearest name and all there are.
const CLI::App& command_named(const CLI::App& parent, const std::string& name);

/// Refuses commands and options that do not exist, in better words than the parser has: with the
/// nearest, and all that are possible. Throws InputError.
void check_command_line(const CLI::App& app, const std::vector<std::string>& arguments);

/// What the parser refused, with the command's name and where to read on.
std::string said_of(const CLI::App& app, const CLI::ParseError& error);

}  // namespace wearwell
