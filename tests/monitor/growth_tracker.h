#pragma once

#include <cmath>
#include <cstring>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell {

/// Wear that grows in proportion to time, at a rate that is known as a normal distribution: mean 1 m/h, sd 0.3 m/h before
/// any reading; readings are good to 5 m. Its posterior is two sums, which are added in the order of the readings.
class GrowthUnit : public prognosis::TrackedUnit {
 public:
  /// `rate`: the mean before any reading, m/h.
  explicit GrowthUnit(double rate = 1) : weighted_(rate / (0.3 * 0.3)) {}
  /// A reading of the study at the mean, which says nothing more of the rate.
  void set_study(double hours) { now_ = 3600 * hours; }
  void leave_out() { left_out_ = true; }
  prognosis::UpdateResult update(const prognosis::Reading& reading,
                                 const prognosis::History& history) override {
    const double wear = reading.numbers[0], hours = reading.numbers[1] / 3600;
    prognosis::UpdateResult taken;
    if (left_out_) taken.problem = "no node fits";
    if (left_out_) return taken;
    if (!(hours >= 0)) {
      taken.problem = "time is negative";
      return taken;
    }
    taken.counted = true;
    taken.tails = predictive(reading);
    taken.p_value = 2 * std::min(taken.tails[0].below, taken.tails[0].above);
    taken.contradicts = taken.p_value < 1e-6;
    precision_ += hours * hours / (noise * noise);
    weighted_ += hours * wear / (noise * noise);
    now_ = std::max(now_, reading.numbers[1]);
    ++readings_;
    if (readings_ % 50 == 0) {  // as one that lays its nodes anew
      std::size_t count = 0;
      history([&](const prognosis::Reading&) { ++count; });
      if (count + 1 != readings_) throw std::logic_error("a history of other readings");
    }
    return taken;
  }

  prognosis::Forecast forecast() const override {
    constexpr double z95 = 1.6448536269514722;
    prognosis::Forecast forecast;
    forecast.now = now_;
    forecast.level05 = now_ / 3600 * (mean() - z95 * sd());
    forecast.level50 = now_ / 3600 * mean();
    forecast.level95 = now_ / 3600 * (mean() + z95 * sd());
    prognosis::move_levels(forecast, -restored_);
    std::vector<double> lives, weights;
    double passed = 0, all = 0;
    for (double z = -4; z <= 4; z += 0.25) {
      const double rate = std::max(1e-9, mean() + z * sd()), weight = std::exp(-z * z / 2);
      const double life = 3600 * (limit + restored_) / rate;
      all += weight;
      if (life <= now_) {
        passed += weight;
      } else {
        lives.push_back(life - now_);
        weights.push_back(weight);
      }
    }
    forecast.passed = passed / all;
    if (!lives.empty()) forecast.remaining = prognosis::WeightedLives(lives, weights);
    return forecast;
  }
  std::vector<prognosis::PredictiveTails> predictive(
      const prognosis::Reading& reading) const override {
    const double hours = reading.numbers[1] / 3600;
    const double z = (reading.numbers[0] - mean() * hours) / std::hypot(hours * sd(), noise);
    return {{std::erfc(-z / std::sqrt(2.0)) / 2, std::erfc(z / std::sqrt(2.0)) / 2}};
  }
  std::vector<prognosis::ForecastBand> ahead(std::span<const double> places) const override {
    std::vector<prognosis::ForecastBand> path;
    for (const double each : places) {
      const double hours = each / 3600, off = 1.6448536269514722 * sd();
      path.push_back({each, hours * (mean() - off), hours * mean(), hours * (mean() + off)});
      prognosis::move_levels(path.back(), -restored_);
    }
    return path;
  }
  void set_restored(double amount) override { restored_ = amount; }
  std::size_t readings() const override { return readings_; }

  std::string save() const override {
    std::string bytes(4 * 8, '\0');
    const double values[] = {precision_, weighted_, now_, static_cast<double>(readings_)};
    std::memcpy(bytes.data(), values, bytes.size());
    return bytes;
  }
  static std::unique_ptr<prognosis::TrackedUnit> restore(const std::string& bytes) {
    double values[4];
    if (bytes.size() != sizeof values) throw InputError("no state of a growing unit");
    std::memcpy(values, bytes.data(), sizeof values);
    auto unit = std::make_unique<GrowthUnit>();
    unit->precision_ = values[0];
    unit->weighted_ = values[1];
    unit->now_ = values[2];
    unit->readings_ = static_cast<std::size_t>(values[3]);
    return unit;
  }

  static constexpr double limit = 1000;  // m

 private:
  static constexpr double noise = 5;
  double mean() const { return weighted_ / precision_; }
  double sd() const { return 1 / std::sqrt(precision_); }
  double precision_ = 1 / (0.3 * 0.3), weighted_, now_ = 0;
  std::size_t readings_ = 0;
  double restored_ = 0;
  bool left_out_ = false;
};

/// In units that are their own SI here: wear in metres, so that tests see the numbers that they send.
class GrowthTracker : public prognosis::Tracker {
 public:
  GrowthTracker() = default;
  /// Another fit: another mean rate. Perhaps another threshold, or one without the unit "only".
  explicit GrowthTracker(double rate, double limit = GrowthUnit::limit, std::string refused = {})
      : rate_(rate), refused_(std::move(refused)) {
    limit_.value = limit;
  }
  /// Its study has readings of these units, each the farthest at so many hours.
  void set_study(std::map<std::string, double> hours) {
    study_ = std::move(hours);
    seen_.clear();
    for (const auto& [name, at] : study_) seen_.push_back(name);
  }
  /// Whether readings are counted at all.
  void set_counted(bool counted) { counted_ = counted; }
  std::string refusal(const std::string& unit) const override {
    return !refused_.empty() && unit == refused_ ? "'" + unit + "' is not a unit of this study"
                                                 : "";
  }
  std::span<const prognosis::ReadingColumn> columns() const override { return columns_; }
  std::span<const std::string> labels() const override { return {}; }
  const prognosis::ReadingColumn& axis() const override { return columns_[1]; }
  const std::string& limited() const override { return columns_[0].name; }
  const Quantity& limit() const override { return limit_; }
  bool rising() const override { return true; }
  bool can_be_restored() const override { return true; }
  const std::string& noun() const override { return noun_; }
  std::span<const std::string> seen() const override { return seen_; }
  double probability_error() const override { return 0.01; }
  std::string problem(const prognosis::Reading& reading) const override {
    return reading.numbers[1] >= 0 ? "" : "time is negative";
  }
  std::unique_ptr<prognosis::TrackedUnit> begin(const std::string& name) const override {
    auto unit = std::make_unique<GrowthUnit>(rate_);
    if (!counted_) unit->leave_out();
    if (const auto at = study_.find(name); at != study_.end()) unit->set_study(at->second);
    return unit;
  }
  std::unique_ptr<prognosis::TrackedUnit> restore(const std::string& bytes) const override {
    return GrowthUnit::restore(bytes);
  }

 private:
  double rate_ = 1;
  std::string refused_ = {};
  std::map<std::string, double> study_ = {};
  std::vector<std::string> seen_ = {};
  bool counted_ = true;
  std::vector<prognosis::ReadingColumn> columns_ = {{"wear", read_unit("m", "m"), true},
                                                    {"time", read_unit("h", "s"), false}};
  Quantity limit_ = {GrowthUnit::limit, read_unit("m", "m")};
  std::string noun_ = "machine";
};

}  // namespace wearwell
