#include "wearwell/prognosis/known_lives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/prognosis/unit_table.h"

namespace wearwell::prognosis {
namespace {

double number_at(const Table& table, const Column& column, std::size_t row, double least) {
  double value = 0;
  if (!column.is_number && (column.text[row] == "inf" || column.text[row] == "never")) {
    value = std::numeric_limits<double>::infinity();
  } else {
    value = cell_number(table, column, row);
  }
  if (!(value >= least))
    throw InputError(
        fmt::format("{}: {} must be at least {}", place(table, column.name, row), value, least));
  return value;
}

struct TabledPoints {
  std::vector<double> life, weight;
  WeightedLives lives() const { return {life, weight}; }
};

const History nothing_read = [](const std::function<void(const Reading&)>&) {};

// A point mass would leave no randomness.
void refuse_one_place(const Table& table, const TabledPoints& points) {
  const auto [least, most] = std::minmax_element(points.life.begin(), points.life.end());
  if (*least < *most || !std::isfinite(*least)) return;
  throw InputError(fmt::format(
      "{}: all lives of a new unit are equal; give points of their distribution, some hundred",
      table.source));
}

double sum(const std::vector<double>& all) {
  double total = 0;
  for (const double each : all) total += each;
  return total;
}

using Populations = std::map<std::string, TabledPoints>;

struct TabledUnit {
  std::string name;
  Populations rows;  // by population
  bool apart() const { return rows.size() > 1 || !rows.begin()->first.empty(); }
  TabledPoints together() const {
    TabledPoints all;
    for (const auto& [_, points] : rows) {
      all.life.insert(all.life.end(), points.life.begin(), points.life.end());
      all.weight.insert(all.weight.end(), points.weight.begin(), points.weight.end());
    }
    return all;
  }
};

using Shares = std::map<std::string, double>;

Shares shares_of(const Populations& rows) {
  Shares shares;
  double all = 0;
  for (const auto& [name, points] : rows) all += shares[name] = sum(points.weight);
  for (auto& [_, share] : shares) share /= all;
  return shares;
}

double share_in(const Shares& shares, const std::string& population) {
  const auto at = shares.find(population);
  return at == shares.end() ? 0 : at->second;
}

// A population is equally likely for every unit: its weight contains the readings of all units.
void refuse_other_shares(const Table& table, const TabledUnit& unit, const Shares& fresh) {
  const Shares of_unit = shares_of(unit.rows);
  Shares named = fresh;
  named.insert(of_unit.begin(), of_unit.end());
  for (const auto& [name, _] : named) {
    const double own = share_in(of_unit, name), all = share_in(fresh, name);
    if (std::abs(own - all) <= 1e-6) continue;
    throw InputError(
        fmt::format("{}: the population '{}' has weight {:.6g} for the unit '{}' and {:.6g} for "
                    "new units; units share the population, so give it the same weight in each, or "
                    "leave out the population in all rows of that unit",
                    table.source, printable(name), own, printable(unit.name), all));
  }
}

// The shared population of running units, if their rows give it.
void add_populations(const Table& table, const std::vector<TabledUnit>& units,
                     const Populations& fresh, KnownLives& known) {
  if (std::none_of(units.begin(), units.end(), [](const auto& each) { return each.apart(); }))
    return;
  const Shares shares = shares_of(fresh);
  for (const auto& [_, share] : shares) {
    if (share > 0) known.populations.push_back(share);
  }
  const std::size_t count = known.populations.size();
  for (std::size_t u = 0; u < units.size(); ++u) {
    InPopulations unit{std::vector<double>(count), std::vector<double>(count), {}};
    if (units[u].apart()) {
      refuse_other_shares(table, units[u], shares);
      for (const auto& [_, points] : units[u].rows)
        if (sum(points.weight) > 0) unit.remaining.push_back(points.lives());
    } else {
      unit.remaining.assign(count, known.units[u].remaining);
    }
    known.units[u].in_populations = [unit = std::move(unit)] { return std::optional(unit); };
  }
}

KnownUnit unit_of_rows(const Table& table, const TabledUnit& unit) {
  const TabledPoints points = unit.together();
  if (sum(points.weight) <= 0)
    throw InputError(
        fmt::format("{}: the unit '{}' has zero total weight", table.source, printable(unit.name)));
  return {unit.name, std::numeric_limits<double>::quiet_NaN(), 0, points.lives()};
}

}  // namespace

KnownLives lives_of_table(const Table& table) {
  const Column& life = table.column("life");
  KnownLives known;
  known.title = table.source;
  const std::string unit = heading_unit(life);
  if (unit.empty())
    throw InputError(fmt::format(
        "{}: the column '{}' needs its unit in the heading: 'life [h]', 'life [cycles]'",
        table.source, printable(life.name)));
  const auto parsed = parse_unit(unit);
  if (!parsed || !parsed->linear || parsed->offset != 0)
    throw InputError(fmt::format("{}: '{}' of the column '{}' is not a unit of a life",
                                 table.source, printable(unit), printable(life.name)));
  known.unit = {unit, parsed->scale, 0};
  const Column* weight = optional_column(table, "weight");
  const Column* name = optional_column(table, "unit");
  const Column* population = optional_column(table, "population");
  refuse_other_columns(table, {&life, weight, name, population}, "life, weight, unit, population");
  Populations fresh;
  std::vector<TabledUnit> units;
  std::map<std::string, std::size_t> place_of;
  for (std::size_t row = 0; row < table.rows; ++row) {
    const std::string who = cell_text(name, row);
    if (!who.empty() && place_of.emplace(who, units.size()).second) units.push_back({who, {}});
    Populations& rows = who.empty() ? fresh : units[place_of.at(who)].rows;
    TabledPoints& points = rows[cell_text(population, row)];
    points.life.push_back(known.unit.scale * number_at(table, life, row, 0));
    points.weight.push_back(weight ? number_at(table, *weight, row, 0) : 1);
    if (!std::isfinite(points.weight.back()))
      throw InputError(fmt::format("{}: {} must be finite", place(table, weight->name, row),
                                   points.weight.back()));
  }
  for (const auto& [_, points] : fresh) {
    if (sum(points.weight) <= 0) continue;
    refuse_one_place(table, points);
    if (known.fresh.lives.empty()) known.fresh.weight.clear();
    known.fresh.lives.push_back(points.lives());
    known.fresh.weight.push_back(sum(points.weight));
  }
  for (const TabledUnit& each : units) known.units.push_back(unit_of_rows(table, each));
  add_populations(table, units, fresh, known);
  return known;
}

std::string new_name(const Tracker& tracker) {
  const auto seen = tracker.seen();
  std::string name = "new";
  while (std::find(seen.begin(), seen.end(), name) != seen.end()) name += " one";
  return name;
}

KnownLives lives_of_new(const Tracker& tracker, const std::string& title, bool trusted) {
  KnownLives known;
  known.title = title;
  known.noun = tracker.noun();
  known.axis = tracker.axis().name;
  known.unit = tracker.axis().unit;
  known.trusted = trusted;
  const auto fresh = tracker.begin(new_name(tracker));
  known.populations = tracker.populations();
  if (std::optional<InPopulations> apart = fresh->in_populations(nothing_read)) {
    known.fresh = PopulationLives(std::move(apart->remaining), known.populations);
  } else if (WeightedLives lives = fresh->forecast().remaining; !lives.points().empty()) {
    known.fresh = PopulationLives(std::move(lives));
  }
  return known;
}

KnownUnit known_unit(const std::string& name, std::shared_ptr<const TrackedUnit> unit,
                     History history) {
  Forecast forecast = unit->forecast();
  return {name, forecast.now, forecast.passed, std::move(forecast.remaining),
          [unit = std::move(unit), history = std::move(history)] {
            return unit->in_populations(history ? history : nothing_read);
          }};
}

KnownLives lives_of_tracker(const Tracker& tracker, const std::string& title, bool trusted) {
  KnownLives known = lives_of_new(tracker, title, trusted);
  for (const std::string& each : tracker.seen())
    known.units.push_back(known_unit(each, tracker.begin(each)));
  return known;
}

}  // namespace wearwell::prognosis
