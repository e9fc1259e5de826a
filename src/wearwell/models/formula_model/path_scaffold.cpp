#include "wearwell/models/formula_model/path_scaffold.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"
#include "wearwell/input/prior.h"
#include "wearwell/models/formula_model/scaffold_parts.h"
#include "wearwell/models/formula_model/straight_line.h"
#include "wearwell/study/column_values.h"

namespace wearwell::formula_model {
namespace {

using Found = ColumnRoles::Found;

bool has_named_measure(const ColumnRoles& roles) {
  return roles.has({"depth", "volume", "mass", "crack", "measured"});
}

// A degradation path found in a table, and what its study needs.
struct Path {
  Found axis, measured;
  std::optional<Found> unit;
  std::string axis_name, measured_name, unit_name, line_name, columns;
  std::string axis_unit, measured_unit;
};

// The measured column, if no heading marks it: the only remaining numeric column.
bool has_lone_measure(ColumnRoles& roles) {
  return has_units(roles) && !has_named_measure(roles);
}

// A threshold of another dimension than the measured quantity is ignored.
void require_limit(const ColumnRoles& roles, const Found& measured) {
  if (roles.choices().limit.empty()) return;
  try {
    read_quantity(roles.choices().limit, measured.unit);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("--limit, of column '{}': {}", measured.column->name, error.what()));
  }
}

std::optional<Path> take_path(ColumnRoles& roles, bool with_force) {
  const bool chosen = roles.choices().columns.contains("measured");
  const bool named = has_named_measure(roles) || chosen;
  if (!has_axis(roles) || !(named || has_lone_measure(roles)) || roles.has({"life", "response"}))
    return {};
  roles.refuse_status();
  Path path;
  std::optional<Found> measured;
  if (named) measured = roles.take("", {"depth", "volume", "mass", "crack", "measured"});
  const auto axis = take_axis(roles, "");
  if (!axis) return {};
  path.axis = *axis;
  path.axis_name = axis->role->name;
  path.axis_unit = counting_unit(*axis);
  if (!with_force) {
    path.unit = take_units(roles, *axis->column);
  } else if (has_units(roles)) {
    path.unit = roles.take("unit", {"unit"});
  }
  if (!measured) {
    const auto others = roles.other_numbers();
    if (others.empty()) return {};
    measured = roles.take_column("measured", *others.front(), role_form("measured"));
    if (others.size() > 1) {
      TableQuestion question{fmt::format("Which column of {} is the measured one?", roles.file()),
                             {}};
      for (const Column* each : others) {
        question.readings.push_back({fmt::format("'{}'", each->name),
                                     {"--column", fmt::format("measured={}", each->name)}});
      }
      roles.questions.push_back(std::move(question));
    } else {
      roles.guesses.push_back(
          fmt::format("column '{}' is assumed to be the measured one: it is the only one left",
                      measured->column->name));
    }
  }
  path.measured = *measured;
  require_limit(roles, *measured);
  path.measured_unit = measured->unit;
  path.measured_name = measured->role->name == "measured" ? name_of(*measured->column, "measured")
                                                          : std::string(measured->role->name);
  path.line_name =
      measured->role->name == "crack" || measured->role->name == "measured" ? "path" : "wear";
  if (path.unit) path.unit_name = name_of(*path.unit->column, "unit");
  path.columns =
      column_line(path.axis_name, path.axis) + ColumnRoles::line(path.measured_name, path.measured);
  if (path.unit)
    path.columns += fmt::format("{} = {}    # the unit of each reading\n", path.unit_name,
                                toml_text(path.unit->column->name));
  return path;
}

double largest(const Table& table, const Column& column) {
  double result = 0;
  for (const double each : values_of(table, column)) result = std::max(result, std::abs(each));
  return result > 0 ? result : 1;
}

// Sections of all such studies with a random effect.
std::string study_text(const ColumnRoles& roles, const Path& path, const std::string& title,
                       const std::string& columns, const std::string& model,
                       const std::string& parameter, const std::string& priors) {
  const Table& table = roles.table();
  const double sigma = rounded_up(largest(table, *path.measured.column));
  const double last = largest(table, *path.axis.column);
  const std::string limit =
      roles.choices().limit.empty()
          ? fmt::format("# limit = {{ {} = {} }}    # STATE THE FAILURE THRESHOLD to get lives\n",
                        path.line_name, toml_text(quantity_text(2 * sigma, path.measured_unit)))
          : fmt::format(
                "limit = {{ {} = {} }}    # lives, and remaining useful lives of each unit\n",
                path.line_name, toml_text(roles.choices().limit));
  const std::string random_effects =
      !path.unit ? ""
                 : fmt::format(
                       "\n"
                       "[random_effects.{0}]    # random effects: {1} varies from unit to unit\n"
                       "{1} = {{ distribution = \"lognormal\", log_sd = \"scatter\" }}\n",
                       path.unit_name, parameter);
  return fmt::format(
      "title = {}\n"
      "model = \"formula\"\n\n"
      "{}[data.columns]\n"
      "{}\n"
      "{}\n"
      "[likelihood.{}]\n"
      "family = \"normal\"                        # readings scatter about the path; for random "
      "increments see docs/reference/degradation.md\n"
      "mean   = \"{}\"\n"
      "sd     = \"sigma\"\n\n"
      "# Prior knowledge: PROPOSED as weak priors from the size of the data. Replace them with "
      "what you know.\n"
      "[prior]\n"
      "{}sigma = {{ distribution = \"half-normal\", scale = {} }}    # scatter of a reading, up to "
      "the size "
      "of the measured values\n"
      "{}{}\n"
      "[predict]\n"
      "along = \"{}\"\n"
      "at = [{}]    # twice the largest value in the data\n"
      "{}",
      toml_text(title + ", from " + roles.file()), roles.data_section(), columns, model,
      path.measured_name, path.line_name, priors,
      toml_text(quantity_text(sigma, path.measured_unit)),
      path.unit
          ? "scatter = { distribution = \"half-normal\", scale = 1 }    # most units are within a "
            "factor of ten\n"
          : "",
      random_effects, path.axis_name, toml_text(quantity_text(2 * last, path.axis_unit)), limit);
}

void say_limit(ColumnRoles& roles) {
  if (roles.choices().limit.empty())
    roles.guesses.emplace_back(
        "no failure threshold is given: wear is fitted, and no life is predicted; give it with "
        "--limit, or as [predict] limit");
}

void say_others(ColumnRoles& roles) {
  std::vector<std::string> names;
  for (const Column* each : roles.other_numbers()) names.push_back("'" + each->name + "'");
  if (names.empty()) return;
  roles.guesses.push_back(
      fmt::format("the rate is assumed not to depend on {}; to model that dependence write your "
                  "own formula (docs/reference/formula-models.md)",
                  fmt::join(names, ", ")));
}

bool needs_unit(const Path& path) {
  return path.measured.unit != "1";
}

}  // namespace

