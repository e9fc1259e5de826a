#include "wearwell/models/formula_model/formula_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/models/formula_model/formula_process_lives.h"
#include "wearwell/models/formula_model/limit_group.h"
#include "wearwell/study/numerical_error.h"

namespace wearwell::formula_model {
namespace {

// At the start values of searches, from the beginning to twice the last row.
void require_monotone(const Asked& asked, const TomlReader& table, const std::string& name,
                      LimitedPath& path) {
  constexpr std::size_t points = 64;
  const NumberColumn& axis = asked.axis();
  PathAt at(*path.next);
  at.move_to(asked.start.data());
  std::vector<double> place, value;
  for (std::size_t i = 1; i <= points; ++i) {
    place.push_back(path.begin + 2 * path.scale * static_cast<double>(i) / points);
  }
  at.evaluate(points, nullptr, place.data());
  double size = 0;
  for (std::size_t i = 0; i < points; ++i) {
    value.push_back(at.output(0, i));
    if (std::isfinite(value[i])) size = std::max(size, std::abs(value[i]));
  }
  for (std::size_t i = 1; i < points; ++i) {
    if (value[i] == value[i - 1]) continue;  // also a crack that has grown without bound
    const double step = value[i] - value[i - 1];
    if ((path.rising ? step : -step) >= -1e-9 * size) continue;
    table.fail(name, fmt::format("{} first {} and then {} with {} (near {:.4g} {}): it may reach a "
                                 "threshold more than once, so its life is ambiguous",
                                 name, path.rising ? "grows" : "falls",
                                 path.rising ? "falls" : "grows", *asked.model->along,
                                 from_si(axis.unit.unit, place[i]), axis.unit.unit.text));
  }
  if (value.back() == value.front()) {
    table.fail(name, fmt::format("{} does not change with {}: it never reaches a threshold", name,
                                 *asked.model->along));
  }
}

// Lives of all units are computed together.
std::optional<InputError> too_many_lives(const Asked& asked) {
  constexpr std::size_t most = 500;
  return too_many_units(asked, "limit", "lives_of", "remaining useful life", "10 MB", most);
}

// Each unit of the study, and a new one; with predict.lives_of only those, with an empty list only
// the new one.
void add_units(const Asked& asked, const TomlReader& table, const std::string& name,
               const std::vector<formula::Wanted>& wanted, LimitedPath& path) {
  const std::vector<std::string>& units = asked.model->units;
  const bool only = asked.predict.has("lives_of");
  const std::vector<std::string> reported = asked.predict.texts("lives_of");
  for (const std::string& each : reported) {
    if (std::find(units.begin(), units.end(), each) == units.end()) {
      asked.predict.fail("lives_of", fmt::format("the data have no {} '{}'{}", asked.noun, each,
                                                 did_you_mean(each, units)));
    }
  }
  // Of units that are too many only the names are needed, which a question on one of them finds.
  const bool names_only = too_many_lives(asked).has_value();
  for (std::size_t u = 0; u < units.size(); ++u) {
    if (only && std::find(reported.begin(), reported.end(), units[u]) == reported.end()) continue;
    path.seen.push_back(names_only ? LimitedPath::SeenUnit{{}, {}, asked.last_place(u), u}
                                   : seen_unit(asked, table, name, wanted, u));
  }
  if (!reported.empty()) path.next.reset();
}

using Lives = std::function<LimitedLives(const WeightedDraws&, double share_of_points)>;

void request_lives(const Asked& asked, const std::string& name, const Quantity& limit,
                   const std::shared_ptr<const LimitedPath>& path, const LimitWishes& reported,
                   const Lives& lives_of, PosteriorStudy& study) {
  const auto rows = std::make_shared<const LimitGroup>(asked, name, limit, path, reported);
  // The study itself is read without a refusal: for one of its units, or with tests that are planned.
  if (const auto refusal = too_many_lives(asked)) {
    study.refusal = refusal;
    study.quantity_groups.push_back(
        {rows->requests(),
         [refusal](const WeightedDraws&) -> std::vector<QuantityQuantiles> {
           throw InputError(*refusal);
         },
         [refusal](const WeightedDraws&) -> std::vector<PredictiveLife> {
           throw InputError(*refusal);
         }});
    return;
  }
  const auto coarse = [=](const LimitedLives& lives, const WeightedDraws& draws) {
    return lives.over_all ? std::nullopt : std::optional(lives_of(draws, fewer_points));
  };
  study.quantity_groups.push_back({rows->requests(),
                                   [=](const WeightedDraws& draws) {
                                     const LimitedLives lives = lives_of(draws, 1);
                                     return rows->answers(lives, coarse(lives, draws));
                                   },
                                   [=](const WeightedDraws& draws) {
                                     const LimitedLives lives = lives_of(draws, 1);
                                     return rows->predictive(lives, coarse(lives, draws));
                                   }});
}

// A first passage has a known distribution if variances are proportional to means.
void require_proportion(const Asked& asked, const TomlReader& table, const std::string& name,
                        const LimitedPath& path) {
  PathAt at(*path.next);
  at.move_to(asked.start.data());
  const double places[] = {path.begin, path.begin + 0.3 * path.scale, path.begin + path.scale,
                           path.begin + 3 * path.scale};
  at.evaluate(4, nullptr, places);
  const auto ratio = [&](std::size_t i) {
    return at.output(1, i) * at.output(1, i) / std::abs(at.output(0, i));
  };
  const bool begins = at.output(0, 0) == 0 && at.output(1, 0) == 0;
  const double size = ratio(2);
  if (begins && std::abs(ratio(1) - size) < 1e-6 * size &&
      std::abs(ratio(3) - size) < 1e-6 * size) {
    return;
  }
  table.fail(name,
             "reaches its threshold at a time whose distribution is known only if the variance, "
             "sd^2, is proportional to the mean from the start: give scale instead of sd, or sd as "
             "a constant times the square root of the mean");
}

// In a study of a process the threshold must be of the process.
void read_process_limit(const Asked& asked, const TomlReader& limits, const std::string& name,
                        PosteriorStudy& study) {
  const std::vector<Measured>& all = asked.model->measured;
  auto asked_for = std::make_shared<ProcessLimit>();
  while (asked_for->column < all.size() &&
         !(all[asked_for->column].process && all[asked_for->column].column == name)) {
    ++asked_for->column;
  }
  if (asked_for->column == all.size()) {
    std::string columns;
    for (const Measured& each : all) {
      if (each.process) columns = joined(columns, each.column);
    }
    limits.fail(name, fmt::format("is not a process: thresholds of this study are of {}, whose "
                                  "paths are random around their means",
                                  columns));
  }
  const Measured& measured = all[asked_for->column];
  const std::vector<formula::Wanted> wanted(measured.wanted.begin(), measured.wanted.begin() + 2);
  LimitedPath& path = asked_for->path;
  path.next = make_path(asked.model, limits, name, wanted, true, asked.common);
  const Quantity limit = limits.required_quantity(name, formula::si_text(measured.powers));
  path.limit = limit.si();
  set_reach(asked, path);
  require_monotone(asked, limits, name, path);
  if (!(path.rising ? path.limit > 0 : path.limit < 0)) {
    limits.fail(name,
                fmt::format("must lie {} 0, the start of paths, since their mean {}",
                            path.rising ? "above" : "below", path.rising ? "grows" : "falls"));
  }
  if (measured.process->by_sd) require_proportion(asked, limits, name, path);
  add_units(asked, limits, name, wanted, path);
  // Each continues from its mean.
  for (LimitedPath::SeenUnit& each : path.seen) each.behind.reset();
  const LimitWishes reported = read_limit_wishes(asked, path);
  const std::shared_ptr<const ProcessLimit> known = asked_for;
  request_lives(
      asked, name, limit, {known, &known->path}, reported,
      [rows = asked.rows, known](const WeightedDraws& draws, double share_of_points) {
        return process_lives(*rows, *known, draws, share_of_points);
      },
      study);
}

}  // namespace

std::optional<InputError> too_many_units(const Asked& asked, const std::string& key,
                                         const std::string& choice, const std::string& what,
                                         const std::string& size, std::size_t most) {
  const std::vector<std::string>& units = asked.model->units;
  if (asked.predict.has(choice) || units.size() <= most) return {};
  try {
    asked.predict.fail(
        key,
        fmt::format("the data have {} units of '{}', and the {} of each takes about {} of "
                    "memory; without a choice at most {} are computed: {} = [\"{}\"] chooses "
                    "some, {} = [] only a new one",
                    units.size(), asked.noun, what, size, most, choice, units.front(), choice));
  } catch (const InputError& error) {
    return error;
  }
}

void set_reach(const Asked& asked, LimitedPath& path) {
  const NumberColumn& axis = asked.axis();
  const double least = *std::min_element(axis.values.begin(), axis.values.end());
  const double most = *std::max_element(axis.values.begin(), axis.values.end());
  path.begin = path.next->goes_on() ? path.next->running->begin : std::min(0.0, least);
  path.scale = most > path.begin ? most - path.begin : 1;
  PathAt at(*path.next);
  at.move_to(asked.start.data());
  const double places[] = {path.begin + path.scale / 32, path.begin + 2 * path.scale};
  at.evaluate(2, nullptr, places);
  path.rising = at.output(0, 1) >= at.output(0, 0);
}

LimitedPath::SeenUnit seen_unit(const Asked& asked, const TomlReader& table, const std::string& key,
                                const std::vector<formula::Wanted>& wanted, std::size_t unit) {
  const Conditions own = conditions_of_unit(*asked.model, unit, {});
  const Conditions ahead = conditions_of_unit(*asked.model, unit, asked.given);
  LimitedPath::SeenUnit seen;
  seen.ahead = make_path(asked.model, table, key, wanted, true, ahead, unit);
  const auto differs = [&](const auto& of_own, const auto& of_ahead, const std::string& name) {
    const auto a = of_own.find(name), b = of_ahead.find(name);
    return a != of_own.end() && b != of_ahead.end() && a->second != b->second;
  };
  bool same = true;
  for (std::size_t c = 0; c < seen.ahead->symbols.columns.size(); ++c) {
    if (!seen.ahead->program.uses_column(c)) continue;
    same &= !differs(own.numbers, ahead.numbers, seen.ahead->symbols.columns[c].name);
  }
  for (std::size_t c = 0; c < seen.ahead->symbols.labels.size(); ++c) {
    if (!seen.ahead->program.uses_label(c)) continue;
    same &= !differs(own.labels, ahead.labels, seen.ahead->symbols.labels[c].name);
  }
  if (!same && !seen.ahead->goes_on()) {
    seen.behind = make_path(asked.model, table, key, wanted, true, own, unit);
  }
  seen.now = asked.last_place(unit);
  seen.unit = unit;
  return seen;
}

void read_limit(const Asked& asked, PosteriorStudy& study) {
  const TomlReader limits = asked.predict.required_table("limit");
  const std::vector<std::string> names = limits.keys();
  if (names.size() != 1) {
    limits.fail(names.empty() ? "" : names[1],
                "needs exactly one failure threshold: limit = { wear = \"100 um\" }");
  }
  const std::string& name = names.front();
  if (asked.model->has_process()) return read_process_limit(asked, limits, name, study);
  const std::vector<formula::Wanted> wanted = {{"[predict] limit", name}};
  auto path = std::make_shared<LimitedPath>();
  path->next = make_path(asked.model, limits, name, wanted, true, asked.common);
  const formula::Powers powers = path->next->program.outputs()[0].powers;
  const Quantity limit = limits.required_quantity(name, formula::si_text(powers));
  path->limit = limit.si();
  set_reach(asked, *path);
  require_monotone(asked, limits, name, *path);
  if (asked.model->label || path->next->goes_on()) add_units(asked, limits, name, wanted, *path);
  const LimitWishes reported = read_limit_wishes(asked, *path);
  const std::shared_ptr<const LimitedPath> known = path;
  request_lives(
      asked, name, limit, known, reported,
      [rows = asked.rows, known](const WeightedDraws& draws, double share_of_points) {
        return limited_lives(*rows, *known, draws, share_of_points);
      },
      study);
}

}  // namespace wearwell::formula_model
