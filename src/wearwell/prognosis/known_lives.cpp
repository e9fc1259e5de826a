#include "wearwell/prognosis/known_lives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/heading.h"

namespace wearwell::prognosis {
namespace {

const Column* optional_column(const Table& table, std::string_view name) {
  for (const Column& each : table.columns)
    if (each.name == name) return &each;
  return nullptr;
}

std::string word(const Column* column, std::size_t row) {
  if (!column) return "";
  return column->is_number ? fmt::format("{}", column->numbers[row]) : column->text[row];
}

void refuse_other_columns(const Table& table, const Column& life) {
  for (const Column& each : table.columns) {
    if (&each == &life || each.name == "weight" || each.name == "unit" || each.name == "population")
      continue;
    throw InputError(fmt::format("{}: the column '{}' is none of life, weight, unit, population",
                                 table.source, printable(each.name)));
  }
}

double number_at(const Table& table, const Column& column, std::size_t row, double least) {
  double value = 0;
  if (!column.is_number && (column.text[row] == "inf" || column.text[row] == "never")) {
    value = std::numeric_limits<double>::infinity();
  } else {
    value = cell_number(table, column, row);
  }
  if (!(value >= least))
    throw InputError(fmt::format("{}: {} is not possible; it must be at least {}",
                                 place(table, column.name, row), value, least));
  return value;
}

struct Points {
  std::vector<double> life, weight;
  WeightedLives lives() const { return {life, weight}; }
};

// One place for all is known to the day: what chance leaves is not.
void refuse_one_place(const Table& table, const Points& points) {
  const auto [least, most] = std::minmax_element(points.life.begin(), points.life.end());
  if (*least < *most || !std::isfinite(*least)) return;
  throw InputError(fmt::format(
      "{}: all lives of a new one lie at one place; points of their distribution are wanted, some "
      "hundred of them",
      table.source));
}

double sum(const std::vector<double>& all) {
  double total = 0;
  for (const double each : all) total += each;
  return total;
}

}  // namespace

KnownLives lives_of_table(const Table& table) {
  const Column& life = table.column("life");
  const Heading heading = read_heading(life.name, "");
  KnownLives known;
  known.title = table.source;
  const std::string unit = heading.unit.empty() ? bare_unit(life.unit) : heading.unit;
  if (unit.empty())
    throw InputError(fmt::format(
        "{}: the column '{}' needs its unit in the heading: 'life [h]', 'life [cycles]'",
        table.source, printable(life.name)));
  const auto parsed = parse_unit(unit);
  if (!parsed || !parsed->linear || parsed->offset != 0)
    throw InputError(fmt::format("{}: '{}' of the column '{}' is no unit of a life", table.source,
                                 printable(unit), printable(life.name)));
  known.unit = {unit, parsed->scale, 0};
  refuse_other_columns(table, life);
  const Column* weight = optional_column(table, "weight");
  const Column* name = optional_column(table, "unit");
  const Column* population = optional_column(table, "population");
  std::map<std::string, Points> fresh;
  std::vector<std::pair<std::string, Points>> units;
  std::map<std::string, std::size_t> place_of;
  for (std::size_t row = 0; row < table.rows; ++row) {
    const std::string who = word(name, row);
    if (!who.empty() && place_of.emplace(who, units.size()).second) units.push_back({who, {}});
    Points& points = who.empty() ? fresh[word(population, row)] : units[place_of.at(who)].second;
    points.life.push_back(known.unit.scale * number_at(table, life, row, 0));
    points.weight.push_back(weight ? number_at(table, *weight, row, 0) : 1);
  }
  for (const auto& [_, points] : fresh) {
    if (sum(points.weight) <= 0) continue;
    refuse_one_place(table, points);
    if (known.fresh.lives.empty()) known.fresh.weight.clear();
    known.fresh.lives.push_back(points.lives());
    known.fresh.weight.push_back(sum(points.weight));
  }
  for (const auto& [who, points] : units) {
    if (sum(points.weight) <= 0)
      throw InputError(
          fmt::format("{}: the unit '{}' has no weight", table.source, printable(who)));
    known.units.push_back({who, std::numeric_limits<double>::quiet_NaN(), 0, points.lives()});
  }
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
  WeightedLives lives = tracker.begin(new_name(tracker))->forecast().remaining;
  if (!lives.points().empty()) known.fresh = PopulationLives(std::move(lives));
  return known;
}

KnownUnit known_unit(const std::string& name, const TrackedUnit& unit) {
  Forecast forecast = unit.forecast();
  return {name, forecast.now, forecast.passed, std::move(forecast.remaining)};
}

KnownLives lives_of_tracker(const Tracker& tracker, const std::string& title, bool trusted) {
  KnownLives known = lives_of_new(tracker, title, trusted);
  for (const std::string& each : tracker.seen())
    known.units.push_back(known_unit(each, *tracker.begin(each)));
  return known;
}

}  // namespace wearwell::prognosis
