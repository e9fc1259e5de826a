#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/join.hpp>

#include "wearwell/base/error.h"
#include "wearwell/formula/lines.h"
#include "wearwell/formula/program.h"
#include "wearwell/formula/program_body.h"
#include "wearwell/formula/reading.h"
#include "wearwell/formula/regroup.h"
#include "wearwell/formula/rules.h"
#include "wearwell/formula/written_graph.h"

namespace wearwell::formula {
namespace {

// Lines may be in any order; each is read after the lines that it names. Within the rate of a
// state, names have another meaning (the running state), so lines are read a second time for it.
class Compiler {
 public:
  Compiler(const std::vector<Line>& law, const std::vector<Wanted>& wanted, const Symbols& symbols,
           Graph& graph)
      : symbols_(symbols),
        graph_(graph),
        lines_(sort_lines(law, symbols)),
        outside_{symbols},
        inside_{symbols} {
    for (const Written& line : lines_.named) names_.push_back(line.name);
    if (!lines_.state.empty()) names_.push_back(lines_.state);
    for (Names* names : {&outside_, &inside_}) {
      names->all_lines = names_;
      names->state = lines_.state;
      names->axis = lines_.start.axis;
    }
    inside_.in_rate = true;
    graph_.set_state_name(lines_.state);
    for (const Wanted& each : wanted) {
      const Text text{each.name, each.text};
      wanted_.push_back({each.name, text, tokens_of(text)});
    }
  }

  std::vector<int> run(const std::vector<Wanted>& wanted) {
    const int lines = static_cast<int>(lines_.named.size());
    done_.assign(2 * static_cast<std::size_t>(lines) + 2, 0);
    for (int i = 0; i < lines; ++i) visit(i);
    if (!lines_.state.empty()) visit(state_item());
    std::vector<int> roots;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      roots.push_back(read(wanted_[i], outside_));
      check(wanted[i], wanted_[i], roots.back());
    }
    return roots;
  }

  std::vector<Text> texts;        ///< origins
  int rate = -1, beginning = -1;  ///< nodes of the state
  const Lines& lines() const { return lines_; }

 private:
  // Items: line i, line i within the rate, the state, its beginning.
  int line_count() const { return static_cast<int>(lines_.named.size()); }
  int state_item() const { return 2 * line_count(); }
  int beginning_item() const { return 2 * line_count() + 1; }
  bool within(int item) const { return item >= line_count() && item < state_item(); }
  const Written& written(int item) const {
    if (item == state_item()) return lines_.rate;
    if (item == beginning_item()) return lines_.beginning;
    return lines_.named[static_cast<std::size_t>(item % line_count())];
  }

  std::vector<int> needs(int item) const {
    std::vector<int> found;
    const bool moving = within(item) || item == state_item();
    if (item == state_item()) found.push_back(beginning_item());
    for (const Token& token : written(item).tokens) {
      if (token.kind != Token::name) continue;
      if (token.text == lines_.state) {
        if (item == beginning_item()) continue;  // refused when it is read
        found.push_back(moving ? beginning_item() : state_item());
        continue;
      }
      for (int i = 0; i < line_count(); ++i) {
        if (lines_.named[static_cast<std::size_t>(i)].name == token.text)
          found.push_back(moving ? i + line_count() : i);
      }
    }
    return found;
  }

  // Depth first, without recursion: a chain of lines may be long.
  void visit(int root) {
    struct Open {
      int item;
      std::vector<int> needs;
      std::size_t next = 0;
    };
    if (done_[static_cast<std::size_t>(root)] == 2) return;
    std::vector<Open> open = {{root, needs(root)}};
    done_[static_cast<std::size_t>(root)] = 1;
    while (!open.empty()) {
      if (open.back().next == open.back().needs.size()) {
        const int item = open.back().item;
        open.pop_back();
        read_item(item);
        done_[static_cast<std::size_t>(item)] = 2;
        continue;
      }
      const int next = open.back().needs[open.back().next++];
      if (done_[static_cast<std::size_t>(next)] == 2) continue;
      if (done_[static_cast<std::size_t>(next)] == 1) {
        std::vector<std::string> circle;
        for (const Open& each : open)
          if (!circle.empty() || each.item == next) circle.push_back(written(each.item).name);
        circle.push_back(written(next).name);
        circle_found(circle, open.back().item, written(next).name);
      }
      done_[static_cast<std::size_t>(next)] = 1;
      open.push_back({next, needs(next)});
    }
  }

