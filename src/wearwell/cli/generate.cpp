#include "wearwell/cli/generate.h"

#include <fmt/format.h>

#include <memory>

#include "wearwell/cli/completion.h"
#include "wearwell/cli/man_page.h"
#include "wearwell/cli/option_rules.h"

namespace wearwell {

void add_generate_command(CLI::App& app, int& exit_code) {
  auto what = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("generate", "Manual page or completions of a shell");
  command->group("");
  command->add_option("WHAT", *what, "What to write")
      ->required()
      ->check(one_of({"man", "bash", "zsh"}));
  command->callback([what, &app, &exit_code] {
    fmt::print("{}", *what == "man"    ? man_page(app, WEARWELL_VERSION)
                     : *what == "bash" ? bash_completion(app)
                                       : zsh_completion(app));
    exit_code = 0;
  });
}

}  // namespace wearwell
