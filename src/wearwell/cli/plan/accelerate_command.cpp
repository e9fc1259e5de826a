#include <CLI/CLI.hpp>
#include <memory>

#include "wearwell/cli/option_rules.h"
#include "wearwell/cli/plan/command_parts.h"
#include "wearwell/plan/accelerate.h"

namespace wearwell::plan {
namespace {

void add_conditions(CLI::App& command, AccelerateQuestion& question) {
  command.add_option("--use", question.use, "Stress in use, '50 degC'")->required();
  command.add_option("--highest", question.highest, "Highest stress to test, '120 degC'")
      ->required();
  command.add_option("--lowest", question.lowest, "Lowest stress to test (default: --use)");
  command.add_option("--low", question.low,
                     "Lower level of the plans with three levels (default: optimized)");
  command.add_option("--until", question.until, "Stop time of every test, '183 d'")->required();
  command.add_option("--stop", question.stop,
                     "Stop times by level instead, lower, middle and highest: '365 d, 250 d, 183 "
                     "d'. Shares that fail stay those by --until");
  command.add_option("--specimens", question.specimens, "Number of specimens in all")->required();
  command.add_option("--goal", question.goal, "Life to predict at the stress in use")
      ->capture_default_str();
  command
      .add_option("--middle-share", question.middle_share,
                  "Share of specimens at the middle level of the compromise plan")
      ->capture_default_str();
  command
      .add_option("--least-failures", question.least_failures,
                  "Failures wanted at each level: their probability is reported")
      ->capture_default_str();
}

void add_planning_values(CLI::App& command, AccelerateQuestion& question) {
  command.add_option("--family", question.family, "Distribution of lives")
      ->check(one_of({"weibull", "lognormal", "loglogistic"}))
      ->capture_default_str();
  command.add_option("--relation", question.relation, "Relation of log life to stress")
      ->check(one_of({"arrhenius", "eyring", "inverse-power", "linear"}))
      ->capture_default_str();
  command.add_option("--shape", question.shape,
                     "Weibull shape: a number, an interval '1.5 to 2' (90 %), or a prior like "
                     "'lognormal, median = 1.7, log_sd = 0.1'");
  command.add_option("--sigma", question.sigma,
                     "Instead: scale of the natural logarithm of life (1/shape)");
  command.add_option("--failing-at-use", question.failing_at_use,
                     "Share that fails in use by the stop time, '0.1 %' or '0.05 % to 0.2 %'");
  command.add_option("--failing-at-highest", question.failing_at_highest,
                     "Share that fails at the highest stress by the stop time, '90 %'");
  command.add_option("--life-at-highest", question.life_at_highest,
                     "Instead: median life there, '60 d', or another one, 'B10 = 20 d'");
  command.add_option("--activation-energy", question.activation_energy,
                     "Arrhenius and Eyring: how steeply life falls, '0.7 eV' or '0.65 to 0.8 eV'");
  command.add_option("--exponent", question.exponent, "The same for inverse-power: '4'");
  command.add_option("--slope", question.slope,
                     "The same for linear: fall of the natural logarithm of life per unit of "
                     "--highest, '0.05'");
}

}  // namespace

void add_accelerate_command(CLI::App& plan, int& exit_code) {
  CLI::App* command = plan.add_subcommand(
      "accelerate", "Plan an accelerated life test: levels and specimens at each");
  const auto question = std::make_shared<AccelerateQuestion>();
  const auto answer = std::make_shared<AnswerOptions>();
  add_conditions(*command, *question);
  add_planning_values(*command, *question);
  add_answer_options(*command, *answer);
  command->footer(
      "Planning values: --shape or --sigma, and two of --failing-at-use, --failing-at-highest (or "
      "--life-at-highest) and --activation-energy (--exponent, --slope).\n\n"
      "Examples:\n"
      "  wearwell plan accelerate --use '50 degC' --highest '120 degC' --until '183 d' --specimens "
      "300 --sigma 0.6 --failing-at-use '0.1 %' --failing-at-highest '90 %'\n"
      "  wearwell plan accelerate --use '50 degC' --highest '120 degC' --until '183 d' --specimens "
      "300 --shape '1.4 to 2' --failing-at-use '0.1 %' --activation-energy '0.65 to 0.8 eV' -o "
      "plan\n"
      "  wearwell plan accelerate --relation inverse-power --family lognormal --use '100 MPa' "
      "--highest '200 MPa' --until '1e7 cycles' --specimens 30 --sigma 0.5 --life-at-highest '1e5 "
      "cycles' --exponent 8\n\n"
      "Exit codes: 0 done; 2 the request is wrong, nothing written.");
  command->callback([question, answer, &exit_code] {
    exit_code = give_answer(*answer, [&] { return accelerate(*question); });
  });
}

}  // namespace wearwell::plan
