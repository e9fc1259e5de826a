#pragma once

#include <algorithm>
#include <atomic>
#include <boost/math/distributions/normal.hpp>
#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "wearwell/monitor/fleet_view.h"

namespace wearwell::monitor {

/// Machines whose wear is in proportion to their hours, at rates that differ: log rate ~ N(mu, tau^2), and a
/// reading y at t hours has log(y / t) ~ N(log rate, s^2). All is in closed form: what a server shows of them
/// is right, not pretended.
class GeneratedFleet : public FleetReader, public Inbox {
 public:
  explicit GeneratedFleet(std::size_t units, unsigned seed = 17) : engine_(seed) {
    static constexpr const char* odd[] = {"<img src=x onerror=alert(1)>", "hall 2/line 7 100%",
                                          "Pumpe Süd \"3\" \\ µ", "never heard of"};
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < units; ++i) {
      Unit unit;
      unit.name = i < std::size(odd) && units > 8 ? odd[i] : "M" + std::to_string(1000 + i);
      unit.rate = std::exp(mu + tau * normal(engine_));
      const int readings = unit.name == "never heard of" ? 0 : 3 + static_cast<int>(i % 23);
      const double step = (20 + 20 * std::abs(normal(engine_))) * (1 + i % 4);
      for (int j = 0; j < readings; ++j) {
        take(&unit, step * (j + 1), now_ms() - (readings - j) * 3'600'000LL);
      }
      if (i % 11 == 5) unit.silent = true;
      if (i % 17 == 9)
        unit.doubt =
            "the last 4 readings lie above the forecast; the rate has changed (3.0 times the "
            "earlier "
            "one), or the sensor has";
      unit.beyond = i % 34 == 9;
      if (i % 13 == 7) unit.quality.last_problem = "line 3: wear = \"n/a\" is no number";
      unit.quality.refused = i % 13 == 7 ? 2 : 0;
      units_.push_back(std::move(unit));
    }
    last_ms_ = now_ms();
  }

  /// A unit works on and reports; -1: one by chance.
  std::string advance(int which = -1, double hours = 40) {
    const std::scoped_lock lock(mutex_);
    Unit& unit = units_.at(which >= 0 ? which : engine_() % units_.size());
    take(&unit, unit.at + hours, now_ms());
    unit.silent = false;
    changed(&unit);
    return unit.name;
  }

  std::atomic<bool> away = false;  ///< what a store does that cannot be reached
  std::atomic<int> asked = 0;      ///< answers of `units` and `unit`

  FleetView fleet() const override {
    const std::scoped_lock lock(mutex_);
    FleetView view;
    view.title = "Pumps of hall 2";
    view.noun = "machine";
    view.axis = "running time";
    view.axis_unit = "h";
    view.limited = "wear";
    view.level_unit = "um";
    view.limit = limit;
    view.horizon = horizon;
    view.units = units_.size();
    for (const Unit& each : units_) {
      const Alarm alarm = alarm_of(each);
      ++(alarm == Alarm::ok      ? view.ok
         : alarm == Alarm::watch ? view.watch
         : alarm == Alarm::act   ? view.act
         : alarm == Alarm::doubt ? view.doubt
                                 : view.unknown);
    }
    view.messages = messages_;
    view.stored = messages_;
    view.now_ms = now_ms();
    view.started_ms = started_ms_;
    view.fit = {"0123456789abcdef0123456789abcdef01234567", started_ms_ - 86'400'000, started_ms_};
    view.webhook = WebhookView{12, 3, 0};
    view.last_message_ms = last_ms_;
    return view;
  }

