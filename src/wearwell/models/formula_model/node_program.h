#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/formula_model/formula_model.h"

namespace wearwell::formula_model {

/// What a unit's readings depend on, at many points: the parameters of the study, and the unit's own effects. Nodes
/// of one line stand side by side and share their parameters.
struct Nodes {
  std::size_t per_line = 1;
  std::shared_ptr<const Points> parameters;  ///< lines x parameters, natural, SI
  std::vector<double> effect[2];             ///< of each node; empty where nothing varies

  std::size_t lines() const { return static_cast<std::size_t>(parameters->rows()); }
  std::size_t count() const { return lines() * per_line; }
};

/// Conditions of one row, SI: numbers as FormulaModel::row_symbols has columns, labels as it has labels.
struct NodeRow {
  std::vector<double> numbers;
  std::vector<int> labels;
};

/// Expressions of a study in one row at many nodes at once: every parameter is given by row, so that one pass
/// runs over nodes. Where no expression depends on rows before or on a state, columns are plain numbers, and
/// what depends on them alone is computed once. Immutable.
class NodeProgram {
 public:
  /// `open`: the axis is given node by node. Throws InputError where an expression is wrong.
  NodeProgram(const FormulaModel& model, const std::vector<formula::Wanted>& wanted,
              bool open = false);

  static constexpr std::size_t most = 128;  ///< nodes of one pass

  bool uses_column(std::size_t c) const { return uses_column_[c]; }
  bool uses_label(std::size_t l) const { return uses_label_[l]; }
  /// What runs along a unit's path: numbers that are carried from row to row, node by node.
  std::size_t running() const { return running_; }
  const std::vector<formula::Output>& outputs() const { return program_.outputs(); }

  /// How rows go on from one before, and rows ahead of which one step stands for all (RunningPath).
  struct GoesOn {
    std::optional<double> from = {};  ///< the place of the row before, or where the path begins, SI
    const std::vector<std::vector<double>>* carried =
        nullptr;  ///< by what runs, then node; null of a path that begins
    const std::vector<std::size_t>* steps = nullptr;  ///< columns that are the way from `from`
    double row_length = 0;
  };

  /// One thread's.
  class Scratch {
   public:
    explicit Scratch(const NodeProgram& program);

   private:
    friend class NodeProgram;
    formula::Workspace workspace_;
    formula::Data data_;
    std::vector<int> bound_labels_;
    std::vector<std::array<double, most>> shared_;
    std::vector<const double*> by_row_, carried_;
    std::vector<double> numbers_;
    std::vector<std::vector<double>> columns_;
    std::vector<std::vector<int>> labels_;
  };

  /// Nodes begin .. begin + count - 1, count <= most. `place`: of each of them, where the axis is open (may
  /// be null else); `on` matters where the law has a path or a state.
  void evaluate(const Nodes& nodes, std::size_t begin, std::size_t count, const NodeRow& row,
                const double* place, const GoesOn& on, Scratch& scratch) const;
  /// Output o of the last evaluation; a single number where it is uniform.
  std::span<const double> values(std::size_t o, const Scratch& scratch) const {
    return scratch.workspace_.values(o);
  }
  /// What runs, after the row of the last evaluation: of node i of it.
  void carry(const Scratch& scratch, std::size_t i, std::span<double> carried) const {
    program_.carry(scratch.workspace_, i, carried);
  }

 private:
  struct Source {
    int effect = -1;            // or
    bool place = false;         // the open axis, or
    std::size_t parameter = 0;  // of the study,
    int label = -1;             // the first of one for each level of this label
  };

  void compile_plain(const std::vector<formula::Line>& lines,
                     const std::vector<formula::Wanted>& wanted, bool open);
  void write_by_row(std::vector<formula::Line>& lines, std::vector<formula::Wanted>& wanted);
  void bind_rows(std::size_t count, const NodeRow& row, const double* place, const GoesOn& on,
                 Scratch& scratch) const;

  formula::Symbols symbols_;  // of the rows, with all parameters by row
  std::vector<Source> sources_;
  formula::Program program_;
  bool plain_ = false;                // columns are numbers
  std::vector<std::size_t> columns_;  // of those numbers
  std::vector<bool> uses_column_, uses_label_;
  bool labelled_ = false;  // some label is compared, not only picked by
  std::size_t axis_ = 0, running_ = 0;
};

}  // namespace wearwell::formula_model
