#include "wearwell/cli/open.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "wearwell/base/scratch_folder.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/workbench/serve.h"

namespace wearwell {
namespace {

struct OpenCommand {
  workbench::Opening opening;
  bool no_browser = false;
};

// Whether xdg-open took the file, or still works on it after some seconds, as it does while a browser
// that it started runs. Command lines are seen by all users of a machine, so it gets a
// file that only this user can read, and which leads to the address with its token.
bool opens_in_browser(const std::filesystem::path& file) {
  const std::string name = file.string();
  const char* const arguments[] = {"xdg-open", name.c_str(), nullptr};
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&quiet, descriptor, "/dev/null", 1 /* O_WRONLY */, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, arguments[0], &quiet, nullptr,
                                  const_cast<char* const*>(arguments), environ);
  posix_spawn_file_actions_destroy(&quiet);
  if (failed) return false;
  using namespace std::chrono_literals;
  for (auto waited = 0ms; waited < 3s; waited += 50ms) {
    int status = 0;
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended != 0) return ended == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    std::this_thread::sleep_for(50ms);
  }
  return true;
}

void write_leading_file(const std::filesystem::path& file, const std::string& address) {
  write_file(file, fmt::format("<!doctype html><meta charset=\"utf-8\"><title>wearwell</title>"
                               "<meta http-equiv=\"refresh\" content=\"0; url={}\">\n",
                               address));
  std::filesystem::permissions(
      file, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

// Any failure is one to open a browser, which the user can do.
bool leads_browser_to(const std::string& address, std::optional<ScratchFolder>& scratch) {
  try {
    scratch.emplace(std::filesystem::temp_directory_path());
    const std::filesystem::path file = scratch->path() / "open.html";
    write_leading_file(file, address);
    return opens_in_browser(file);
  } catch (const std::exception&) {
    return false;
  }
}

void run_open(const OpenCommand& command, Models models) {
  std::optional<ScratchFolder> scratch;
  workbench::serve(command.opening, models, [&](const std::string& address) {
    // First: the address is of use whatever becomes of the browser.
    fmt::print("The page is at {}\nCtrl-C ends it; so does closing the page, after a minute.\n",
               address);
    std::fflush(stdout);
    if (command.no_browser || leads_browser_to(address, scratch)) return;
    fmt::print("No browser could be opened: open this address in one.\n");
    std::fflush(stdout);
  });
}

}  // namespace

void add_open_command(CLI::App& app, Models models, int& exit_code) {
  auto options = std::make_shared<OpenCommand>();
  CLI::App* open = app.add_subcommand(
      "open", "Open a table, a study or a result in the browser: from data to a life without TOML");
  open->add_option(
          "FILE", options->opening.target,
          "Table, study, folder of results, or folder with such files (default: the current "
          "folder)")
      ->type_name("TABLE|STUDY|RESULT");
  open->add_flag("--no-browser", options->no_browser, "Print the address and open no browser");
  open->add_option("--port", options->opening.port, "Port on 127.0.0.1 (default: any free one)")
      ->check(CLI::Range(0, 65535));
  open->footer(
      "Examples:\n"
      "  wearwell open lives.csv\n"
      "  wearwell open study.toml --no-browser\n"
      "  wearwell open study-results\n\n"
      "The page is served on this machine alone, under an address with a random token. What you "
      "save is in the folder of FILE.\n\n"
      "Exit codes: 0 the page was closed; 2 the request is wrong; 3 the machine failed.");
  open->callback([options, models, &exit_code] {
    run_open(*options, models);
    exit_code = 0;
  });
}

}  // namespace wearwell
