#include "wearwell/models/formula_model/formula_running.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/models/formula_model/formula_path.h"

namespace wearwell::formula_model {
namespace {

constexpr double same = 1e-6;  // of the largest position on the axis: rounding in files

// The rows of each unit along the axis.
std::vector<std::vector<std::size_t>> rows_of_units(const FormulaModel& model,
                                                    const NumberColumn& axis) {
  std::vector<std::vector<std::size_t>> rows(model.units.size());
  for (std::size_t row = 0; row < model.data.table.rows; ++row) {
    rows[model.unit_of_row[row]].push_back(row);
  }
  for (auto& each : rows) {
    std::stable_sort(each.begin(), each.end(),
                     [&](std::size_t a, std::size_t b) { return axis.values[a] < axis.values[b]; });
  }
  return rows;
}

class Continuation {
 public:
  Continuation(const FormulaModel& model, const TomlReader& table, const std::string& key,
               const formula::Program& program, const Conditions& conditions)
      : model_(model),
        table_(table),
        key_(key),
        program_(program),
        conditions_(conditions),
        axis_(*model.data.number(*model.along)),
        rows_(rows_of_units(model, axis_)) {
    for (const double each : axis_.values) size_ = std::max(size_, std::abs(each));
    path_.running = program.running();
    path_.numbers.assign(columns().size(), std::nan(""));
    path_.labels.assign(model.row_symbols.labels.size(), 0);
  }

  RunningPath run(std::optional<std::size_t> unit) {
    if (path_.running.nested) {
      table_.fail(key_,
                  "has a running sum or a state of something that depends on earlier rows; its "
                  "continuation is not predicted");
    }
    for (std::size_t c = 0; c < columns().size(); ++c) read_column(c);
    for (std::size_t l = 0; l < model_.row_symbols.labels.size(); ++l) read_label(l);
    if (path_.running.sums) find_row_length();
    if (unit) {
      bind_history(rows_[*unit]);
    } else {
      path_.begin = beginning();
    }
    if (path_.running.sums) require_additive();
    return std::move(path_);
  }

 private:
  const std::vector<formula::ColumnSymbol>& columns() const { return model_.row_symbols.columns; }
  double shown(double si) const { return from_si(axis_.unit.unit, si); }

  // In all rows but the first of a unit, which has no previous row.
  bool is_step(const NumberColumn& column) const {
    if (column.unit.powers != axis_.unit.powers || column.name == axis_.name) return false;
    bool any = false;
    for (const auto& rows : rows_) {
      for (std::size_t i = 1; i < rows.size(); ++i) {
        const double step = axis_.values[rows[i]] - axis_.values[rows[i - 1]];
        if (!(std::abs(column.values[rows[i]] - step) <= same * size_)) return false;
        any = true;
      }
    }
    return any;
  }

  void read_column(std::size_t c) {
    const std::string& name = columns()[c].name;
    if (name == *model_.along) path_.axis = c;
    if (!program_.uses_column(c) || name == *model_.along) return;
    const NumberColumn& column = *model_.data.number(name);
    model_.data.require_complete(column);
    const auto at = conditions_.numbers.find(name);
    const bool said = at != conditions_.numbers.end() && !conditions_.of_last_row.count(name);
    if (path_.running.sums && is_step(column)) {
      step_ = &column;
      if (said) {
        if (!(at->second > 0)) table_.fail(key_, fmt::format("needs steps of {} above 0", name));
        path_.row_length = at->second;
      } else {
        path_.steps.push_back(c);
        return;
      }
    }
    if (at == conditions_.numbers.end()) fail_without_condition(model_, table_, key_, name);
    path_.numbers[c] = at->second;
  }

  void read_label(std::size_t l) {
    if (!program_.uses_label(l)) return;
    const formula::LabelSymbol& label = model_.row_symbols.labels[l];
    const auto at = conditions_.labels.find(label.name);
    if (at == conditions_.labels.end()) {
      fail_without_label(table_, key_, label);
    }
    path_.labels[l] = at->second;
  }

