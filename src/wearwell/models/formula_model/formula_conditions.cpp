#include "wearwell/models/formula_model/formula_conditions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/models/formula_model/scaffold_parts.h"
#include "wearwell/study/scaffold.h"

namespace wearwell::formula_model {
namespace {

bool is_condition(const FormulaModel& model, const std::string& name) {
  const auto column =
      std::find_if(model.symbols.columns.begin(), model.symbols.columns.end(),
                   [&](const formula::ColumnSymbol& each) { return each.name == name; });
  return column != model.symbols.columns.end() && !column->measured && model.along != name;
}

// Whether this condition is written as a table, which is a distribution.
bool is_table(const TomlReader& table, const std::string& name) {
  for (const TomlReader::Present& each : table.present())
    if (each.is_table && each.path.ends_with("." + name)) return true;
  return false;
}

std::shared_ptr<const VariedConditions> varied_or_refused(const TomlReader& table,
                                                          std::vector<VariedCondition> varied) {
  if (varied.size() > VariedConditions::most)
    table.fail(varied[VariedConditions::most].column,
               fmt::format("is the third condition with a distribution; at most {} differ between "
                           "units",
                           VariedConditions::most));
  const std::string last = varied.back().column;
  try {
    return varied_conditions(std::move(varied));
  } catch (const InputError& error) {
    table.fail(last, error.what());
  }
}

}  // namespace

bool Conditions::has(const std::string& column) const {
  if (numbers.count(column)) return true;
  return varied && std::any_of(varied->conditions.begin(), varied->conditions.end(),
                               [&](const auto& each) { return each.column == column; });
}

Conditions read_conditions(const TomlReader& table, const FormulaModel& model) {
  Conditions result;
  std::vector<std::string> words, known;
  std::vector<VariedCondition> varied;
  for (const formula::ColumnSymbol& each : model.symbols.columns) {
    if (is_condition(model, each.name)) known.push_back(each.name);
  }
  for (const formula::LabelSymbol& each : model.symbols.labels) {
    // Failure modes are levels of parameters, and no condition of a life.
    if (model.label != each.name && model.data.label(each.name)) known.push_back(each.name);
  }
  for (const std::string& name : table.keys()) {
    if (model.along == name)
      table.fail(name, "is the axis (predict.along); use predict.at instead");
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      table.fail(name, known.empty()
                           ? "is not a condition: the data have no such column"
                           : fmt::format("is not a condition; use one of {} (nearest: '{}')",
                                         fmt::join(known, ", "), nearest_name(name, known)));
    }
    if (const LabelColumn* label = model.data.label(name)) {
      const std::string level = table.required_text(name);
      if (model.is_drawn(name) && level == "new " + name) {
        result.labels[name] = static_cast<int>(label->levels.size());
        words.push_back(level);
        continue;
      }
      const auto at = std::find(label->levels.begin(), label->levels.end(), level);
      if (at == label->levels.end()) {
        table.fail(name,
                   fmt::format("'{}' is not in the data; use one of {} (nearest: '{}')", level,
                               fmt::join(label->levels, ", "), nearest_name(level, label->levels)));
      }
      result.labels[name] = static_cast<int>(at - label->levels.begin());
      words.push_back(fmt::format("{} = {}", name, level));
      continue;
    }
    const NumberColumn& column = *model.data.number(name);
    if (is_table(table, name)) {
      varied.push_back(read_varied_condition(table, name, formula::si_text(column.unit.powers)));
      words.push_back(description(varied.back()));
      continue;
    }
    const Quantity quantity = table.required_quantity(name, formula::si_text(column.unit.powers));
    result.numbers[name] = quantity.si();
    words.push_back(fmt::format("{} = {:.6g}{}", name, quantity.value,
                                quantity.unit.text == "1" ? "" : " " + quantity.unit.text));
  }
  result.words = fmt::format("{}", fmt::join(words, ", "));
  if (!varied.empty()) result.varied = varied_or_refused(table, std::move(varied));
  return result;
}

void refuse_varied(const Conditions& conditions, const TomlReader& table, const std::string& key,
                   const std::string& where) {
  if (!conditions.varied) return;
  const std::string& column = conditions.varied->conditions.front().column;
  table.fail(key, fmt::format("{} has a distribution, but {} needs one value; write {} = a number",
                              column, where, column));
}

Conditions conditions_of_unit(const FormulaModel& model, std::size_t unit,
                              const Conditions& given) {
  Conditions result = given;
  const NumberColumn* axis = model.along ? model.data.number(*model.along) : nullptr;
  std::optional<std::size_t> last;
  for (const std::size_t row : model.order) {
    if (model.unit_of_row[row] != unit) continue;
    if (!last || !axis || axis->values[row] >= axis->values[*last]) last = row;
  }
  if (!last) return result;
  for (const NumberColumn& each : model.data.numbers) {
    if (!is_condition(model, each.name)) continue;
    if (given.has(each.name)) continue;
    result.numbers.emplace(each.name, each.values[*last]);
    const bool alike = std::all_of(each.values.begin(), each.values.end(),
                                   [&](double x) { return x == each.values.front(); });
    if (!alike) result.of_last_row.insert(each.name);
  }
  for (const LabelColumn& each : model.data.labels) {
    if (model.label != each.name || model.is_drawn(each.name)) {
      result.labels.try_emplace(each.name, each.at[*last]);
    }
  }
  return result;
}

Conditions common_conditions(const FormulaModel& model, const Conditions& given) {
  Conditions result = given;
  for (const NumberColumn& each : model.data.numbers) {
    const bool same = std::all_of(each.values.begin(), each.values.end(),
                                  [&](double x) { return x == each.values.front(); });
    if (same && is_condition(model, each.name) && !given.has(each.name)) {
      result.numbers.try_emplace(each.name, each.values.front());
    }
  }
  for (const LabelColumn& each : model.data.labels) {
    if (each.levels.size() == 1 && model.label != each.name)
      result.labels.try_emplace(each.name, 0);
    // For the units' label: a new unit.
    if (model.is_drawn(each.name)) {
      result.labels.try_emplace(each.name, static_cast<int>(each.levels.size()));
    }
  }
  return result;
}

void fail_without_condition(const FormulaModel& model, const TomlReader& table,
                            const std::string& key, const std::string& column) {
  const NumberColumn& numbers = *model.data.number(column);
  const std::string& unit = numbers.unit.unit.text;
  const std::string value = quantity_text(from_si(numbers.unit.unit, numbers.values.front()), unit);
  table.fail(
      key,
      fmt::format("needs predict.given.{}: it varies between rows (write given = {{ {} = {} }})",
                  column, column, unit == "1" ? value : toml_text(value)));
}

void fail_without_label(const TomlReader& table, const std::string& key,
                        const formula::LabelSymbol& label) {
  table.fail(key, fmt::format("needs predict.given.{}, one of {}", label.name,
                              fmt::join(label.levels, ", ")));
}

}  // namespace wearwell::formula_model
