// What `cmake --install` puts beside the program: its manual page, and what shells complete.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

// "wearwell", "wearwell fit", "wearwell clutch life": all that `help` lists.
void add_commands(const std::string& command, std::vector<std::string>& all) {
  const std::string help = run_command(fmt::format("'{}' help {}", WEARWELL_BINARY,
                                                   command.substr(std::string("wearwell").size())))
                               .out;
  all.push_back(command);
  std::size_t list = help.find("\nA study:\n");  // the first group of the program's commands
  if (list == help.npos) list = help.find("\nSubcommands:\n");
  if (list == help.npos) return;
  static const std::regex line("\n  ([a-z]+) ");
  for (std::sregex_iterator at(help.begin() + static_cast<std::ptrdiff_t>(list), help.end(), line),
       end;
       at != end; ++at)
    add_commands(command + " " + (*at)[1].str(), all);
}

std::vector<std::string> commands() {
  std::vector<std::string> all;
  add_commands("wearwell", all);
  return all;
}

std::set<std::string> options_of(const std::string& command) {
  const std::string help = run_command(fmt::format("'{}' help {}", WEARWELL_BINARY,
                                                   command.substr(std::string("wearwell").size())))
                               .out;
  std::set<std::string> options;
  static const std::regex option("\n  (?:-., *)?(--[a-z-]+)");
  for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at)
    options.insert((*at)[1].str());
  return options;
}

class Generated : public ScratchTest {
 protected:
  std::string generated(const std::string& what) const {
    const CommandResult run = run_command(fmt::format("'{}' generate {}", WEARWELL_BINARY, what));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.out;
  }

  // What bash offers for the last word.
  std::vector<std::string> offered(const std::string& words) const {
    write("wearwell.bash", generated("bash"));
    write("ask.bash", R"(source ./wearwell.bash
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
_wearwell
printf '%s\n' "${COMPREPLY[@]}"
)");
    const CommandResult run = run_command(
        fmt::format("cd '{}' && bash -eu ask.bash wearwell {}", folder().string(), words));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    std::vector<std::string> lines;
    std::istringstream stream(run.out);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
  }
};

TEST_F(Generated, TheManualHasEveryCommandAndOption) {
  write("wearwell.1", generated("man"));
  const CommandResult page = run_command(fmt::format(
      "cd '{}' && groff -man -Tascii -ww wearwell.1 | sed 's/.\x08//g; s/\x1b\\[[0-9;]*m//g'",
      folder().string()));
  ASSERT_EQ(page.exit_code, 0);
  EXPECT_EQ(page.err, "");
  const std::vector<std::string> all = commands();
  EXPECT_THAT(all,
              IsSupersetOf({"wearwell fit", "wearwell clutch life", "wearwell bearing chart"}));
  for (const std::string& command : all) {
    if (command == "wearwell" || command == "wearwell bearing" || command == "wearwell clutch" ||
        command == "wearwell fatigue" || command == "wearwell export" || command == "wearwell plan")
      continue;
    EXPECT_THAT(page.out, HasSubstr("\n   " + command + "\n")) << page.out;
    for (const std::string& option : options_of(command)) {
      if (option != "--help") {
        EXPECT_THAT(page.out, HasSubstr(option)) << command;
      }
    }
  }
  for (const char* text : {"EXIT STATUS", "nothing was written", "wearwell new joint my-joint"})
    EXPECT_THAT(page.out, HasSubstr(text));
}

TEST_F(Generated, BashCompletesCommandsAtEachLevel) {
  for (const std::string& command : commands()) {
    const std::size_t space = command.rfind(' ');
    if (space == command.npos) continue;
    const std::string before = space > 8 ? command.substr(9, space - 8) : "";
    const std::string name = command.substr(space + 1);
    const std::string begun = name.size() > 1 ? name.substr(0, name.size() - 1) : "''";
    EXPECT_THAT(offered(before + begun), testing::Contains(name)) << command;
  }
  EXPECT_THAT(offered("''"), IsSupersetOf({"fit", "check", "clutch", "help", "version"}));
  EXPECT_THAT(offered("''"), Not(testing::Contains("generate")));
  EXPECT_THAT(offered("clutch l"), ElementsAre("life"));
}

TEST_F(Generated, BashCompletesOptionsTheirWordsAndFiles) {
  write("study.toml", "");
  for (const std::string& command : commands()) {
    if (command == "wearwell") continue;
    const std::vector<std::string> all = offered(command.substr(9) + " --");
    EXPECT_EQ(std::set<std::string>(all.begin(), all.end()), options_of(command)) << command;
  }
  EXPECT_THAT(offered("fit --method e"), ElementsAre("exact"));
  EXPECT_THAT(offered("fit study.toml --me"), ElementsAre("--method"));
  EXPECT_THAT(offered("fit stu"), ElementsAre("study.toml"));
  EXPECT_THAT(offered("fit study.toml -o stu"), ElementsAre("study.toml"));
  EXPECT_THAT(offered("new fa"), ElementsAre("fatigue"));
  EXPECT_THAT(offered("new f"), testing::UnorderedElementsAre("fatigue", "fleet", "formula"));
  EXPECT_THAT(offered("clutch predict --state stu"), ElementsAre("study.toml"));
}

TEST_F(Generated, ZshTakesItsCompletions) {
  const std::string script = generated("zsh");
  EXPECT_THAT(script, testing::StartsWith("#compdef wearwell\n"));
  for (const std::string& command : commands()) {
    for (const std::string& option : options_of(command))
      EXPECT_THAT(script, HasSubstr("'" + option + "[")) << command;
  }
  if (run_command("command -v zsh").exit_code != 0) GTEST_SKIP() << "no zsh here";
  write("_wearwell", script);
  // A zsh on a terminal of its own, asked with the Tab key; what it waits for is what it must show.
  write("ask.zsh", R"(zmodload zsh/zpty
zpty z 'zsh -f -i'
zpty -w z 'PS1="READ""Y> "; fpath=($PWD $fpath); autoload -Uz compinit; compinit -u -d $PWD/dump; bindkey "^I" complete-word; bindkey "^A" kill-whole-line'
zpty -r z line '*READY> *' || exit 1
while read -r asked shown; do
  zpty -w -n z "${asked//_/ }"$'\t'
  zpty -r z line "*${shown//_/ }*" || exit 1
  print -r -- "$shown"
  zpty -w -n z $'\x01'
done <<'END'
wearwell_cl wearwell_clutch
wearwell_clutch_li wearwell_clutch_life
wearwell_fit_--met wearwell_fit_--method
wearwell_fit_--method_me wearwell_fit_--method_metropolis
wearwell_new_fa wearwell_new_fatigue
END
zpty -d z
)");
  const CommandResult run = run_command(fmt::format(
      "cd '{}' && zsh -f -n _wearwell && timeout 60 zsh -f ask.zsh", folder().string()));
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_THAT(run.out, HasSubstr("wearwell_fit_--method_metropolis\nwearwell_new_fatigue\n"));
}

}  // namespace
}  // namespace wearwell
