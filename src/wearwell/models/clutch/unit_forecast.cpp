#include "wearwell/models/clutch/unit_forecast.h"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace wearwell::clutch {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
/// Limit of the search for an end, in multiples of the estimated life or of the cycles so far.
constexpr double farthest = 1e6;

/// The point where `f` changes from negative to non-negative.
template <class F>
double turn(double low, double high, const F& f) {
  const double at_low = f(low), at_high = f(high);
  if (!(at_low < 0)) return low;
  if (!(at_high > 0)) return high;
  std::uintmax_t most = 200;
  const auto [a, b] = boost::math::tools::toms748_solve(
      f, low, high, at_low, at_high, [](double x, double y) { return y - x <= 1e-12 * y; }, most);
  return 0.5 * (a + b);
}

/// The first n >= `from` at which `f` is non-negative; infinite beyond `most`.
template <class F>
double first_not(double from, double step, double most, const F& f) {
  if (!(f(from) < 0)) return from;
  double low = from;
  for (double high = from + step;; high = from + step) {
    if (!(f(high) < 0)) return turn(low, high, f);
    if (high > most) return never;
    low = high;
    step *= 2;
  }
}

}  // namespace

UnitSums unit_sums(const fleet::Row& row, std::size_t replicates) {
  UnitSums sums;
  sums.unit = row.texts.front();
  std::size_t at = 0;
  const auto next = [&](double& to) { to = row.numbers.at(at++); };
  for (double* each : {&sums.last_cycle, &sums.cycles, &sums.refused, &sums.repeated}) next(*each);
  for (double& each : sums.outside) next(each);
  for (double* each : {&sums.outside_any, &sums.negative, &sums.energy, &sums.volume,
                       &sums.variance, &sums.settled})
    next(*each);
  for (double& each : sums.inputs) next(each);
  const auto count = static_cast<Eigen::Index>(replicates);
  sums.volumes.resize(count);
  sums.settleds.resize(count);
  for (double& each : sums.volumes) next(each);
  for (double& each : sums.settleds) next(each);
  return sums;
}

UnitForecast::UnitForecast(const WearModel& model, const UnitSums& sums)
    : model_(model), cycles_(sums.cycles), variance_(sums.variance) {
  const Eigen::Index count = 1 + sums.volumes.size();
  for (Eigen::ArrayXd* each : {&volume_, &rate_, &slow_, &fast_, &slow_rate_, &fast_rate_})
    each->resize(count);
  const double duty = sums.energy / sums.cycles;
  for (Eigen::Index b = 0; b < count; ++b) {
    const RunIn& run_in =
        b == 0 ? model.run_in : model.replicates[static_cast<std::size_t>(b - 1)].run_in;
    volume_[b] = b == 0 ? sums.volume : sums.volumes[b - 1];
    rate_[b] = (b == 0 ? sums.settled : sums.settleds[b - 1]) / sums.cycles;
    // A geometric series: the remaining contribution of both modes, if the unit ran for ever.
    const auto left = [&](double share, double scale) {
      return rate_[b] * share * std::exp(-sums.energy / scale) / -std::expm1(-duty / scale);
    };
    slow_[b] = left(run_in.slow, run_in.slow_energy);
    fast_[b] = left(run_in.fast, run_in.fast_energy);
    slow_rate_[b] = duty / run_in.slow_energy;
    fast_rate_[b] = duty / run_in.fast_energy;
  }
}

double UnitForecast::of(std::size_t replicate, double more) const {
  const auto b = static_cast<Eigen::Index>(replicate);
  return volume_[b] + more * rate_[b] - slow_[b] * std::expm1(-more * slow_rate_[b]) -
         fast_[b] * std::expm1(-more * fast_rate_[b]);
}

double UnitForecast::scatter_sd(double more) const {
  return std::sqrt(variance_ * (1 + more / cycles_));
}

double UnitForecast::full_sd(double more) const {
  const Eigen::ArrayXd all = volume_ + more * rate_ + slow_ * (1 - (-more * slow_rate_).exp()) +
                             fast_ * (1 - (-more * fast_rate_).exp());
  const Eigen::Index count = all.size() - 1;
  const double model = count > 0 ? (all.tail(count) - all[0]).square().mean() : 0;
  const double scatter = scatter_sd(more), plate = model_.plate_sd * all[0];
  return std::sqrt(scatter * scatter + model + plate * plate);
}

double UnitForecast::until(double target) const {
  if (volume_[0] >= target) return 0;
  if (!(rate_[0] > 0)) return never;
  const double most = (target - volume_[0]) / rate_[0];  // g >= 1
  return turn(0, most, [&](double n) { return volume(n) - target; });
}

LifeInterval UnitForecast::interval(double target, double (UnitForecast::*sd)(double) const) const {
  const double middle = until(target);
  if (!std::isfinite(middle)) return {0, never};
  const auto beyond = [&](double sign) {
    return
        [this, sign, sd, target](double n) { return volume(n) + sign * 2 * (this->*sd)(n)-target; };
  };
  LifeInterval found{0, never};
  if (beyond(1)(0) < 0) found.low = turn(0, middle, beyond(1));
  const double scale = std::max(middle, std::max(1.0, 1e-3 * cycles_));
  found.high = first_not(middle, scale, farthest * std::max(scale, cycles_), beyond(-1));
  return found;
}

LifeInterval UnitForecast::scatter_interval(double target) const {
  return interval(target, &UnitForecast::scatter_sd);
}
LifeInterval UnitForecast::full_interval(double target) const {
  return interval(target, &UnitForecast::full_sd);
}

UnitForecast::Ahead UnitForecast::ahead(std::size_t b, double more) const {
  const double mean = of(b, more), plate = model_.plate_sd * mean;
  return {mean, std::sqrt(variance_ * (1 + more / cycles_) + plate * plate)};
}

double UnitForecast::Ahead::reached(double target) const {
  if (!(sd > 0)) return mean >= target ? 1 : 0;
  return 0.5 * std::erfc((target - mean) / (sd * std::numbers::sqrt2));
}

}  // namespace wearwell::clutch
