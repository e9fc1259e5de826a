#include "wearwell/models/formula_model/life_stress.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "wearwell/present/plot.h"
#include "wearwell/study/plot_study.h"

namespace wearwell::formula_model {
namespace {

using Numbers = std::vector<double>;

constexpr std::size_t stress_points = 24, most_stress_columns = 3;
// If units vary, a quantile is the root of a mixture.
constexpr Eigen::Index stress_draws = 400, stress_draws_of_units = 80;

// Equal but for the rounding of units.
bool is_same(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

// Whether all but one column have the values of `held`.
bool is_held(const Conditions& own, const Conditions& held, const std::string& column) {
  return own.labels == held.labels &&
         std::all_of(held.numbers.begin(), held.numbers.end(), [&](const auto& each) {
           return each.first == column || is_same(own.numbers.at(each.first), each.second);
         });
}

// The conditions of use as far as the study states them, otherwise the most frequent ones.
Conditions conditions_of_use(const FormulaModel& model, const Conditions& most,
                             const Conditions& given) {
  Conditions use = most;
  for (auto& [name, value] : use.numbers) {
    if (const auto stated = given.numbers.find(name); stated != given.numbers.end())
      value = stated->second;
  }
  for (auto& [name, level] : use.labels) {
    const auto stated = given.labels.find(name);
    // One level more than the data have is a new one, which has no name of its own.
    if (stated != given.labels.end() &&
        static_cast<std::size_t>(stated->second) < model.data.label(name)->levels.size())
      level = stated->second;
  }
  return use;
}

std::string words_of_held(const FormulaModel& model, const Conditions& held,
                          const std::string& column) {
  std::string words;
  const auto add = [&](const std::string& each) { words += (words.empty() ? "" : ", ") + each; };
  for (const auto& [name, value] : held.numbers) {
    if (name == column) continue;
    const Unit& unit = model.data.number(name)->unit.unit;
    const std::string in = html::unit(unit.text);
    add(fmt::format("{} = {}{}{}", name, html::given(from_si(unit, value)),
                    in.empty() ? "" : "\u00a0", in));
  }
  for (const auto& [name, level] : held.labels)
    add(fmt::format("{} = {}", name,
                    model.data.label(name)->levels[static_cast<std::size_t>(level)]));
  return words;
}

// By decades if it spans one.
bool is_logarithmic(const Numbers& at) {
  return at.front() > 0 && at.back() >= 10 * at.front();
}

std::vector<double> spread_over(double low, double high) {
  Numbers at;
  for (std::size_t i = 0; i < stress_points; ++i) {
    const double share = static_cast<double>(i) / (stress_points - 1);
    at.push_back(is_logarithmic({low, high}) ? low * std::pow(high / low, share)
                                             : std::lerp(low, high, share));
  }
  return at;
}

struct Markers {
  Numbers x, y;
};

void add_points(const Markers& points, const char* shape, const plot::Look& look,
                std::vector<plot::Json>& marks) {
  if (points.x.empty()) return;
  marks.push_back(
      plot::arrows({{"x", points.x}, {"y", points.y}, {"life", points.y}}, shape, look));
}

}  // namespace

std::vector<LifeStress> life_stresses(const TomlReader& root,
                                      const std::shared_ptr<const FormulaModel>& model,
                                      const std::vector<LifeGroup>& groups) {
  std::vector<LifeStress> stresses;
  if (groups.empty()) return stresses;
  const auto most = std::max_element(
      groups.begin(), groups.end(),
      [](const auto& a, const auto& b) { return a.responses.size() < b.responses.size(); });
  Conditions given;
  if (const auto predict = root.table("predict")) {
    if (const auto table = predict->table("given")) given = read_conditions(*table, *model);
  }
  const Conditions held = conditions_of_use(*model, most->conditions, given);
  for (const auto& [name, value] : held.numbers) {
    if (stresses.size() == most_stress_columns) break;
    LifeStress stress{name, held, {}, {}, {}};
    stress.of_use = !is_held(most->conditions, held, name);
    std::set<double> values;
    for (const LifeGroup& group : groups) {
      const bool there = is_held(group.conditions, held, name);
      if (there) stress.tested.push_back(group);
      if (there || stress.of_use) values.insert(group.conditions.numbers.at(name));
    }
    if (values.size() < 2 || std::isnan(*values.begin())) continue;
    double low = *values.begin(), high = *values.rbegin();
    if (const auto asked = given.numbers.find(name); asked != given.numbers.end()) {
      low = std::min(low, asked->second);
      high = std::max(high, asked->second);
    }
    for (std::size_t i = 0; given.varied && i < given.varied->conditions.size(); ++i) {
      const VariedCondition& each = given.varied->conditions[i];
      if (each.column != name) continue;
      low = std::min(low, each.quantile(0.01));
      high = std::max(high, each.quantile(0.99));
      stress.of_units = description(each);
    }
    stress.held.words = words_of_held(*model, held, name);
    stress.at = spread_over(low, high);
    for (const double at : stress.at) {
      Conditions there = held;
      there.numbers[name] = at;
      stress.lives.push_back(life_distribution(root, "likelihood", model, there));
    }
    stresses.push_back(std::move(stress));
  }
  return stresses;
}

html::Figure life_stress_figure(const FormulaModel& model, const LifeStress& stress,
                                const Fit& fit) {
  const Measured& measured = model.measured.front();
  const NumberColumn& column = *model.data.number(stress.column);
  const bool positive = measured.form->positive;
  const WeightedDraws draws =
      thinned(fit.exact ? fit.exact->nodes : fit.pooled,
              model.has_random_effects() ? stress_draws_of_units : stress_draws);
  struct Row {
    double low, middle, high, b10;
  };
  std::vector<Row> rows(stress.at.size());
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
    const QuantityDistribution median = stress.lives[i]->quantile(draws, 0.5).distribution;
    rows[i] = {median.quantile(0.05), median.quantile(0.5), median.quantile(0.95),
               stress.lives[i]->quantile(draws, 0.1).distribution.quantile(0.5)};
  });
  Numbers x, low, middle, high, b10;
  double least = INFINITY, largest = -INFINITY;
  const auto cover = [&](double life) {
    if (!std::isfinite(life) || (positive && !(life > 0))) return;
    least = std::min(least, life);
    largest = std::max(largest, life);
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    if (positive && !(row.low > 0 && row.b10 > 0)) continue;  // dead on arrival
    if (!std::isfinite(row.low) || !std::isfinite(row.high) || !std::isfinite(row.b10)) continue;
    x.push_back(from_si(column.unit.unit, stress.at[i]));
    low.push_back(from_si(measured.unit, row.low));
    middle.push_back(from_si(measured.unit, row.middle));
    high.push_back(from_si(measured.unit, row.high));
    b10.push_back(from_si(measured.unit, row.b10));
    cover(middle.back());
    cover(b10.back());
  }
  Markers failed, went_on;
  bool dead = false;
  for (const LifeGroup& group : stress.tested) {
    for (const Response& each : group.responses) {
      const bool above = each.seen == Censoring::right;
      const double life = each.seen == Censoring::interval ? 0.5 * (each.at + each.until) : each.at;
      if (positive && !(life > 0)) {
        dead = true;
        continue;
      }
      Markers& points = above ? went_on : failed;
      points.x.push_back(from_si(column.unit.unit, group.conditions.numbers.at(stress.column)));
      points.y.push_back(from_si(measured.unit, life));
      cover(points.y.back());
    }
  }
  std::vector<plot::Json> marks = {
      plot::area({{"x", x}, {"y", high}, {"y2", low}},
                 {plot::colour::posterior, "90 % of the median life", 0.3}),
      plot::line({{"x", x}, {"y", middle}, {stress.column, x}, {"median life", middle}},
                 {plot::colour::posterior, "median life", 1, 2}),
      plot::line({{"x", x}, {"y", b10}, {stress.column, x}, {"B10", b10}},
                 {plot::colour::limit, "B10", 1, 1.5, true})};
  add_points(failed, "circle", {plot::colour::measured, "failures", 1, 0, false, 50}, marks);
  add_points(went_on, "triangle-up", {plot::colour::chains[2], "run-outs", 1, 0, false, 60}, marks);
  const auto title = [](const std::string& name, const Unit& unit) {
    const std::string text = html::unit(unit.text);
    return html::capital(name) + (text.empty() ? "" : fmt::format(" [{}]", text));
  };
  plot::Axis lives{title(measured.column, measured.unit), positive};
  if (positive && least < INFINITY) {
    lives.low = least / 1.5;
    lives.high = largest * 1.5;
  }
  const double one = from_si(column.unit.unit, stress.at.front());
  const double other = from_si(column.unit.unit, stress.at.back());
  const bool by_decades = is_logarithmic({std::min(one, other), std::max(one, other)});
  const double room = by_decades ? 0 : 0.03 * std::abs(other - one);
  const double factor = by_decades ? 1.1 : 1;
  return {"life-stress-" + stress.column, fmt::format("Life against {}", stress.column),
          fmt::format("Posterior medians of the life that half of all outlast, and of B10{}.{}",
                      stress.held.words.empty() ? "" : ", at " + stress.held.words,
                      went_on.x.empty() ? "" : " Arrows: not failed by then.") +
              (stress.of_use && stress.tested.empty()
                   ? " These are the conditions of use; no observation was made under them."
                   : "") +
              (dead ? " Parts dead on arrival have no point." : "") +
              (stress.of_units.empty() ? "" : " In use " + stress.of_units + " over the units."),
          plot::plot(fmt::format("{} against {}", html::capital(measured.column), stress.column),
                     {title(stress.column, column.unit.unit), by_decades,
                      std::min(one, other) / factor - room, std::max(one, other) * factor + room},
                     lives, marks, 340, true)};
}

}  // namespace wearwell::formula_model