  void find_row_length() {
    if (path_.row_length > 0 || !path_.steps.empty()) return;
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const auto& rows : rows_) {
      for (std::size_t i = 1; i < rows.size(); ++i) {
        const double step = axis_.values[rows[i]] - axis_.values[rows[i - 1]];
        least = std::min(least, step);
        most = std::max(most, step);
      }
    }
    if (most - least <= same * size_ && least > 0) {
      path_.row_length = 0.5 * (least + most);
      return;
    }
    table_.fail(
        key_,
        most == 0
            ? fmt::format("sums over rows (cum), but no unit has two rows: the spacing of future "
                          "rows along {} is unknown",
                          axis_.name)
            : fmt::format(
                  "sums over rows (cum) that are {:.6g} to {:.6g} {} apart: the number of future "
                  "rows is unknown. Sum a quantity proportional to the step of each row, a column "
                  "of {} since the previous row; or write a state, \"d(x)/d({})\"",
                  shown(least), shown(most), axis_.unit.unit.text, axis_.name, axis_.name));
  }

  // The common position of the first rows of units, less `before` of it.
  template <class Before>
  double common_place(const Before& before, const char* what) const {
    double first = std::nan("");
    for (const auto& rows : rows_) {
      const double place = axis_.values[rows.front()] - before(rows.front());
      if (std::isnan(first)) first = place;
      if (std::abs(place - first) <= same * size_) continue;
      table_.fail(key_, fmt::format("{} where the data do, but units begin at {:.6g} and at {:.6g} "
                                    "{}: the start of a new unit is ambiguous",
                                    what, shown(first), shown(place), axis_.unit.unit.text));
    }
    return first;
  }

  // Of a new unit.
  double beginning() const {
    std::optional<double> by_state, by_sum;
    if (path_.running.state) {
      by_state = path_.running.at;
      if (path_.running.at_first_row) {
        by_state = common_place([](std::size_t) { return 0.0; }, "its state begins");
      }
    }
    if (path_.running.sums) {
      by_sum = common_place(
          [&](std::size_t row) { return step_ ? step_->values[row] : path_.row_length; },
          "its running sum begins");
    }
    if (by_state && by_sum && std::abs(*by_state - *by_sum) > same * size_) {
      table_.fail(key_, fmt::format("its state begins at {:.6g} {}, and its running sum at {:.6g}",
                                    shown(*by_state), axis_.unit.unit.text, shown(*by_sum)));
    }
    if (by_state || by_sum) return by_state ? *by_state : *by_sum;
    return std::min(0.0, *std::min_element(axis_.values.begin(), axis_.values.end()));
  }

  void bind_history(const std::vector<std::size_t>& rows) {
    path_.begin = axis_.values[rows.back()];
    std::vector<std::vector<double>> numbers(columns().size());
    std::vector<std::vector<int>> labels(model_.row_symbols.labels.size());
    formula::Rows bound;
    bound.count = rows.size();
    for (std::size_t c = 0; c < columns().size(); ++c) {
      if (!program_.uses_column(c) && c != path_.axis) continue;
      for (const std::size_t row : rows) {
        numbers[c].push_back(model_.data.number(columns()[c].name)->values[row]);
      }
    }
    for (std::size_t l = 0; l < labels.size(); ++l) {
      if (!program_.uses_label(l)) continue;
      const LabelColumn& label = *model_.data.label(model_.row_symbols.labels[l].name);
      for (const std::size_t row : rows) labels[l].push_back(label.at[row]);
    }
    for (const auto& each : numbers) bound.columns.emplace_back(each);
    for (const auto& each : labels) bound.labels.emplace_back(each);
    path_.history = std::make_unique<const formula::Data>(program_.bind(bound));
  }

