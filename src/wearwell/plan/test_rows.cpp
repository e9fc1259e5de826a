#include "wearwell/plan/test_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "wearwell/base/contains.h"
#include "wearwell/input/columns.h"
#include "wearwell/plan/candidates.h"

namespace wearwell::plan {
namespace {

std::string cell_as_text(const Column& column, std::size_t row) {
  return column.is_number
             ? (std::isnan(column.numbers[row]) ? "" : fmt::format("{}", column.numbers[row]))
             : column.text[row];
}

void become_text(Column& column, std::size_t rows) {
  if (!column.is_number) return;
  for (std::size_t i = 0; i < rows; ++i) column.text.push_back(cell_as_text(column, i));
  column.numbers.clear();
  column.is_number = false;
  column.marks = NumberMarks{'.', 0};
}

void push(Column& column, double value) {
  column.is_number ? column.numbers.push_back(value)
                   : column.text.push_back(std::isnan(value) ? "" : fmt::format("{}", value));
}

// A row of the result: of the study's table or of the tests; the row that messages name; and the
// number of its unit.
struct RowCopy {
  bool own = false;
  std::size_t row = 0, origin = 0, unit = 0;
};
using RowCopies = std::vector<RowCopy>;

// A word that begins no level of the label.
std::string unused_word(const ConditionColumn& label) {
  std::string word = "planned";
  while (std::any_of(label.labels.begin(), label.labels.end(),
                     [&](const std::string& each) { return each.starts_with(word); }))
    word += "'";
  return word;
}

Table copied_rows(const TestStudy& study, const Table& rows, const RowCopies& copies) {
  Table table{rows.source, {}, copies.size()};
  for (const Column& planned : rows.columns) {
    const Column& own = study.table().column(planned.name);
    const ConditionColumn* const condition = study.condition(planned.name);
    const ConditionColumn* const label = condition && condition->varies ? condition : nullptr;
    const std::string fresh = label ? unused_word(*label) : "";
    Column column{planned.name, planned.is_number && own.is_number, {}, {}, planned.unit,
                  planned.marks};
    if (!column.is_number && !column.marks) column.marks = own.marks;
    for (const RowCopy& each : copies) {
      const Column& from = each.own ? own : planned;
      if (column.is_number) {
        column.numbers.push_back(from.numbers[each.row]);
      } else if (label && planned.name == study.unit) {
        column.text.push_back(fmt::format("{} {}", fresh, each.unit + 1));
      } else if (const std::string text = cell_as_text(from, each.row);
                 label && label->is_new(text)) {
        column.text.push_back(fresh);
      } else {
        column.text.push_back(text);
      }
    }
    table.columns.push_back(std::move(column));
  }
  for (const RowCopy& each : copies) table.origins.push_back(each.origin);
  return table;
}

}  // namespace

std::size_t Histories::index_of(const std::string& name) {
  const auto at = std::find(units.begin(), units.end(), name);
  if (at != units.end()) return static_cast<std::size_t>(at - units.begin());
  units.push_back(name);
  return units.size() - 1;
}

Table rows_with_outcomes(const TestStudy& study, const Table& conditions,
                         std::span<const std::size_t> rows, std::span<const TestOutcome> outcomes,
                         const std::string& prefix) {
  const Table& like = study.table();
  Table table{conditions.source, {}, rows.size()};
  const bool by_limit = !study.status;  // a run-out is a limit: ">1e6"
  const bool any_runout =
      std::any_of(outcomes.begin(), outcomes.end(), [](const auto& each) { return each.runout; });
  for (const Column& of : like.columns) {
    Column column{of.name, of.is_number, {}, {}, of.unit, of.marks};
    const bool measured = of.name == study.measured;
    const bool status = study.status && of.name == study.status->column;
    if (status || (measured && by_limit && any_runout)) column.is_number = false;
    if (measured && !column.is_number) column.marks = NumberMarks{'.', 0};
    const ConditionColumn* const condition = study.condition(of.name);
    const bool label = condition && condition->varies;
    const bool name = contains(study.new_units, of.name) || contains(study.names, of.name);
    if (label || name) column.is_number = false;
    const Column* const from = condition ? &condition_column(conditions, of.name) : nullptr;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const TestOutcome& outcome = outcomes[i];
      if (measured) {
        column.is_number ? column.numbers.push_back(outcome.value)
                         : column.text.push_back(fmt::format(
                               "{}{}", by_limit && outcome.runout ? ">" : "", outcome.value));
      } else if (status) {
        column.text.push_back(outcome.runout ? "runout" : "failure");
      } else if (label && !cell_word(*from, rows[i]).empty()) {
        column.text.push_back(cell_word(*from, rows[i]));
      } else if (label || name) {
        column.text.push_back(fmt::format("{} {}", prefix, i + 1));
      } else if (contains(study.ones, of.name)) {
        push(column, 1);
      } else if (from && column.is_number) {
        column.numbers.push_back(cell_value(conditions, *from, rows[i]).number);
      } else if (from) {
        column.text.push_back(cell_as_text(*from, rows[i]));
      } else {
        push(column, NAN);
      }
    }
    table.columns.push_back(std::move(column));
  }
  for (const std::size_t row : rows) table.origins.push_back(row + 1);
  return table;
}

