#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "wearwell/cli/option_rules.h"
#include "wearwell/cli/plan/command_parts.h"
#include "wearwell/plan/size.h"
#include "wearwell/present/progress_line.h"

namespace wearwell::plan {
namespace {

struct SizeOptions {
  std::filesystem::path study, tests;
  SizeQuestion question;
  AnswerOptions answer;
};

int run_size(const SizeOptions& options, Models models) {
  return give_answer(options.answer, [&] {
    ProgressLine line(!options.answer.json && isatty(STDERR_FILENO) ? stderr : nullptr);
    const Monitor monitor{.progress = [&](const Step& step) { line.show(step); }};
    return size(
        options.question, source_of(options.study), read_table(options.tests),
        [models](const Source& source) { return read_study(source, models); }, monitor);
  });
}

}  // namespace

void add_size_command(CLI::App& plan, Models models, int& exit_code) {
  auto options = std::make_shared<SizeOptions>();
  CLI::App* command = plan.add_subcommand(
      "size", "Number of specimens before any test, by simulation from the priors");
  SizeQuestion& question = options->question;
  command
      ->add_option("STUDY", options->study,
                   "Study file with proper priors; its data file need not exist")
      ->required();
  command
      ->add_option(
          "--tests", options->tests,
          "Table of tests: a column for each condition, specimens (proportions), stop, name")
      ->required();
  command->add_option("--goal", question.goal, "What the tests determine: 'B10 at hanger'")
      ->required();
  command
      ->add_option("--width", question.width,
                   "Largest width of its interval: 'factor 2' (upper / lower end) or '30 um'")
      ->required();
  command->add_option("--assurance", question.assurance, "Probability that it is so narrow")
      ->capture_default_str();
  command->add_option("--level", question.level, "Level of the interval")->capture_default_str();
  command->add_option("--measure", question.measure, "Measured column, if the study has several");
  command->add_option("--most", question.most, "Largest number of specimens tried")
      ->check(number_between(1, 100000))
      ->capture_default_str();
  command->add_option("--simulations", question.simulations, "Number of simulated campaigns")
      ->check(number_between(20, 100000))
      ->capture_default_str();
  command->add_option("--seed", question.seed, "Seed of the random numbers")
      ->check(seed_number())
      ->capture_default_str();
  add_answer_options(*command, options->answer);
  command->footer(
      "Examples:\n"
      "  wearwell plan size study.toml --tests tests.csv --goal 'B10 at hanger' --width 'factor "
      "2'\n"
      "  wearwell plan size study.toml --tests tests.csv --goal k --width '2e-7 mm^3/(N m)' "
      "--assurance '90 %' -o size\n\n"
      "Exit codes: 0 done; 2 the request is wrong, nothing written; 3 the machine failed.");
  command->callback([options, models, &exit_code] { exit_code = run_size(*options, models); });
}

}  // namespace wearwell::plan