std::optional<Scaffold> wear_scaffold(ColumnRoles& roles) {
  if (!roles.has({"depth", "volume", "mass"}) || !roles.has({"force", "pressure"})) return {};
  const auto load = roles.find({"force", "pressure"});
  const bool steady = [&] {
    const auto unit = roles.find({"unit"});
    return !differs_within(roles.table(), *load->column,
                           unit && repeats(roles.table(), *unit->column) ? unit->column : nullptr);
  }();
  if (!steady) return {};
  const auto by_time = [&] {
    return !roles.has({"distance"}) && !roles.has({"cycles"}) && roles.has({"time"}) &&
           roles.has({"velocity"});
  }();
  auto path = take_path(roles, true);
  if (!path || !needs_unit(*path)) return {};
  const Found force = *roles.take(std::string(load->role->name), {load->role->name});
  const std::string name(force.role->name);
  std::string columns = path->columns + ColumnRoles::line(name, force);
  std::string formula = fmt::format("k * {} * {}", name, path->axis_name);
  std::vector<std::string> under = {force.unit, path->axis_unit};
  double product =
      largest(roles.table(), *force.column) * largest(roles.table(), *path->axis.column);
  if (by_time) {
    const Found speed = *roles.take("velocity", {"velocity"});
    columns += ColumnRoles::line("velocity", speed);
    formula += " * velocity";
    under.push_back(speed.unit);
    product *= largest(roles.table(), *speed.column);
  }
  say_limit(roles);
  say_others(roles);
  const double k = rounded_up(largest(roles.table(), *path->measured.column) / product);
  const std::string unit = unit_of_ratio(path->measured_unit, under);
  std::string text = study_text(
      roles, *path, "Wear law", columns,
      fmt::format("[formula]                                    # the simplest formula: "
                  "Archard's law, proportional to {0} and {1}\n"
                  "{2} = \"{3}\"\n"
                  "# {2} = \"k * {0}^a * {1}^b\" and the like: divide by a unit first, "
                  "(force/1 [N])^a (docs/reference/formula-language.md)\n",
                  name, path->axis_name, path->line_name, formula),
      "k",
      fmt::format("k = {{ distribution = \"lognormal\", median = {}, log_sd = 2 }}    # a factor "
                  "of 27 to either side\n",
                  toml_text(quantity_text(k, unit))));
  if (differs(roles.table(), *force.column))
    text += fmt::format(
        "given = {{ {} = {} }}    # GUESS: the largest tested; state the value in use\n", name,
        toml_text(quantity_text(largest(roles.table(), *force.column), force.unit)));
  return roles.study("wear law: wear proportional to " + name + " and " + path->axis_name,
                     ReadingFit::general, std::move(text));
}

