#include "wearwell/cli/fit.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/base/progress.h"
#include "wearwell/base/same_file.h"
#include "wearwell/cli/clutch_fit.h"
#include "wearwell/cli/option_value.h"
#include "wearwell/report/csv.h"
#include "wearwell/report/json.h"
#include "wearwell/report/long_tables.h"
#include "wearwell/report/plots_json.h"
#include "wearwell/report/report.h"
#include "wearwell/report/result_folder.h"
#include "wearwell/report/terminal.h"
#include "wearwell/study/clutch_study.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

using Json = nlohmann::ordered_json;

struct FitOptions {
  std::filesystem::path study, output;
  SamplerChoice sampler;
  int threads = 0;
  bool json = false, quiet = false, no_report = false;
};

int run_fit(const FitOptions& options) {
  const std::filesystem::path output =
      options.output.empty() ? std::filesystem::path(options.study.stem().string() + "-results")
                             : options.output;
  const TextFile file = read_text_file(options.study);
  refuse_overwriting({{"the study", options.study}}, {{"--output", output}});
  if (clutch::is_clutch_study(file)) {
    const SamplerChoice& sampler = options.sampler;
    if (sampler.method || sampler.chains || sampler.draws || sampler.warmup || sampler.seed)
      throw InputError(
          "--method, --chains, --draws, --warmup and --seed are for studies that sample a "
          "posterior; a clutch study has its seeds in the study file");
    return clutch::fit_clutch_study(
        {file, output, options.threads, options.json, options.quiet, options.no_report});
  }
  const Study study = read_study(file);
  ResultFolder folder(output);
  const StudyResult result = [&] {
    const bool shown = !options.quiet && isatty(STDERR_FILENO);
    Progress progress(shown ? stderr : nullptr, "iterations");
    return run_study(study, options.sampler, options.threads, !options.no_report, &progress);
  }();

  const std::string summary =
      to_json(result).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  folder.write("summary.json", summary);
  for (std::size_t c = 0; c < result.posterior_draws.size(); ++c) {
    folder.write(fmt::format("draws_{}.csv", c + 1), draws_csv(result, c));
  }
  folder.write("predictions.csv", predictions_csv(result));
  for (const auto& [name, content] : long_tables(result)) folder.write(name, content);
  if (!options.no_report) {
    const Json plots = to_json(*result.plots);
    folder.write("plots.json", plots.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
    folder.write("report.html", html_report(result));
  }
  folder.write("study.toml", study.file_text);
  folder.commit();

  if (options.json) {
    fmt::print("{}", summary);
  } else if (!options.quiet) {
    fmt::print("{}Results are in {}\n", terminal_summary(result, terminal_style()),
               folder.path().string());
  }
  return result.trusted ? 0 : 1;
}

}  // namespace

void add_fit_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<FitOptions>();
  CLI::App* fit = app.add_subcommand(
      "fit", "Estimate a study's parameters, predict, and say whether to trust it");
  fit->add_option("STUDY", options->study, "Study file (TOML)")->required();
  fit->add_option("-o,--output", options->output,
                  "Folder for the results (default: STUDY-results here)");
  fit->add_option("--method", options->sampler.method,
                  "nuts (default), metropolis, or exact (up to 4 parameters)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Method>{
          {"exact", Method::exact}, {"nuts", Method::nuts}, {"metropolis", Method::metropolis}}))
      ->type_name("METHOD");
  fit->add_option("--chains", options->sampler.chains, "Independent chains (default 4)")
      ->check(CLI::Range(1, max_chains));
  fit->add_option("--draws", options->sampler.draws,
                  "Draws kept per chain (default 1000; metropolis 6000)")
      ->check(CLI::Range(min_draws, max_iterations));
  fit->add_option("--warmup", options->sampler.warmup,
                  "Iterations discarded per chain (default 1000; metropolis 4000)")
      ->check(CLI::Range(0, max_iterations));
  fit->add_option("--seed", options->sampler.seed, "Seed of the random numbers (default 1)")
      ->check(seed_number());
  fit->add_option("--threads", options->threads,
                  "Threads (default: all); results do not depend on it")
      ->check(CLI::Range(1, 1024));
  CLI::Option* json = fit->add_flag("--json", options->json, "Print summary.json and nothing else");
  fit->add_flag("--quiet", options->quiet, "Print nothing but errors")->excludes(json);
  fit->add_flag("--no-report", options->no_report, "Write no report.html");
  fit->footer(
      "Examples:\n"
      "  wearwell fit examples/joint/study.toml\n"
      "  wearwell fit study.toml -o results --method exact --seed 7\n"
      "  wearwell fit study.toml --json | jq .parameters.k.mean\n\n"
      "Exit codes: 0 done and trusted; 1 done, but a check failed; 2 the request or the data is "
      "wrong, nothing\n"
      "written; 3 the machine failed.");
  fit->callback([options, &exit_code] { exit_code = run_fit(*options); });
}

}  // namespace wearwell
