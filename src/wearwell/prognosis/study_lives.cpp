#include "wearwell/prognosis/study_lives.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit.h"
#include "wearwell/input/status_words.h"
#include "wearwell/predict/thinned_posterior.h"
#include "wearwell/prognosis/named_life.h"
#include "wearwell/prognosis/unit_table.h"

namespace wearwell::prognosis {
namespace {

constexpr std::size_t most_populations = 128;

// Ends of cells of probability: a quarter longer from one to the next in the tails, where the cost
// of a rare failure is decided, and equal between.
std::vector<double> cell_ends() {
  constexpr double first = 1e-7, tail = 0.01, ratio = 1.25;
  constexpr int middle = 150;
  std::vector<double> lower = {0};
  for (double p = first; p < tail; p *= ratio) lower.push_back(p);
  std::vector<double> ends = lower;
  for (int i = 0; i <= middle; ++i) ends.push_back(tail + (1 - 2 * tail) * i / middle);
  for (auto each = lower.rbegin(); each != lower.rend(); ++each) ends.push_back(1 - *each);
  return ends;
}

template <class Quantile>
WeightedLives represented(const Quantile& quantile) {
  static const std::vector<double> ends = cell_ends();
  std::vector<double> life, weight;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    life.push_back(quantile(0.5 * (ends[i - 1] + ends[i])));
    weight.push_back(ends[i] - ends[i - 1]);
  }
  return WeightedLives(life, weight);
}

Unit unit_of(const Table& table, const Column& age, const Unit& like) {
  const std::string text = heading_unit(age);
  if (text.empty())
    throw InputError(fmt::format("{}: the column '{}' needs its unit in the heading: 'age [{}]'",
                                 table.source, printable(age.name), like.text));
  try {
    return read_unit(text, like.text);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}: column '{}': {}", table.source, printable(age.name), error.what()));
  }
}

bool in_study(const Table& table, const Column* column, std::size_t row) {
  if (!column) return false;
  const std::string word = cell_text(column, row);
  const std::optional<bool> truth = truth_in(word);
  if (!truth)
    throw InputError(fmt::format("{}: '{}' is not allowed; use yes or no",
                                 place(table, column->name, row), printable(word)));
  return *truth;
}

// Of a unit that has survived to this age; closer to the distribution than its points beyond.
WeightedLives remaining_at(const WeightedLives& fresh, double age) {
  const double before = fresh.cdf(age);
  if (!(before < 1)) return {};
  return represented([&](double p) {
    return std::max(0.0, fresh.quantile(std::min(before + p * (1 - before), 1 - 1e-12)) - age);
  });
}

// The remaining lives of a unit in each population, and their mixture.
KnownUnit unit_of_age(const KnownLives& lives, std::string name, double age, bool counted) {
  KnownUnit unit{std::move(name), age, 0, {}};
  InPopulations in;
  std::vector<double> share;
  for (std::size_t k = 0; k < lives.populations.size(); ++k) {
    const WeightedLives& fresh = lives.fresh.lives[k];
    const double survival = 1 - fresh.cdf(age);
    in.log_likelihood.push_back(counted ? 0 : std::log(survival));
    in.passed.push_back(0);
    in.remaining.push_back(remaining_at(fresh, age));
    share.push_back(lives.populations[k] * (counted ? 1 : survival));
  }
  const WeightedLives mixture = PopulationLives(in.remaining, share).mixture();
  if (mixture.points().empty()) return unit;
  unit.remaining = represented([&](double p) { return mixture.quantile(p); });
  unit.in_populations = [in = std::move(in)] { return std::optional(in); };
  return unit;
}

}  // namespace

WeightedLives represented_lives(const LifeDistribution& lives) {
  return represented(lives.quantile);
}

KnownLives lives_of_study(const PosteriorStudy& study, const WeightedDraws& posterior,
                          const std::string& title, bool trusted, const std::string& point) {
  const std::vector<NamedLife> lives = named_lives(study);
  if (lives.empty())
    throw InputError(fmt::format("{}: the study has no life of a new unit", title));
  const NamedLife life = life_named(lives, point, "--at");
  const ThinnedPosterior few(posterior, most_populations);
  KnownLives known;
  known.title = title;
  known.noun = without_new(life.request->of);
  known.unit = life.request->unit;
  known.trusted = trusted;
  known.fresh = PopulationLives(std::vector<WeightedLives>(few.weights.size()), few.weights);
  known.populations = few.weights;
  tbb::parallel_for(std::size_t{0}, few.weights.size(), [&](std::size_t k) {
    const auto x = few.values.row(static_cast<Eigen::Index>(k));
    known.fresh.lives[k] =
        represented_lives(distribution_at(life, {x.data(), static_cast<std::size_t>(x.size())}));
  });
  return known;
}

void add_units_in_service(KnownLives& lives, const Table& table) {
  const Column& name = table.column("unit");
  const Column& age = table.column("age");
  const Column* counted = optional_column(table, "in_study");
  refuse_other_columns(table, {&name, &age, counted}, "unit, age, in_study");
  const Unit unit = unit_of(table, age, lives.unit);
  std::set<std::string> known;
  for (std::size_t row = 0; row < table.rows; ++row) {
    const std::string who = cell_text(&name, row);
    if (who.empty() || !known.insert(who).second)
      throw InputError(fmt::format(
          "{}: {}", place(table, name.name, row),
          known.count(who) ? "the unit '" + printable(who) + "' has a row already" : "is empty"));
    const double value = cell_number(table, age, row);
    if (!(value >= 0))
      throw InputError(
          fmt::format("{}: {} must be at least 0", place(table, age.name, row), value));
    KnownUnit each = unit_of_age(lives, who, value * unit.scale, in_study(table, counted, row));
    if (each.remaining.points().empty())
      throw InputError(fmt::format("{}: by this study no unit survives to {}",
                                   place(table, age.name, row), value));
    lives.units.push_back(std::move(each));
  }
}

}  // namespace wearwell::prognosis