std::optional<Scaffold> first_degradation_study(ColumnRoles& roles) {
  const auto path = take_path(roles, false);
  if (!path) return {};
  const StraightLine line = straight_line(roles.table(), *path->axis.column, *path->measured.column,
                                          path->unit ? path->unit->column : nullptr);
  say_limit(roles);
  say_others(roles);
  const std::string rate_unit = unit_of_ratio(path->measured_unit, {path->axis_unit});
  const std::string sign = line.falls ? "-" : "";
  const std::string before = line.begins_at_zero ? sign : line.falls ? "start - " : "start + ";
  const std::string formula = fmt::format("{}rate * {}", before, path->axis_name);
  std::string priors = fmt::format(
      "rate = {{ distribution = \"lognormal\", median = {}, log_sd = 2 }}    # a factor of 27 to "
      "either "
      "side\n",
      toml_text(quantity_text(rounded_up(line.rate), rate_unit)));
  if (!line.begins_at_zero) {
    const double size = rounded_up(largest(roles.table(), *path->measured.column));
    priors += fmt::format(
        "start = {{ distribution = \"normal\", mean = {}, sd = {} }}    # initial value of a "
        "path\n",
        toml_text(quantity_text(size / 2, path->measured_unit)),
        toml_text(quantity_text(size, path->measured_unit)));
    roles.guesses.push_back(
        fmt::format("readings of '{}' do not start at 0: the path is start {} rate * {}",
                    path->measured.column->name, line.falls ? "-" : "+", path->axis_name));
  }
  const std::string model = fmt::format(
      "[formula]                                    # the simplest path: a straight line\n"
      "{0} = \"{1}\"\n"
      "# {0} = \"{5}rate * ({2}/1 [{3}])^p\"    # for wear that slows down or speeds up; rate in "
      "{4}; "
      "p needs a prior\n",
      path->line_name, formula, path->axis_name, path->axis_unit, path->measured_unit, before);
  return roles.study(fmt::format("degradation: {} along {}{}", path->measured_name, path->axis_name,
                                 path->unit ? " with unit-to-unit variation" : ""),
                     roles.has({"force", "pressure"}) ? ReadingFit::possible : ReadingFit::general,
                     study_text(roles, *path, "Degradation", path->columns, model, "rate", priors));
}

}  // namespace wearwell::formula_model
