#include "wearwell/models/fatigue/part_population.h"

#include <fmt/format.h>

#include "wearwell/base/printable.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/fatigue/sn_predictions.h"
#include "wearwell/models/fatigue/sn_study.h"

namespace wearwell::fatigue {
namespace {

// Of the posterior; more points if life is either finite or infinite at each of them.
constexpr std::size_t part_points = 1000, part_points_at_a_limit = 4000;

}  // namespace

PartPopulation::PartPopulation(const TomlReader& root, const prognosis::CarriedState& state)
    : law(read_sn_law(root)),
      data(read_sn_data(root, state.source, law.correction)),
      reading(root, data, law.correction),
      few(state.posterior, law.bends() && !law.limit ? part_points_at_a_limit : part_points),
      ahead(reading.only()),
      fingerprint(prognosis::population_fingerprint(state)) {
  for (std::size_t i = 0; i < data.parts.size(); ++i) {
    row[data.parts[i]] = i;
    if (data.tests[i].outcome == Outcome::runout) seen.push_back(data.parts[i]);
  }
  const auto predict = root.table("predict");
  const auto stresses = predict ? predict->table("stress") : std::nullopt;
  if (!ahead && stresses && stresses->keys().size() == 1)
    ahead = read_stress(stresses->required_table(stresses->keys().front()), law.correction,
                        data.spring, data.stress_si);
  if (predict) sum = read_part_damage_sum(*predict, law);
}

std::string PartPopulation::refusal(const std::string& part) const {
  const auto at = row.find(part);
  if (at == row.end() || data.tests[at->second].outcome == Outcome::runout) return {};
  return fmt::format("'{}' is row {} of {}, where it failed: no life remains", printable(part),
                     at->second + 1, data.source);
}

PartRun PartPopulation::studied(const std::string& part) const {
  PartRun run;
  const auto at = row.find(part);
  if (at == row.end() || !refusal(part).empty()) return run;
  const LifeTest& test = data.tests[at->second];
  run.add(test.life, test.stress);
  return run;
}

std::shared_ptr<const StressLives> PartPopulation::lives(const Stress& stress) const {
  constexpr std::size_t most = 32;
  const std::lock_guard lock(lock_);
  const std::pair key(stress.alternating, stress.mean);
  auto at = lives_.find(key);
  if (at == lives_.end()) {
    if (lives_.size() >= most) lives_.clear();
    at = lives_.emplace(key, std::make_shared<const StressLives>(law, few, stress)).first;
  }
  return at->second;
}

std::vector<double> PartPopulation::log_survival(const PartRun& run, const Stress& ahead_of_it,
                                                 const PartRun& studied) const {
  if (is_constant(run, ahead_of_it)) return lives(ahead_of_it)->log_survival(run.now, studied.now);
  std::vector<double> log = damage(run, ahead_of_it).log_survival();
  if (studied.now == 0) return log;
  // In the study a part fails at a damage sum of 1.
  const std::vector<double> before =
      PartDamage(law, few, studied.cycles, *studied.last).log_survival();
  for (std::size_t i = 0; i < log.size(); ++i)
    log[i] = log[i] == -infinity || before[i] == -infinity ? -infinity : log[i] - before[i];
  return log;
}

}  // namespace wearwell::fatigue
