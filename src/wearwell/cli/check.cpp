#include "wearwell/cli/check.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "wearwell/study/clutch_describe.h"
#include "wearwell/study/describe.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

std::string words_of(const Study& study) {
  require_posterior(study);
  return study_in_words(study);
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_code) {
  auto study = std::make_shared<std::filesystem::path>();
  CLI::App* check = app.add_subcommand(
      "check", "Say in words and units what a study will fit; reads the data, runs nothing");
  check->add_option("STUDY", *study, "Study file (TOML)")->required();
  check->footer("Example:\n  wearwell check examples/joint/study.toml");
  check->callback([study, &exit_code] {
    const TextFile file = read_text_file(*study);
    fmt::print("{}", clutch::is_clutch_study(file)
                         ? clutch::study_in_words(clutch::read_clutch_study(file))
                         : words_of(read_study(file)));
    exit_code = 0;
  });
}

}  // namespace wearwell
