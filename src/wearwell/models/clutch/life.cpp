#include "wearwell/models/clutch/life.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/present/number.h"

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
  /// 1 + p + p^2 + ... with this number of terms, p = exp(-energy_/scale).
  double series(double summands, double scale) const {
    return std::expm1(-summands * energy_ / scale) / std::expm1(-energy_ / scale);
  }

  RunIn run_in_;
  double settled_ = 0, energy_ = 0;
  double slow_ = 0, fast_ = 0;  ///< volume by cycle, times exp(-energy before it/eps)
};

/// The distribution of the volume after any number of repetitions.
struct Knowledge {
  const Repeated& repeated;
  const std::vector<Repeated>& replicates;
  double sd = 0;        ///< of one repetition by the scatter of cycles
  double plate_sd = 0;  ///< of the logarithm of a plate's factor

  double scatter_sd(double repetitions) const { return sd * std::sqrt(repetitions); }

  double full_sd(double repetitions) const {
    const double volume = repeated.volume(repetitions), scatter = scatter_sd(repetitions);
    double squares = 0;
    for (const Repeated& replicate : replicates) {
      const double off = replicate.volume(repetitions) - volume;
      squares += off * off / static_cast<double>(replicates.size());
    }
    const double plate = plate_sd * volume;
    return std::sqrt(scatter * scatter + squares + plate * plate);
  }

  /// First repetition where volume + 2 sd reaches the target, and last where volume - 2 sd is at
  /// most the target.
  LifeInterval interval(double target, double middle,
                        double (Knowledge::*sd_at)(double) const) const {
    const auto end = [&](double sign) {
      const auto below = [&](double n) {
        return repeated.volume(n) + sign * 2 * (this->*sd_at)(n) < target;
      };
      double low = sign > 0 ? 0 : middle, high = middle;
      constexpr double farthest = 1e6;  // times the estimate
      while (below(high)) {
        low = high;
        high *= 2;
        if (high > farthest * middle) return std::numeric_limits<double>::infinity();
      }
      for (int i = 0; i < 200 && high - low > 1e-12 * high; ++i) {
        const double half = 0.5 * (low + high);
        (below(half) ? low : high) = half;
      }
      return 0.5 * (low + high);
    };
    return {end(1), end(-1)};
  }
};

}  // namespace

std::string description(const LifeInterval& interval) {
  const auto cycles = [](double x) {
    return std::isfinite(x) ? given_text(std::round(x), Script::terminal) : "never";
  };
  return cycles(interval.low) + " to " + cycles(interval.high);
}

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
        "the wear of this duty is not a finite number; check whether the duty is far outside the "
        "model's range");
  if (!(life.volume > 0)) throw InputError("the model predicts no wear under this duty");

  const Repeated repeated(w, model.run_in, duty);
  std::vector<Repeated> replicates;
  for (const Replicate& replicate : model.replicates)
    replicates.emplace_back(replicate.w, replicate.run_in, duty);
  const Knowledge known{repeated, replicates, life.sd, model.plate_sd};
  for (const double level : levels) {
    if (!(level > 0 && std::isfinite(level)))
      throw InputError(fmt::format("wear level {} must be positive and finite", level));
    LifeAtLevel at;
    at.level = level;
    const double target = level * model.worn_out;
    at.without_run_in = target / life.volume;
    at.repetitions = repeated.until(target);
    at.sd = known.scatter_sd(at.repetitions);
    at.full_sd = known.full_sd(at.repetitions);
    if (!std::isfinite(at.repetitions) || !std::isfinite(at.full_sd))
      throw InputError(
          fmt::format("wear level {} needs more repetitions than a finite number", level));
    at.scatter = known.interval(target, at.repetitions, &Knowledge::scatter_sd);
    at.full = known.interval(target, at.repetitions, &Knowledge::full_sd);
    at.relative = 2 * at.sd / target;
    at.full_relative = 2 * at.full_sd / target;
    life.levels.push_back(at);
  }
  return life;
}

}  // namespace wearwell::clutch
