// The first sub-expression that is not finite.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/formula/program_body.h"

namespace wearwell::formula {
namespace {

using Column = std::vector<double>;

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

// Evaluates every node separately, in the written order; slow, used only for messages.
class Examination {
 public:
  Examination(const Graph& graph, const std::vector<int>& roots)
      : graph_(graph),
        roots_(roots),
        needed_(reachable(graph, roots)),
        values_(index(graph.size())) {}

  // `leaf` gives the values of leaves and states.
  template <class F>
  void compute(std::size_t n, const std::uint8_t* starts, const F& leaf) {
    rows_ = n;
    starts_ = starts;
    for (int i = 0; i < graph_.size(); ++i) {
      const Node& node = graph_[i];
      if (!needed_[index(i)] || node.moving) continue;
      Column& out = values_[index(i)];
      out.assign(n, node.value);
      if (node.op == Op::constant) continue;
      if (node.a < 0 || node.op == Op::state) {
        leaf(node, out);
      } else if (node.op == Op::cum) {
        double sum = 0;
        for (std::size_t r = 0; r < n; ++r)
          out[r] = sum = (starts[r] != 0 ? 0 : sum) + values_[index(node.a)][r];
      } else {
        kernels_of(node.op, 0)
            .forward(at(node.a), at(node.b), at(node.c), out.data(), n, node.value);
      }
    }
  }

  struct Found {
    int node = -1;
    std::size_t row = 0;
  };

  Found first() {
    asked_.assign(index(graph_.size()), std::vector<bool>());
    for (const int root : roots_) {
      for (std::size_t r = 0; r < rows_; ++r)
        if (!std::isfinite(values_[index(root)][r])) ask(root, r);
    }
    for (int i = graph_.size(); i-- > 0;)
      if (!asked_[index(i)].empty()) pass_on(i);
    for (int i = 0; i < graph_.size(); ++i) {
      for (std::size_t r = 0; r < asked_[index(i)].size(); ++r)
        if (asked_[index(i)][r] && !std::isfinite(values_[index(i)][r])) return {i, r};
    }
    return {};
  }

  std::string why(const Found& found) const {
    const Node& node = graph_[found.node];
    const auto value = [&](int i) {
      const Powers& powers = graph_.dimension(graph_[i].powers);
      return fmt::format("{:.6g}{}", values_[index(i)][found.row],
                         powers.empty() ? "" : " " + description(powers));
    };
    const double result = values_[index(found.node)][found.row];
    if (node.a < 0) return "its value is not finite";
    switch (node.op) {
      case Op::divide:
        if (values_[index(node.b)][found.row] == 0) return "division by 0";
        break;
      case Op::log:
      case Op::log10:
      case Op::log1p:
      case Op::sqrt:
      case Op::exp:
      case Op::probit:
      case Op::gamma:
      case Op::lgamma:
      case Op::digamma:
        return fmt::format("{} of {}", name_of(node.op), value(node.a));
      case Op::power:
        return fmt::format("{} to the power {}", value(node.a), value(node.b));
      case Op::whole_power:
        return fmt::format("{} to the power {}", value(node.a), node.value);
      case Op::state:
        return std::isinf(result) ? "it becomes infinite before this row"
                                  : "its rate cannot be computed before this row";
      default:
        break;
    }
    return std::isnan(result) ? "it is not a number" : "it is infinite";
  }

 private:
  static const char* name_of(Op op) {
    for (const Function& each : functions())
      if (each.op == op) return each.name;
    return "?";
  }

  const double* at(int i) const { return i < 0 ? nullptr : values_[index(i)].data(); }

  void ask(int node, std::size_t row) {
    if (graph_[node].moving) return;
    auto& rows = asked_[index(node)];
    if (rows.empty()) rows.assign(rows_, false);
    rows[row] = true;
  }

  // Also checks the operands of a value, except those of branches not taken.
  void pass_on(int i) {
    const Node& node = graph_[i];
    for (std::size_t r = 0; r < rows_; ++r) {
      if (!asked_[index(i)][r]) continue;
      if (node.op == Op::where) {
        ask(node.a, r);
        ask(values_[index(node.a)][r] != 0 ? node.b : node.c, r);
      } else if (node.op == Op::cum) {
        std::size_t from = r;
        while (from > 0 && starts_[from] == 0) --from;
        for (std::size_t k = from; k <= r; ++k) ask(node.a, k);
      } else {
        for (const int argument : {node.a, node.b, node.c})
          if (argument >= 0) ask(argument, r);
      }
    }
  }

  const Graph& graph_;
  const std::vector<int>& roots_;
  std::vector<bool> needed_;
  std::vector<Column> values_;
  std::vector<std::vector<bool>> asked_;
  std::size_t rows_ = 0;
  const std::uint8_t* starts_ = nullptr;
};

}  // namespace

std::optional<Fault> Program::first_fault(const Data& data, std::size_t begin, std::size_t end,
                                          const Inputs& inputs) const {
  const Tape& tape = body_->tape;
  const Symbols& symbols = body_->symbols;
  Workspace work = workspace(end - begin);
  forward(data, begin, end, inputs, work);
  const std::vector<std::size_t> first = slots(symbols);
  const auto bound = [&](const Node& node, Column& out) {
    for (const DataLeaf& leaf : tape.leaves) {
      if (leaf.op != node.op || leaf.index != node.index || leaf.level != node.level) continue;
      const Column& column = data.body_->columns[index(tape.cells[index(leaf.cell)].slot)];
      std::copy(column.begin() + static_cast<std::ptrdiff_t>(begin),
                column.begin() + static_cast<std::ptrdiff_t>(end), out.begin());
      return;
    }
  };
  const auto pick = [&](const Node& node, Column& out) {
    for (std::size_t label = 0; label < symbols.labels.size(); ++label) {
      if (symbols.labels[label].name != symbols.parameters[index(node.index)].label) continue;
      for (std::size_t r = 0; r < out.size(); ++r)
        out[r] =
            inputs
                .parameters[first[index(node.index)] + index(data.body_->labels[label][begin + r])];
    }
  };
  Examination examination(body_->graph, body_->roots);
  examination.compute(
      end - begin, data.body_->starts.data() + begin, [&](const Node& node, Column& out) {
        switch (node.op) {
          case Op::parameter:
            std::fill(out.begin(), out.end(),
                      inputs.parameters[first[index(node.index)] + index(std::max(node.level, 0))]);
            return;
          case Op::by_row: {
            int before = 0;
            for (int i = 0; i < node.index; ++i)
              before += symbols.parameters[index(i)].scope == Scope::per_row;
            std::copy_n(inputs.by_row[index(before)], out.size(), out.begin());
            return;
          }
          case Op::pick:
            return pick(node, out);
          case Op::state: {
            const double* state = work.body_->at[index(tape.state)];
            std::copy_n(state, out.size(), out.begin());
            return;
          }
          default:
            return bound(node, out);
        }
      });
  const auto found = examination.first();
  if (found.node < 0) return {};
  const Node& node = body_->graph[found.node];
  Fault fault;
  fault.row = begin + found.row;
  fault.uniform = !node.rows;
  fault.expression = text_of(body_->graph, found.node, symbols);
  fault.why = examination.why(found);
  fault.where = node.origin < 0 ? "" : body_->texts[index(node.origin)].where;
  return fault;
}

}  // namespace wearwell::formula
