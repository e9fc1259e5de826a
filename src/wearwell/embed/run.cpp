#include "wearwell/embed/run.h"

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/embed/fork_guard.h"
#include "wearwell/infer/fit.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/registry.h"
#include "wearwell/netcdf/netcdf_file.h"
#include "wearwell/present/result_folder.h"
#include "wearwell/present/section_json.h"
#include "wearwell/prognosis/carry.h"
#include "wearwell/study/comparison.h"
#include "wearwell/study/family_ranking.h"
#include "wearwell/study/inference_data.h"
#include "wearwell/study/json.h"
#include "wearwell/study/model.h"
#include "wearwell/study/result_writer.h"
#include "wearwell/study/saved_result.h"
#include "wearwell/study/summarize.h"

namespace wearwell::embed {
namespace {

const PosteriorSummary& posterior_of(const Run& run) {
  static_cast<void>(require_posterior_study(*run.of.study));
  return *run.result->posterior;
}

// Whether [predict] has keys that are answered by what a model adds to its result: forecasts of
// failures and returns, estimates of frequentist software.
bool asks_for_addition(const std::string& study) {
  const auto predict = TomlReader::parse({"study", study}).table("predict");
  return predict && (predict->has("next") || predict->has("classical"));
}

}  // namespace

ReadStudy read(Source source) {
  const ForkGuard guard;
  ReadStudy result;
  result.study = read_study(source, all_models());
  result.text = source.study.text;
  result.source = std::make_shared<const Source>(std::move(source));
  return result;
}

ReadStudy read_text(const std::string& text, const std::string& path,
                    std::map<std::string, Table> tables) {
  return read({{path, text}, std::move(tables)});
}

Run run(const ReadStudy& read, const RunOptions& options, Monitor monitor) {
  const ForkGuard guard;
  monitor.threads = guard.most(monitor.threads);
  const auto* const of_posterior = dynamic_cast<const PosteriorStudy*>(read.study.get());
  if (!of_posterior)
    return {read, std::make_shared<const Result>(read.study->run(options, monitor))};
  std::optional<Source> carried;
  try {
    carried = prognosis::carried_source(*read.source, *of_posterior);
  } catch (const InputError&) {
    // The files no longer exist or have changed since the study was read, so that no state can be
    // carried on.
  }
  Run run{read, std::make_shared<const Result>(read.study->run(options, monitor))};
  if (carried) {
    run.state =
        prognosis::state_bytes(prognosis::state_of_result(std::move(*carried), *run.result));
  }
  return run;
}

std::vector<std::pair<std::string, std::vector<double>>> sample_stats(const Run& run) {
  std::vector<std::pair<std::string, std::vector<double>>> stats;
  if (!run.result->posterior || run.result->posterior->posterior_draws.empty()) return stats;
  const Draws& draws = run.result->posterior->posterior_draws;
  const auto add = [&](const char* name, const auto& value) {
    std::vector<double> all;
    all.reserve(draws.size() * draws.front().log_density.size());
    for (const Chain& chain : draws) {
      for (std::size_t d = 0; d < chain.log_density.size(); ++d)
        all.push_back(static_cast<double>(value(chain, d)));
    }
    stats.emplace_back(name, std::move(all));
  };
  add("lp", [](const Chain& c, std::size_t d) { return c.log_density[d]; });
  if (draws.front().nuts.empty()) return stats;
  add("accept_stat", [](const Chain& c, std::size_t d) { return c.nuts[d].accept_stat; });
  add("stepsize", [](const Chain& c, std::size_t) { return c.step_size; });
  add("treedepth", [](const Chain& c, std::size_t d) { return c.nuts[d].treedepth; });
  add("n_leapfrog", [](const Chain& c, std::size_t d) { return c.nuts[d].n_leapfrog; });
  add("divergent", [](const Chain& c, std::size_t d) { return c.nuts[d].divergent; });
  add("energy", [](const Chain& c, std::size_t d) { return c.nuts[d].energy; });
  return stats;
}

Files files_of(const Run& run) {
  const Result& result = *run.result;
  Files files = {{"summary.json", summary_text(result)}};
  files.insert(files.end(), result.files.begin(), result.files.end());
  if (!run.state.empty()) files.emplace_back("state.bin", run.state);
  for (const present::Table* table : present::tables(result.sections))
    files.emplace_back("tables/" + table->id + ".csv", present::csv(*table));
  if (!result.sections.empty()) {
    using Json = nlohmann::ordered_json;
    files.emplace_back("report.json",
                       printable_json(present::to_json(result.sections)
                                          .dump(-1, ' ', false, Json::error_handler_t::replace)) +
                           "\n");
  }
  files.emplace_back("study.toml", run.of.text);
  return files;
}

std::string page_of(const std::string& summary, const std::string& report) {
  const SavedReport saved = read_saved_report(summary, report);
  return report_html(saved.header, saved.sections);
}

void write_folder(const std::string& target, const Files& files) {
  ResultFolder folder(target);
  for (const auto& [name, content] : files) folder.write(name, content);
  folder.commit();
}

void write_netcdf(const Run& run, const std::string& target) {
  std::vector<netcdf::Group> groups;
  {
    const ForkGuard guard;
    groups = inference_data(require_posterior_study(*run.of.study), posterior_of(run));
  }
  netcdf::write(target, groups);
}

nlohmann::ordered_json asked(const Run& run, const ReadStudy& other, double level) {
  const ForkGuard guard;
  constexpr double usual = 0.9;
  const Ends ends = level == usual ? Ends{} : Ends{(1 - level) / 2, (1 + level) / 2};
  const PosteriorStudy& study = require_posterior_study(*other.study);
  const PosteriorSummary& fitted = posterior_of(run);
  const auto all = posterior_json(asked_later(study, fitted, ends));
  nlohmann::ordered_json answers;
  for (const char* each : {"predictions", "quantities", "life"})
    if (all.contains(each)) answers[each] = all[each];
  if (study.addition && asks_for_addition(other.text)) {
    if (!proper(*fitted.fit))
      throw InputError("the posterior is improper, so that it forecasts nothing");
    answers.update(study.addition(*fitted.fit).body);
  }
  return answers;
}

Compared compared(const Files& names_and_folders) {
  std::vector<std::pair<std::string, SavedResult>> results;
  for (const auto& [name, folder] : names_and_folders)
    results.emplace_back(name, read_saved_result(folder));
  const Comparison comparison = compare(std::move(results));
  return {to_json(comparison), comparison_text(comparison), comparison_page(comparison)};
}

Compared compared_families(const ReadStudy& read, const std::string& families, Monitor monitor) {
  const ForkGuard guard;
  monitor.threads = guard.most(monitor.threads);
  const FamilyRanking ranking = rank_families(*read.source, families, all_models(), monitor);
  return {ranking_json(ranking), ranking_text(ranking), comparison_page(ranking.comparison)};
}

}  // namespace wearwell::embed
