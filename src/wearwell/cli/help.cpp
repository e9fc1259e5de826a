#include "wearwell/cli/help.h"

#include <fmt/format.h>

#include <memory>

#include "wearwell/cli/command_line.h"

namespace wearwell {

void add_help_command(CLI::App& app, int& exit_code) {
  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* help = app.add_subcommand("help", "Show the help of a command");
  help->add_option("COMMAND", *words, "As in `wearwell help fit`, `wearwell help clutch life`");
  help->callback([words, &app, &exit_code] {
    const CLI::App* command = &app;
    for (const std::string& word : *words) command = &command_named(*command, word);
    // App::help would describe the command that runs, which is this one.
    fmt::print("{}", command->get_formatter()->make_help(command, full_name(*command),
                                                         CLI::AppFormatMode::Normal));
    exit_code = 0;
  });
}

void add_version_command(CLI::App& app, int& exit_code) {
  app.add_subcommand("version", "Print the version")->callback([&exit_code] {
    fmt::print("{}\n", WEARWELL_VERSION);
    exit_code = 0;
  });
}

}  // namespace wearwell
