#include "wearwell/formula/tape.h"

#include <algorithm>
#include <map>

#include "wearwell/formula/rate_factor.h"

// Longer than others: one walk over the graph, and the plan of its state.
namespace wearwell::formula {
namespace {

class Maker {
 public:
  Maker(const Graph& graph, const std::vector<int>& roots, const Symbols& symbols,
        const StateStart& start, bool continued)
      : graph_(graph),
        roots_(roots),
        symbols_(symbols),
        start_(start),
        continued_(continued),
        slots_(slots(symbols)),
        cell_(static_cast<std::size_t>(graph.size()), -1) {}

  Tape run() {
    mark();
    for (int i = 0; i < graph_.size(); ++i)
      if (needed_[static_cast<std::size_t>(i)] && !graph_[i].moving) place(i);
    for (const int root : roots_) tape_.outputs.push_back({row_cell(root), false, false});
    activate();
    return std::move(tape_);
  }

 private:
  int cell(int node) const { return node < 0 ? -1 : cell_[static_cast<std::size_t>(node)]; }
  Cell& home(int cell) { return tape_.cells[static_cast<std::size_t>(cell)]; }

  // The operations of a state's rate are not separate steps; they run within the state's steps.
  void mark() {
    needed_ = reachable(graph_, roots_);
    for (int i = 0; i < graph_.size(); ++i) {
      if (!needed_[static_cast<std::size_t>(i)]) continue;
      tape_.has_paths |=
          graph_[i].op == Op::cum || graph_[i].op == Op::state || graph_[i].op == Op::recurrence;
    }
  }

  int levels_of(int label) const {
    return label < 0
               ? 0
               : static_cast<int>(symbols_.labels[static_cast<std::size_t>(label)].levels.size());
  }

  // The cell of a node in row computations; values by label are expanded over the rows.
  int row_cell(int node) {
    const int at = cell(node);
    if (at < 0 || home(at).home != Cell::level) return at;
    const auto [known, is_new] = expanded_.emplace(node, -1);
    if (!is_new) return known->second;
    Step step;
    step.op = Op::expand;
    step.a = at;
    step.out = known->second = new_cell(Cell::row);
    step.label = graph_[node].by_label;
    step.levels = levels_of(step.label);
    tape_.row_steps.push_back(step);
    return step.out;
  }

  void expand_arguments(const Node& node) {
    for (const int argument : {node.a, node.b, node.c})
      if (argument >= 0 && !graph_[argument].moving) row_cell(argument);
  }

  int new_cell(Cell::Home home, int levels = 0) {
    Cell each{home, 0};
    if (home == Cell::number) {
      each.slot = static_cast<int>(tape_.numbers.size());
      tape_.numbers.push_back(0);
    } else if (home == Cell::data) {
      each.slot = tape_.data++;
    } else if (home == Cell::row) {
      each.slot = tape_.rows++;
    } else if (home == Cell::level) {
      each.slot = tape_.levels;
      tape_.levels += levels;
    } else {
      each.slot = static_cast<int>(tape_.by_row.size());
    }
    tape_.cells.push_back(each);
    return static_cast<int>(tape_.cells.size()) - 1;
  }

  void place(int i) {
    const Node& node = graph_[i];
    const bool computed = node.parametric || (continued_ && node.by_path);
    Cell::Home where = !node.rows ? Cell::number : computed ? Cell::row : Cell::data;
    if (node.op == Op::by_row) where = Cell::by_row;
    if (node.op == Op::state) prepare_state(node);
    if (node.by_label >= 0 && node.parametric) where = Cell::level;
    if (where == Cell::row) expand_arguments(node);
    const int at = cell_[static_cast<std::size_t>(i)] = new_cell(where, levels_of(node.by_label));
    const auto parameter = static_cast<std::size_t>(std::max(node.index, 0));
    switch (node.op) {
      case Op::constant:
        tape_.numbers[static_cast<std::size_t>(home(at).slot)] = node.value;
        return;
      case Op::parameter:
        tape_.parameters.push_back(
            {at, static_cast<int>(slots_[parameter]) + std::max(node.level, 0)});
        return;
      case Op::pick:
        home(at).slot = -1;
        tape_.by_level.push_back({at, static_cast<int>(slots_[parameter])});
        return;
      case Op::by_row:
        tape_.by_row.push_back({at, by_row_index(node.index)});
        return;
      case Op::column:
      case Op::label_is:
      case Op::step:
        tape_.leaves.push_back({node.op, at, node.index, node.level});
        return;
      default:
        break;
    }
    Step step = step_of(node, at);
    step.levels = levels_of(node.by_label);
    if (node.op == Op::state) tape_.states.back().out = at;
    if (node.op == Op::state || node.op == Op::recurrence) tape_.state = at;
    if (continued_) note_run(node, step);
    (where == Cell::number  ? tape_.number_steps
     : where == Cell::data  ? tape_.bind_steps
     : where == Cell::level ? tape_.level_steps
                            : tape_.row_steps)
        .push_back(step);
  }

