#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "wearwell/cli/lives_input.h"
#include "wearwell/cli/plan/command_parts.h"
#include "wearwell/plan/inspect.h"
#include "wearwell/present/progress_line.h"

namespace wearwell::plan {
namespace {

struct InspectOptions {
  LivesOptions lives;
  InspectQuestion question;
  AnswerOptions answer;
};

void add_bounds(CLI::App& command, InspectQuestion& question) {
  command.add_option("--risk", question.risk,
                     "Largest probability that the threshold is reached between one inspection and "
                     "the next (default 1 % unless --total-risk or costs are given)");
  command.add_option("--total-risk", question.total_risk,
                     "Largest probability of a failure that no inspection foresees, for each unit; "
                     "needs --warning");
  command.add_option("--warning", question.warning,
                     "An inspection shows a failure that comes within this use after it: '200 h'");
  command.add_option("--until", question.until,
                     "End of the plan, from now: '5000 h' (default: when half of the units have "
                     "reached their threshold)");
  command.add_option("--step", question.step, "Inspections at multiples of this use: '100 h'");
  command.add_option("--unit", question.unit, "One running unit (default: all, with joint visits)");
  command.add_flag("--new", question.fresh, "A new unit (default if there is no running one)");
  command.add_option("--given", question.given,
                     "Conditions of the next reading of that unit: 'force = 20 N'");
}

void add_prices(CLI::App& command, InspectQuestion& question) {
  command.add_option("--inspection-cost", question.inspection_cost,
                     "Cost of one inspection: '60 EUR'; finds the cheapest times");
  command.add_option("--failure-cost", question.failure_cost,
                     "Cost of a failure in service, including the replacement: '12000 EUR'");
  command.add_option("--replacement-cost", question.replacement_cost,
                     "Cost of a preventive replacement: '900 EUR'");
  command.add_option("--downtime-cost", question.downtime_cost,
                     "Failures are hidden until an inspection, and each unit of use until then "
                     "costs this: '5 EUR/h'");
  command.add_option("--visit-cost", question.visit_cost,
                     "Cost of a visit, whatever the number of units inspected at it");
}

}  // namespace

void add_inspect_command(CLI::App& plan, Models models, int& exit_code) {
  auto options = std::make_shared<InspectOptions>();
  CLI::App* command = plan.add_subcommand(
      "inspect", "Inspection times that keep the risk below a bound, or cost least");
  command
      ->add_option(
          "RESULT", options->lives.path,
          "Folder that wearwell fit wrote for lives, a failure threshold or S-N parts; "
          "configuration of a monitor (.toml); or a table of lives, as for wearwell decide")
      ->required();
  add_lives_options(*command, options->lives);
  add_bounds(*command, options->question);
  add_prices(*command, options->question);
  add_answer_options(*command, options->answer);
  command->footer(
      "Examples:\n"
      "  wearwell plan inspect study-results --risk '1 %' --until '5000 h'\n"
      "  wearwell plan inspect study-results --unit 7 --risk '5 %' --given 'force = 20 N'\n"
      "  wearwell plan inspect lives.csv --risk '5 %' --step '100 h' -o plan\n"
      "  wearwell plan inspect lives.csv --total-risk '2 %' --warning '200 h'\n"
      "  wearwell plan inspect lives.csv --inspection-cost '60 EUR' --failure-cost '12000 EUR' \\\n"
      "    --replacement-cost '900 EUR' --visit-cost '400 EUR'\n\n"
      "Exit codes: 0 done; 1 done, but the study is not trusted; 2 the request is wrong, nothing "
      "written; 3 the machine failed.");
  command->callback([options, models, &exit_code] {
    exit_code = give_answer(options->answer, [&] {
      const LivesInput input = read_lives(options->lives, models);
      ProgressLine line(!options->answer.json && isatty(STDERR_FILENO) ? stderr : nullptr);
      const Monitor monitor{.progress = [&](const Step& step) { line.show(step); }};
      return inspect(options->question, input.lives, input.followed(), monitor);
    });
  });
}

}  // namespace wearwell::plan
