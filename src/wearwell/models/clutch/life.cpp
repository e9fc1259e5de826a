#include "wearwell/models/clutch/life.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

/// Energy until the run-in has added up to `settled` energy's worth of settled wear.
double energy_for(const RunIn& run_in, double settled) {
  double low = 0, high = settled;  // g >= 1
  for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (run_in.integral(middle) < settled ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Life predict_life(const WearModel& model, const std::vector<Cycle>& duty,
                  const std::vector<double>& levels) {
  if (duty.empty()) throw InputError("a duty needs at least one cycle");
  const WearPolynomial w = model.polynomial();
  Life life;
  double variance = 0;
  for (const Cycle& cycle : duty) {
    const double rate = std::max(0.0, w(cycle.at));
    const double step = model.sigma(rate, cycle.at) * cycle.energy;
    life.energy += cycle.energy;
    life.volume += rate * cycle.energy;
    variance += step * step;
    life.outside |= outside(model, cycle.at);
  }
  life.sd = std::sqrt(variance);
  if (!std::isfinite(life.volume) || !std::isfinite(life.energy) || !std::isfinite(variance))
    throw InputError(
        "the wear of this duty is no finite number; is the model far outside its range?");
  if (!(life.volume > 0)) throw InputError("the model predicts no wear under this duty");

  std::vector<double> replicate_volumes;
  for (const Replicate& replicate : model.replicates) {
    double volume = 0;
    for (const Cycle& cycle : duty) volume += std::max(0.0, replicate.w(cycle.at)) * cycle.energy;
    replicate_volumes.push_back(volume);
  }
  for (const double level : levels) {
    if (!(level > 0 && std::isfinite(level)))
      throw InputError(fmt::format("wear level {} must be positive and finite", level));
    LifeAtLevel at;
    at.level = level;
    const double target = level * model.worn_out;
    at.without_run_in = target / life.volume;
    const double energy = energy_for(model.run_in, at.without_run_in * life.energy);
    at.repetitions = energy / life.energy;
    at.sd = life.sd * std::sqrt(at.repetitions);
    double squares = 0;
    for (std::size_t b = 0; b < replicate_volumes.size(); ++b) {
      const double volume =
          replicate_volumes[b] / life.energy * model.replicates[b].run_in.integral(energy);
      squares += (volume - target) * (volume - target);
    }
    if (!replicate_volumes.empty()) squares /= static_cast<double>(replicate_volumes.size());
    const double plate = model.plate_sd * target;
    at.full_sd = std::sqrt(at.sd * at.sd + squares + plate * plate);
    if (!std::isfinite(at.repetitions) || !std::isfinite(at.full_sd))
      throw InputError(
          fmt::format("wear level {} is too far away: no finite number of repetitions", level));
    at.relative = 2 * at.sd / target;
    at.full_relative = 2 * at.full_sd / target;
    life.levels.push_back(at);
  }
  return life;
}

}  // namespace wearwell::clutch
