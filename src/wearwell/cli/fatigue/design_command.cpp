#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/cli/fatigue/command_parts.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/input/option_value.h"
#include "wearwell/models/fatigue/averaged_design_report.h"
#include "wearwell/present/page.h"
#include "wearwell/present/result_folder.h"

namespace wearwell::fatigue {
namespace {

struct DesignOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path output;
  std::vector<std::string> stresses;
  std::string mean_stress, stress_ratio;
  std::optional<double> reliability, confidence;
  bool json = false;
};

DesignQuestion read_question(const DesignOptions& options,
                             const std::vector<WeightedModel>& models) {
  DesignQuestion question;
  const std::string& si = models.front().result.stress_si;
  for (const std::string& text : options.stresses)
    question.alternating.push_back(option_value("--stress", text, si, Allowed::positive));
  std::sort(question.alternating.rbegin(), question.alternating.rend());
  if (question.alternating.empty()) question.alternating = design_stresses(models);
  if (!options.mean_stress.empty()) {
    question.line.mean = option_value("--mean-stress", options.mean_stress, si);
  } else if (!options.stress_ratio.empty()) {
    question.line.ratio = option_value("--stress-ratio", options.stress_ratio, "1");
    if (!(*question.line.ratio < 1))
      throw InputError(
          fmt::format("--stress-ratio {}: smallest over largest stress; it must be less than 1",
                      options.stress_ratio));
  } else {
    question.line = design_line(models);
  }
  question.levels = design_levels();
  if (options.reliability || options.confidence) {
    const double r = options.reliability.value_or(90), c = options.confidence.value_or(90);
    question.levels = {{fmt::format("{:.6g}/{:.6g}", r, c), r / 100, c / 100}};
  }
  return question;
}

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
  AveragedDesignReport report;
  report.from = models_to_average(options.folders);
  report.question = read_question(options, report.from.models);
  report.shown_all = !options.stresses.empty();
  std::optional<ResultFolder> folder;
  if (!options.output.empty()) folder.emplace(options.output);
  report.points = averaged_design(report.from.models, report.question);
  if (folder) write_folder(report, *folder);
  if (options.json) {
    fmt::print("{}\n", printable_json(averaged_design_json(report).dump(2)));
  } else {
    fmt::print("{}", averaged_design_text(report));
    if (folder) fmt::print("Results are in {}\n", options.output.string());
  }
  const std::vector<Check> checks = averaged_design_checks(report);
  return std::any_of(checks.begin(), checks.end(),
                     [](const Check& each) { return each.verdict == Verdict::fail; })
             ? 1
             : 0;
}

}  // namespace

void add_design_command(CLI::App& fatigue, int& exit_code) {
  CLI::App* command = fatigue.add_subcommand(
      "design", "Design curves averaged over several S-N models of the same tests");
  const auto options = std::make_shared<DesignOptions>();
  command
      ->add_option("RESULT", options->folders,
                   "Folders that wearwell fit wrote for models \"sn\" of the same tests")
      ->required()
      ->expected(2, 100);
  command
      ->add_option(
          "--stress", options->stresses,
          "Alternating stress at which lives are reported, like '300 MPa'; may be repeated "
          "(default: levels across the tested range)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  CLI::Option* mean =
      command->add_option("--mean-stress", options->mean_stress,
                          "Mean stress of all of them, like '100 MPa' (default: as tested)");
  command
      ->add_option("--stress-ratio", options->stress_ratio,
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