  // One step of twice the length must equal two steps, at the start values of searches.
  void require_additive() const {
    const double reach = size_ > 0 ? size_ : 1;
    const double h = path_.row_length > 0 ? path_.row_length : 0.25 * reach;
    formula::Data data;
    const double places[] = {path_.begin + 2 * h, path_.begin + h};
    path_.bind(program_, 2, places, data);
    std::vector<double> inner, by_row_values[2];
    for (const std::size_t i : model_.shared) inner.push_back(model_.parameters[i].start);
    const double* by_row[2] = {};
    for (std::size_t e = 0; e < model_.effects.size(); ++e) {
      by_row_values[e].assign(2, model_.parameters[model_.effects[e].parameter].start);
      by_row[e] = by_row_values[e].data();
    }
    formula::Workspace workspace = program_.workspace(2);
    const std::size_t runs = path_.running.count;
    const std::span<const double* const> effects(by_row, model_.effects.size());
    program_.forward(data, 0, 2, {inner, effects}, workspace);
    std::vector<double> at_once(runs), half(runs), twice(runs);
    program_.carry(workspace, 0, at_once);
    program_.carry(workspace, 1, half);
    // Continues from half of the way.
    RunningPath rest;
    rest.running = path_.running;
    rest.axis = path_.axis;
    rest.numbers = path_.numbers;
    rest.labels = path_.labels;
    rest.steps = path_.steps;
    rest.row_length = path_.row_length;
    rest.begin = places[1];
    rest.bind(program_, 1, places, data);
    std::vector<const double*> carried;
    for (const double& each : half) carried.push_back(&each);
    program_.forward(data, 0, 1, {inner, effects, carried}, workspace);
    program_.carry(workspace, 0, twice);
    for (std::size_t i = 0; i < runs; ++i) {
      const double size = std::max(std::abs(at_once[i]), std::abs(half[i]));
      if (!(std::abs(at_once[i] - twice[i]) > 1e-8 * size)) continue;
      table_.fail(key_,
                  step_ && path_.row_length == 0
                      ? fmt::format("sums (cum) a quantity that is not proportional to the step "
                                    "'{}': give the length of future steps in predict.given.{}",
                                    step_->name, step_->name)
                      : "sums (cum) a quantity that varies over future rows; its continuation is "
                        "not predicted; write a state, \"d(x)/d(" +
                            axis_.name + ")\"");
    }
  }

  const FormulaModel& model_;
  const TomlReader& table_;
  const std::string& key_;
  const formula::Program& program_;
  const Conditions& conditions_;
  const NumberColumn& axis_;
  std::vector<std::vector<std::size_t>> rows_;
  double size_ = 0;
  const NumberColumn* step_ = nullptr;
  RunningPath path_;
};

}  // namespace

void RunningPath::bind(const formula::Program& program, std::size_t count, const double* place,
                       formula::Data& data) const {
  static thread_local std::vector<std::vector<double>> columns;
  static thread_local std::vector<std::vector<int>> texts;
  static thread_local formula::Rows rows;
  columns.resize(numbers.size());
  texts.resize(labels.size());
  rows.count = count;
  rows.columns.clear();
  rows.labels.clear();
  for (std::size_t c = 0; c < numbers.size(); ++c) {
    if (c == axis) {
      columns[c].assign(place, place + count);
    } else {
      columns[c].assign(count, numbers[c]);
    }
  }
  for (const std::size_t c : steps) {
    for (std::size_t i = 0; i < count; ++i) columns[c][i] = place[i] - begin;
  }
  for (std::size_t l = 0; l < labels.size(); ++l) texts[l].assign(count, labels[l]);
  for (const auto& each : columns) rows.columns.emplace_back(each);
  for (const auto& each : texts) rows.labels.emplace_back(each);
  rows.paths.resize(count);
  for (std::size_t i = 0; i < count; ++i) rows.paths[i] = i;
  rows.from.assign(count, begin);
  rows.repeats.clear();
  if (row_length > 0) {
    for (std::size_t i = 0; i < count; ++i) {
      rows.repeats.push_back((place[i] - begin) / row_length);
    }
  }
  program.bind(rows, data);
}

RunningPath continue_path(const FormulaModel& model, const TomlReader& table,
                          const std::string& key, const formula::Program& program,
                          const Conditions& conditions, std::optional<std::size_t> unit) {
  return Continuation(model, table, key, program, conditions).run(unit);
}

}  // namespace wearwell::formula_model
