#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace wearwell {

/// "wearwell clutch life": the full name of a command.
std::string full_name(const CLI::App& command);

/// The visible subcommands of `parent`, in the order in which they were added.
std::vector<const CLI::App*> commands_of(const CLI::App& parent);

/// The options and arguments of a command that its help shows.
std::vector<const CLI::Option*> options_of(const CLI::App& command);

/// Throws InputError with the nearest name and all valid names.
const CLI::App& command_named(const CLI::App& parent, const std::string& name);

/// Refuses unknown commands and options with a message that names the nearest and all valid ones,
/// which the parser's own message does not. Throws InputError.
void check_command_line(const CLI::App& app, const std::vector<std::string>& arguments);

/// The parser's error, with the command's name and where to find help.
std::string said_of(const CLI::App& app, const CLI::ParseError& error);

}  // namespace wearwell
