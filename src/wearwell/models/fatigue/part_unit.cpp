#include "wearwell/models/fatigue/part_unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/fatigue/sn_predictions.h"
#include "wearwell/prognosis/unit_state.h"

namespace wearwell::fatigue {
namespace {

using prognosis::Forecast;
using prognosis::Reading;

// probability of surviving so far: below it the reading contradicts
constexpr double hardly_survived = 1e-4;
constexpr double undefined_share = 1e-8;  // of the posterior, where the model has no life
constexpr std::size_t most_stresses = 4096;
constexpr std::array used_levels = {0.05, 0.5, 0.95};

// The share of its life that a part has used at a given life: small for long lives.
prognosis::ForecastBand used_of(const prognosis::WeightedLives& remaining, double now, double at) {
  const auto level = [&](double p) { return at > 0 ? at / (now + remaining.quantile(p)) : 0; };
  return {at, level(0.95), level(0.5), level(0.05)};
}

}  // namespace

PartUnit::PartUnit(std::shared_ptr<const PartPopulation> parts, std::string name)
    : parts_(std::move(parts)),
      name_(std::move(name)),
      refusal_(parts_->refusal(name_)),
      studied_(parts_->studied(name_)),
      run_(studied_) {
  bound_ = run_.last.has_value();
  if (!bound_ && refusal_.empty()) run_.last = parts_->ahead;
}

std::string PartUnit::two_stresses(double cycles, const Stress& one, const Stress& other) const {
  const auto text = [&](const Stress& stress) {
    return description(parts_->law, parts_->data, stress);
  };
  return fmt::format(
      "at {:.6g} {} it ran under {}, and under {}: a reading gives all cycles since the beginning, "
      "and the stress since the reading before it",
      from_si(parts_->data.life_unit, cycles), life_unit(parts_->data.life_unit).text, text(one),
      text(other));
}

// Why the stress cannot be that of these cycles; empty if it can.
std::string PartUnit::stress_problem(const RunReading& read) const {
  if (!read.stress)
    return run_.last ? "" : "alternating_stress is missing, or other columns that give it";
  if (studied_.now > 0 && read.cycles <= studied_.now &&
      !is_same_stress(*read.stress, *studied_.last))
    return fmt::format("until {:.6g} {} it ran under {} in the study, not under {}",
                       from_si(parts_->data.life_unit, studied_.now),
                       life_unit(parts_->data.life_unit).text,
                       description(parts_->law, parts_->data, *studied_.last),
                       description(parts_->law, parts_->data, *read.stress));
  if (readings_ > 0 && read.cycles == run_.now && !is_same_stress(*read.stress, *run_.last))
    return two_stresses(read.cycles, *run_.last, *read.stress);
  return {};
}

std::string PartUnit::run_problem(const PartRun& run) const {
  if (run.cycles.size() > 1 && !parts_->law.logarithmic())
    return fmt::format(
        "it runs under {}, but earlier under {}, and the study's lives are normal in cycles "
        "(likelihood.family): under small stresses a scatter in cycles has no meaning, and damage "
        "cannot be summed; fit log10-normal or weibull",
        description(parts_->law, parts_->data, run.cycles.front().stress),
        description(parts_->law, parts_->data, run.cycles.back().stress));
  if (run.cycles.size() > most_stresses)
    return fmt::format(
        "it has run under more than {} different stresses: round them, or send counted cycles by "
        "class, whose order does not matter",
        most_stresses);
  return {};
}

std::string PartUnit::problem_of(const Reading& reading, RunReading& read) const {
  if (reading.numbers.size() != parts_->reading.columns().size() || !reading.labels.empty())
    throw InputError(fmt::format("a reading has {} numbers and {} labels; expected are {} and 0",
                                 reading.numbers.size(), reading.labels.size(),
                                 parts_->reading.columns().size()));
  if (!refusal_.empty()) return refusal_;
  std::string problem = parts_->reading.read(reading.numbers, read.cycles, read.stress);
  return problem.empty() ? stress_problem(read) : problem;
}

// Whether it says more of the cycles before the last reading than that they are survived.
bool PartUnit::is_late(const RunReading& reading) const {
  if (!(reading.cycles < run_.now)) return false;
  if (studied_.now > 0 && reading.cycles <= studied_.now) return false;
  return run_.cycles.size() > 1 || !run_.is_under(reading.stress ? *reading.stress : *run_.last);
}

PartUnit::Weights PartUnit::weights(const PartRun& run, const Stress& ahead) const {
  Weights weights{parts_->log_survival(run, ahead, studied_), 0};
  for (std::size_t i = 0; i < weights.weight.size(); ++i) {
    weights.weight[i] = parts_->few.weights[i] * std::exp(weights.weight[i]);
    weights.survival += weights.weight[i];
  }
  return weights;
}

// P(it survives this run) given its survival so far; 0 if it never does.
double PartUnit::survival_until(const PartRun& run) const {
  const double after = weights(run, *run.last).survival;
  if (!(after > 0)) return 0;
  // Under the same stress ahead, so that both are read from tables or both are sums.
  const double before = weights(run_, *run.last).survival;
  return std::min(1.0, after / before);
}

prognosis::UpdateResult PartUnit::update(const Reading& reading,
                                         const prognosis::History& history) {
  static const std::string impossible =
      "no part of the population survives so long under that stress";
  prognosis::UpdateResult taken;
  RunReading read;
  taken.problem = problem_of(reading, read);
  if (!taken.problem.empty()) return taken;
  if (is_late(read)) return take_late(read, history);
  taken.p_value = 1;  // for a reading with less information than is known
  PartRun after = run_;
  if (read.cycles > run_.now || readings_ == 0)
    after.add(read.cycles, read.stress ? *read.stress : *run_.last);
  taken.problem = run_problem(after);
  if (!taken.problem.empty()) return taken;
  if (read.cycles > run_.now) {
    taken.p_value = survival_until(after);
    if (!(taken.p_value > 0)) {
      taken.problem = impossible;
      taken.impossible = true;
      taken.tails = {{1, 0}};
      return taken;
    }
    taken.tails = {{1, taken.p_value}};  // it fails later: all that is known
  }
  run_ = std::move(after);
  bound_ = true;
  ++readings_;
  taken.counted = true;
  taken.contradicts = taken.p_value < hardly_survived;
  return taken;
}

// A reading between earlier ones divides the cycles of the next: the whole run is found again.
prognosis::UpdateResult PartUnit::take_late(const RunReading& reading,
                                            const prognosis::History& history) {
  prognosis::UpdateResult taken;
  std::vector<RunReading> all;
  history([&](const Reading& each) {
    RunReading earlier;
    if (parts_->reading.read(each.numbers, earlier.cycles, earlier.stress).empty())
      all.push_back(std::move(earlier));
  });
  PartRun begun = studied_;
  if (!begun.last) begun.last = parts_->ahead;
  if (const auto other = stress_until(begun, all, reading.cycles);
      other && reading.stress && !is_same_stress(*other, *reading.stress))
    taken.problem = two_stresses(reading.cycles, *other, *reading.stress);
  all.push_back(reading);
  const PartRun after = run_after(std::move(begun), std::move(all));
  if (taken.problem.empty() && !after.last)
    taken.problem = "alternating_stress is missing, or other columns that give it";
  if (taken.problem.empty()) taken.problem = run_problem(after);
  if (!taken.problem.empty()) return taken;
  if (!(weights(after, *after.last).survival > 0)) {
    taken.problem = "no part of the population survives its cycles under these stresses";
    taken.impossible = true;
    return taken;
  }
  run_ = after;
  taken.p_value = 1;
  ++readings_;
  taken.counted = true;
  return taken;
}

std::vector<prognosis::PredictiveTails> PartUnit::predictive(const Reading& reading) const {
  RunReading read;
  if (!problem_of(reading, read).empty() || !(read.cycles > run_.now)) return {};
  PartRun after = run_;
  after.add(read.cycles, read.stress ? *read.stress : *run_.last);
  if (!run_problem(after).empty()) return {};
  return {{1, survival_until(after)}};
}

// Whether the model has a life of it.
bool PartUnit::has_forecast() const {
  return refusal_.empty() && run_.last.has_value() &&
         (run_.now > 0 || !(parts_->lives(*run_.last)->undefined() > undefined_share));
}

Forecast PartUnit::forecast() const {
  Forecast forecast;
  forecast.now = run_.now;
  if (!has_forecast()) {
    forecast.level05 = forecast.level50 = forecast.level95 = forecast.passed =
        std::numeric_limits<double>::quiet_NaN();
    return forecast;
  }
  const Weights now = weights(run_, *run_.last);
  double square = 0;
  for (const double each : now.weight) square += each * each;
  forecast.effective = now.survival * now.survival / square;
  if (parts_->is_constant(run_, *run_.last)) {
    forecast.remaining = parts_->lives(*run_.last)->remaining(now.weight, run_.now);
    const prognosis::ForecastBand level = used_of(forecast.remaining, run_.now, run_.now);
    forecast.level05 = level.level05;
    forecast.level50 = level.level50;
    forecast.level95 = level.level95;
    return forecast;
  }
  const PartDamage damage = parts_->damage(run_, *run_.last);
  forecast.remaining = damage.remaining(now.weight);
  const auto level = damage.used(now.weight, std::array{0.0}, used_levels).front();
  forecast.level05 = level[0];
  forecast.level50 = level[1];
  forecast.level95 = level[2];
  return forecast;
}

std::vector<prognosis::ForecastBand> PartUnit::ahead(std::span<const double> places) const {
  if (!places.empty() && places.front() < run_.now)
    throw std::invalid_argument("a forecast must start at the unit's present position");
  std::vector<prognosis::ForecastBand> path;
  if (!has_forecast()) return path;
  if (parts_->is_constant(run_, *run_.last)) {
    const Forecast now = forecast();
    for (const double at : places) path.push_back(used_of(now.remaining, run_.now, at));
    return path;
  }
  std::vector<double> further;
  for (const double at : places) further.push_back(at - run_.now);
  const auto levels =
      parts_->damage(run_, *run_.last).used(weights(run_, *run_.last).weight, further, used_levels);
  for (std::size_t i = 0; i < places.size(); ++i)
    path.push_back({places[i], levels[i][0], levels[i][1], levels[i][2]});
  return path;
}

std::optional<prognosis::InPopulations> PartUnit::in_populations(const prognosis::History&) const {
  if (!has_forecast()) return {};
  prognosis::InPopulations apart;
  apart.log_likelihood = parts_->log_survival(run_, *run_.last, studied_);
  const std::size_t count = apart.log_likelihood.size();
  apart.passed.assign(count, 0);
  const bool constant = parts_->is_constant(run_, *run_.last);
  const auto lives = constant ? parts_->lives(*run_.last) : nullptr;
  std::optional<PartDamage> damage;
  if (!constant) damage.emplace(parts_->damage(run_, *run_.last));
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> one(count, 0.0);
    one[i] = 1;
    apart.remaining.push_back(lives ? lives->remaining(one, run_.now) : damage->remaining(one));
  }
  return apart;
}

