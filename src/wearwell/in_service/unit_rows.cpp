#include "wearwell/in_service/unit_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/status_words.h"
#include "wearwell/study/scaffold.h"

namespace wearwell::in_service {
namespace {

// Texts first, then numbers, as Engine::rows gives them.
struct UnitQuery {
  std::string text;
  std::size_t texts = 0;
};

UnitQuery query_of(const fleet::Engine& engine, const UnitColumns& columns) {
  const fleet::Dialect dialect = engine.dialect();
  std::vector<std::string> texts, numbers;
  const auto name = [&](const std::string& column) {
    return "t." + fleet::identifier(dialect, column);
  };
  const auto add_text = [&](const std::string& column) {
    if (!column.empty()) texts.push_back(fleet::text(dialect, name(column)));
  };
  const auto add_number = [&](const std::string& column) {
    numbers.push_back(fleet::real(dialect, fleet::number_cell(name(column), columns.text_decimal)));
  };
  add_text(columns.unit);
  add_text(columns.in_study);
  add_text(columns.life);
  for (const UnitColumns::Given& each : columns.conditions)
    if (each.condition.si.empty()) add_text(each.column.column);
  add_number(columns.age.column);
  for (const UnitColumns::Given& each : columns.conditions)
    if (!each.condition.si.empty()) add_number(each.column.column);
  const std::size_t count = texts.size();
  texts.insert(texts.end(), numbers.begin(), numbers.end());
  return {fmt::format("select {} from {} as t", fmt::join(texts, ", "), engine.table()), count};
}

class UnitReader {
 public:
  UnitReader(const fleet::Engine& engine, const UnitColumns& columns, const ReadUnits& how,
             UnitRows& rows)
      : source_(engine.source()), columns_(columns), how_(how), rows_(rows) {
    for (std::size_t i = 0; i < rows.sets.size(); ++i) place_.emplace(key_of(rows.sets[i]), i);
  }

  void add(const fleet::Row& row) {
    constexpr double between_checks = 4096;
    if (std::fmod(rows_.rows, between_checks) == 0 && how_.stop.stop_requested()) throw Cancelled();
    ++rows_.rows;
    const std::string unit = printable(row.texts.front());
    const double age = to_si(columns_.age.unit, row.numbers.front());
    bool in_study = how_.all_in_study;
    const std::string problem = problem_of(row, in_study);
    if (!problem.empty()) return leave_out(unit, problem, row.numbers.front());
    const std::uint32_t group = set_of(row);
    if (rows_.sets[group].units++ == 0) rows_.sets[group].first = unit;
    rows_.names.push_back(unit);
    rows_.units.age.push_back(age);
    rows_.units.group.push_back(group);
    rows_.units.in_study.push_back(in_study ? 1 : 0);
  }

 private:
  // The first reason why a row cannot be used; empty if there is none.
  std::string problem_of(const fleet::Row& row, bool& in_study) const {
    if (row.texts.front().empty()) return "it has no unit";
    const double age = row.numbers.front();
    if (std::isnan(age)) return "age is missing or not a number";
    if (!(age >= 0) || std::isinf(age)) return "age is negative or infinite";
    std::size_t text = 1, number = 1;
    if (!columns_.in_study.empty()) {
      const std::optional<bool> truth = truth_in(row.texts[text++]);
      if (!truth) return "in_study is neither yes nor no";
      in_study |= *truth;
    }
    if (!columns_.life.empty() && row.texts[text++].empty()) return "life is missing";
    for (const UnitColumns::Given& each : columns_.conditions) {
      const bool missing = each.condition.si.empty() ? row.texts[text++].empty()
                                                     : !std::isfinite(row.numbers[number++]);
      if (missing) return each.condition.name + " is missing or not a number";
    }
    return "";
  }

  void leave_out(const std::string& unit, const std::string& problem, double age) {
    if (!how_.skip_bad)
      throw InputError(fmt::format(
          "{}: row of unit '{}': {}{}; ages are numbers of at least 0, and each unit has its "
          "conditions; --skip-bad leaves such rows out and reports them",
          source_, unit, problem,
          std::isfinite(age) ? fmt::format(" (age {:.6g} {})", age, columns_.age.unit.text) : ""));
    rows_.leave_out({unit, problem, to_si(columns_.age.unit, age)});
  }

  static std::string key_of(const ConditionSet& set) {
    std::string key = set.life;
    for (const auto& [name, value] : set.given) key += '\n' + name + '=' + value;
    return key;
  }

  std::uint32_t set_of(const fleet::Row& row) {
    ConditionSet set;
    std::size_t text = columns_.in_study.empty() ? 1 : 2, number = 1;
    if (!columns_.life.empty()) set.life = row.texts[text++];
    std::vector<std::string> words;
    for (const UnitColumns::Given& each : columns_.conditions) {
      const std::string& name = each.condition.name;
      if (each.condition.si.empty()) {
        const std::string& level = row.texts[text++];
        set.given[name] = toml_text(level);
        words.push_back(fmt::format("{} = {}", name, printable(level)));
        continue;
      }
      const double value = row.numbers[number++];
      const std::string& unit = each.column.unit.text;
      const std::string written =
          unit == "1" ? fmt::format("{}", value) : fmt::format("{} {}", value, unit);
      set.given[name] = unit == "1" ? written : toml_text(written);
      set.values.push_back(to_si(each.column.unit, value));
      words.push_back(fmt::format("{} = {}", name, written));
    }
    const auto [at, is_new] = place_.try_emplace(key_of(set), rows_.sets.size());
    if (!is_new) return static_cast<std::uint32_t>(at->second);
    if (rows_.sets.size() == most_condition_sets)
      throw InputError(fmt::format(
          "{}: units have more than {} different conditions ({}); lives are computed for each. "
          "Round the conditions, in a view or in the table",
          source_, most_condition_sets, fmt::join(words, ", ")));
    if (!set.life.empty()) words.insert(words.begin(), printable(set.life));
    set.description = fmt::format("{}", fmt::join(words, ", "));
    rows_.sets.push_back(std::move(set));
    return static_cast<std::uint32_t>(at->second);
  }

  const std::string source_;
  const UnitColumns& columns_;
  const ReadUnits& how_;
  UnitRows& rows_;
  std::unordered_map<std::string, std::size_t> place_;
};

}  // namespace

void add_units(fleet::Engine& engine, const UnitColumns& columns, const ReadUnits& how,
               UnitRows& rows) {
  const UnitQuery query = query_of(engine, columns);
  UnitReader reader(engine, columns, how, rows);
  engine.begin();
  engine.rows(query.text, query.texts, [&](const fleet::Row& row) { reader.add(row); });
  engine.commit();
}

void refuse_repeated_units(const UnitRows& rows, const std::string& source) {
  std::unordered_set<std::string_view> seen;
  seen.reserve(rows.names.size());
  for (const std::string& each : rows.names)
    if (!seen.insert(each).second)
      throw InputError(fmt::format(
          "{}: unit {} has more than one row; each unit in service has one, with its age now",
          source, each));
}

}  // namespace wearwell::in_service
