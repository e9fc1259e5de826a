#include "wearwell/models/fatigue/load_life_request.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/option_value.h"
#include "wearwell/study/plot_study.h"

namespace wearwell::fatigue {
namespace {

// This many stresses and points determine the printed digits.
constexpr std::size_t most_cycles = 2048, most_cycles_with_limit = 512;
constexpr Eigen::Index most_summed_points = 4000;
// Share of a posterior's weight: lighter points are merged.
constexpr double gathered_share = 3e-5;

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

MinerRule read_rule(const std::string& text, const SnLaw& law, const Knee& knee) {
  if (text.empty()) {
    if (knee.any())
      throw InputError(
          "--knee: add the rule below the knee: --rule original, haibach or liu-zenner");
    return law.bends() ? MinerRule::original : MinerRule::elementary;
  }
  const auto rule = static_cast<MinerRule>(choice_among("--rule", text, miner_rule_names()));
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
  return law.limit ? thinned(posterior, most_summed_points) : gathered(posterior, gathered_share);
}

// The relative change of the damage at the posterior mean with fewer classes.
double reduction(const SnResult& result, const DamageRule& rule, const LoadCycles& all,
                 const LoadCycles& few) {
  const Eigen::VectorXd mean = result.posterior.values.transpose() * result.posterior.weights;
  const double before = BlockDamage(result.law, mean.data(), rule, all).log10_damage(0);
  const double after = BlockDamage(result.law, mean.data(), rule, few).log10_damage(0);
  return before == after ? 0 : std::abs(std::expm1((after - before) * std::log(10.0)));
}

void refuse_wrong_shares(const LoadLifeRequest& request) {
  constexpr double least = 1e-4, most = 99.9999;
  if (request.b_lives.empty()) throw InputError("--b-lives: no percentage is given");
  for (const double percent : request.b_lives)
    if (!(percent >= least && percent <= most))
      throw InputError(
          fmt::format("--b-lives: {} is not a percentage from {} to {}", percent, least, most));
  if (!(request.confidence >= 0.01 && request.confidence <= 0.9999))
    throw InputError(
        fmt::format("--confidence: {} is not a share from 0.01 to 0.9999", request.confidence));
}

}  // namespace

LoadLifeReport load_life_of(const LoadLifeRequest& request, SnResult result) {
  refuse_wrong_shares(request);
  const CountingChoice& counting = request.counting;
  LoadLifeReport report{std::move(result), {}, {}, 0, {}, {}};
  const SnLaw& law = report.result.law;
  LoadQuestion& question = report.question;
  question.rule.knee = read_knee(request.knee, report.result.stress_si);
  question.rule.miner = read_rule(request.rule, law, question.rule.knee);
  question.sum = read_damage_sum("--damage-sum", request.damage_sum);
  question.percents = request.b_lives;
  question.confidence = request.confidence;
  read_block_length(request.block, report);
  const bool with_mean = law.correction != MeanStress::none;
  const bool timed = !counting.signal.time.empty() && request.block.empty();
  report.block = read_block(
      {counting.signal, counting.rule(), request.scale, with_mean, timed, report.result.stress_si});
  if (report.block.seconds) {
    report.per_block = *report.block.seconds / 3600;
    report.unit = "h";
  }
  const bool expensive = law.limit || law.scatter_grows;
  report.cycles =
      reduced(report.block.cycles, expensive ? most_cycles_with_limit : most_cycles, with_mean);
  report.result.posterior = summed_points(law, report.result.posterior);
  report.life = load_life(report.result, report.cycles, question, counting.signal.stop);
  report.reduction = reduction(report.result, question.rule, report.block.cycles, report.cycles);
  return report;
}

}  // namespace wearwell::fatigue
