#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/cli/fatigue/command_parts.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/models/fatigue/design_request.h"
#include "wearwell/present/page.h"
#include "wearwell/present/result_folder.h"

namespace wearwell::fatigue {
namespace {

struct DesignOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path output;
  DesignRequest request;
  std::optional<double> reliability, confidence;  // %
  bool json = false;
};

void write_folder(const AveragedDesignReport& report, ResultFolder& folder) {
  const std::vector<present::Section> sections = averaged_design_sections(report);
  folder.write("design.json", printable_json(averaged_design_json(report).dump(2)) + "\n");
  for (const present::Table* table : present::tables(sections))
    folder.write(fmt::format("tables/{}.csv", table->id), present::csv(*table));
  folder.write("report.html", html_page({WEARWELL_VERSION, "Design curves averaged over models",
                                         report.from.models.front().result.title, sections}));
  folder.commit();
}

int run(const DesignOptions& options) {
  for (const auto& folder : options.folders) {
    if (!options.output.empty() && folder == options.output)
      throw InputError(fmt::format(
          "-o {}: the folder is one of the results to average; give another", folder.string()));
  }
  std::vector<std::pair<std::string, std::filesystem::path>> named;
  for (const auto& folder : options.folders) named.emplace_back(folder.string(), folder);
  ModelsToAverage models = models_to_average(named);
  std::optional<ResultFolder> folder;
  if (!options.output.empty()) folder.emplace(options.output);
  DesignRequest request = options.request;
  if (options.reliability) request.reliability = *options.reliability / 100;
  if (options.confidence) request.confidence = *options.confidence / 100;
  const AveragedDesignReport report = averaged_design_of(request, std::move(models));
  if (folder) write_folder(report, *folder);
  if (options.json) {
    fmt::print("{}\n", printable_json(averaged_design_json(report).dump(2)));
  } else {
    fmt::print("{}", averaged_design_text(report));
    if (folder) fmt::print("Results are in {}\n", options.output.string());
  }
  return is_trusted(report) ? 0 : 1;
}

}  // namespace

void add_design_command(CLI::App& fatigue, int& exit_code) {
  CLI::App* command = fatigue.add_subcommand(
      "design", "Design curves of an S-N model, or averaged over several models of the same tests");
  const auto options = std::make_shared<DesignOptions>();
  command
      ->add_option(
          "RESULT", options->folders,
          "Folders that wearwell fit wrote for one or more models \"sn\" of the same tests")
      ->required()
      ->expected(1, 100);
  command
      ->add_option(
          "--stress", options->request.stresses,
          "Alternating stress at which lives are reported, like '300 MPa'; may be repeated "
          "(default: levels across the tested range)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  CLI::Option* mean =
      command->add_option("--mean-stress", options->request.mean_stress,
                          "Mean stress of all of them, like '100 MPa' (default: as tested)");
  command
      ->add_option("--stress-ratio", options->request.stress_ratio,
                   "Stress ratio R, smallest over largest stress, instead of a mean stress")
      ->excludes(mean);
  command
      ->add_option("--reliability", options->reliability,
                   "Reliability: share of parts that outlast the life, %")
      ->check(number_between(1, 99.9999));
  command->add_option("--confidence", options->confidence, "Confidence of that reliability, %")
      ->check(number_between(1, 99.99));
  command->add_option("-o,--output", options->output, "Folder for the page and the tables");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->footer(
      "Without --reliability and --confidence: 90/90, B-basis, A-basis and 97.7/90. Weights are "
      "those of wearwell compare.\n\n"
      "Examples:\n"
      "  wearwell fatigue design basquin knee stromeyer -o design\n"
      "  wearwell fatigue design basquin knee --stress '300 MPa' --reliability 99 --confidence "
      "95\n\n"
      "Exit codes: 0 done; 1 a study with non-negligible weight is not trusted; 2 the request is "
      "wrong, nothing written.");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace wearwell::fatigue
