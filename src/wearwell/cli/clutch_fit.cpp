#include "wearwell/cli/clutch_fit.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "wearwell/report/result_folder.h"
#include "wearwell/study/clutch_model_file.h"
#include "wearwell/study/clutch_report.h"
#include "wearwell/study/clutch_study.h"
#include "wearwell/study/clutch_summary.h"

namespace wearwell::clutch {

int fit_clutch_study(const FitRequest& request) {
  const ClutchStudy study = read_clutch_study(request.study);
  ResultFolder folder(request.output);
  const ClutchResult result = [&] {
    const bool shown = !request.quiet && isatty(STDERR_FILENO);
    Progress progress(shown ? stderr : nullptr, "exact searches");
    return run_clutch_study(study, request.threads, &progress);
  }();
  const std::string summary = summary_json(study, result).dump(2) + "\n";
  folder.write("summary.json", summary);
  folder.write("model.json", to_json(result.model).dump(1) + "\n");
  folder.write("predictions.csv", sequences_csv(result));
  if (!request.no_report) folder.write("report.html", clutch_report(study, result));
  folder.write("study.toml", study.file_text);
  folder.commit();
  if (request.json) {
    fmt::print("{}", summary);
  } else if (!request.quiet) {
    fmt::print("{}Results are in {}\n", summary_text(study, result), folder.path().string());
  }
  return result.trusted ? 0 : 1;
}

}  // namespace wearwell::clutch
