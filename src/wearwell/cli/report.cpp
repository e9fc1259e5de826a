#include "wearwell/cli/report.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "wearwell/present/result_folder.h"
#include "wearwell/study/saved_result.h"

namespace wearwell {
namespace {

void rebuild(const std::filesystem::path& folder) {
  recover_results(folder);
  const SavedReport saved = read_saved_report(folder);
  replace_result(folder, "report.html", report_html(saved.header, saved.sections));
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  auto folder = std::make_shared<std::filesystem::path>();
  CLI::App* report = app.add_subcommand("report", "Rebuild report.html of a result folder");
  report->add_option("DIR", *folder, "Folder that `wearwell fit` wrote")->required();
  report->footer("Example:\n  wearwell report study-results");
  report->callback([folder, &exit_code] {
    rebuild(*folder);
    fmt::print("The report is {}\n", (*folder / "report.html").string());
    exit_code = 0;
  });
}

}  // namespace wearwell
