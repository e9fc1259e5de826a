#include "wearwell/embed/update.h"

#include <filesystem>
#include <utility>

#include "wearwell/embed/fork_guard.h"
#include "wearwell/input/json_reader.h"
#include "wearwell/models/registry.h"
#include "wearwell/prognosis/update.h"
#include "wearwell/study/model.h"

namespace wearwell::embed {
namespace {

SamplerChoice sampler_of(const Fitted& fitted) {
  if (fitted.run)
    return prognosis::sampler_of_summary(summary_json(*fitted.run->result), "summary.json");
  const std::filesystem::path file = std::filesystem::path(fitted.path) / "summary.json";
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  return prognosis::sampler_of_summary(read_json(file), file);
}

}  // namespace

Run update(const Fitted& fitted, const std::vector<prognosis::NewRows>& rows,
           const std::string& repeated, bool report, Monitor monitor) {
  const ForkGuard guard;
  monitor.threads = guard.most(monitor.threads);
  prognosis::StudyOfAllRows all = prognosis::study_of_all_rows(
      state_of(fitted), rows, prognosis::repeated_named(repeated),
      [](const Source& source) { return read_study(source, all_models()); });
  const auto source = std::make_shared<const Source>(all.source);
  Run run{{all.study, source->study.text, source},
          std::make_shared<const Result>(all.study->run({sampler_of(fitted), report}, monitor))};
  run.state = prognosis::state_of_all_rows(std::move(all.source), *run.result);
  return run;
}

}  // namespace wearwell::embed
