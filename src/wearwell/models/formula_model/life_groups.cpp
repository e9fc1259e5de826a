#include "wearwell/models/formula_model/life_groups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

namespace wearwell::formula_model {
namespace {

// The conditions of a row that the formula depends on.
Conditions conditions_of_row(const FormulaModel& model, std::size_t row) {
  const formula::Program& program = model.measured.front().program;
  Conditions found;
  std::vector<std::string> words;
  for (std::size_t c = 0; c < model.row_symbols.columns.size(); ++c) {
    if (!program.uses_column(c)) continue;
    const NumberColumn& column = *model.data.number(model.row_symbols.columns[c].name);
    found.numbers[column.name] = column.values[row];
    const std::string& unit = column.unit.unit.text;
    words.push_back(fmt::format("{} = {:.6g}{}", column.name,
                                from_si(column.unit.unit, column.values[row]),
                                unit == "1" ? "" : " " + unit));
  }
  for (std::size_t c = 0; c < model.row_symbols.labels.size(); ++c) {
    if (!program.uses_label(c)) continue;
    const LabelColumn& column = *model.data.label(model.row_symbols.labels[c].name);
    found.labels[column.name] = column.at[row];
    words.push_back(fmt::format("{} = {}", column.name,
                                column.levels[static_cast<std::size_t>(column.at[row])]));
  }
  found.words = fmt::format("{}", fmt::join(words, ", "));
  return found;
}

}  // namespace

double LifeGroup::failures() const {
  double sum = 0;
  for (std::size_t i = 0; i < responses.size(); ++i)
    sum += responses[i].seen == Censoring::right ? 0 : counts[i];
  return sum;
}

std::vector<LifeGroup> life_groups(const FormulaModel& model, std::size_t most) {
  const Measured& measured = model.measured.front();
  std::vector<LifeGroup> groups;
  std::map<std::pair<std::map<std::string, double>, std::map<std::string, int>>, std::size_t> known;
  for (std::size_t i = 0; i < measured.observed.rows.size(); ++i) {
    Conditions own = conditions_of_row(model, measured.observed.rows[i]);
    const auto [at, is_new] = known.try_emplace({own.numbers, own.labels}, groups.size());
    if (is_new) {
      if (groups.size() == most) return {};
      groups.push_back({std::move(own), {}});
    }
    LifeGroup& group = groups[at->second];
    group.responses.push_back(measured.observed.responses[i]);
    group.counts.push_back(measured.observed.counts[i]);
  }
  return groups;
}

std::shared_ptr<const LifeDistribution> life_distribution(
    const TomlReader& root, const std::shared_ptr<const FormulaModel>& model,
    const Conditions& conditions) {
  const Measured& measured = model->measured.front();
  return std::make_shared<const LifeDistribution>(
      make_path(model, root, "likelihood", measured.wanted, false, conditions), measured);
}

}  // namespace wearwell::formula_model
