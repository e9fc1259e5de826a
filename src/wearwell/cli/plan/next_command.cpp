#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "wearwell/cli/carried.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/cli/plan/command_parts.h"
#include "wearwell/models/clutch/next_point.h"
#include "wearwell/plan/next_question.h"
#include "wearwell/prognosis/new_data.h"

namespace wearwell::plan {
namespace {

struct NextOptions {
  std::filesystem::path result, candidates;
  std::vector<std::filesystem::path> tests;
  NextQuestion question;
  AnswerOptions answer;
};

Answer answer_next(const NextOptions& options, Models models) {
  NextQuestion question = options.question;
  if (!options.candidates.empty()) question.candidates = read_table(options.candidates);
  if (clutch::is_clutch_result(options.result)) {
    for (const auto& each : options.tests) question.tests.push_back(read_table(each));
    return clutch::next_point(options.result, question);
  }
  prognosis::CarriedState state = read_carried(options.result);
  for (const auto& each : options.tests)
    question.tests.push_back(prognosis::read_new_data(state.source, each));
  const ReadStudy read = [models](const Source& source) { return read_study(source, models); };
  return next_test(std::move(state), options.result.string(), read, question);
}

}  // namespace

void add_next_command(CLI::App& plan, Models models, int& exit_code) {
  auto options = std::make_shared<NextOptions>();
  NextQuestion& question = options->question;
  CLI::App* command = plan.add_subcommand(
      "next", "Rank tests to do next by how much they are expected to narrow a goal");
  command->add_option("RESULT", options->result, "Folder that wearwell fit wrote")->required();
  command
      ->add_option("--goal", question.goal,
                   "What the tests are to determine: 'B10 at NAME', a reported quantity, a "
                   "prediction, a parameter; of a clutch 'wear rate at POINT' or 'life at POINT'")
      ->required();
  command->add_option("--candidates", options->candidates,
                      "Table of tests: a column for each condition of the data, and optionally "
                      "specimens, stop, name and a cost");
  command->add_option(
      "--grid", question.grid,
      "Tests on a grid instead: 'stress = 200 to 500 by 25 MPa; stop = 1e6 cycles'");
  command->add_option("--specimens", question.specimens,
                      "Numbers of specimens of each test without that column: '1, 3, 5'");
  command->add_option("--cost", question.cost, "Column of the candidates that has their costs");
  command->add_option("--specimen-cost", question.specimen_cost,
                      "Instead of a column: cost of a specimen");
  command->add_option("--use-cost", question.use_cost,
                      "And cost of each unit of its life on test, in the unit of the data");
  command->add_option("--value", question.value,
                      "Worth of narrowing the interval by one per cent, in units of cost");
  command->add_option("--batch", question.batch, "Choose up to so many candidates together")
      ->capture_default_str();
  command->add_option("--budget", question.budget, "Most that they may cost together");
  command
      ->add_option("--by", question.by,
                   "Rank by the variance of the goal, by information, or by the loss of age "
                   "replacement")
      ->check(one_of({"variance", "information", "loss"}))
      ->capture_default_str();
  command->add_option("--failure-cost", question.failure_cost,
                      "Of --by loss: cost of a failure in service, '12000 EUR'");
  command->add_option("--replacement-cost", question.replacement_cost,
                      "And of a replacement before it, '3000 EUR'");
  command->add_option("--fleet-use", question.fleet_use,
                      "And use of all units that the decision is for, '1e9 cycles': savings in "
                      "money, and whether a test is worth its cost");
  command->add_option("--tests", options->tests,
                      "Tables of tests done since the fit, in the columns of its data");
  command->add_option("--until", question.until,
                      "When to stop testing: 'width <= factor 1.5', 'width <= 20 MPa'");
  command->add_option("--measure", question.measure,
                      "The column that a test measures, if the study measures several");
  command->add_option("--samples", question.samples, "Simulated results for more than one specimen")
      ->capture_default_str();
  command->add_option("--nodes", question.nodes, "Most nodes of the posterior")
      ->capture_default_str();
  command->add_option("--seed", question.seed, "Seed of the simulated results")
      ->capture_default_str();
  add_answer_options(*command, options->answer);
  command->footer(
      "Examples:\n"
      "  wearwell plan next springs --goal 'B10 at softer spring' --candidates tests.csv --cost "
      "cost\n"
      "  wearwell plan next springs --goal 'B10 at softer spring' \\\n"
      "    --grid 'alternating_stress_MPa = 200 to 300 by 10; mean_stress_MPa = 1000; stop = 5e5 "
      "cycles' \\\n"
      "    --specimens '1, 3' --tests log.csv --until 'width <= factor 1.5' -o next\n"
      "  wearwell plan next clutch --goal 'life at slip_speed = 1700 rpm, torque = 50 N m, "
      "temperature = 170 degC, closing_time = 2.15 s' \\\n"
      "    --grid 'slip_speed = 1200 to 2800 by 400 rpm; torque = 50 N m; temperature = 120, 240 "
      "degC; closing_time = 2.15 s; cycles = 1500'\n\n"
      "Exit codes: 0 done; 1 the fit is not trusted; 2 the request is wrong, nothing written.");
  command->callback([options, models, &exit_code] {
    exit_code = give_answer(options->answer, [&] { return answer_next(*options, models); });
  });
}

}  // namespace wearwell::plan
