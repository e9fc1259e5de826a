#include <CLI/CLI.hpp>
#include <memory>

#include "wearwell/cli/option_rules.h"
#include "wearwell/cli/plan/command_parts.h"
#include "wearwell/plan/demonstrate.h"

namespace wearwell::plan {

void add_demonstrate_command(CLI::App& plan, int& exit_code) {
  CLI::App* command = plan.add_subcommand(
      "demonstrate", "Plan a test that demonstrates a life: specimens, time, failures allowed");
  const auto question = std::make_shared<DemonstrateQuestion>();
  const auto answer = std::make_shared<AnswerOptions>();
  command
      ->add_option("GOAL", question->goal,
                   "What to show: 'B10 >= 1e6 cycles', or 'reliability >= 90 % at 1e6 cycles'")
      ->required();
  command->add_option("--confidence", question->confidence, "Confidence to show it with")
      ->capture_default_str();
  command
      ->add_option("--failures", question->failures,
                   "Failures with which the test still passes: 0, or several like '0 to 3'")
      ->capture_default_str();
  command->add_option("--specimens", question->specimens,
                      "Number of specimens: solves for the time");
  command->add_option("--time", question->time,
                      "Length of each test, '2e6 cycles': solves for the number of specimens; with "
                      "--specimens: the confidence that is reached");
  command->add_option("--distribution", question->distribution, "Distribution of lives")
      ->check(one_of({"weibull", "lognormal", "loglogistic"}))
      ->capture_default_str();
  command->add_option(
      "--shape", question->shape,
      "Weibull shape: a number, its 90 % interval '1.5 to 3', or a prior like 'lognormal, median = "
      "2, log_sd = 0.2'. Without it: success run, tests as long as the life to show");
  command->add_option("--sigma", question->sigma,
                      "Lognormal, loglogistic: scale of the natural logarithm of life, as --shape");
  command
      ->add_option("--true", question->truth,
                   "True life at which to report the probability to pass, 'B10 = 3e6 cycles'; may "
                   "be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--sudden-death", question->sudden_death,
                      "Number of groups of equal size, each tested to its first failure");
  add_answer_options(*command, *answer);
  command->footer(
      "Examples:\n"
      "  wearwell plan demonstrate 'B10 >= 1e6 cycles' --failures '0 to 3'\n"
      "  wearwell plan demonstrate 'B10 >= 1e6 cycles' --shape 2 --specimens 10\n"
      "  wearwell plan demonstrate 'B10 >= 1e6 cycles' --shape '1.5 to 3' --time '2e6 cycles' -o "
      "plan\n"
      "  wearwell plan demonstrate 'reliability >= 95 % at 1000 h' --shape 1.5 --sudden-death 6\n\n"
      "Exit codes: 0 done; 2 the request is wrong, nothing written.");
  command->callback([question, answer, &exit_code] {
    exit_code = give_answer(*answer, [&] { return demonstrate(*question); });
  });
}

}  // namespace wearwell::plan