  [[noreturn]] void circle_found(const std::vector<std::string>& circle, int item,
                                 const std::string& name) const {
    const Written& from = written(item);
    std::size_t at = 0;
    for (const Token& token : from.tokens)
      if (token.kind == Token::name && token.text == name) at = token.at;
    complain(from.text, at,
             fmt::format("the lines refer to each other in a circle: {}",
                         boost::algorithm::join(circle, " -> ")),
             "write a quantity that depends on itself as a state: \"d(x)/d(y)\"");
  }

  int read(const Written& text, const Names& names) {
    graph_.set_origin(static_cast<int>(texts.size()));
    texts.push_back(text.text);
    try {
      return read_expression(graph_, text.text, text.tokens, names);
    } catch (const std::bad_alloc&) {
      throw InputError(fmt::format("{}: too large", text.text.where));
    }
  }

  void read_item(int item) {
    if (item == beginning_item()) return read_beginning();
    if (item == state_item()) return read_state();
    Names& names = within(item) ? inside_ : outside_;
    names.lines[written(item).name] = read(written(item), names);
  }

  const ColumnSymbol* state_column() const {
    for (const ColumnSymbol& each : symbols_.columns)
      if (each.name == lines_.state) return &each;
    return nullptr;
  }

  void read_beginning() {
    const ColumnSymbol* column = state_column();
    if (column != nullptr) state_powers_ = graph_.intern(column->powers);
    if (lines_.has_beginning) {
      Names names = outside_;
      names.state_node = -1;
      beginning = read(lines_.beginning, names);
      const Node& node = graph_[beginning];
      if (!node.any && column != nullptr && node.powers != state_powers_)
        complain(lines_.beginning.text, 0,
                 fmt::format("the state begins as {}, but the column '{}' is {}",
                             description(graph_.dimension(node.powers)), lines_.state,
                             description(column->powers)),
                 difference(graph_.dimension(node.powers), column->powers));
      if (!node.any) state_powers_ = node.powers;
    } else {
      Node zero;
      zero.any = true;
      beginning = graph_.add(zero);
    }
    if (state_powers_ < 0) return;
    Node now;
    now.op = Op::state_now;
    now.powers = state_powers_;
    inside_.state_node = graph_.add(now);
  }

  void read_state() {
    const Text& text = lines_.rate.text;
    rate = read(lines_.rate, inside_);
    const ColumnSymbol& axis = symbols_.columns[static_cast<std::size_t>(lines_.start.axis)];
    const Node& node = graph_[rate];
    if (state_powers_ < 0)
      state_powers_ = graph_.intern(product(graph_.dimension(node.powers), axis.powers));
    const Powers demanded = quotient(graph_.dimension(state_powers_), axis.powers);
    if (!node.any && graph_.dimension(node.powers) != demanded) {
      complain(text, 0,
               fmt::format("the rate is {}, but the rate of '{}' along '{}' must be {}",
                           description(graph_.dimension(node.powers)), lines_.state, axis.name,
                           description(demanded)),
               difference(graph_.dimension(node.powers), demanded));
    }
    outside_.state_node =
        node.moving ? graph_.make(Op::state, state_powers_, beginning, rate) : closed_form();
  }

  // A rate that depends neither on the state nor on the axis: each row adds its step.
  int closed_form() {
    Node step;
    step.op = Op::step;
    step.index = lines_.start.axis;
    step.powers = graph_.intern(symbols_.columns[static_cast<std::size_t>(step.index)].powers);
    const int gain = graph_.make(Op::multiply, state_powers_, rate, graph_.add(step));
    Node running;
    running.op = Op::cum;
    running.a = gain;
    running.value = whole_step;
    running.powers = state_powers_;
    const int sum = graph_.add(running);
    const Node& begin = graph_[beginning];
    if (begin.op == Op::constant && begin.value == 0) return sum;
    return graph_.make(Op::add, state_powers_, beginning, sum);
  }