  std::vector<UnitView> units(const std::string& search, std::size_t offset, std::size_t count,
                              std::uint64_t* matching) const override {
    const std::scoped_lock lock(mutex_);
    ++const_cast<GeneratedFleet*>(this)->asked;
    std::vector<std::pair<double, const Unit*>> found;
    for (const Unit& each : units_) {
      if (lower(each.name).find(lower(search)) == std::string::npos) continue;
      const double least = each.beyond ? 1 : each.doubt.empty() ? 0 : 0.3;
      found.emplace_back(-std::max(risk_of(each), least), &each);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    if (matching) *matching = found.size();
    std::vector<UnitView> views;
    for (std::size_t i = offset; i < found.size() && views.size() < count; ++i) {
      views.push_back(view_of(*found[i].second));
    }
    return views;
  }

  std::optional<UnitDetail> unit(const std::string& name) const override {
    const std::scoped_lock lock(mutex_);
    ++const_cast<GeneratedFleet*>(this)->asked;
    const auto at = std::find_if(units_.begin(), units_.end(),
                                 [&](const Unit& each) { return each.name == name; });
    if (at == units_.end()) return {};
    UnitDetail detail{view_of(*at), {at->moments.begin(), at->moments.end()}, {}, {}, at->held,
                      at->judged};
    const double end = std::max(at->at * 1.15, std::min(life(*at, z95), 3 * life(*at, 0)));
    for (int i = 0; i <= 80; ++i) {
      const double t = end * i / 80;
      detail.path.push_back({t, level(*at, t)});
    }
    for (int i = 0; i <= 80; ++i) {
      const double x = std::max(remaining(*at, 0.995), 10.0) * i / 80;
      detail.survival.push_back({x, 1 - reached(*at, x)});
    }
    return detail;
  }

  std::optional<UnitView> view(const std::string& name) const override {
    const std::scoped_lock lock(mutex_);
    const auto at = std::find_if(units_.begin(), units_.end(),
                                 [&](const Unit& each) { return each.name == name; });
    if (at == units_.end()) return {};
    return view_of(*at);
  }

  /// Nine units, whose remaining useful life is forecast a tenth longer than before.
  std::vector<MovedForecast> moved(std::size_t offset, std::size_t count,
                                   std::uint64_t* all) const override {
    const std::scoped_lock lock(mutex_);
    constexpr std::size_t most = 9;
    std::vector<MovedForecast> moved;
    if (all) *all = std::min(most, units_.size());
    for (std::size_t i = offset; i < std::min(most, units_.size()) && moved.size() < count; ++i) {
      const UnitView now = view_of(units_[i]);
      const Interval& to = now.remaining;
      moved.push_back({now.unit,
                       now.last_key,
                       "h",
                       {Alarm::watch, true, {to.q05 / 1.1, to.q50 / 1.1, to.q95 / 1.1}, now.risk},
                       {now.alarm, true, to, now.risk}});
    }
    return moved;
  }

  std::uint64_t version() const override { return version_; }

  std::vector<std::string> changed_since(std::uint64_t version) const override {
    const std::scoped_lock lock(mutex_);
    std::vector<std::string> names;
    for (const Unit& each : units_) {
      if (each.version > version) names.push_back(each.name);
    }
    return names;
  }

  /// Why events in the last delivery are refused.
  std::string no_events() const {
    const std::scoped_lock lock(mutex_);
    return no_events_;
  }

  /// Lines of {"unit": "M1003", "at": 1200, "wear": 31.5}.
  using Inbox::deliver;
  Delivery deliver(const std::string& topic, const std::string& payload,
                   const std::string& no_events) override {
    {
      const std::scoped_lock lock(mutex_);
      no_events_ = no_events;
    }
    if (away) return {false, 0, 0, 0, "the store cannot be reached"};
    Delivery delivery{true, 0, 0, 0, ""};
    if (!topic.empty() && !view(topic) && payload.find("installed") == payload.npos) {
      delivery.unknown_unit = true;
      delivery.refused = 1;
      delivery.problem = "'" + topic + "' is not a unit; report \"installed\" first";
      return delivery;
    }
    std::istringstream lines(payload);
    for (std::string line; std::getline(lines, line);) {
      const auto json = nlohmann::json::parse(line, nullptr, false);
      const std::scoped_lock lock(mutex_);
      const auto at = std::find_if(units_.begin(), units_.end(), [&](const Unit& each) {
        return json.is_object() && json.contains("unit") && json["unit"] == each.name;
      });
      if (at == units_.end() || !json.contains("at") || !json["at"].is_number() ||
          !json.contains("wear") || !json["wear"].is_number()) {
        ++delivery.refused;
        if (delivery.problem.empty())
          delivery.problem = "\"" + line.substr(0, 40) + "\" is no reading";
        continue;
      }
      count(&*at, json["at"], json["wear"], now_ms());
      changed(&*at);
      ++delivery.readings;
    }
    return delivery;
  }

 private:
  static constexpr double limit = 80, horizon = 500, tau = 0.45, s = 0.18, z95 = 1.6448536269514722;
  inline static const double mu = std::log(80.0 / 4000);

  struct Unit {
    std::string name;
    double rate = 0, at = 0, sum = 0;
    int n = 0;
    bool silent = false, beyond = false;
    std::string doubt = {};
    std::int64_t last_ms = 0;
    std::uint64_t version = 0, held = 0, judged = 0;
    std::deque<UnitMoment> moments = {};
    Quality quality = {};
  };

  static std::int64_t now_ms() {
    using namespace std::chrono;
    return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
  }
  static std::string lower(std::string text) {
    for (char& each : text) each = each >= 'A' && each <= 'Z' ? each + 32 : each;
    return text;
  }
  static double variance(const Unit& unit) { return 1 / (1 / (tau * tau) + unit.n / (s * s)); }
  static double mean(const Unit& unit) {
    return variance(unit) * (mu / (tau * tau) + unit.sum / (s * s));
  }
  static double rate(const Unit& unit, double z) {
    return std::exp(mean(unit) + z * std::sqrt(variance(unit)));
  }
  static double life(const Unit& unit, double z) { return limit / rate(unit, -z); }
  static Interval level(const Unit& unit, double t) {
    return {t * rate(unit, -z95), t * rate(unit, 0), t * rate(unit, z95)};
  }
  /// P(life > t).
  static double after(const Unit& unit, double t) {
    if (t <= 0) return 1;
    const double z = (std::log(t / limit) + mean(unit)) / std::sqrt(variance(unit));
    return boost::math::cdf(boost::math::complement(boost::math::normal(), z));
  }
  static double passed(const Unit& unit) { return 1 - after(unit, unit.at); }
  /// P(life <= at + x | life > at).
  static double reached(const Unit& unit, double x) {
    return 1 - after(unit, unit.at + x) / std::max(1e-300, after(unit, unit.at));
  }
  static double remaining(const Unit& unit, double p) {
    const double left = std::max(1e-300, after(unit, unit.at)) * (1 - p);
    const boost::math::normal normal;
    return life(unit, boost::math::quantile(boost::math::complement(normal, left))) - unit.at;
  }
  static double risk_of(const Unit& unit) { return 1 - after(unit, unit.at + horizon); }
  static Alarm alarm_of(const Unit& unit) {
    if (unit.silent || unit.n == 0) return Alarm::unknown;
    const double risk = risk_of(unit);
    if (unit.beyond) return Alarm::act;
    if (!unit.doubt.empty() && risk <= 0.3) return Alarm::doubt;
    return risk > 0.3 ? Alarm::act : risk > 0.05 ? Alarm::watch : Alarm::ok;
  }

  UnitView view_of(const Unit& unit) const {
    UnitView view;
    view.unit = unit.name;
    view.alarm = alarm_of(unit);
    view.at = unit.at;
    view.last_reading_ms = unit.last_ms;
    view.level = level(unit, unit.at);
    view.remaining = {remaining(unit, 0.05), remaining(unit, 0.5), remaining(unit, 0.95)};
    if (unit.n == 0) view.remaining.q95 = std::numeric_limits<double>::infinity();
    view.b10 = remaining(unit, 0.1);
    view.risk = risk_of(unit);
    view.passed = passed(unit);
    view.doubt = unit.doubt;
    view.beyond = unit.beyond;
    view.quality = unit.quality;
    return view;
  }

  void take(Unit* unit, double t, std::int64_t ms) {
    std::normal_distribution<double> normal;
    count(unit, t, t * unit->rate * std::exp(s * normal(engine_)), ms);
  }

  void count(Unit* unit, double t, double y, std::int64_t ms) {
    const double wide = z95 * std::sqrt(variance(*unit) + s * s);
    ++unit->judged;
    if (std::abs(std::log(y / t) - mean(*unit)) <= wide) ++unit->held;
    unit->sum += std::log(y / t);
    ++unit->n;
    unit->at = std::max(unit->at, t);
    unit->last_ms = last_ms_ = ms;
    ++unit->quality.readings;
    unit->moments.push_back(
        {ms, t, y, level(*unit, t), {life(*unit, -z95), life(*unit, 0), life(*unit, z95)}});
    if (unit->moments.size() > 300) unit->moments.pop_front();
    ++messages_;
  }
  void changed(Unit* unit) { unit->version = ++version_; }

  mutable std::mutex mutex_;
  std::string no_events_;
  std::mt19937_64 engine_;
  std::vector<Unit> units_;
  std::atomic<std::uint64_t> version_ = 1;
  std::uint64_t messages_ = 0;
  std::int64_t started_ms_ = now_ms(), last_ms_ = 0;
};

}  // namespace wearwell::monitor