std::string PartUnit::save() const {
  prognosis::ByteWriter to = prognosis::unit_state(part_mark, parts_->fingerprint);
  to.text(name_);
  to.u64(readings_);
  to.number(run_.now);
  to.byte(bound_);
  to.number(bound_ ? run_.last->alternating : 0);
  to.number(bound_ ? run_.last->mean : 0);
  to.u64(run_.cycles.size());
  for (const LoadCycle& each : run_.cycles)
    for (const double number : {each.stress.alternating, each.stress.mean, each.count})
      to.number(number);
  return prognosis::signed_unit_state(std::move(to));
}

void PartUnit::load(prognosis::ByteReader& from) {
  const auto stress = [&] {
    const Stress read{from.number(), from.number()};
    return read;
  };
  const auto is_stress = [](const Stress& read) {
    return read.alternating > 0 && std::isfinite(read.alternating) && std::isfinite(read.mean);
  };
  readings_ = from.u64();
  run_.now = from.number();
  bound_ = from.flag();
  const Stress last = stress();
  run_.cycles.clear();
  double sum = 0;
  for (std::size_t left = from.count(3 * sizeof(double)); left > 0; --left) {
    LoadCycle cycle{stress(), 0};
    cycle.count = from.number();
    if (!is_stress(cycle.stress)) from.fail("its stress is not a number");
    if (!(cycle.count > 0 && std::isfinite(cycle.count)))
      from.fail("its number of cycles is not a number");
    sum += cycle.count;
    run_.cycles.push_back(cycle);
  }
  from.end();
  constexpr double rounding = 1e-9;
  if (!(run_.now >= studied_.now && std::isfinite(run_.now)) ||
      !(std::abs(sum - run_.now) <= rounding * run_.now) || (!bound_ && run_.now > 0))
    from.fail("its number of cycles is not a number");
  if (!bound_) return;
  if (!is_stress(last)) from.fail("its stress is not a number");
  run_.last = last;
}

}  // namespace wearwell::fatigue
