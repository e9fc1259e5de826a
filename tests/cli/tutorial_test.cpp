// Every command of a tutorial, with what it says the command prints.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/run_command.h"

namespace wearwell {
namespace {

struct Step {
  std::string command;
  std::string printed;
};

/// The steps of the ```console blocks: "$ command", continued by a backslash, then its output.
std::vector<Step> steps(const std::string& file) {
  std::ifstream text(file);
  std::vector<Step> result;
  bool inside = false, continued = false;
  for (std::string line; std::getline(text, line);) {
    if (!inside) {
      inside = line == "```console";
    } else if (line == "```") {
      inside = false;
    } else if (continued || line.rfind("$ ", 0) == 0) {
      if (continued) {
        result.back().command += line + "\n";
      } else {
        result.push_back({line.substr(2) + "\n", ""});
      }
      continued = line.back() == '\\';
    } else if (!result.empty()) {
      result.back().printed += line + "\n";
    }
  }
  return result;
}

TEST(Tutorial, BearingPrintsWhatItShows) {
  const std::string bin = std::filesystem::path(WEARWELL_BINARY).parent_path();
  const std::vector<Step> all = steps(PROJECT_SOURCE_DIR "/docs/bearing.md");
  EXPECT_GE(all.size(), 8u);
  for (const Step& step : all) {
    const CommandResult run = run_command("exec 2>&1; PATH='" + bin + "':$PATH\n" + step.command);
    EXPECT_EQ(run.out, step.printed) << step.command;
  }
}

}  // namespace
}  // namespace wearwell
