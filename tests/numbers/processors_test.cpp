// One study, one seed, the same bits on a processor with AVX2 and FMA and on one without: glibc is told to choose its functions as
// there.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/run_command.h"

namespace wearwell {
namespace {

const char* const other_processor = "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F ";

class Processors : public testing::TestWithParam<std::string> {};

TEST_P(Processors, GiveTheSameBits) {
  std::string folder = std::filesystem::temp_directory_path() / "wearwell-processors-XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const std::string fit = "'" WEARWELL_BINARY "' fit " PROJECT_SOURCE_DIR "/examples/" + GetParam();
  const std::string here = "cd '" + folder + "'; mkdir here there; ";
  const CommandResult first = run_command(here + "cd here; " + fit + " -o out");
  const CommandResult second =
      run_command("cd '" + folder + "/there'; " + other_processor + fit + " -o out");
  EXPECT_LE(first.exit_code, 1) << first.err;
  EXPECT_EQ(first.exit_code, second.exit_code);
  const auto without_folder = [](const std::string& text) {
    return text.substr(0, text.find("Results are in "));
  };
  EXPECT_EQ(without_folder(first.out), without_folder(second.out));
  // The report says how long the fit took, and results.sha1 what the report is.
  const CommandResult differ = run_command("diff -rq -x 'report.*' -x results.sha1 '" + folder +
                                           "/here' '" + folder + "/there'");
  EXPECT_EQ(differ.exit_code, 0) << differ.out << differ.err;
  EXPECT_TRUE(std::filesystem::exists(folder + "/here/out/summary.json"));
  std::filesystem::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(, Processors,
                         testing::Values("joint/study.toml", "joint/lognormal_flat.toml",
                                         "bearing/study.toml", "fatigue/study.toml",
                                         "spring/case1.toml", "staircase/study.toml",
                                         "clutch/study.toml", "formula/study.toml",
                                         "repairable/study.toml", "life/study.toml",
                                         "accelerated/study.toml", "degradation/steps.toml"),
                         [](const auto& each) {
                           std::string name = each.param.substr(0, each.param.rfind('.'));
                           for (char& c : name) {
                             if (c == '/') c = '_';
                           }
                           return name;
                         });

}  // namespace
}  // namespace wearwell
