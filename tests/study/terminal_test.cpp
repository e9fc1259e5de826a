#include "wearwell/study/terminal.h"

#include <gmock/gmock.h>

#include "support/run_command.h"

namespace wearwell {
namespace {

using testing::HasSubstr;
using testing::Not;

PosteriorSummary two_values() {
  PosteriorSummary result;
  result.parameters = {{"k", "mm", 0, 0, 0, 0, 0, 0, 0, 0, 0, {}}};
  Chain chain;
  chain.values.resize(4, 1);
  chain.values << 1, 1, 1, 2;
  result.posterior_draws = {chain};
  result.checks = {{"convergence", Verdict::fail, "R-hat 2", ""}};
  result.trusted = false;
  return result;
}

TEST(Terminal, IsPlainUnlessAskedOtherwise) {
  const std::string plain = terminal_summary(two_values(), {});
  EXPECT_THAT(plain, Not(HasSubstr("\033")));
  EXPECT_THAT(plain, Not(HasSubstr("█")));
  EXPECT_THAT(plain, HasSubstr("FAIL  convergence"));
  EXPECT_THAT(terminal_summary(two_values(), {.colour = true}), HasSubstr("\033[31mFAIL\033[0m"));
}

TEST(Terminal, HistogramIsAsHighAsItsBinsAreFull) {
  std::string bars = "█";
  for (int i = 0; i < 30; ++i) bars += "▁";
  EXPECT_THAT(terminal_summary(two_values(), {.histograms = true}),
              HasSubstr("k [mm]       1.000 " + bars + "▃ 2.000\n"));
}

// `script` gives the program a terminal.
TEST(Terminal, ShowsMoreOnATerminal) {
  const std::string fit = "\"" WEARWELL_BINARY "\" fit \"" PROJECT_SOURCE_DIR
                          "/examples/joint/study.toml\" --no-report -o \"$d/r\"";
  const auto on_terminal = [&](const std::string& environment, const std::string& options) {
    return run_command("d=$(mktemp -d) && export d && " + environment + " script -qec '" + fit +
                       options + "' /dev/null; rm -rf \"$d\"")
        .out;
  };
  const std::string full = on_terminal("TERM=xterm LC_ALL=C.UTF-8", "");
  EXPECT_THAT(full, HasSubstr("\033[32mpass"));
  EXPECT_THAT(full, HasSubstr("█"));
  const std::string plain = on_terminal("NO_COLOR=1 TERM=xterm LC_ALL=C", "");
  EXPECT_THAT(plain, Not(HasSubstr("\033[32m")));
  EXPECT_THAT(plain, Not(HasSubstr("█")));
  EXPECT_EQ(on_terminal("TERM=xterm LC_ALL=C.UTF-8", " --quiet"), "");
}

}  // namespace
}  // namespace wearwell
