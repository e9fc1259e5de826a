#include "wearwell/cli/report.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/report/read_result.h"
#include "wearwell/report/report.h"
#include "wearwell/report/result_folder.h"

namespace wearwell {
namespace {

void rebuild(const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder / "model.json"))
    throw InputError(fmt::format(
        "{} holds a clutch study, whose report is written by wearwell fit only: fit it again",
        folder.string()));
  heal_results(folder);
  const StudyResult result = read_result(folder);
  if (!result.plots) {
    throw InputError(
        fmt::format("{} is missing: the study was fitted with --no-report; fit it again",
                    (folder / "plots.json").string()));
  }
  replace_result(folder, "report.html", html_report(result));
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  auto folder = std::make_shared<std::filesystem::path>();
  CLI::App* report = app.add_subcommand(
      "report", "Write report.html of a result folder anew, from its summary, draws and plots");
  report->add_option("DIR", *folder, "Folder that `wearwell fit` wrote")->required();
  report->footer("Example:\n  wearwell report study-results");
  report->callback([folder, &exit_code] {
    rebuild(*folder);
    fmt::print("The report is {}\n", (*folder / "report.html").string());
    exit_code = 0;
  });
}

}  // namespace wearwell
