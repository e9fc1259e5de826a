#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/same_file.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/cli/fatigue/command_parts.h"
#include "wearwell/cli/fatigue/counting_options.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/input/option_value.h"
#include "wearwell/models/fatigue/load_life_report.h"
#include "wearwell/present/page.h"
#include "wearwell/present/result_folder.h"
#include "wearwell/study/plot_study.h"

namespace wearwell::fatigue {
namespace {

// This many stresses and points determine the printed digits.
constexpr std::size_t most_cycles = 2048, most_cycles_with_limit = 512;
constexpr Eigen::Index most_points_with_limit = 4000;
// Share of a posterior's weight: lighter points are merged.
constexpr double gathered_share = 3e-5;

struct LoadLifeOptions {
  std::filesystem::path result, output;
  CountingOptions counting;
  std::string scale, rule, knee, block;
  std::string damage_sum = "1 x/ 1.34";
  std::vector<double> b_lives = {1, 10, 50};
  double confidence = 90;
  bool json = false;
};

Knee read_knee(const std::string& text, const std::string& si) {
  Knee knee;
  if (text.empty()) return knee;
  const std::size_t at = text.find_first_not_of("0123456789.,eE+- ");
  const auto unit = at == std::string::npos ? std::nullopt : parse_unit(text.substr(at));
  if (at == std::string::npos)
    throw InputError(fmt::format(
        "--knee: '{}' may be a life or a stress; write '{} cycles' or '{} {}'", text, text, text,
        si == "Pa"  ? "MPa"
        : si == "1" ? "%"
                    : si));
  const bool stress = unit && unit->dimension == parse_unit(si)->dimension;
  const double value = option_value("--knee", text, stress ? si : "cycle", Allowed::positive);
  (stress ? knee.stress : knee.life) = value;
  return knee;
}

// "0.7", or "0.7 x/ 1.5".
DamageSum read_damage_sum(const std::string& text) {
  const std::size_t at = text.find("x/");
  DamageSum sum{option_value("--damage-sum", text.substr(0, at), "1", Allowed::positive), 1};
  if (at == std::string::npos) return sum;
  sum.factor = option_value("--damage-sum", text.substr(at + 2), "1", Allowed::positive);
  if (sum.factor < 1)
    throw InputError(
        fmt::format("--damage-sum: the factor {} must be at least 1: two thirds lie between the "
                    "median divided by the factor and the median times the factor",
                    sum.factor));
  return sum;
}

MinerRule read_rule(const std::string& text, const SnLaw& law, const Knee& knee) {
  if (text.empty()) {
    if (knee.any())
      throw InputError(
          "--knee: add the rule below the knee: --rule original, haibach or liu-zenner");
    return law.bends() ? MinerRule::original : MinerRule::elementary;
  }
  const auto& names = miner_rule_names();
  const auto rule =
      static_cast<MinerRule>(std::find(names.begin(), names.end(), text) - names.begin());
  if (rule == MinerRule::elementary && knee.any())
    throw InputError("--knee: --rule elementary has no knee; leave out one of them");
  return rule;
}

// The use of one block: "350 km", "8 h".
void read_block_length(const std::string& text, LoadLifeReport& report) {
  if (text.empty()) return;
  const std::size_t at = text.find_first_not_of("0123456789.eE+- ");
  const std::string unit = at == std::string::npos ? "" : text.substr(at);
  const auto parsed = unit.empty() ? std::nullopt : parse_unit(unit);
  if (!parsed)
    throw InputError(
        fmt::format("--block: '{}' must be a number with a unit, like '350 km', '8 h' "
                    "or '1 cycle'",
                    text));
  report.per_block = option_value("--block", text.substr(0, at), "1", Allowed::positive);
  report.unit = unit;
}

// The points of the posterior over which damage is summed.
WeightedDraws summed_points(const SnLaw& law, const WeightedDraws& posterior) {
  return law.limit ? thinned(posterior, most_points_with_limit)
                   : gathered(posterior, gathered_share);
}

// The relative change of the damage at the posterior mean with fewer classes.
double reduction(const SnResult& result, const DamageRule& rule, const LoadCycles& all,
                 const LoadCycles& few) {
  const Eigen::VectorXd mean = result.posterior.values.transpose() * result.posterior.weights;
  const double before = BlockDamage(result.law, mean.data(), rule, all).log10_damage(0);
  const double after = BlockDamage(result.law, mean.data(), rule, few).log10_damage(0);
  return before == after ? 0 : std::abs(std::expm1((after - before) * std::log(10.0)));
}

void write_folder(const LoadLifeReport& report, ResultFolder& folder) {
  const std::vector<present::Section> sections = load_life_sections(report);
  folder.write("life.json", printable_json(load_life_json(report).dump(2)) + "\n");
  for (const present::Table* table : present::tables(sections))
    folder.write(fmt::format("tables/{}.csv", table->id), present::csv(*table));
  folder.write("report.html", html_page({WEARWELL_VERSION, "Life under a load history",
                                         report.result.title, sections}));
  folder.commit();
}

int run(const LoadLifeOptions& options) {
  refuse_overwriting(
      {{"the results", options.result}, {"the history", options.counting.signal.file}},
      {{"--output", options.output}});
  LoadLifeReport report{read_sn_result(options.result), {}, {}, 0, {}, {}};
  const SnLaw& law = report.result.law;
  LoadQuestion& question = report.question;
  question.rule.knee = read_knee(options.knee, report.result.stress_si);
  question.rule.miner = read_rule(options.rule, law, question.rule.knee);
  question.sum = read_damage_sum(options.damage_sum);
  question.percents = options.b_lives;
  question.confidence = options.confidence / 100;
  read_block_length(options.block, report);
  const bool with_mean = law.correction != MeanStress::none;
  const bool timed = !options.counting.signal.time.empty() && options.block.empty();
  report.block = read_block({options.counting.signal, options.counting.rule(), options.scale,
                             with_mean, timed, report.result.stress_si});
  if (report.block.seconds) {
    report.per_block = *report.block.seconds / 3600;
    report.unit = "h";
  }
  std::optional<ResultFolder> folder;
  if (!options.output.empty()) folder.emplace(options.output);
  const bool expensive = law.limit || law.scatter_grows;
  report.cycles =
      reduced(report.block.cycles, expensive ? most_cycles_with_limit : most_cycles, with_mean);
  report.result.posterior = summed_points(law, report.result.posterior);
  report.life = load_life(report.result, report.cycles, question);
  report.reduction = reduction(report.result, question.rule, report.block.cycles, report.cycles);
  if (folder) write_folder(report, *folder);
  if (options.json) {
    fmt::print("{}\n", printable_json(load_life_json(report).dump(2)));
  } else {
    fmt::print("{}", load_life_text(report));
    if (folder) fmt::print("Results are in {}\n", options.output.string());
  }
  return report.result.trusted ? 0 : 1;
}

}  // namespace

void add_life_command(CLI::App& fatigue, int& exit_code) {
  CLI::App* command = fatigue.add_subcommand(
      "life", "Damage and life under a load history, as distributions, from a fitted S-N study");
  const auto options = std::make_shared<LoadLifeOptions>();
  command
      ->add_option("RESULT", options->result, "Folder that wearwell fit wrote for a model \"sn\"")
      ->required();
  command
      ->add_option("HISTORY", options->counting.signal.file,
                   "One block: a signal, or counted cycles (range or amplitude, mean, cycles)")
      ->required();
  add_counting_options(*command, options->counting, "for a signal: ");
  command->add_option("--time", options->counting.signal.time,
                      "For a signal: a column of times; refuses a file with missing samples and, "
                      "without --block, reports lives in h");
  command->add_option("--scale", options->scale,
                      "Factor from the load to stress, like '0.35 MPa/N'; for a strain '206 GPa'");
  command
      ->add_option(
          "--rule", options->rule,
          "Damage accumulation rule (default: elementary; original with a random fatigue limit)")
      ->check(one_of(miner_rule_names()));
  command->add_option("--knee", options->knee,
                      "Knee of the curve: '2e6 cycles', or a fully reversed amplitude '150 MPa'");
  command
      ->add_option(
          "--damage-sum", options->damage_sum,
          "Damage sum at failure: a number, or a median and the factor that covers two thirds")
      ->capture_default_str();
  command->add_option("--block", options->block,
                      "Use of one block: '350 km', '8 h'; lives are reported in this unit");
  command->add_option("--b-lives", options->b_lives, "Percentages failed")
      ->check(number_between(1e-4, 99.9999))
      ->capture_default_str();
  command->add_option("--confidence", options->confidence, "Confidence of the lower bounds, %")
      ->check(number_between(1, 99.99))
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "Folder for the page and the tables");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->footer(
      "Rules below the knee: original no damage; haibach slope 2k - 1; liu-zenner slope (k + "
      "3.6)/2 "
      "down to half\nof it; elementary has no knee. A damage sum of '1 x/ 1.34' is Wirsching's: "
      "median 1, 30 % scatter.\n\n"
      "Examples:\n"
      "  wearwell fatigue life study-results loads.csv --column stress --block '350 km'\n"
      "  wearwell fatigue life study-results loads.csv --time 'time [s]'\n"
      "  wearwell fatigue life study-results loads.csv --rule haibach --knee '2e6 cycles'\n"
      "  wearwell fatigue life study-results cycles.csv --damage-sum '0.5 x/ 2' --json\n\n"
      "Exit codes: 0 done; 1 the study is not trusted; 2 the request is wrong, nothing written.");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace wearwell::fatigue
