#include "wearwell/models/formula_model/formula_path.h"

#include <algorithm>

#include "wearwell/base/error.h"

namespace wearwell::formula_model {

namespace {

// A column, for example the axis, becomes a row input, so that no row is bound again during the search for a life.
formula::Symbols with_open_column(formula::Symbols symbols, const std::string& name) {
  auto& columns = symbols.columns;
  const auto column = std::find_if(columns.begin(), columns.end(),
                                   [&](const auto& each) { return each.name == name; });
  symbols.parameters.push_back({column->name, column->powers, formula::Scope::per_row, {}});
  columns.erase(column);
  return symbols;
}

void open_varied(const FormulaModel& model, const std::vector<formula::Wanted>& wanted,
                 const Conditions& conditions, Path& path) {
  path.varied = conditions.varied;
  for (const VariedCondition& each : conditions.varied->conditions) {
    path.symbols = with_open_column(std::move(path.symbols), each.column);
  }
  path.program = formula::compile(model.lines, wanted, path.symbols);
}

// Identical rows.
void bind_conditions(const FormulaModel& model, const TomlReader& table, const std::string& key,
                     const Conditions& conditions, Path& path) {
  formula::Rows rows;
  rows.count = Path::most;
  std::vector<std::vector<double>> numbers;
  std::vector<std::vector<int>> labels;
  for (std::size_t c = 0; c < path.symbols.columns.size(); ++c) {
    numbers.emplace_back();
    if (!path.program.uses_column(c)) continue;
    const auto at = conditions.numbers.find(path.symbols.columns[c].name);
    if (at == conditions.numbers.end()) {
      fail_without_condition(model, table, key, path.symbols.columns[c].name);
    }
    numbers.back().assign(Path::most, at->second);
  }
  for (std::size_t c = 0; c < path.symbols.labels.size(); ++c) {
    labels.emplace_back();
    if (!path.program.uses_label(c)) continue;
    const auto at = conditions.labels.find(path.symbols.labels[c].name);
    if (at == conditions.labels.end()) fail_without_label(table, key, path.symbols.labels[c]);
    labels.back().assign(Path::most, at->second);
  }
  for (const auto& each : numbers) rows.columns.emplace_back(each);
  for (const auto& each : labels) rows.labels.emplace_back(each);
  path.data = path.program.bind(rows);
}

}  // namespace

std::shared_ptr<const Path> make_path(std::shared_ptr<const FormulaModel> model,
                                      const TomlReader& table, const std::string& key,
                                      const std::vector<formula::Wanted>& wanted, bool along,
                                      const Conditions& conditions,
                                      std::optional<std::size_t> unit) {
  auto path = std::make_shared<Path>();
  path->symbols = model->row_symbols;
  path->shared = model->shared;
  try {
    path->program = formula::compile(model->lines, wanted, path->symbols, true);
    const bool has_state = path->program.running().state;
    if (along && !path->program.has_paths() && !has_state) {
      path->along = true;
      path->symbols = with_open_column(std::move(path->symbols), *model->along);
      path->program = formula::compile(model->lines, wanted, path->symbols);
    }
    if (conditions.varied && !along && !path->program.has_paths())
      open_varied(*model, wanted, conditions, *path);
  } catch (const InputError& error) {
    table.fail(key, error.what());
  }
  if (along && !path->along) {
    path->running = continue_path(*model, table, key, path->program, conditions, unit);
  } else if (path->program.has_paths()) {
    table.fail(
        key,
        "depends on earlier rows (cum, or a state), but the request has no position on an axis");
  } else {
    bind_conditions(*model, table, key, conditions, *path);
  }
  path->model = std::move(model);
  return path;
}

std::shared_ptr<const Path> make_trace(std::shared_ptr<const FormulaModel> model,
                                       const TomlReader& table, const std::string& key,
                                       const std::vector<formula::Wanted>& wanted,
                                       std::size_t unit) {
  auto path = std::make_shared<Path>();
  path->symbols = model->row_symbols;
  path->shared = model->shared;
  path->program = formula::compile(model->lines, wanted, path->symbols, true);
  path->running =
      continue_path(*model, table, key, path->program, conditions_of_unit(*model, unit, {}), unit);
  path->model = std::move(model);
  return path;
}

PathAt::PathAt(const Path& path)
    : path_(&path),
      population_at_(*path.model),
      inner_(path.shared.size()),
      workspace_(path.program.workspace(Path::most)) {
  std::size_t most = Path::most;
  if (path.running && path.running->history) {
    most = std::max(most, path.running->history->rows());
    history_workspace_ = path.program.workspace(path.running->history->rows());
  }
  if (path.goes_on() && path.running->history) {
    carried_.assign(path.running->running.count, std::vector<double>(Path::most));
    for (const auto& each : carried_) carried_at_.push_back(each.data());
  }
  for (std::size_t e = 0; e < path.model->effects.size(); ++e) effect_[e].resize(most);
}

void PathAt::move_to(const double* x) {
  population_ = population_at_(x);
  for (std::size_t i = 0; i < inner_.size(); ++i) inner_[i] = x[path_->shared[i]];
}

void PathAt::fill_effects(std::size_t count, const double* z) {
  static constexpr double middle[2] = {};
  const std::size_t d = path_->model->effects.size();
  for (std::size_t e = 0; e < d; ++e) {
    for (std::size_t i = 0; i < count; ++i) {
      effect_[e][i] = population_.value(*path_->model, e, z ? z + i * d : middle);
    }
  }
}

void PathAt::retrace(const double* z) {
  static constexpr double middle[2] = {};
  const formula::Data& history = *path_->running->history;
  const std::size_t d = path_->model->effects.size();
  const double* by_row[2] = {effect_[0].data(), effect_[1].data()};
  for (std::size_t e = 0; e < d; ++e) {
    std::fill_n(effect_[e].begin(), history.rows(),
                population_.value(*path_->model, e, z ? z : middle));
  }
  path_->program.forward(history, 0, history.rows(), {inner_, {by_row, d}}, history_workspace_);
}

double PathAt::retraced(std::size_t o, std::size_t row) const {
  const std::span<const double> values = history_workspace_.values(o);
  return values[values.size() == 1 ? 0 : row];
}

void PathAt::stand(std::size_t count, const double* z) {
  if (!path_->goes_on() || !path_->running->history) return;
  const std::size_t d = path_->model->effects.size();
  std::vector<double> last(carried_.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (i == 0 || (d > 0 && z)) {
      retrace(z && d > 0 ? z + i * d : nullptr);
      path_->program.carry(history_workspace_, path_->running->history->rows() - 1, last);
    }
    for (std::size_t r = 0; r < last.size(); ++r) carried_[r][i] = last[r];
  }
}

void PathAt::evaluate(std::size_t count, const double* z, const double* place,
                      std::span<const double* const> varied) {
  fill_effects(count, z);
  const double* by_row[3 + VariedConditions::most] = {effect_[0].data(), effect_[1].data()};
  std::size_t given = path_->model->effects.size();
  if (path_->running) {
    path_->running->bind(path_->program, count, place, ahead_);
    path_->program.forward(ahead_, 0, count, {inner_, {by_row, given}, carried_at_}, workspace_);
    return;
  }
  if (path_->along) by_row[given++] = place;
  for (const double* const each : varied) by_row[given++] = each;
  path_->program.forward(path_->data, 0, count, {inner_, {by_row, given}}, workspace_);
}

double PathAt::output(std::size_t o, std::size_t i) const {
  const std::span<const double> values = workspace_.values(o);
  return values[values.size() == 1 ? 0 : i];
}

}  // namespace wearwell::formula_model
