#include "wearwell/models/formula_model/life_groups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>

#include "wearwell/base/stop_scope.h"

namespace wearwell::formula_model {

UsedColumns used_columns(const FormulaModel& model) {
  const auto any = [&](auto uses) {
    return std::any_of(model.measured.begin(), model.measured.end(),
                       [&](const Measured& each) { return uses(each.program); });
  };
  UsedColumns used;
  for (std::size_t c = 0; c < model.row_symbols.columns.size(); ++c) {
    if (any([c](const formula::Program& program) { return program.uses_column(c); }))
      used.numbers.push_back(model.data.number(model.row_symbols.columns[c].name));
  }
  for (std::size_t c = 0; c < model.row_symbols.labels.size(); ++c) {
    if (any([c](const formula::Program& program) { return program.uses_label(c); }))
      used.labels.push_back(model.data.label(model.row_symbols.labels[c].name));
  }
  return used;
}

Conditions conditions_of_row(const UsedColumns& used, std::size_t row, int digits) {
  Conditions found;
  std::vector<std::string> words;
  for (const NumberColumn* column : used.numbers) {
    found.numbers[column->name] = column->values[row];
    const std::string& unit = column->unit.unit.text;
    words.push_back(fmt::format("{} = {:.{}g}{}", column->name,
                                from_si(column->unit.unit, column->values[row]), digits,
                                unit == "1" ? "" : " " + unit));
  }
  for (const LabelColumn* column : used.labels) {
    found.labels[column->name] = column->at[row];
    words.push_back(fmt::format("{} = {}", column->name,
                                column->levels[static_cast<std::size_t>(column->at[row])]));
  }
  found.words = fmt::format("{}", fmt::join(words, ", "));
  return found;
}

namespace {

// The values of these columns in a row: rows of one group have the same.
std::vector<double> values_of_row(const UsedColumns& used, std::size_t row) {
  std::vector<double> values;
  for (const NumberColumn* column : used.numbers) values.push_back(column->values[row]);
  for (const LabelColumn* column : used.labels) values.push_back(column->at[row]);
  return values;
}

}  // namespace

double LifeGroup::failures() const {
  double sum = 0;
  for (std::size_t i = 0; i < responses.size(); ++i)
    sum += responses[i].seen == Censoring::right ? 0 : counts[i];
  return sum;
}

namespace {

// As far as a mode is known: a failure that may have been of several modes is a run-out of each.
std::optional<Response> life_by_mode(const FormulaModel& model, std::size_t row, std::size_t k) {
  Response y = model.lives.responses[row];
  if (model.modes->possible[row] == std::uint32_t{1} << k) return y;
  if (y.seen == Censoring::left) return {};
  y.seen = Censoring::right;
  return y;
}

std::vector<LifeGroup> groups_of_modes(const FormulaModel& model, std::size_t most) {
  std::vector<LifeGroup> groups;
  const UsedColumns used = used_columns(model);
  std::map<std::vector<double>, std::size_t> known;
  const std::size_t modes = model.measured.size();
  for (std::size_t row = 0; row < model.lives.rows.size(); ++row) {
    check_stop();
    const auto [at, is_new] = known.try_emplace(values_of_row(used, row), groups.size());
    if (is_new) {
      const Conditions own = conditions_of_row(used, row);
      if (groups.size() + modes + 1 > most) return {};
      groups.push_back({own, {}});
      groups.back().conditions.words = own.words.empty() ? "all modes" : "all modes, " + own.words;
      for (std::size_t k = 0; k < modes; ++k) {
        const std::string& mode = model.modes->modes[k];
        groups.push_back({own, {}});
        groups.back().conditions.words = own.words.empty() ? mode : mode + ", " + own.words;
        groups.back().modes = std::uint32_t{1} << k;
      }
    }
    LifeGroup* const group = &groups[at->second];
    group->responses.push_back(model.lives.responses[row]);
    group->counts.push_back(model.lives.counts[row]);
    for (std::size_t k = 0; k < modes; ++k) {
      const auto y = life_by_mode(model, row, k);
      if (!y) continue;
      group[k + 1].responses.push_back(*y);
      group[k + 1].counts.push_back(model.lives.counts[row]);
    }
  }
  return groups;
}

// Conditions that differ between units: a life depends on one of them at least, and has finite parameters wherever
// the conditions may be.
void require_values(const TomlReader& table, const std::string& key, const FormulaModel& model,
                    const std::vector<Risk>& risks) {
  const std::shared_ptr<const VariedConditions>& varied = risks.front().family_parameters->varied;
  if (!varied) return;
  const auto fail = [&](const std::string& column, const std::string& message) {
    table.required_table(key).fail(column, message);
  };
  for (const VariedCondition& each : varied->conditions) {
    const auto& columns = model.row_symbols.columns;
    const auto at = std::find_if(columns.begin(), columns.end(),
                                 [&](const auto& column) { return column.name == each.column; });
    const auto c = static_cast<std::size_t>(at - columns.begin());
    if (std::none_of(model.measured.begin(), model.measured.end(),
                     [c](const Measured& one) { return one.program.uses_column(c); }))
      fail(each.column, "has a distribution, but no life depends on it");
  }
  std::vector<double> start;
  for (const Parameter& each : model.parameters) start.push_back(each.start);
  LifeAtPoint at(risks);
  at.move_to(start.data());
  if (const auto node = at.undefined_condition()) {
    const Unit& unit = varied->conditions.front().distribution.unit;
    fail(varied->conditions.front().column,
         fmt::format("has units at {:.4g}{}, where the formula has no finite value; state bounds "
                     "of the distribution (lower, upper)",
                     from_si(unit, *node), unit.text == "1" ? "" : " " + unit.text));
  }
}

}  // namespace

std::vector<LifeGroup> life_groups(const FormulaModel& model, std::size_t most) {
  if (model.modes && model.measured.size() > 1) return groups_of_modes(model, most);
  const Measured& measured = model.measured.front();
  std::vector<LifeGroup> groups;
  const UsedColumns used = used_columns(model);
  std::map<std::vector<double>, std::size_t> known;
  for (std::size_t i = 0; i < measured.observed.rows.size(); ++i) {
    check_stop();
    const std::size_t row = measured.observed.rows[i];
    const auto [at, is_new] = known.try_emplace(values_of_row(used, row), groups.size());
    if (is_new) {
      if (groups.size() == most) return {};
      groups.push_back({conditions_of_row(used, row), {}});
      if (used.numbers.empty() && used.labels.empty()) {
        groups.back().responses.reserve(measured.observed.rows.size());
        groups.back().counts.reserve(measured.observed.rows.size());
      }
    }
    LifeGroup& group = groups[at->second];
    group.responses.push_back(measured.observed.responses[i]);
    group.counts.push_back(measured.observed.counts[i]);
  }
  return groups;
}

std::shared_ptr<const LifeDistribution> life_distribution(
    const TomlReader& table, const std::string& key,
    const std::shared_ptr<const FormulaModel>& model, const Conditions& conditions,
    std::uint32_t modes) {
  std::vector<Risk> risks;
  for (std::size_t k = 0; k < (model->modes ? model->measured.size() : 1); ++k) {
    if (!(modes >> k & 1)) continue;
    const Measured& measured = model->measured[k];
    std::vector<formula::Wanted> wanted = measured.wanted;
    if (model->has_exposure()) wanted.pop_back();  // a new item has no age
    risks.push_back(risk_of(make_path(model, table, key, wanted, false, conditions), measured));
  }
  require_values(table, key, *model, risks);
  return std::make_shared<const LifeDistribution>(std::move(risks));
}

std::shared_ptr<const LifeDistribution> life_in_calendar_time(
    const TomlReader& table, const std::string& key,
    const std::shared_ptr<const FormulaModel>& model, const Conditions& conditions) {
  const Measured& in_time = model->use_rate->in_time;
  std::vector<Risk> risks = {
      risk_of(make_path(model, table, key, in_time.wanted, false, conditions), in_time)};
  require_values(table, key, *model, risks);
  return std::make_shared<const LifeDistribution>(std::move(risks));
}

std::shared_ptr<const LifeDistribution> life_of_subpopulation(
    const TomlReader& table, const std::string& key,
    const std::shared_ptr<const FormulaModel>& model, const Conditions& conditions, std::size_t k) {
  const Measured& measured = model->measured.front();
  std::vector<formula::Wanted> own;
  for (std::size_t o = 0; o < measured.wanted.size(); ++o) {
    if (measured.family_parameter[o] / most_response_parameters == k)
      own.push_back(measured.wanted[o]);
  }
  std::vector<Risk> risks = {
      risk_of_subpopulation(make_path(model, table, key, own, false, conditions), measured, k)};
  require_values(table, key, *model, risks);
  return std::make_shared<const LifeDistribution>(std::move(risks));
}

}  // namespace wearwell::formula_model
