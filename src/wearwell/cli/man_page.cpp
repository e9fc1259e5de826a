#include "wearwell/cli/man_page.h"

#include <fmt/format.h>

#include "wearwell/cli/command_line.h"

namespace wearwell {
namespace {

// Text for roff: escaped, no requests, hyphens that can be copied.
std::string plain(std::string_view text) {
  std::string result;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
    line_begins = c == '\n';
  }
  return result;
}

// "-o, --output TEXT"
std::string signature(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames()) names += (names.empty() ? "-" : ", -") + name;
  for (const std::string& name : option.get_lnames())
    names += (names.empty() ? "--" : ", --") + name;
  if (names.empty()) return option.get_name();
  if (option.get_items_expected_max() == 0) return names;
  const std::string type = option.get_type_name();  // "METHOD:nuts|exact", "INT:INT in [1 - 9]"
  return names + " " + type.substr(type.find(':') + 1);
}

std::string synopsis(const CLI::App& command) {
  std::string text = full_name(command);
  for (const CLI::Option* option : options_of(command)) {
    if (!option->get_positional()) continue;
    const bool many = option->get_items_expected_max() > 1;
    const std::string name = option->get_name() + (many ? " ..." : "");
    text += option->get_required() ? " " + name : " [" + name + "]";
  }
  return text + " [OPTIONS]";
}

void add_options(const CLI::App& command, std::string& page) {
  for (const CLI::Option* option : options_of(command)) {
    if (option == command.get_help_ptr()) continue;
    std::string text = option->get_description();
    if (!option->get_default_str().empty()) text += fmt::format(" [{}]", option->get_default_str());
    page += fmt::format(".TP\n.B {}\n{}\n", plain(signature(*option)), plain(text));
  }
}

void add_command(const CLI::App& command, std::string& page) {
  const auto commands = commands_of(command);
  if (commands.empty()) {
    page += fmt::format(".SS {}\n{}\n.PP\n.B {}\n", plain(full_name(command)),
                        plain(command.get_description()), plain(synopsis(command)));
    add_options(command, page);
    if (!command.get_footer().empty())
      page += fmt::format(".PP\n.nf\n{}\n.fi\n", plain(command.get_footer()));
  }
  for (const CLI::App* each : commands) add_command(*each, page);
}

}  // namespace

std::string man_page(const CLI::App& app, const std::string& version) {
  std::string page = fmt::format(
      ".TH WEARWELL 1 \"\" \"wearwell {0}\" \"User Commands\"\n"
      ".SH NAME\n"
      "wearwell \\- {1}\n"
      ".SH SYNOPSIS\n"
      ".B wearwell\n"
      "COMMAND [ARGUMENTS]\n"
      ".SH DESCRIPTION\n"
      "A study is a file in TOML that names a model, a table of measurements, prior knowledge, and "
      "what to predict.\n"
      ".B wearwell new\n"
      "writes a first one,\n"
      ".B wearwell check\n"
      "describes it, and\n"
      ".B wearwell fit\n"
      "fits it.\n"
      ".SH COMMANDS\n",
      version, plain(app.get_description()));
  add_command(app, page);
  page +=
      ".SH EXIT STATUS\n"
      ".TP\n"
      ".B 0\n"
      "Done, and the result is trusted.\n"
      ".TP\n"
      ".B 1\n"
      "Done, but a check failed, or a search was stopped before its proof.\n"
      ".TP\n"
      ".B 2\n"
      "The request or the data is wrong; nothing was written.\n"
      ".TP\n"
      ".B 3\n"
      "The machine failed.\n"
      ".SH EXAMPLES\n"
      ".nf\n"
      "wearwell new joint my\\-joint\n"
      "wearwell check my\\-joint/study.toml\n"
      "wearwell fit my\\-joint/study.toml \\-o results\n"
      ".fi\n";
  return page;
}

}  // namespace wearwell
