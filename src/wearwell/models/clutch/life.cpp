#include "wearwell/models/clutch/life.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

/// A duty repeated on a new plate. After whole repetitions the volume is that of CycleSum: the sum
/// over repetitions of exp(-Ec/eps) is a geometric series. Between them it is interpolated.
class Repeated {
 public:
  Repeated(const WearPolynomial& w, const RunIn& run_in, const std::vector<Cycle>& duty)
      : run_in_(run_in) {
    for (const Cycle& cycle : duty) {
      const double volume = std::max(0.0, w(cycle.at)) * cycle.energy;
      settled_ += volume;
      slow_ += volume * std::exp(-energy_ / run_in.slow_energy);
      fast_ += volume * std::exp(-energy_ / run_in.fast_energy);
      energy_ += cycle.energy;
    }
  }

  double volume(double repetitions) const {
    return settled_ * repetitions +
           run_in_.slow * slow_ * series(repetitions, run_in_.slow_energy) +
           run_in_.fast * fast_ * series(repetitions, run_in_.fast_energy);
  }

  /// Repetitions until the volume is `target`.
  double until(double target) const {
    double low = 0, high = target / settled_;  // g >= 1
    for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
      const double middle = 0.5 * (low + high);
      (volume(middle) < target ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  /// 1 + p + p^2 + ... of so many summands, p = exp(-energy_/scale).
  double series(double summands, double scale) const {
    return std::expm1(-summands * energy_ / scale) / std::expm1(-energy_ / scale);
  }

  RunIn run_in_;
  double settled_ = 0, energy_ = 0;
  double slow_ = 0, fast_ = 0;  ///< volume by cycle, times exp(-energy before it/eps)
};

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

  const Repeated repeated(w, model.run_in, duty);
  std::vector<Repeated> replicates;
  for (const Replicate& replicate : model.replicates)
    replicates.emplace_back(replicate.w, replicate.run_in, duty);
  for (const double level : levels) {
    if (!(level > 0 && std::isfinite(level)))
      throw InputError(fmt::format("wear level {} must be positive and finite", level));
    LifeAtLevel at;
    at.level = level;
    const double target = level * model.worn_out;
    at.without_run_in = target / life.volume;
    at.repetitions = repeated.until(target);
    at.sd = life.sd * std::sqrt(at.repetitions);
    double squares = 0;
    for (const Repeated& replicate : replicates) {
      const double off = replicate.volume(at.repetitions) - target;
      squares += off * off / static_cast<double>(replicates.size());
    }
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
