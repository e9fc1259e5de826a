#include "wearwell/cli/fit.h"

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "wearwell/base/same_file.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/present/progress_line.h"
#include "wearwell/prognosis/carried_run.h"
#include "wearwell/study/inference_data.h"
#include "wearwell/study/posterior_study.h"
#include "wearwell/study/result_writer.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

struct FitOptions {
  std::filesystem::path study, output, netcdf;
  SamplerChoice sampler;
  std::string method;
  int threads = 0;
  bool json = false, quiet = false, no_report = false, rows = false;
};

std::optional<Method> method_named(const std::string& name) {
  if (name.empty()) return {};
  return name == "exact" ? Method::exact : name == "nuts" ? Method::nuts : Method::metropolis;
}

int run_fit(const FitOptions& options, Models models) {
  const std::filesystem::path output =
      options.output.empty() ? std::filesystem::path(options.study.stem().string() + "-results")
                             : options.output;
  const Source source = source_of(options.study);
  refuse_overwriting({{"the study", options.study}},
                     {{"--output", output}, {"--netcdf", options.netcdf}});
  const auto study = read_study(source, models);
  const bool netcdf = !options.netcdf.empty();
  if (netcdf) static_cast<void>(require_posterior_study(*study));
  const auto* const of_posterior = dynamic_cast<const PosteriorStudy*>(study.get());
  std::optional<Source> carried = prognosis::source_to_carry(source, *study);
  if (of_posterior && !options.quiet) {
    const std::string note = method_note(*of_posterior, options.sampler);
    if (!note.empty()) fmt::print(stderr, "wearwell: {}\n", note);
  }
  ResultFolder folder(output);
  std::optional<StagedFile> draws;
  if (netcdf) draws.emplace(options.netcdf);
  const Result result = [&] {
    ProgressLine line(!options.quiet && isatty(STDERR_FILENO) ? stderr : nullptr);
    const Monitor monitor{.progress = [&](const Step& step) { line.show(step); },
                          .threads = options.threads};
    return prognosis::carried_run(std::move(carried), *study, {options.sampler, !options.no_report},
                                  monitor);
  }();
  if (draws) {
    draws->write(
        netcdf::file_of(inference_data(require_posterior_study(*study), *result.posterior)));
  }
  write_result(result, source.study.text, folder);
  if (draws) draws->commit();

  if (options.json) {
    fmt::print("{}", summary_text(result));
  } else if (!options.quiet) {
    TerminalStyle style = terminal_style();
    style.rows = options.rows;
    fmt::print("{}Results are in {}\n", terminal_text(result, style), folder.path().string());
    if (netcdf) fmt::print("The draws for ArviZ are in {}\n", options.netcdf.string());
  }
  return result.header.trusted ? 0 : 1;
}

}  // namespace

void add_fit_command(CLI::App& app, Models models, int& exit_code) {
  auto options = std::make_shared<FitOptions>();
  CLI::App* fit = app.add_subcommand(
      "fit", "Estimate a study's parameters, predict, and check whether to trust the result");
  fit->add_option("STUDY", options->study, "Study file (TOML)")->required();
  fit->add_option("-o,--output", options->output,
                  "Folder for the results (default: STUDY-results in the current folder)");
  fit->add_option("--method", options->method,
                  "Sampling method (default nuts); exact: quadrature, up to 4 parameters")
      ->check(one_of({"nuts", "metropolis", "exact"}))
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
                  "Threads (default: all); results do not depend on the number")
      ->check(CLI::Range(1, 1024));
  CLI::Option* json = fit->add_flag("--json", options->json, "Print summary.json and nothing else");
  fit->add_flag("--quiet", options->quiet, "Print nothing but errors")->excludes(json);
  fit->add_flag("--rows", options->rows, "Include tables with a line for each row of the data");
  fit->add_flag("--no-report", options->no_report, "Write no report.html");
  fit->add_option("--netcdf", options->netcdf,
                  "Also write draws, their statistics and log-likelihoods as NetCDF for ArviZ")
      ->type_name("FILE");
  fit->footer(
      "Examples:\n"
      "  wearwell fit examples/joint/study.toml\n"
      "  wearwell fit study.toml -o results --method exact --seed 7\n"
      "  wearwell fit study.toml --json | jq .parameters.k.mean\n\n"
      "Exit codes: 0 done and trusted; 1 done, but a check failed; 2 the request or the data is "
      "wrong, nothing\n"
      "written; 3 the machine failed.");
  fit->callback([options, models, &exit_code] {
    options->sampler.method = method_named(options->method);
    exit_code = run_fit(*options, models);
  });
}

}  // namespace wearwell