Histories with_histories(const TestStudy& study, const Table& rows) {
  const Table& own = study.table();
  const ConditionColumn* const unit = study.condition(study.unit);
  std::map<std::string, std::vector<std::size_t>> of_unit;  // rows of the study
  if (unit)
    for (std::size_t i = 0; i < own.rows; ++i)
      of_unit[cell_word(own.column(study.unit), i)].push_back(i);
  Histories all;
  RowCopies copies;
  const auto copy_history = [&](const std::string& name, std::size_t origin, std::size_t as) {
    for (const std::size_t i : of_unit.at(name)) copies.push_back({true, i, origin, as});
  };
  std::vector<std::size_t> first_row;  // of a test of each unit in `all.units`
  for (std::size_t i = 0; i < rows.rows; ++i) {
    const std::string name = unit ? cell_word(rows.column(study.unit), i) : "";
    const bool seen = unit && !unit->is_new(name);
    all.unit.push_back(seen ? all.index_of(name) : Histories::none);
    if (all.units.size() > first_row.size()) first_row.push_back(i);
    if (seen) copy_history(name, rows.origins[i], i);
    copies.push_back({false, i, rows.origins[i], i});
    all.blocks.push_back(1 + (seen ? of_unit.at(name).size() : 0));
  }
  for (std::size_t k = 0; k < all.units.size(); ++k) {
    copy_history(all.units[k], rows.origins[first_row[k]], rows.rows + k);
    all.blocks.push_back(of_unit.at(all.units[k]).size());
  }
  all.rows = copied_rows(study, rows, copies);
  return all;
}

Source with_rows(const TestStudy& study, const Table& rows) {
  Source source = study.source;
  Table& table = source.tables[study.key];
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    Column& column = table.columns[c];
    Column more = rows.columns[c];
    if (column.is_number != more.is_number) {
      become_text(column, table.rows);
      become_text(more, rows.rows);
    }
    column.numbers.insert(column.numbers.end(), more.numbers.begin(), more.numbers.end());
    column.text.insert(column.text.end(), more.text.begin(), more.text.end());
  }
  // Messages name the row of the tests.
  table.origins.clear();
  for (std::size_t i = 0; i < table.rows; ++i) table.origins.push_back(i + 1);
  table.origins.insert(table.origins.end(), rows.origins.begin(), rows.origins.end());
  table.rows += rows.rows;
  table.lines.clear();
  table.source = rows.source;
  return source;
}

}  // namespace wearwell::plan
