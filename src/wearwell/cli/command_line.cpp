#include "wearwell/cli/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"

namespace wearwell {
namespace {

std::vector<std::string> names_of(const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> long_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options_of(command)) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// "wearwell help fit" of "wearwell fit".
std::string where_to_read(const CLI::App& command) {
  std::string words;
  for (const CLI::App* at = &command; at->get_parent(); at = at->get_parent())
    words = " " + at->get_name() + words;
  return "wearwell help" + words;
}

void check_option(const CLI::App& command, const std::string& argument) {
  const std::string name = argument.substr(0, argument.find('='));
  const std::vector<std::string> all = long_options(command);
  const auto known = [&](const std::string& each) {
    return command.get_option_no_throw(each) != nullptr;
  };
  if (!name.starts_with("--")) {
    // "-output out" would be -o with the value "utput".
    if (name.size() > 2 && known("-" + name))
      throw InputError(fmt::format("{} needs two dashes: -{}", name, name));
    return;
  }
  if (known(name)) return;
  throw InputError(fmt::format("{} has no option {}{} (options: {}; see {})", full_name(command),
                               name, did_you_mean(name, all), fmt::join(all, ", "),
                               where_to_read(command)));
}

// "--output: 1 required TEXT missing" and its like.
std::string what_is_wrong(const CLI::App& command, const CLI::ParseError& error) {
  const std::string what = error.what(), kind = error.get_name();
  const std::size_t colon = what.find(": ");
  const auto has = [&](const char* words) { return what.find(words) != what.npos; };
  const auto number_behind = [&](const std::string& words) {
    return what.substr(what.rfind(words) + words.size());
  };
  if (kind == "RequiredError") {
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_required() && option->count() == 0)
        return fmt::format("{} is missing: {}", option->get_name(), option->get_description());
    }
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) && colon != what.npos)
    return fmt::format("'{}' is an extra argument", what.substr(colon + 2));
  if (kind == "ArgumentMismatch" && colon != what.npos) {
    const std::string name = what.substr(0, colon);
    if (has("missing")) return name + " needs a value";
    if (has("At Most"))
      return fmt::format("{} may be given once; it is given {} times", name,
                         number_behind("received "));
    if (has("At least"))
      return fmt::format(
          "{} is given {} times; at least {} are needed", name, number_behind("received "),
          what.substr(what.find("least ") + 6, what.find(" required") - what.find("least ") - 6));
  }
  return what;
}

}  // namespace

std::string full_name(const CLI::App& command) {
  return command.get_parent() ? full_name(*command.get_parent()) + " " + command.get_name()
                              : command.get_name();
}

std::vector<const CLI::App*> commands_of(const CLI::App& parent) {
  return parent.get_subcommands(
      [](const CLI::App* command) { return !command->get_group().empty(); });
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  return command.get_options(
      [](const CLI::Option* option) { return !option->get_group().empty(); });
}

const CLI::App& command_named(const CLI::App& parent, const std::string& name) {
  for (const CLI::App* command : parent.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == name) return *command;
  }
  const std::vector<std::string> names = names_of(commands_of(parent));
  if (names.empty())
    throw InputError(
        fmt::format("{} has no subcommands; '{}' is unknown", full_name(parent), name));
  throw InputError(fmt::format("'{}' is not a command of {}{} (commands: {}; see {})", name,
                               full_name(parent), did_you_mean(name, names), fmt::join(names, ", "),
                               where_to_read(parent)));
}

void check_command_line(const CLI::App& app, const std::vector<std::string>& arguments) {
  const CLI::App* command = &app;
  for (const std::string& argument : arguments) {
    if (argument == "--") return;
    if (argument.size() > 1 && argument.starts_with('-')) {
      check_option(*command, argument);
      if (argument == "--help" || argument == "-h" || argument == "--version") return;
    } else if (!commands_of(*command).empty()) {
      command = &command_named(*command, argument);
    }
  }
  const std::vector<const CLI::App*> commands = commands_of(*command);
  if (commands.empty()) return;
  throw InputError(fmt::format("{} needs a command: {} (see {})", full_name(*command),
                               fmt::join(names_of(commands), ", "), where_to_read(*command)));
}

std::string said_of(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  return fmt::format("{}: {} (see {})", full_name(*command), what_is_wrong(*command, error),
                     where_to_read(*command));
}

}  // namespace wearwell
