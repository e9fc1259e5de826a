#include "wearwell/formula/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "wearwell/formula/program_body.h"
#include "wearwell/formula/recurrence.h"
#include "wearwell/formula/running_sum.h"

namespace wearwell::formula {

Data::Data() = default;
Data::Data(Data&&) noexcept = default;
Data& Data::operator=(Data&&) noexcept = default;
Data::~Data() = default;
std::size_t Data::rows() const {
  return body_ ? body_->rows : 0;
}

Workspace::Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;
Workspace::~Workspace() = default;

std::span<const double> Workspace::values(std::size_t i) const {
  return {body_->at[static_cast<std::size_t>(body_->output_cells[i])],
          body_->output_uniform[i] ? 1 : body_->rows};
}

std::span<double> Workspace::adjoints(std::size_t i) {
  return {body_->output_adjoints[i].data(), body_->output_uniform[i] ? 1 : body_->rows};
}

const std::vector<Output>& Program::outputs() const {
  return body_->outputs;
}
bool Program::uses_parameter(std::size_t i) const {
  return body_->parameters[i];
}
bool Program::uses_column(std::size_t i) const {
  return body_->columns[i];
}
bool Program::uses_label(std::size_t i) const {
  return body_->labels[i];
}
ByRowDegree Program::by_row_degree(std::size_t output) const {
  return formula::by_row_degree(body_->graph, body_->roots[output]);
}
bool Program::has_paths() const {
  return body_->tape.has_paths;
}

Running Program::running() const {
  const Tape& tape = body_->tape;
  return {tape.runs.size(),     tape.sums,
          tape.nested,          body_->start.axis >= 0,
          !tape.states.empty(), body_->start.at_first_row,
          body_->start.at};
}

void Program::carry(const Workspace& workspace, std::size_t row, std::span<double> carried) const {
  const std::vector<int>& runs = body_->tape.runs;
  for (std::size_t i = 0; i < runs.size(); ++i)
    carried[i] = workspace.body_->at[static_cast<std::size_t>(runs[i])][row];
}

namespace {

void prepare_state(const Tape& tape, Workspace::Body& work, const Data::Body& data,
                   std::size_t begin) {
  const StatePlan& plan = tape.states.front();
  const auto values = [&](int cell) {
    return Values{work.at[static_cast<std::size_t>(cell)],
                  tape.cells[static_cast<std::size_t>(cell)].uniform()};
  };
  work.state_rows.axis = work.at[static_cast<std::size_t>(plan.axis)];
  work.state_rows.starts = data.starts.data() + begin;
  work.state_rows.from = data.from.empty() ? nullptr : data.from.data() + begin;
  work.state_rows.count = work.rows;
  work.state_rows.beginning = work.state_rows.anchor = values(plan.beginning);
  for (std::size_t j = 0; j < plan.inputs.size(); ++j)
    work.state_rows.inputs[j] = values(plan.inputs[j]);
}

}  // namespace

namespace {

Recurrence recurrence(const Tape& tape, const Workspace::Body& work, const Data::Body& data,
                      std::size_t begin, const Step& step) {
  const auto at = [&](int cell) {
    return cell < 0 ? nullptr : work.at[static_cast<std::size_t>(cell)];
  };
  return {at(step.a),
          at(step.c),
          at(step.b),
          tape.cells[static_cast<std::size_t>(step.b)].uniform(),
          data.starts.data() + begin,
          work.rows};
}

}  // namespace

void Program::forward(const Data& data, std::size_t begin, std::size_t end, const Inputs& inputs,
                      Workspace& workspace) const {
  const Tape& tape = body_->tape;
  const Data::Body& rows = *data.body_;
  Workspace::Body& work = *workspace.body_;
  if (begin > end || end > rows.rows || end - begin > work.most)
    throw std::logic_error("forward: rows that the data or the workspace do not have");
  const std::size_t n = work.rows = end - begin;
  for (std::size_t i = 0; i < tape.cells.size(); ++i) {
    if (tape.cells[i].home == Cell::data)
      work.at[i] = rows.columns[static_cast<std::size_t>(tape.cells[i].slot)].data() + begin;
  }
  for (const ParameterLeaf& leaf : tape.by_row)
    work.at[static_cast<std::size_t>(leaf.cell)] =
        inputs.by_row[static_cast<std::size_t>(leaf.slot)];
  for (const ParameterLeaf& leaf : tape.parameters) {
    const auto slot =
        static_cast<std::size_t>(tape.cells[static_cast<std::size_t>(leaf.cell)].slot);
    work.numbers[slot] = inputs.parameters[static_cast<std::size_t>(leaf.slot)];
  }
  for (const ParameterLeaf& leaf : tape.by_level)
    work.at[static_cast<std::size_t>(leaf.cell)] = inputs.parameters.data() + leaf.slot;
  const auto at = [&](int cell) {
    return cell < 0 ? nullptr : work.at[static_cast<std::size_t>(cell)];
  };
  const auto carried = [&](const Step& step) {
    return step.run < 0 || inputs.carried.empty()
               ? nullptr
               : inputs.carried[static_cast<std::size_t>(step.run)];
  };
  for (const Step& step : tape.number_steps) {
    double* out = &work.numbers[static_cast<std::size_t>(
        tape.cells[static_cast<std::size_t>(step.out)].slot)];
    step.kernels.forward(at(step.a), at(step.b), at(step.c), out, 1, step.extra);
  }
  for (const Step& step : tape.level_steps) {
    double* out = &work.level_values[static_cast<std::size_t>(
        tape.cells[static_cast<std::size_t>(step.out)].slot)];
    step.kernels.forward(at(step.a), at(step.b), at(step.c), out,
                         static_cast<std::size_t>(step.levels), step.extra);
  }
  for (const Step& step : tape.row_steps) {
    double* out =
        &work.values[static_cast<std::size_t>(tape.cells[static_cast<std::size_t>(step.out)].slot) *
                     work.most];
    if (step.kernels.forward != nullptr) {
      step.kernels.forward(at(step.a), at(step.b), at(step.c), out, n, step.extra);
    } else if (step.op == Op::expand) {
      const int* label = rows.labels[static_cast<std::size_t>(step.label)].data() + begin;
      const double* known = at(step.a);
      for (std::size_t i = 0; i < n; ++i) out[i] = known[label[i]];
    } else if (step.op == Op::cum) {
      running_sum(at(step.a), tape.cells[static_cast<std::size_t>(step.a)].uniform(),
                  rows.starts.data() + begin, out, n, carried(step),
                  step.run < 0 || rows.repeats.empty() || step.extra == whole_step
                      ? nullptr
                      : rows.repeats.data() + begin);
    } else if (step.op == Op::recurrence) {
      Recurrence running = recurrence(tape, work, rows, begin, step);
      if (const double* before = carried(step)) {
        running.beginning = before;
        running.uniform_beginning = false;
      }
      running.forward(out);
    } else {
      prepare_state(tape, work, rows, begin);
      if (const double* before = carried(step)) work.state_rows.beginning = {before, false};
      work.solver->forward(work.state_rows, out);
    }
  }
}

namespace {

// The adjoints of a cell, zeroed before the first contribution.
double* emptied(const Tape& tape, Workspace::Body& work, int cell, bool gives, bool first) {
  if (!gives) return nullptr;
  double* to = work.adjoint_at[static_cast<std::size_t>(cell)];
  if (first && !tape.cells[static_cast<std::size_t>(cell)].uniform())
    std::fill(to, to + work.rows, 0.0);
  return to;
}

void reverse_state(const Tape& tape, Workspace::Body& work, const Data::Body& data,
                   std::size_t begin, const Step& step) {
  const StatePlan& plan = tape.states.front();
  prepare_state(tape, work, data, begin);
  for (std::size_t j = 0; j < plan.inputs.size(); ++j)
    work.state_adjoints.inputs[j] =
        emptied(tape, work, plan.inputs[j], plan.gives[j], plan.first[j]);
  work.state_adjoints.beginning =
      emptied(tape, work, plan.beginning, plan.beginning_gives, plan.beginning_first);
  work.solver->reverse(work.state_rows, work.at[static_cast<std::size_t>(step.out)],
                       work.adjoint_at[static_cast<std::size_t>(step.out)], work.state_adjoints);
}

// Adds to the sum of each label. Rows of one label are usually adjacent and are summed in four
// lanes.
void sum_by_label(const int* label, const double* x, std::size_t n, double* sums) {
  for (std::size_t i = 0; i < n;) {
    const int here = label[i];
    double lane[4] = {};
    for (std::size_t j = 0; i < n && label[i] == here; ++i, j = (j + 1) % 4) lane[j] += x[i];
    sums[here] += (lane[0] + lane[2]) + (lane[1] + lane[3]);
  }
}

// Adds the caller's adjoints of outputs that do not own the adjoints of their cell.
void collect_outputs(const Tape& tape, Workspace::Body& work) {
  for (std::size_t i = 0; i < tape.outputs.size(); ++i) {
    const OutputCell& output = tape.outputs[i];
    double* to = work.adjoint_at[static_cast<std::size_t>(output.cell)];
    if (!output.active || output.owner || to == nullptr) continue;
    const std::size_t n = work.output_uniform[i] ? 1 : work.rows;
    for (std::size_t j = 0; j < n; ++j) to[j] += work.output_adjoints[i][j];
  }
}

}  // namespace

void Program::reverse(const Data& data, std::size_t begin, std::size_t, const Inputs&,
                      Workspace& workspace, std::span<double> gradient,
                      std::span<double* const> by_row) const {
  const Tape& tape = body_->tape;
  const Data::Body& rows = *data.body_;
  Workspace::Body& work = *workspace.body_;
  std::fill(work.number_adjoints.begin(), work.number_adjoints.end(), 0.0);
  for (const ParameterLeaf& leaf : tape.by_row) {
    const auto slot = static_cast<std::size_t>(leaf.slot);
    work.adjoint_at[static_cast<std::size_t>(leaf.cell)] =
        slot < by_row.size() ? by_row[slot] : nullptr;
  }
  for (const ParameterLeaf& leaf : tape.by_level)
    work.adjoint_at[static_cast<std::size_t>(leaf.cell)] = gradient.data() + leaf.slot;
  collect_outputs(tape, work);
  const auto at = [&](int cell) {
    return cell < 0 ? nullptr : work.at[static_cast<std::size_t>(cell)];
  };
  const auto to = [&](const Step& step, int cell, unsigned bit) {
    return (step.gives >> bit & 1u) != 0 ? work.adjoint_at[static_cast<std::size_t>(cell)]
                                         : nullptr;
  };
  const auto run = [&](const Step& step, std::size_t n) {
    step.kernels.reverse(at(step.a), at(step.b), at(step.c), at(step.out),
                         work.adjoint_at[static_cast<std::size_t>(step.out)], to(step, step.a, 0),
                         to(step, step.b, 1), to(step, step.c, 2), n, step.extra, step.first);
  };
  for (std::size_t i = tape.row_steps.size(); i-- > 0;) {
    const Step& step = tape.row_steps[i];
    if (step.gives == 8) continue;  // the adjoint is not needed
    const double* given = work.adjoint_at[static_cast<std::size_t>(step.out)];
    if (step.kernels.reverse != nullptr) {
      run(step, work.rows);
    } else if (step.op == Op::expand) {
      if (double* sums = to(step, step.a, 0); sums != nullptr) {
        if ((step.first & 1u) != 0) std::fill(sums, sums + step.levels, 0.0);
        sum_by_label(rows.labels[static_cast<std::size_t>(step.label)].data() + begin, given,
                     work.rows, sums);
      }
    } else if (step.op == Op::cum) {
      if (double* sum = to(step, step.a, 0); sum != nullptr)
        running_sum_reverse(given, tape.cells[static_cast<std::size_t>(step.a)].uniform(),
                            rows.starts.data() + begin, sum, work.rows, (step.first & 1u) != 0);
    } else if (step.op == Op::recurrence) {
      const auto place = [&](int cell, unsigned bit) {
        return emptied(tape, work, cell, (step.gives >> bit & 1u) != 0,
                       (step.first >> bit & 1u) != 0);
      };
      double* growth = place(step.a, 0);
      double* gain = place(step.c, 2);
      recurrence(tape, work, rows, begin, step)
          .reverse(at(step.out), given, growth, gain, place(step.b, 1));
    } else {
      reverse_state(tape, work, rows, begin, step);
    }
  }
  for (std::size_t i = tape.level_steps.size(); i-- > 0;) {
    const Step& step = tape.level_steps[i];
    if (step.gives != 8) run(step, static_cast<std::size_t>(step.levels));
  }
  for (std::size_t i = tape.number_steps.size(); i-- > 0;)
    if (tape.number_steps[i].gives != 8) run(tape.number_steps[i], 1);
  for (const ParameterLeaf& leaf : tape.parameters)
    gradient[static_cast<std::size_t>(leaf.slot)] +=
        *work.adjoint_at[static_cast<std::size_t>(leaf.cell)];
}

std::string Program::text(std::size_t output) const {
  return text_of(body_->graph, body_->roots[output], body_->symbols);
}

std::string Program::state_text() const {
  if (body_->rate < 0) return {};
  const ColumnSymbol& axis = body_->symbols.columns[static_cast<std::size_t>(body_->start.axis)];
  const std::string& name = body_->graph.state_name();
  const std::string place =
      body_->start.at_first_row ? "first"
      : body_->start.at == 0    ? "0"
                             : fmt::format("{:.6g} {}", body_->start.at, description(axis.powers));
  return fmt::format("d({})/d({}) = {}, {}({}) = {}", name, axis.name,
                     text_of(body_->graph, body_->rate, body_->symbols), name, place,
                     text_of(body_->graph, body_->beginning, body_->symbols));
}

}  // namespace wearwell::formula