  void check(const Wanted& wanted, const Written& written, int root) const {
    const Node& node = graph_[root];
    const Powers& powers = graph_.dimension(node.powers);
    if (wanted.powers && !node.any && powers != *wanted.powers) {
      complain(written.text, 0,
               fmt::format("'{}' is {}, but must be {}{}{}", shortened_text(wanted.text),
                           description(powers), description(*wanted.powers),
                           wanted.because.empty() ? "" : ", as ", wanted.because),
               difference(powers, *wanted.powers));
    }
    if (!wanted.uniform || !node.rows) return;
    const std::string column = first_column(root);
    std::size_t at = 0;
    for (const Token& token : written.tokens)
      if (token.kind == Token::name && token.text == column) at = token.at;
    complain(written.text, at,
             fmt::format("'{}' varies from row to row, but this must be one number", column),
             "use only parameters and constants");
  }

  static std::string shortened_text(const std::string& text) {
    return text.size() > 60 ? text.substr(0, 57) + "..." : text;
  }

  std::string first_column(int root) const {
    const std::vector<bool> within = reachable(graph_, {root});
    for (int i = 0; i < graph_.size(); ++i) {
      const Node& node = graph_[i];
      if (!within[static_cast<std::size_t>(i)]) continue;
      const auto index = static_cast<std::size_t>(std::max(node.index, 0));
      if (node.op == Op::column || node.op == Op::step || node.op == Op::axis_now)
        return symbols_.columns[index].name;
      if (node.op == Op::label_is) return symbols_.labels[index].name;
      if (node.op == Op::pick || node.op == Op::by_row) return symbols_.parameters[index].name;
    }
    return "cum";
  }

  const Symbols& symbols_;
  Graph& graph_;
  Lines lines_;
  Names outside_, inside_;
  std::vector<std::string> names_;
  std::vector<Written> wanted_;
  std::vector<char> done_;
  int state_powers_ = -1;
};

}  // namespace

WrittenGraph written_graph(const std::vector<Line>& law, const std::vector<Wanted>& wanted,
                           const Symbols& symbols) {
  check(symbols);
  WrittenGraph written;
  Compiler compiler(law, wanted, symbols, written.graph);
  written.roots = compiler.run(wanted);
  return written;
}

Program compile(const std::vector<Line>& law, const std::vector<Wanted>& wanted,
                const Symbols& symbols, bool continued) {
  check(symbols);
  auto body = std::make_shared<Program::Body>();
  body->symbols = symbols;
  Compiler compiler(law, wanted, body->symbols, body->graph);
  body->roots = compiler.run(wanted);
  body->texts = std::move(compiler.texts);
  body->start = compiler.lines().start;
  body->rate = compiler.rate;
  body->beginning = compiler.beginning;
  const Graph& graph = body->graph;
  body->parameters.resize(symbols.parameters.size());
  body->columns.resize(symbols.columns.size());
  body->labels.resize(symbols.labels.size());
  const std::vector<bool> used = reachable(graph, body->roots);
  for (int i = 0; i < graph.size(); ++i) {
    if (!used[static_cast<std::size_t>(i)]) continue;
    // A state uses its axis even if its rate does not name it.
    if (graph[i].op == Op::state) body->columns[static_cast<std::size_t>(body->start.axis)] = true;
    if (graph[i].index < 0) continue;
    const auto index = static_cast<std::size_t>(graph[i].index);
    const Op op = graph[i].op;
    if (op == Op::column || op == Op::step || op == Op::axis_now) body->columns[index] = true;
    if (op == Op::label_is) body->labels[index] = true;
    if (op == Op::parameter || op == Op::by_row || op == Op::pick) body->parameters[index] = true;
    if (op != Op::pick) continue;
    for (std::size_t label = 0; label < symbols.labels.size(); ++label)
      if (symbols.labels[label].name == symbols.parameters[index].label) body->labels[label] = true;
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Node& node = graph[body->roots[i]];
    const Powers powers =
        node.any && wanted[i].powers ? *wanted[i].powers : graph.dimension(node.powers);
    body->outputs.push_back({wanted[i].name, powers, !node.rows, node.parametric, node.by_path});
  }
  Graph best;
  const std::vector<int> roots = regrouped(graph, body->roots, body->start.axis, best);
  body->tape = make_tape(best, roots, body->symbols, body->start, continued);
  body->continued = continued;
  Program program;
  program.body_ = std::move(body);
  return program;
}

}  // namespace wearwell::formula
