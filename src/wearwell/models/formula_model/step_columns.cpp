#include "wearwell/models/formula_model/step_columns.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/life_status.h"
#include "wearwell/models/formula_model/scaffold_parts.h"
#include "wearwell/study/column_values.h"

namespace wearwell::formula_model {
namespace {

struct TestStep {
  double age = 0;
  bool failed = false;
};

// Whether each step ended in a failure; empty if a cell says neither. An empty cell is a step that was survived.
std::optional<std::vector<bool>> failures_in(const Table& table, const LifeStatus& status) {
  std::vector<bool> failed;
  try {
    for (std::size_t row = 0; row < table.rows; ++row) {
      if (cell_word(table.column(status.column), row).empty()) {
        failed.push_back(false);
        continue;
      }
      const Censoring seen = seen_in(table, status, row);
      if (seen != Censoring::none && seen != Censoring::right) return {};
      failed.push_back(seen == Censoring::none);
    }
  } catch (const InputError&) {
    return {};
  }
  return failed;
}

bool are_steps(std::vector<TestStep>& steps) {
  std::sort(steps.begin(), steps.end(),
            [](const TestStep& a, const TestStep& b) { return a.age < b.age; });
  for (std::size_t i = 1; i < steps.size(); ++i) {
    if (!(steps[i].age > steps[i - 1].age) || steps[i - 1].failed) return false;
  }
  return steps.front().age > 0;
}

// Whether rows are the steps of their specimens, if these of them are failures.
bool end_with_failures(const Table& table, const Column& specimen, const Column& age,
                       const std::vector<bool>& failed) {
  if (std::find(failed.begin(), failed.end(), true) == failed.end()) return false;
  std::map<std::string, std::vector<TestStep>> of_specimen;
  const std::vector<double> ages = numbers_of(table, age);
  for (std::size_t row = 0; row < table.rows; ++row) {
    if (!std::isfinite(ages[row]) || cell_word(specimen, row).empty()) return false;
    of_specimen[cell_word(specimen, row)].push_back({ages[row], failed[row]});
  }
  return std::all_of(of_specimen.begin(), of_specimen.end(),
                     [](auto& each) { return are_steps(each.second); });
}

// Levels that repeat, unlike those of a temperature that was read.
bool has_levels(const Table& table, const Column& stress, const Column& specimen) {
  return 2 * kinds_of(table, stress).size() <= table.rows &&
         differs_within(table, stress, &specimen);
}

}  // namespace

const Column* specimens_of_steps(const ColumnRoles& roles, ColumnRoles::Roles stresses) {
  const Table& table = roles.table();
  const auto specimen = roles.find({"unit"}), status = roles.find({"status"});
  const auto age = roles.find({"life", "time", "cycles", "revolutions", "distance"});
  if (!specimen || !status || !age || !repeats(table, *specimen->column)) return nullptr;
  if (roles.has({"depth", "volume", "mass", "crack", "measured"})) return nullptr;
  if (std::none_of(stresses.begin(), stresses.end(), [&](std::string_view each) {
        const auto stress = roles.find({each});
        return stress && has_levels(table, *stress->column, *specimen->column);
      }))
    return nullptr;
  std::vector<std::optional<int>> codes = {roles.choices().failure,
                                           failure_code_of(status->column->name)};
  if (!codes[0] && !codes[1]) codes = {1, 0};
  for (const std::optional<int>& code : codes) {
    const auto failed = failures_in(table, LifeStatus{status->column->name, code});
    if (failed && end_with_failures(table, *specimen->column, *age->column, *failed))
      return specimen->column;
  }
  return nullptr;
}

}  // namespace wearwell::formula_model
