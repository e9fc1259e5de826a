#include "wearwell/cli/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>

#include "wearwell/cli/command_line.h"

namespace wearwell {
namespace {

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

// The choices of "METHOD:exact|nuts|metropolis" (one_of); empty where any text is valid.
std::vector<std::string> words_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::string words = type.substr(type.find(':') + 1);
  std::vector<std::string> result;
  if (words.find('|') == words.npos) return result;
  for (std::size_t from = 0; from <= words.size();) {
    const std::size_t end = std::min(words.find('|', from), words.size());
    result.push_back(words.substr(from, end - from));
    from = end + 1;
  }
  return result;
}

void for_each_command(const CLI::App& command, const std::function<void(const CLI::App&)>& visit) {
  visit(command);
  for (const CLI::App* each : commands_of(command)) for_each_command(*each, visit);
}

std::string in_quotes(std::string_view text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

// As part of a specification of zsh's _arguments.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c == '\n' ? ' ' : c;
  }
  return result;
}

std::string zsh_option(const CLI::Option& option) {
  const std::vector<std::string> names = names_of(option), words = words_of(option);
  const bool takes_value = option.get_items_expected_max() > 0;
  const std::string what = escaped(option.get_description());
  std::string action = "";
  if (takes_value)
    action = words.empty() ? ":value:_files" : fmt::format(":value:({})", fmt::join(words, " "));
  if (names.empty()) {
    return "    " + in_quotes(fmt::format(
                        "{}:{}{}", option.get_items_expected_max() > 1 ? "*" : "",
                        escaped(option.get_name()),
                        words.empty() ? ":_files" : fmt::format(":({})", fmt::join(words, " "))));
  }
  std::string lines;
  for (const std::string& name : names)
    lines += (lines.empty() ? "    " : " \\\n    ") +
             in_quotes(fmt::format("{}[{}]{}", name, what, action));
  return lines;
}

std::string function_name(const CLI::App& command) {
  std::string name = "_" + full_name(command);
  for (char& c : name) c = c == ' ' || c == '-' ? '_' : c;
  return name;
}

std::string zsh_function(const CLI::App& command) {
  const std::vector<const CLI::App*> commands = commands_of(command);
  std::string text = function_name(command) + "() {\n";
  if (commands.empty()) {
    text += "  _arguments -s";
    for (const CLI::Option* option : options_of(command)) text += " \\\n" + zsh_option(*option);
    return text + "\n}\n\n";
  }
  text += "  local context state line\n  local -a commands\n  _arguments -C";
  for (const CLI::Option* option : options_of(command)) text += " \\\n" + zsh_option(*option);
  text +=
      " \\\n    '1: :->command' \\\n    '*:: :->arguments'\n  case $state in\n  command)\n    "
      "commands=(\n";
  for (const CLI::App* each : commands)
    text += "      " + in_quotes(each->get_name() + ":" + escaped(each->get_description())) + "\n";
  text += "    )\n    _describe command commands ;;\n  arguments)\n    case $words[1] in\n";
  for (const CLI::App* each : commands)
    text += fmt::format("    {}) {} ;;\n", each->get_name(), function_name(*each));
  return text + "    esac ;;\n  esac\n}\n\n";
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::string next, options, values;
  for_each_command(app, [&](const CLI::App& command) {
    const std::string name = full_name(command);
    std::vector<std::string> subcommands, names;
    for (const CLI::App* each : commands_of(command)) subcommands.push_back(each->get_name());
    for (const CLI::Option* option : options_of(command)) {
      const std::vector<std::string> spelled = names_of(*option), words = words_of(*option);
      names.insert(names.end(), spelled.begin(), spelled.end());
      // The value of an option; "" is a positional.
      if (option->get_items_expected_max() == 0) continue;
      if (spelled.empty() && words.empty()) continue;
      for (const std::string& each : spelled.empty() ? std::vector<std::string>{""} : spelled)
        values +=
            fmt::format("    '{}:{}') words='{}'; takes=1 ;;\n", name, each, fmt::join(words, " "));
    }
    if (!subcommands.empty())
      next += fmt::format("    '{}') words='{}' ;;\n", name, fmt::join(subcommands, " "));
    options += fmt::format("    '{}') words='{}' ;;\n", name, fmt::join(names, " "));
  });
  return fmt::format(R"(# Completion of wearwell for bash; made by `wearwell generate bash`.
_wearwell_commands() {{
  words=
  case $1 in
{}  esac
}}
_wearwell_options() {{
  words=
  case $1 in
{}  esac
}}
_wearwell_values() {{
  words= takes=
  case $1:$2 in
{}  esac
}}
_wearwell() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}}
  local command=wearwell words= takes= i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    _wearwell_commands "$command"
    case " $words " in *" ${{COMP_WORDS[i]}} "*) command+=" ${{COMP_WORDS[i]}}" ;; esac
  done
  COMPREPLY=()
  case $previous in -*) _wearwell_values "$command" "$previous" ;; esac
  if [[ -z $takes ]]; then
    if [[ $current == -* ]]; then
      _wearwell_options "$command"
    else
      _wearwell_commands "$command"
      [[ -n $words ]] || _wearwell_values "$command" ''
    fi
  fi
  if [[ -n $words ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  else
    COMPREPLY=($(compgen -f -- "$current"))
  fi
}}
complete -o filenames -F _wearwell wearwell
)",
                     next, options, values);
}

std::string zsh_completion(const CLI::App& app) {
  std::string text = "#compdef wearwell\n# Made by `wearwell generate zsh`.\n\n";
  for_each_command(app, [&](const CLI::App& command) { text += zsh_function(command); });
  return text + "_wearwell \"$@\"\n";
}

}  // namespace wearwell
