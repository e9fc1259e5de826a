#include "wearwell/models/formula_model/node_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "wearwell/base/error.h"

namespace wearwell::formula_model {

NodeProgram::NodeProgram(const FormulaModel& model, const std::vector<formula::Wanted>& wanted,
                         bool open)
    : symbols_(model.row_symbols) {
  // The inputs as the study has them.
  const formula::Program known = formula::compile(model.lines, wanted, symbols_, true);
  for (std::size_t c = 0; c < symbols_.columns.size(); ++c) {
    uses_column_.push_back(known.uses_column(c));
    if (model.along == symbols_.columns[c].name) axis_ = c;
  }
  for (std::size_t l = 0; l < symbols_.labels.size(); ++l) {
    uses_label_.push_back(known.uses_label(l));
  }
  running_ = known.running().count;
  plain_ = !known.has_paths() && !known.running().state;

  std::vector<formula::Line> lines = model.lines;
  std::vector<formula::Wanted> rewritten = wanted;
  std::vector<std::size_t> of_study;  // the first parameter of each symbol of the rows
  const std::vector<std::size_t> begin = formula::slots(model.symbols);
  for (std::size_t s = 0; s < symbols_.parameters.size(); ++s) {
    Source source;
    source.parameter = begin[s];
    for (std::size_t e = 0; e < model.effects.size(); ++e) {
      if (model.effects[e].symbol == s) source.effect = static_cast<int>(e);
    }
    sources_.push_back(source);
  }
  write_by_row(lines, rewritten);
  if (plain_) {
    compile_plain(lines, rewritten, open);
  } else {
    program_ = formula::compile(lines, rewritten, symbols_, true);
  }
  for (std::size_t l = 0; l < symbols_.labels.size(); ++l) labelled_ |= program_.uses_label(l);
}

// `k[material]` becomes `k`, with the value for the row's level, and `k["PTFE"]` a parameter of its
// own.
void NodeProgram::write_by_row(std::vector<formula::Line>& lines,
                               std::vector<formula::Wanted>& wanted) {
  const auto write = [&](const std::string& pattern, const std::string& by) {
    const std::regex expression(pattern);
    for (formula::Line& each : lines) each.text = std::regex_replace(each.text, expression, by);
    for (formula::Wanted& each : wanted) each.text = std::regex_replace(each.text, expression, by);
  };
  const std::size_t count = symbols_.parameters.size();
  for (std::size_t s = 0; s < count; ++s) {
    if (symbols_.parameters[s].scope == formula::Scope::per_level) {
      const formula::ParameterSymbol symbol = symbols_.parameters[s];
      const auto label =
          std::find_if(symbols_.labels.begin(), symbols_.labels.end(),
                       [&](const formula::LabelSymbol& each) { return each.name == symbol.label; });
      sources_[s].label = static_cast<int>(label - symbols_.labels.begin());
      write(fmt::format(R"(\b{}\s*\[\s*{}\s*\])", symbol.name, symbol.label), symbol.name);
      for (std::size_t level = 0; level < label->levels.size(); ++level) {
        std::string quoted;
        for (const char each : label->levels[level]) {
          if (!std::isalnum(static_cast<unsigned char>(each)) && each > 0) quoted += '\\';
          quoted += each;
        }
        const std::string name = fmt::format("{}_at_level_{}", symbol.name, level);
        write(fmt::format(R"re(\b{}\s*\[\s*"{}"\s*\])re", symbol.name, quoted), name);
        symbols_.parameters.push_back({name, symbol.powers, formula::Scope::per_row, {}});
        sources_.push_back({-1, false, sources_[s].parameter + level, -1});
      }
    }
    symbols_.parameters[s].scope = formula::Scope::per_row;
    symbols_.parameters[s].label.clear();
  }
}

void NodeProgram::compile_plain(const std::vector<formula::Line>& lines,
                                const std::vector<formula::Wanted>& wanted, bool open) {
  std::vector<formula::ParameterSymbol> numbers;
  for (std::size_t c = 0; c < symbols_.columns.size(); ++c) {
    const formula::ColumnSymbol& column = symbols_.columns[c];
    if (column.measured) continue;
    if (open && c == axis_) {
      symbols_.parameters.push_back({column.name, column.powers, formula::Scope::per_row, {}});
      sources_.push_back({-1, true, 0, -1});
      continue;
    }
    numbers.push_back({column.name, column.powers});
    columns_.push_back(c);
  }
  symbols_.columns.clear();
  symbols_.parameters.insert(symbols_.parameters.begin(), numbers.begin(), numbers.end());
  program_ = formula::compile(lines, wanted, symbols_);
}

NodeProgram::Scratch::Scratch(const NodeProgram& program)
    : workspace_(program.program_.workspace(most)),
      shared_(program.sources_.size()),
      by_row_(program.sources_.size()),
      carried_(program.running_),
      numbers_(program.columns_.size()),
      columns_(program.symbols_.columns.size()),
      labels_(program.symbols_.labels.size()) {}

void NodeProgram::bind_rows(std::size_t count, const NodeRow& row, const double* place,
                            const GoesOn& on, Scratch& scratch) const {
  formula::Rows rows;
  rows.count = plain_ ? most : count;
  for (std::size_t c = 0; c < symbols_.columns.size(); ++c) {
    std::vector<double>& values = scratch.columns_[c];
    values.assign(rows.count, row.numbers[c]);
    if (c == axis_ && place) std::copy_n(place, count, values.begin());
  }
  if (on.steps) {
    for (const std::size_t c : *on.steps) {
      for (std::size_t i = 0; i < count; ++i) {
        scratch.columns_[c][i] = scratch.columns_[axis_][i] - *on.from;
      }
    }
  }
  for (const auto& each : scratch.columns_) rows.columns.emplace_back(each);
  for (std::size_t l = 0; l < symbols_.labels.size(); ++l) {
    scratch.labels_[l].assign(rows.count, row.labels[l]);
    rows.labels.emplace_back(scratch.labels_[l]);
  }
  if (!plain_) {
    rows.paths.resize(count);
    for (std::size_t i = 0; i < count; ++i) rows.paths[i] = i;
    if (on.from) rows.from.assign(count, *on.from);
    for (std::size_t i = 0; on.row_length > 0 && i < count; ++i) {
      rows.repeats.push_back((scratch.columns_[axis_][i] - *on.from) / on.row_length);
    }
  }
  program_.bind(rows, scratch.data_);
}

namespace {

// Node by node; those of one line share it.
void copy_parameter(const Nodes& nodes, std::size_t parameter, std::size_t begin, std::size_t count,
                    double* to) {
  const double* const value = nodes.parameters->data() + parameter;
  const auto stride = static_cast<std::size_t>(nodes.parameters->cols());
  if (nodes.per_line == 1) {
    for (std::size_t i = 0; i < count; ++i) to[i] = value[(begin + i) * stride];
    return;
  }
  for (std::size_t i = 0; i < count;) {
    const std::size_t line = (begin + i) / nodes.per_line;
    const std::size_t end = std::min(count, (line + 1) * nodes.per_line - begin);
    std::fill(to + i, to + end, value[line * stride]);
    i = end;
  }
}

}  // namespace

void NodeProgram::evaluate(const Nodes& nodes, std::size_t begin, std::size_t count,
                           const NodeRow& row, const double* place, const GoesOn& on,
                           Scratch& scratch, bool again) const {
  again = again && scratch.shared_labels_ == row.labels;
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    const Source& source = sources_[s];
    if (source.place) {
      scratch.by_row_[s] = place;
    } else if (source.effect >= 0) {
      scratch.by_row_[s] = nodes.effect[source.effect].data() + begin;
    } else if (!again) {
      const std::size_t level =
          source.label < 0
              ? 0
              : static_cast<std::size_t>(row.labels[static_cast<std::size_t>(source.label)]);
      auto& shared = scratch.shared_[s];
      copy_parameter(nodes, source.parameter + level, begin, count, shared.data());
      scratch.by_row_[s] = shared.data();
    }
  }
  scratch.shared_labels_ = row.labels;
  if (!plain_) {
    bind_rows(count, row, place, on, scratch);
  } else if (scratch.data_.rows() == 0 || (labelled_ && scratch.bound_labels_ != row.labels)) {
    bind_rows(count, row, nullptr, {}, scratch);
    scratch.bound_labels_ = row.labels;
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    scratch.numbers_[i] = row.numbers[columns_[i]];
  }
  const bool goes_on = !plain_ && on.carried && running_ > 0;
  for (std::size_t r = 0; goes_on && r < running_; ++r) {
    scratch.carried_[r] = (*on.carried)[r].data() + begin;
  }
  const std::span<const double* const> carried(scratch.carried_.data(), goes_on ? running_ : 0);
  program_.forward(scratch.data_, 0, count, {scratch.numbers_, scratch.by_row_, carried},
                   scratch.workspace_);
}

}  // namespace wearwell::formula_model
