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

INSTANTIATE_TEST_SUITE_P(
    , Tutorial,
    testing::Values(
        "README.md", "docs/how-to/b10-from-field-data.md", "docs/how-to/reliability-growth.md",
        "docs/how-to/classical-estimates.md", "docs/how-to/common-shape.md",
        "docs/how-to/compare-lives.md", "docs/how-to/compare.md", "docs/how-to/decisions.md",
        "docs/how-to/edge.md", "docs/how-to/failed-check.md", "docs/how-to/failure-modes.md",
        "docs/how-to/fleet.md", "docs/how-to/material-factor.md", "docs/how-to/plan-accelerate.md",
        "docs/how-to/plan-demonstrate.md", "docs/how-to/plan-inspect.md",
        "docs/how-to/plan-next.md", "docs/how-to/prior-from-a-study.md",
        "docs/how-to/rul-of-one-machine.md", "docs/how-to/select.md",
        "docs/how-to/sn-design-value.md", "docs/how-to/spectrum.md", "docs/how-to/state.md",
        "docs/how-to/subpopulations.md", "docs/how-to/use-rates.md",
        "docs/how-to/warranty-returns.md", "docs/how-to/weibayes.md", "docs/reference/bearing.md",
        "docs/reference/clutch.md", "docs/reference/degradation.md", "docs/reference/fatigue.md",
        "docs/reference/joint.md", "docs/reference/life.md", "docs/reference/repairable.md",
        "docs/reference/staircase.md", "docs/reference/tables.md", "docs/reference/units.md",
        "docs/reference/warranty.md", "docs/tutorials/joint-wear.md",
        "docs/tutorials/monitoring.md", "docs/tutorials/own-formula.md",
        "docs/tutorials/plan-springs.md", "docs/tutorials/several-units.md",
        "docs/tutorials/sn-design-value.md", "docs/tutorials/weibull-life-data.md"),
    [](const auto& each) {
      const std::filesystem::path page = each.param;
      std::string name = page.parent_path().filename() / page.stem();
      std::replace_if(
          name.begin(), name.end(), [](char c) { return c == '-' || c == '/'; }, '_');
      return name;
    });

}  // namespace
}  // namespace wearwell
