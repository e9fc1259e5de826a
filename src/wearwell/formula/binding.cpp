// Binding of rows to a program, and the workspace of a call.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "wearwell/base/error.h"
#include "wearwell/formula/program_body.h"
#include "wearwell/formula/recurrence.h"
#include "wearwell/formula/running_sum.h"

namespace wearwell::formula {

Workspace Program::workspace(std::size_t most_rows) const {
  const Tape& tape = body_->tape;
  Workspace made;
  made.body_ = std::make_unique<Workspace::Body>();
  Workspace::Body& work = *made.body_;
  // Avoids strides that map to the same cache sets.
  work.most = (std::max<std::size_t>(most_rows, 1) + 15) / 8 * 8;
  work.numbers = tape.numbers;
  work.number_adjoints.assign(tape.numbers.size(), 0);
  work.values.assign(static_cast<std::size_t>(tape.rows) * work.most, 0);
  work.adjoints.assign(work.values.size(), 0);
  work.level_values.assign(static_cast<std::size_t>(tape.levels), 0);
  work.level_adjoints.assign(work.level_values.size(), 0);
  work.at.resize(tape.cells.size());
  work.adjoint_at.resize(tape.cells.size());
  for (std::size_t i = 0; i < tape.cells.size(); ++i) {
    if (tape.cells[i].slot < 0) continue;  // read directly from the parameters
    const auto slot = static_cast<std::size_t>(tape.cells[i].slot);
    if (tape.cells[i].home == Cell::number) {
      work.at[i] = &work.numbers[slot];
      work.adjoint_at[i] = &work.number_adjoints[slot];
    } else if (tape.cells[i].home == Cell::level) {
      work.at[i] = &work.level_values[slot];
      work.adjoint_at[i] = &work.level_adjoints[slot];
    } else if (tape.cells[i].home == Cell::row) {
      work.at[i] = &work.values[slot * work.most];
      work.adjoint_at[i] = &work.adjoints[slot * work.most];
    }
  }
  for (const OutputCell& output : tape.outputs) {
    const bool uniform = tape.cells[static_cast<std::size_t>(output.cell)].uniform();
    work.output_cells.push_back(output.cell);
    work.output_uniform.push_back(uniform);
    work.output_adjoints.emplace_back(uniform ? 1 : work.most);
    if (output.owner)
      work.adjoint_at[static_cast<std::size_t>(output.cell)] = work.output_adjoints.back().data();
  }
  if (!tape.states.empty()) {
    work.solver.emplace(tape.states.front(), body_->start);
    work.state_rows.inputs.resize(tape.states.front().inputs.size());
    work.state_adjoints.inputs.resize(tape.states.front().inputs.size());
  }
  return made;
}

Data Program::bind(const Rows& rows) const {
  Data data;
  bind(rows, data);
  return data;
}

namespace {

// The state of row i's path at the previous row.
double place_before(const StateStart& start, const std::vector<double>& axis,
                    const Data::Body& rows, std::size_t i) {
  if (rows.starts[i] == 0) return axis[i - 1];
  if (!rows.from.empty()) return rows.from[i];
  return start.at_first_row ? axis[i] : start.at;
}

void check_axis(const Symbols& symbols, const StateStart& start, const std::vector<double>& axis,
                const Data::Body& rows) {
  const std::vector<std::uint8_t>& starts = rows.starts;
  const std::string& name = symbols.columns[static_cast<std::size_t>(start.axis)].name;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    const double least = place_before(start, axis, rows, i);
    if (axis[i] >= least) continue;
    throw InputError(
        starts[i] == 0
            ? fmt::format("'{}' decreases at row {}, from {:.6g} to {:.6g} in SI; a state needs "
                          "ascending values of it",
                          name, i + 1, least, axis[i])
            : fmt::format(
                  "'{}' is {:.6g} in SI at row {}, before the beginning of the state at {:.6g}",
                  name, axis[i], i + 1, least));
  }
}

// The increment of `axis` since the previous row.
void steps_along(const StateStart& start, const std::vector<double>& axis, const Data::Body& rows,
                 std::vector<double>& steps) {
  for (std::size_t i = 0; i < axis.size(); ++i) {
    steps[i] = axis[i] - place_before(start, axis, rows, i);
  }
}

}  // namespace

