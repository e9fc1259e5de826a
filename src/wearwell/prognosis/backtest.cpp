#include "wearwell/prognosis/backtest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/columns.h"
#include "wearwell/prognosis/reading_table.h"

namespace wearwell::prognosis {
namespace {

double median(std::vector<double> all) {
  if (all.empty()) return std::nan("");
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return *middle;
}

struct Followed {
  std::unique_ptr<TrackedUnit> unit;
  std::vector<Reading> history;
  std::set<std::pair<std::vector<double>, std::vector<std::string>>> known;
};

Hindcast hindcast(const std::string& name, const Followed& followed, double life) {
  const Forecast now = followed.unit->forecast();
  Hindcast one;
  one.unit = name;
  one.readings = followed.history.size();
  one.at = now.now;
  one.life = life;
  const auto at = [&](double p) {  // of all, including those past their failure threshold
    if (p <= now.passed || now.remaining.points().empty()) return now.now;
    return now.now + now.remaining.quantile((p - now.passed) / (1 - now.passed));
  };
  one.q05 = at(0.05);
  one.q50 = at(0.5);
  one.q95 = at(0.95);
  one.place = now.remaining.points().empty()
                  ? 1
                  : now.passed + (1 - now.passed) * now.remaining.cdf(life - now.now);
  return one;
}

HeldAt summary(const std::string& age, const std::vector<const Hindcast*>& all) {
  HeldAt held;
  held.age = age;
  held.forecasts = all.size();
  std::set<std::string> units;
  std::vector<double> width, error;
  for (const Hindcast* each : all) {
    units.insert(each->unit);
    held.held += each->held();
    const double left = each->life - each->at;
    width.push_back((each->q95 - each->q05) / left);
    error.push_back(std::abs(each->q50 - each->life) / left);
  }
  held.units = units.size();
  held.width = median(width);
  held.error = median(error);
  const double n = static_cast<double>(held.units), spread = 1.96 * std::sqrt(0.09 / n);
  held.low = std::max(0.0, 0.9 - spread);
  held.high = std::min(1.0, 0.9 + spread);
  return held;
}

std::vector<HeldAt> by_age(const std::vector<Hindcast>& all) {
  static constexpr std::pair<std::size_t, std::size_t> ages[] = {
      {1, 1}, {2, 2}, {3, 4}, {5, 9}, {10, 19}, {20, 39}, {40, 79}, {80, ~std::size_t{0}}};
  std::vector<HeldAt> result;
  for (const auto& [from, to] : ages) {
    std::vector<const Hindcast*> these;
    for (const Hindcast& each : all)
      if (each.readings >= from && each.readings <= to) these.push_back(&each);
    if (these.empty()) continue;
    result.push_back(summary(from == to  ? fmt::format("{}", from)
                             : to > 1000 ? fmt::format("{} and more", from)
                                         : fmt::format("{} to {}", from, to),
                             these));
  }
  std::vector<const Hindcast*> every;
  for (const Hindcast& each : all) every.push_back(&each);
  if (!every.empty()) result.push_back(summary("all", every));
  return result;
}

}  // namespace

Backtest backtest(const Tracker& tracker, const Table& readings,
                  const std::map<std::string, double>& lives) {
  const Column& units = readings.column(tracker.noun());
  const ReadingTable rows(tracker, readings);
  Backtest result;
  std::map<std::string, Followed> fleet;
  std::map<std::string, std::vector<Hindcast>> hindcasts;
  for (std::size_t row = 0; row < readings.rows; ++row) {
    const std::string name = unit_name(units, row);
    Followed& followed = fleet[name];
    if (!followed.unit) followed.unit = tracker.begin(name);
    Reading reading = rows.reading(row);
    const bool complete = std::none_of(reading.numbers.begin(), reading.numbers.end(),
                                       [](double x) { return std::isnan(x); });
    if (complete && !followed.known.emplace(reading.numbers, reading.labels).second) {
      ++result.repeated;
      continue;
    }
    const UpdateResult taken = followed.unit->update(reading, [&](const auto& visit) {
      for (const Reading& each : followed.history) visit(each);
    });
    if (!taken.counted) {
      if (result.refused++ == 0)
        result.first_refused = fmt::format("{}: {}", row_name(row + 1, 0), taken.problem);
      continue;
    }
    ++result.readings;
    result.contradicting += taken.contradicts;
    followed.history.push_back(std::move(reading));
    const auto life = lives.find(name);
    if (life == lives.end()) continue;
    Hindcast one = hindcast(name, followed, life->second);
    if (one.at < life->second) hindcasts[name].push_back(std::move(one));
  }
  result.units = fleet.size();
  for (const auto& [name, _] : fleet) result.without_life += !lives.contains(name);
  for (auto& [_, of_unit] : hindcasts)
    for (Hindcast& each : of_unit) result.hindcasts.push_back(std::move(each));
  result.ages = by_age(result.hindcasts);
  return result;
}

Backtest backtest(const Tracker& tracker, const Table& readings, const Table& lives) {
  Backtest test = backtest(tracker, readings, lives_by_unit(tracker, lives));
  if (test.hindcasts.empty())
    throw InputError(
        fmt::format("{}: no unit of {} has a known end there", lives.source, readings.source));
  return test;
}

std::map<std::string, double> lives_by_unit(const Tracker& tracker, const Table& table) {
  const Column& units = table.column(tracker.noun());
  const NumberColumn life = number_column(table, {"life", tracker.axis().unit, false});
  std::map<std::string, double> lives;
  for (std::size_t row = 0; row < table.rows; ++row) {
    const double at = to_si(life.unit, cell_number(table, *life.column, row));
    if (std::isnan(at)) continue;  // it has not ended
    if (!lives.emplace(unit_name(units, row), at).second)
      throw InputError(fmt::format("{}: {} has two lives", place(table, units.name, row),
                                   printable(unit_name(units, row))));
  }
  return lives;
}

}  // namespace wearwell::prognosis
