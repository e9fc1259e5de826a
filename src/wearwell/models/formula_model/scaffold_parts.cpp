#include "wearwell/models/formula_model/scaffold_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "wearwell/base/unit_system.h"
#include "wearwell/input/columns.h"
#include "wearwell/study/column_values.h"
#include "wearwell/study/heading_words.h"

namespace wearwell::formula_model {
namespace {

constexpr std::string_view axes[] = {"distance", "revolutions", "cycles", "time"};

bool is_plain_unit(const std::string& unit) {
  return std::all_of(unit.begin(), unit.end(), [](char each) {
    const auto u = static_cast<unsigned char>(each);
    return std::isalnum(u) || each == '^' || u >= 0x80;
  });
}

std::string factor(const std::string& unit) {
  return is_plain_unit(unit) ? unit : "(" + unit + ")";
}

// Several rows of each unit, and none without a name: remarks are excluded.
bool may_be_units(const Table& table, const Column& column) {
  for (std::size_t i = 0; i < table.rows; ++i) {
    if (cell_word(column, i).empty()) return false;
  }
  return 2 * kinds_of(table, column).size() <= table.rows;
}

bool rises_throughout(const Table& table, const Column& axis) {
  const std::vector<double> at = numbers_of(table, axis);
  return std::adjacent_find(at.begin(), at.end(), [](double a, double b) { return !(b > a); }) ==
         at.end();
}

}  // namespace

std::string quantity_text(double value, const std::string& unit) {
  if (unit.empty() || unit == "1") return fmt::format("{:.6g}", value);
  const std::size_t blank = unit.find(' ');
  // "1000 km" and "10^3 km": the factor goes into the number.
  if (std::isdigit(static_cast<unsigned char>(unit.front())) && blank != unit.npos) {
    const auto factor = parse_unit(unit.substr(0, blank));
    if (factor && factor->dimension.empty())
      return quantity_text(value * factor->scale, unit.substr(blank + 1));
  }
  return fmt::format("{:.6g} {}", value, unit);
}

std::string unit_of_ratio(const std::string& over, const std::vector<std::string>& under) {
  std::string below;
  int count = 0;
  for (const std::string& each : under) {
    if (each == "1" || each.empty()) continue;
    below += (below.empty() ? "" : " ") + factor(each);
    ++count;
  }
  if (count == 0) return over;
  return fmt::format(fmt::runtime(count > 1 ? "{}/({})" : "{}/{}"), factor(over), below);
}

bool has_axis(const ColumnRoles& roles) {
  return std::any_of(std::begin(axes), std::end(axes),
                     [&](std::string_view each) { return roles.has({each}); });
}

std::optional<ColumnRoles::Found> take_axis(ColumnRoles& roles, const std::string& key) {
  std::vector<ColumnRoles::Found> found;
  for (const std::string_view each : axes) {
    const auto chosen = roles.choices().columns.find(std::string(each));
    if (chosen != roles.choices().columns.end() && !chosen->second.empty())
      return roles.take(key.empty() ? std::string(each) : key, {each});
    const auto one = roles.find({each});
    if (one && differs(roles.table(), *one->column)) found.push_back(*one);
  }
  if (found.empty()) return {};
  if (found.size() > 1) {
    TableQuestion question{
        fmt::format("Which column of {} is the axis of wear or life?", roles.file()), {}};
    for (const auto& each : found) {
      question.readings.push_back(
          {fmt::format("{}: '{}'", each.role->name, each.column->name),
           {"--column", fmt::format("{}={}", each.role->name, each.column->name)}});
    }
    roles.questions.push_back(std::move(question));
  }
  const std::string_view role = found.front().role->name;
  return roles.take(key.empty() ? std::string(role) : key, {role});
}

std::string counting_unit(const ColumnRoles::Found& found) {
  if (found.unit != "1") return found.unit;
  if (found.role->name == "cycles") return "cycles";
  return found.role->name == "revolutions" ? "rev" : "1";
}

std::string name_of(const Column& column, const std::string& otherwise) {
  static const std::set<std::string> reserved = {
      "rate",        "start",       "sigma",   "scatter", "path",
      "wear",        "status",      "count",   "lower",   "upper",
      "entry",       "force",       "work",    "pi",      "characteristic",
      "slope",       "energy",      "k",       "and",     "or",
      "not",         "exp",         "log",     "min",     "max",
      "cum",         "where",       "abs",     "sqrt",    "speed",
      "temperature", "boltzmann",   "life",    "time",    "cycles",
      "depth",       "volume",      "mass",    "crack",   "distance",
      "pow",         "sin",         "cos",     "tanh",    "erf",
      "erfc",        "probit",      "gamma",   "lgamma",  "digamma",
      "unused",      "revolutions", "pressure"};
  std::string name = name_and_unit(column, "").name;
  for (char& each : name) {
    each = each == ' ' || each == '-'
               ? '_'
               : static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
  }
  const bool letters = !name.empty() && std::all_of(name.begin(), name.end(), [](char each) {
    return (each >= 'a' && each <= 'z') || (each >= '0' && each <= '9') || each == '_';
  });
  constexpr std::size_t longest = 30;
  if (!letters || name.size() > longest || !(name.front() >= 'a' && name.front() <= 'z') ||
      reserved.contains(name))
    return otherwise;
  return name;
}

std::string column_line(const std::string& name, ColumnRoles::Found found) {
  found.unit = counting_unit(found);
  return ColumnRoles::line(name, found);
}

bool has_units(const ColumnRoles& roles) {
  const auto found = roles.find({"unit"});
  if (found && repeats(roles.table(), *found->column)) return true;
  return false;
}

std::optional<ColumnRoles::Found> take_units(ColumnRoles& roles, const Column& axis) {
  const auto chosen = roles.choices().columns.find("unit");
  if (chosen != roles.choices().columns.end())
    return chosen->second.empty() ? std::nullopt : roles.take("unit", {"unit"});
  if (has_units(roles)) return roles.take("unit", {"unit"});
  std::vector<const Column*> labels = roles.other_labels();
  std::erase_if(labels, [&](const Column* each) { return !may_be_units(roles.table(), *each); });
  if (labels.empty()) return {};
  if (rises_throughout(roles.table(), axis)) {
    roles.guesses.emplace_back("all rows are assumed to be of one unit");
    return {};
  }
  TableQuestion question{
      fmt::format("Which column of {} identifies the unit of a row?", roles.file()), {}};
  for (const Column* each : labels) {
    question.readings.push_back(
        {fmt::format("'{}'", each->name), {"--column", fmt::format("unit={}", each->name)}});
  }
  question.readings.push_back(
      {"none: all rows are of one unit, or each is of its own unit", {"--column", "unit="}});
  roles.questions.push_back(std::move(question));
  return {};
}

bool differs_within(const Table& table, const Column& column, const Column* unit) {
  const std::vector<double> numbers = numbers_of(table, column);
  std::map<std::string, double> first;
  for (std::size_t i = 0; i < table.rows; ++i) {
    if (!std::isfinite(numbers[i])) continue;
    const auto [at, is_new] =
        first.emplace(unit ? cell_word(*unit, i) : fmt::format("{}", i), numbers[i]);
    if (!is_new && std::abs(at->second - numbers[i]) > 1e-9 * std::abs(numbers[i])) return true;
  }
  return false;
}

}  // namespace wearwell::formula_model
