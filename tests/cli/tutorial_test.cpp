// Every command of README and the tutorials, with what they say the command prints: words exactly, numbers to one unit of their
// last printed digit.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/printed_numbers.h"
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

class Tutorial : public testing::TestWithParam<std::string> {};

// In a folder of its own that holds the project's examples, with the program in the path.
TEST_P(Tutorial, PrintsWhatItShows) {
  const std::string bin = std::filesystem::path(WEARWELL_BINARY).parent_path();
  std::string folder = std::filesystem::temp_directory_path() / "wearwell-tutorial-XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  std::filesystem::create_directory_symlink(PROJECT_SOURCE_DIR "/examples", folder + "/examples");
  const std::vector<Step> all = steps(PROJECT_SOURCE_DIR "/" + GetParam());
  EXPECT_GE(all.size(), 1u);
  for (const Step& step : all) {
    const CommandResult run =
        run_command("exec 2>&1; cd '" + folder + "'; PATH='" + bin + "':$PATH\n" + step.command);
    EXPECT_EQ(printed_difference(run.out, step.printed), "") << step.command << run.out;
  }
  std::filesystem::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(, Tutorial,
                         testing::Values("README.md", "docs/reference/bearing.md",
                                         "docs/reference/clutch.md", "docs/how-to/compare.md",
                                         "docs/how-to/decisions.md",
                                         "docs/reference/degradation.md", "docs/how-to/edge.md",
                                         "docs/reference/fatigue.md", "docs/how-to/fleet.md",
                                         "docs/reference/joint.md", "docs/reference/life.md",
                                         "docs/tutorials/monitoring.md", "docs/how-to/select.md",
                                         "docs/how-to/spectrum.md", "docs/reference/staircase.md",
                                         "docs/how-to/state.md", "docs/reference/tables.md",
                                         "docs/reference/units.md"),
                         [](const auto& each) {
                           std::string name = std::filesystem::path(each.param).stem().string();
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace wearwell
