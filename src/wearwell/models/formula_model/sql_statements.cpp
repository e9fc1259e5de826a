#include "wearwell/models/formula_model/sql_statements.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/sha1.h"

namespace wearwell::formula_model {
namespace {

using fleet::number;

constexpr const char* largest = "1.7976931348623157e308";
constexpr std::pair<double, const char*> quantiles[] = {
    {0.05, "formula_q05"}, {0.5, "formula_q50"}, {0.95, "formula_q95"}};

}  // namespace

std::string SqlStatements::rows() const {
  std::string text;
  for (const Draw& each : draws) {
    text += fmt::format("{}({}, {}",
                        text.empty()   ? ""
                        : clickhouse() ? ","
                                       : ",\n",
                        fleet::literal(choice.dialect, each.unit), each.number);
    for (const double x : each.numbers) text += ", " + number(x);
    text += ')';
  }
  return text;
}

/// A name derived from all that is drawn: another fit or another value gets another table.
std::string SqlStatements::draws_table() const {
  std::string all;
  for (const auto& [name, what] : numbers) all += name + ' ' + what + '\n';
  for (const Draw& each : draws) {
    all += each.unit;
    for (const double x : each.numbers) all += fmt::format(" {}", x);
    all += '\n';
  }
  return fleet::table_identifier(choice.dialect,
                                 choice.prefix + "_formula_" + sha1_of(all).substr(0, 12));
}

std::string SqlStatements::setup() const {
  const fleet::Types types = fleet::types(choice.dialect);
  std::string columns, words;
  for (const auto& [name, what] : numbers) {
    columns += fmt::format(", {} {}{}", name, types.real, clickhouse() ? "" : " not null");
    words += fleet::comment(fmt::format("{}: {}", name, what));
  }
  const std::string table = draws_table();
  const std::string head = fmt::format(
      "-- 1. Set-up: {} draws of the unknowns, as rows. May be run again. SI.\n"
      "{}",
      choice.draws,
      words + (random_effects
                   ? "-- unit '': a new unit; the others are conditioned on their readings in "
                     "the study.\n"
                   : ""));
  if (clickhouse())
    return fmt::format(
        "{0}create table if not exists {1} (unit String, draw Int32{2}) engine = "
        "ReplacingMergeTree "
        "order by (unit, draw);\ninsert into {1} values{3};\n",
        head, table, columns, rows());
  return fmt::format(
      "{0}create table if not exists {1} (unit {2} not null, draw integer not null{3}, primary key "
      "(unit, draw));\ndelete from {1};\ninsert into {1} values\n{4};\n",
      head, table, types.text, columns, rows());
}

/// Columns of the table in the answer.
std::vector<std::string> SqlStatements::kept() const {
  std::vector<std::string> names = choice.keep;
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  };
  add(unit_column);
  for (const SqlInput& each : inputs) add(each.column);
  fleet::refuse_alike(choice.dialect, names);
  for (std::string& each : names) {
    if (each.starts_with("formula_"))
      throw InputError(fmt::format(
          "the column '{}' has the name of a column of the answer: rename it in the table",
          printable(each)));
    each = fleet::identifier(choice.dialect, each);
  }
  return names;
}

/// Of a row of the table: the kept columns, the inputs of the value, and whether all inputs are
/// present.
std::string SqlStatements::row_columns() const {
  std::string text;
  for (const std::string& each : kept()) text += fmt::format("  t.{0} as {0},\n", each);
  std::string whole;
  const auto need = [&](const std::string& condition) {
    whole += (whole.empty() ? "" : " and ") + condition;
  };
  if (random_effects) {
    const std::string unit = "t." + fleet::identifier(choice.dialect, unit_column);
    need(clickhouse() ? fmt::format("ifNull(toString({}), '') != ''", unit)
                      : unit + " is not null");
  }
  for (const SqlInput& each : inputs) {
    std::string value = "t." + fleet::identifier(choice.dialect, each.column);
    if (!each.is_label) {
      value = fleet::real(choice.dialect, value);
      if (clickhouse()) value = fmt::format("ifNull({}, nan)", value);
      if (each.unit.scale != 1) value += " * " + number(each.unit.scale);
      if (each.unit.offset != 0) value += " + " + number(each.unit.offset);
      need(fmt::format("abs({}) <= {}", value, largest));
    } else {
      std::vector<std::string> levels;
      for (const std::string& level : each.levels)
        levels.push_back(fleet::literal(choice.dialect, level));
      value = fleet::text(choice.dialect, value);
      if (clickhouse()) value = fmt::format("ifNull({}, '')", value);
      if (!levels.empty()) need(fmt::format("{} in ({})", value, fmt::join(levels, ", ")));
    }
    text += fmt::format("  {} as {},\n", value, each.name);
  }
  return text + fmt::format("  case when {} then 1 else 0 end as formula_whole",
                            whole.empty() ? "1 = 1" : whole);
}

/// Nested SELECTs: every step is computed once.
std::string SqlStatements::steps(std::string from) const {
  const bool fence = choice.dialect == fleet::Dialect::postgresql;
  int level = 0;
  for (const FormulaSql::Step& each : sql.steps) {
    const std::string names = fmt::format("{}", fmt::join(each.drawn, ", "));
    const std::string value =
        clickhouse() && !each.drawn.empty()
            ? fmt::format("arrayMap(({0}) -> {1}, {0})", names, each.expression)
            : each.expression;
    from = fmt::format("select *, {} as {}\nfrom (\n{}\n) as step{}{}", value, each.name, from,
                       level++, fence ? "\noffset 0" : "");
  }
  return from;
}