  void note_run(const Node& node, Step& step) {
    if (node.op != Op::cum && node.op != Op::state && node.op != Op::recurrence) return;
    step.run = static_cast<int>(tape_.runs.size());
    tape_.runs.push_back(step.out);
    tape_.sums |= node.op == Op::cum && node.value == 0;
    std::vector<int> arguments;
    for (const int each : {node.a, node.b, node.c})
      if (each >= 0) arguments.push_back(each);
    const std::vector<bool> within = reachable(graph_, arguments);
    for (int i = 0; i < graph_.size(); ++i)
      tape_.nested |= within[static_cast<std::size_t>(i)] && graph_[i].by_path;
  }

  int by_row_index(int parameter) const {
    int count = 0;
    for (int i = 0; i < parameter; ++i)
      count += symbols_.parameters[static_cast<std::size_t>(i)].scope == Scope::per_row;
    return count;
  }

  Step step_of(const Node& node, int out) {
    Step step;
    step.op = node.op;
    step.out = out;
    step.extra = node.value;
    if (node.op == Op::state) return step;
    const bool by_label = home(out).home == Cell::level;
    step.a = by_label ? cell(node.a) : row_cell(node.a);
    step.b = by_label ? cell(node.b) : row_cell(node.b);
    step.c = by_label ? cell(node.c) : row_cell(node.c);
    unsigned uniform = 0;
    const int arguments[] = {step.a, step.b, step.c};
    for (unsigned i = 0; i < 3; ++i)
      if (arguments[i] >= 0 && home(arguments[i]).uniform()) uniform |= 1u << i;
    step.kernels = kernels_of(node.op, uniform);
    return step;
  }

  // The steps of the rate: moving nodes are numbers, all others are inputs.
  void prepare_state(const Node& node) {
    StatePlan plan;
    plan.beginning = row_cell(node.a);
    plan.axis = axis_cell();
    const std::vector<bool> within = reachable(graph_, {node.b});
    std::vector<int> number(static_cast<std::size_t>(graph_.size()), -1), moving;
    const auto new_number = [&](int i, double value = 0) {
      number[static_cast<std::size_t>(i)] = static_cast<int>(plan.numbers.size());
      plan.numbers.push_back(value);
    };
    std::vector<int> inputs;
    for (int i = 0; i < graph_.size(); ++i) {
      if (!within[static_cast<std::size_t>(i)] || !graph_[i].moving) continue;
      moving.push_back(i);
      for (const int argument : {graph_[i].a, graph_[i].b, graph_[i].c}) {
        if (argument < 0 || graph_[argument].moving) continue;
        if (graph_[argument].op != Op::constant) inputs.push_back(argument);
      }
    }
    std::sort(inputs.begin(), inputs.end());
    inputs.erase(std::unique(inputs.begin(), inputs.end()), inputs.end());
    plan.first_input = 0;
    for (const int each : inputs) {
      plan.inputs.push_back(row_cell(each));
      new_number(each);
    }
    plan.gives.resize(inputs.size());
    plan.first.resize(inputs.size());
    const auto number_of = [&](int argument) {
      if (argument < 0) return -1;
      if (number[static_cast<std::size_t>(argument)] < 0)
        new_number(argument, graph_[argument].value);
      return number[static_cast<std::size_t>(argument)];
    };
    for (const int each : moving) {
      const Node& inner = graph_[each];
      Step step;
      step.op = inner.op;
      step.extra = inner.value;
      step.a = number_of(inner.a);
      step.b = number_of(inner.b);
      step.c = number_of(inner.c);
      new_number(each);
      step.out = number[static_cast<std::size_t>(each)];
      if (inner.op == Op::state_now) plan.state = step.out;
      if (inner.op == Op::axis_now) plan.running = step.out;
      if (inner.a < 0) continue;
      step.kernels = kernels_of(inner.op, 7);
      plan.steps.push_back(step);
    }
    plan.result = number[static_cast<std::size_t>(node.b)];
    note_shape(node.b, inputs, number, plan);
    tape_.states.push_back(std::move(plan));
  }