void Program::bind(const Rows& rows, Data& data) const {
  const Tape& tape = body_->tape;
  const Symbols& symbols = body_->symbols;
  if (!data.body_) data.body_ = std::make_unique<Data::Body>();
  Data::Body& body = *data.body_;
  body.rows = rows.count;
  body.starts.assign(rows.count, 0);
  for (const std::size_t path : rows.paths)
    if (path < rows.count) body.starts[path] = 1;
  if (rows.count > 0) body.starts[0] = 1;
  body.from.assign(rows.from.begin(), rows.from.end());
  body.repeats.assign(rows.repeats.begin(), rows.repeats.end());
  body.columns.resize(static_cast<std::size_t>(tape.data));
  for (auto& column : body.columns) column.resize(rows.count);
  body.labels.resize(symbols.labels.size());
  const auto slot = [&](int cell) -> std::vector<double>& {
    return body.columns[static_cast<std::size_t>(tape.cells[static_cast<std::size_t>(cell)].slot)];
  };
  for (const DataLeaf& leaf : tape.leaves) {
    const auto index = static_cast<std::size_t>(leaf.index);
    std::vector<double>& to = slot(leaf.cell);
    if (leaf.op == Op::label_is) {
      if (rows.labels.size() <= index || rows.labels[index].size() != rows.count)
        throw std::logic_error("bind: rows without the label '" + symbols.labels[index].name + "'");
      for (std::size_t i = 0; i < rows.count; ++i) to[i] = rows.labels[index][i] == leaf.level;
      continue;
    }
    if (rows.columns.size() <= index || rows.columns[index].size() != rows.count)
      throw std::logic_error("bind: rows without the column '" + symbols.columns[index].name + "'");
    std::copy(rows.columns[index].begin(), rows.columns[index].end(), to.begin());
    const bool along =
        body_->start.axis == leaf.index && (leaf.op == Op::step || !tape.states.empty());
    if (along) check_axis(symbols, body_->start, to, body);
    if (leaf.op != Op::step) continue;
    const std::vector<double> axis = to;
    steps_along(body_->start, axis, body, to);
  }
  for (const Step& step : tape.row_steps) {
    if (step.op != Op::expand) continue;
    const auto label = static_cast<std::size_t>(step.label);
    if (rows.labels.size() <= label || rows.labels[label].size() != rows.count)
      throw std::logic_error("bind: rows without the label '" + symbols.labels[label].name + "'");
    body.labels[label].assign(rows.labels[label].begin(), rows.labels[label].end());
  }
  const auto argument = [&](int cell) -> const double* {
    if (cell < 0) return nullptr;
    const Cell& each = tape.cells[static_cast<std::size_t>(cell)];
    return each.uniform() ? &tape.numbers[static_cast<std::size_t>(each.slot)]
                          : body.columns[static_cast<std::size_t>(each.slot)].data();
  };
  for (const Step& step : tape.bind_steps) {
    double* out = slot(step.out).data();
    if (step.op == Op::cum) {
      running_sum(argument(step.a), tape.cells[static_cast<std::size_t>(step.a)].uniform(),
                  body.starts.data(), out, rows.count);
    } else if (step.op == Op::recurrence) {
      Recurrence{argument(step.a),   argument(step.c),
                 argument(step.b),   tape.cells[static_cast<std::size_t>(step.b)].uniform(),
                 body.starts.data(), rows.count}
          .forward(out);
    } else {
      step.kernels.forward(argument(step.a), argument(step.b), argument(step.c), out, rows.count,
                           step.extra);
    }
  }
}

}  // namespace wearwell::formula