/// The mean of the two neighbouring order statistics, in the unit of the answer.
std::string SqlStatements::answer_of(const std::string& sorted, double p) const {
  const auto k = static_cast<std::size_t>(p * static_cast<double>(choice.draws) + 0.5);
  std::string text = fmt::format("({0}[{1}] + {0}[{2}]) * 0.5e0", sorted, k, k + 1);
  if (answer.offset != 0) text = fmt::format("({} - {})", text, number(answer.offset));
  if (answer.scale != 1) text += " / " + number(answer.scale);
  return text;
}

std::string SqlStatements::by_lateral() const {
  const std::string table = draws_table();
  std::string drawn = "select ";
  for (const auto& [name, what] : numbers) drawn += fmt::format("d.{}, ", name);
  for (const SqlInput& each : inputs) drawn += fmt::format("r.{}, ", each.name);
  drawn += fmt::format("r.formula_whole\nfrom {} as d where d.unit = {}", table,
                       random_effects ? "r.formula_unit" : "''");
  std::string answers, names;
  for (const auto& [p, name] : quantiles) {
    answers += fmt::format(
        "{}\n  case when count(case when formula_whole = 1 and abs(formula_value) <= {} then 1 "
        "end) = {} "
        "then "
        "{} end as {}",
        answers.empty() ? "" : ",", largest, choice.draws,
        answer_of("(array_agg(formula_value order by formula_value))", p), name);
    names += fmt::format(", q.{}", name);
  }
  std::string known, join;
  if (random_effects) {
    known =
        ",\n  coalesce(known.unit, '') as formula_unit,\n  case when known.unit is null then 0 "
        "else 1 "
        "end as formula_known";
    join = fmt::format(
        "\nleft join (select distinct unit from {} where unit <> '') as known on known.unit = {}",
        table, fleet::text(choice.dialect, "t." + fleet::identifier(choice.dialect, unit_column)));
  }
  std::vector<std::string> own;
  for (const std::string& each : kept()) own.push_back("r." + each);
  if (random_effects) own.push_back("r.formula_known");
  std::string text = fmt::format("{}", fmt::join(own, ", "));
  if (text.empty()) names.erase(0, 2);
  return fmt::format(
      "select {}{}\nfrom (\nselect\n{}{}\nfrom {} as t{}\n) as r cross join lateral "
      "(\nselect{}\nfrom "
      "(\n{}\n) as drawn\n) as q",
      text, names, row_columns(), known, fleet::table_identifier(choice.dialect, choice.table),
      join, answers, steps(drawn));
}

/// ClickHouse has no lateral joins: the draws of a row are arrays.
std::string SqlStatements::by_arrays() const {
  const std::string table = draws_table();
  std::string all, any, apart;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::string& name = numbers[i].first;
    all += (i == 0 ? "" : ", ") + name;
    any += fmt::format(", any({0}) as {0}", name);
    apart += fmt::format(",\n  arrayMap(d -> d.{}, formula_draws) as {}", i + 1, name);
  }
  if (numbers.size() > 1) all = "(" + all + ")";
  if (numbers.size() == 1) apart = fmt::format(",\n  formula_draws as {}", numbers[0].first);
  std::string unit = "'' as formula_unit";
  if (random_effects) {
    const std::string name =
        fmt::format("ifNull(toString(t.{}), '')", fleet::identifier(choice.dialect, unit_column));
    const std::string in =
        fmt::format("{} global in (select unit from {} where unit != '')", name, table);
    unit = fmt::format("if({0}, {1}, '') as formula_unit, {0} as formula_known", in, name);
  }
  const std::string base = fmt::format(
      "select *{}\nfrom (\nselect\n{},\n  {}\nfrom {} as t\n) as r any left join (\n  select unit "
      "as "
      "formula_unit, groupArray({}) as formula_draws from (select unit, draw{} from {} group by "
      "unit, "
      "draw) "
      "group by unit\n) as known using formula_unit",
      apart, row_columns(), unit, fleet::table_identifier(choice.dialect, choice.table), all, any,
      table);
  std::vector<std::string> own = kept();
  if (random_effects) own.push_back("formula_known");
  for (const auto& [p, name] : quantiles)
    own.push_back(
        fmt::format("if(formula_good, {}, nan) as {}", answer_of("formula_sorted", p), name));
  // ClickHouse 18.16 drops outer columns that only a function within arrayMap uses, unless the
  // query uses them elsewhere.
  std::vector<std::string> outside;
  for (const SqlInput& each : inputs) outside.push_back(each.name);
  for (const FormulaSql::Step& each : sql.steps)
    if (each.drawn.empty()) outside.push_back(each.name);
  outside.push_back("formula_whole");
  return fmt::format(
      "select {}\nfrom (\nselect *, arraySort(formula_value) as formula_sorted,\n  formula_whole = "
      "1 and "
      "arrayCount(x -> abs(x) <= {}, formula_value) = {} as formula_good\nfrom (\n{}\n) as "
      "valued\n) as "
      "sorted\nwhere ignore({}) = 0",
      fmt::join(own, ", "), largest, choice.draws, steps(base), fmt::join(outside, ", "));
}

std::string SqlStatements::query() const {
  return clickhouse() ? by_arrays() : by_lateral();
}

}  // namespace wearwell::formula_model
