#include "wearwell/models/clutch/fleet_counts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/workers.h"
#include "wearwell/models/clutch/energy_balance.h"

namespace wearwell::clutch {

FleetCounts::FleetCounts(const WearModel& model, bool replicates, std::vector<double> levels,
                         std::vector<double> horizons, std::vector<double> days)
    : model_(model),
      models_(1 + (replicates ? model.replicates.size() : 0)),
      levels_(std::move(levels)),
      horizons_(std::move(horizons)),
      days_(std::move(days)),
      sums_(levels_.size() * (horizons_.size() + days_.size()) * models_) {}

std::vector<UnitRow> FleetCounts::add(std::span<const UnitSums> units,
                                      std::span<const double> per_day, int threads) {
  for (const UnitSums& each : units) {
    if (!std::isfinite(each.volume) || !std::isfinite(each.variance) ||
        !each.volumes.isFinite().all())
      throw InputError(fmt::format("unit {} has no finite wear", printable(each.unit)));
  }
  std::vector<UnitRow> rows(units.size());
  constexpr std::size_t together = 64;
  std::mutex mutex;
  run_tasks(static_cast<int>((units.size() + together - 1) / together), threads, [&](int task) {
    const std::size_t from = static_cast<std::size_t>(task) * together;
    std::vector<Sum> sums(sums_.size());
    for (std::size_t i = from; i < std::min(units.size(), from + together); ++i)
      rows[i] = forecast(units[i], per_day.empty() ? NAN : per_day[i], sums);
    const std::lock_guard lock(mutex);
    for (std::size_t s = 0; s < sums.size(); ++s) {
      sums_[s].mean += sums[s].mean;
      sums_[s].variance += sums[s].variance;
    }
  });
  for (const UnitSums& each : units) describe(each);
  return rows;
}

/// The cases that need no forecast.
void FleetCounts::describe(const UnitSums& sums) {
  ++units_;
  for (std::size_t i = 0; i < 4; ++i) {
    duty_[i].push_back(static_cast<float>(sums.inputs[i] / sums.cycles));
    outside_[i] += sums.outside[i];
  }
  duty_[4].push_back(static_cast<float>(sums.energy / sums.cycles));
  balance(sums);
  worn_.push_back(static_cast<float>(sums.volume / model_.worn_out));
  cycles_ += sums.cycles;
  energy_ += std::llround(sums.energy / energy_unit);
  outside_any_ += sums.outside_any;
  negative_ += sums.negative;
  units_outside_ += sums.outside_any > 0;
}

void FleetCounts::balance(const UnitSums& sums) {
  volume_ += sums.volume;
  OperatingPoint mean;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    mean.*inputs[i].value = sums.inputs[i] / sums.cycles;
  const EnergyBalance energy{sums.energy / sums.cycles, closing_energy(mean)};
  if (energy.is_plausible()) return;
  ++implausible_.units;
  implausible_.volume += sums.volume;
  const auto distance = [](double ratio) { return std::abs(std::log(ratio)); };
  const double farther = distance(energy.ratio()) - distance(implausible_.ratio);
  if (implausible_.worst.empty() || farther > 0 ||
      (farther == 0 && sums.unit < implausible_.worst)) {
    implausible_.worst = sums.unit;
    implausible_.ratio = energy.ratio();
  }
}

UnitRow FleetCounts::forecast(const UnitSums& sums, double per_day,
                              std::vector<Sum>& reached) const {
  const UnitForecast forecast(model_, sums);
  for (std::size_t h = 0; h < horizons_.size() + days_.size(); ++h) {
    const double more = h < horizons_.size() ? horizons_[h] : days_[h - horizons_.size()] * per_day;
    for (std::size_t b = 0; b < models_; ++b) {
      const UnitForecast::Ahead ahead = forecast.ahead(b, more);
      for (std::size_t l = 0; l < levels_.size(); ++l) {
        const double p = ahead.reached(levels_[l] * model_.worn_out);
        Sum& sum = reached[place(l, h) + b];
        sum.mean += std::llround(p / probability_unit);
        sum.variance += std::llround(p * (1 - p) / probability_unit);
      }
    }
  }
  UnitRow row{sums.unit, sums.cycles, sums.energy, sums.volume};
  row.sd = forecast.scatter_sd(0);
  row.full_sd = forecast.full_sd(0);
  row.left = forecast.until(model_.worn_out);
  row.scatter = forecast.scatter_interval(model_.worn_out);
  row.full = forecast.full_interval(model_.worn_out);
  const double to_go = model_.worn_out - sums.volume;
  row.reached = row.full_sd > 0 ? 0.5 * std::erfc(to_go / (row.full_sd * std::numbers::sqrt2))
                                : (to_go <= 0 ? 1.0 : 0.0);
  row.outside_any = sums.outside_any;
  row.negative = sums.negative;
  row.per_day = per_day;
  return row;
}

UnitCount FleetCounts::reached(std::size_t level, std::size_t horizon) const {
  const Sum* const sums = &sums_[place(level, horizon)];
  const auto mean = [&](std::size_t b) {
    return static_cast<double>(sums[b].mean) * probability_unit;
  };
  UnitCount count{mean(0)};
  const std::size_t first = models_ > 1 ? 1 : 0;
  // The cdf of the mixture at x.
  const auto below = [&](double x) {
    double share = 0;
    for (std::size_t b = first; b < models_; ++b) {
      const double sd = std::sqrt(static_cast<double>(sums[b].variance) * probability_unit);
      share += sd > 0 ? 0.5 * std::erfc((mean(b) - x) / (sd * std::numbers::sqrt2))
                      : (x >= mean(b) ? 1.0 : 0.0);
    }
    return share / static_cast<double>(models_ - first);
  };
  const auto quantile = [&](double p) {
    double low = 0, high = static_cast<double>(units_);
    for (int i = 0; i < 100 && high - low > 1e-9 * high; ++i) {
      const double half = 0.5 * (low + high);
      (below(half) < p ? low : high) = half;
    }
    // A bracket that contains the estimate may be as narrow as rounding: where all replicates agree
    // it is the interval's end.
    return low <= count.expected && count.expected <= high ? count.expected : 0.5 * (low + high);
  };
  constexpr double tail = 0.025;
  // The model itself is not one of its replicates: where its count lies beyond theirs, the interval
  // reaches to it.
  count.low = std::min(quantile(tail), count.expected);
  count.high = std::max(quantile(1 - tail), count.expected);
  return count;
}

}  // namespace wearwell::clutch