  void note_shape(int rate, const std::vector<int>& inputs, const std::vector<int>& number,
                  StatePlan& plan) const {
    const RateParts parts = rate_parts(graph_, rate);
    const std::vector<bool> within = reachable(graph_, {parts.shape});
    std::vector<bool> made(plan.numbers.size());
    plan.shape_inputs.assign(inputs.size(), false);
    for (int i = 0; i < graph_.size(); ++i) {
      if (!within[static_cast<std::size_t>(i)] || !graph_[i].moving) continue;
      if (graph_[i].op == Op::axis_now) return;
      made[static_cast<std::size_t>(number[static_cast<std::size_t>(i)])] = true;
      for (const int argument : {graph_[i].a, graph_[i].b, graph_[i].c}) {
        const auto at = std::lower_bound(inputs.begin(), inputs.end(), argument);
        if (at == inputs.end() || *at != argument) continue;
        plan.shape_inputs[static_cast<std::size_t>(at - inputs.begin())] = true;
      }
    }
    for (const Step& step : plan.steps) {
      if (made[static_cast<std::size_t>(step.out)]) plan.shape_steps.push_back(step);
    }
    plan.shape = number[static_cast<std::size_t>(parts.shape)];
    if (parts.factor >= 0) plan.factor = number[static_cast<std::size_t>(parts.factor)];
  }

  int axis_cell() {
    for (const DataLeaf& leaf : tape_.leaves)
      if (leaf.op == Op::column && leaf.index == start_.axis) return leaf.cell;
    const int at = new_cell(Cell::data);
    tape_.leaves.push_back({Op::column, at, start_.axis, -1});
    return at;
  }

  // Which arguments have a derivative.
  static unsigned slopes(Op op) {
    switch (op) {
      case Op::less:
      case Op::less_equal:
      case Op::equal:
      case Op::unequal:
      case Op::both:
      case Op::either:
      case Op::opposite:
      case Op::state:
        return 0;
      case Op::where:
        return 6;
      case Op::power_log:
        return 2;
      default:
        return 7;
    }
  }

  // Backward from the outputs: which cells take adjoints, and which step contributes first.
  void activate() {
    std::vector<bool> parametric(tape_.cells.size()), takes(tape_.cells.size());
    for (int i = 0; i < graph_.size(); ++i)
      if (cell(i) >= 0) parametric[static_cast<std::size_t>(cell(i))] = graph_[i].parametric;
    for (const auto& [node, expanded] : expanded_)
      parametric[static_cast<std::size_t>(expanded)] = true;
    for (OutputCell& output : tape_.outputs) {
      const auto at = static_cast<std::size_t>(output.cell);
      output.active = parametric[at];
      output.owner = output.active && !takes[at] && tape_.cells[at].home == Cell::row;
      if (output.active) takes[at] = true;
    }
    const auto offer = [&](int to, bool& gives, bool& first) {
      const auto at = static_cast<std::size_t>(to);
      gives = parametric[at];
      const Cell& taker = tape_.cells[at];
      const bool own = taker.home == Cell::row || (taker.home == Cell::level && taker.slot >= 0);
      first = gives && !takes[at] && own;
      if (gives) takes[at] = true;
    };
    const auto walk = [&](std::vector<Step>& steps) {
      for (std::size_t i = steps.size(); i-- > 0;) {
        Step& step = steps[i];
        if (!takes[static_cast<std::size_t>(step.out)]) {
          step.kernels.reverse = nullptr;
          step.gives = 8;  // the adjoint is not needed
          continue;
        }
        if (step.op == Op::state) {
          StatePlan& plan = tape_.states.front();
          for (std::size_t j = 0; j < plan.inputs.size(); ++j) {
            bool gives = false, first = false;
            offer(plan.inputs[j], gives, first);
            plan.gives[j] = gives;
            plan.first[j] = first;
          }
          offer(plan.beginning, plan.beginning_gives, plan.beginning_first);
          continue;
        }
        const int arguments[] = {step.a, step.b, step.c};
        for (unsigned j = 0; j < 3; ++j) {
          if (arguments[j] < 0 || (slopes(step.op) >> j & 1u) == 0) continue;
          bool gives = false, first = false;
          offer(arguments[j], gives, first);
          step.gives |= static_cast<unsigned>(gives) << j;
          step.first |= static_cast<unsigned>(first) << j;
        }
      }
    };
    walk(tape_.row_steps);
    walk(tape_.level_steps);
    walk(tape_.number_steps);
  }

  const Graph& graph_;
  const std::vector<int>& roots_;
  const Symbols& symbols_;
  StateStart start_;
  bool continued_;
  std::vector<std::size_t> slots_;
  std::vector<int> cell_;
  std::map<int, int> expanded_;  ///< node by label, and its cell over the rows
  std::vector<bool> needed_;
  Tape tape_;
};

}  // namespace

Tape make_tape(const Graph& graph, const std::vector<int>& roots, const Symbols& symbols,
               const StateStart& start, bool continued) {
  return Maker(graph, roots, symbols, start, continued).run();
}

}  // namespace wearwell::formula
