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
#include "wearwell/prognosis/required_lives.h"
#include "wearwell/prognosis/unit_table.h"

namespace wearwell::prognosis {
namespace {

constexpr std::size_t most_populations = 128, fewer_populations = 32;

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
  return represented_lives([&](double p) {
    return std::max(0.0, fresh.quantile(std::min(before + p * (1 - before), 1 - 1e-12)) - age);
  });
}

// The remaining lives of a unit in each population, and their mixture.
KnownUnit unit_of_age(const KnownLives& lives, std::string name, double age, bool counted) {
  KnownUnit unit{std::move(name), age, 0, {}};
  unit.by_age = true;
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
  unit.remaining = PopulationLives(in.remaining, share).mixture();
  if (unit.remaining.points().empty()) return unit;
  unit.in_populations = [in = std::move(in)] { return std::optional(in); };
  return unit;
}

PopulationLives lives_over(const ThinnedPosterior& few, const NamedLife& life) {
  PopulationLives lives(std::vector<WeightedLives>(few.weights.size()), few.weights);
  tbb::parallel_for(std::size_t{0}, few.weights.size(), [&](std::size_t k) {
    const auto x = few.values.row(static_cast<Eigen::Index>(k));
    lives.lives[k] = represented_lives(
        distribution_at(life, {x.data(), static_cast<std::size_t>(x.size())}).quantile);
  });
  return lives;
}

}  // namespace

KnownLives lives_of_study(const PosteriorStudy& study, const WeightedDraws& posterior,
                          const std::string& title, bool trusted, const std::string& point) {
  const std::vector<NamedLife> lives = required_lives(study, title);
  const NamedLife life = life_named(lives, point, "--at");
  const ThinnedPosterior few(posterior, most_populations);
  KnownLives known;
  known.title = title;
  known.noun = without_new(life.request->of);
  known.unit = life.request->unit;
  known.trusted = trusted;
  known.fresh = lives_over(few, life);
  known.populations = few.weights;
  if (posterior.values.rows() > static_cast<Eigen::Index>(most_populations))
    known.fewer = lives_over(ThinnedPosterior(posterior, fewer_populations), life);
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
