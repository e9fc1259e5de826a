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

/// The inputs of a unit's readings at many points: the parameters of the study, and the unit's
/// effects. Nodes of one line are contiguous and share their parameters.
struct Nodes {
  std::size_t per_line = 1;
  std::shared_ptr<const Points> parameters;  ///< lines x parameters, natural, SI
  std::vector<double> effect[2];             ///< of each node; empty if there are no random effects

  std::size_t lines() const { return static_cast<std::size_t>(parameters->rows()); }
  std::size_t count() const { return lines() * per_line; }
};

/// Conditions of one row, SI: numbers in the order of the columns of FormulaModel::row_symbols, labels in
/// that of its labels.
struct NodeRow {
  std::vector<double> numbers;
  std::vector<int> labels;
};

/// Expressions of a study in one row at many nodes at once: every parameter is given by row, so
/// that one pass covers all nodes. If no expression depends on earlier rows or on a state, columns
/// are plain numbers, and what depends only on them is computed once. Immutable.
class NodeProgram {
 public:
  /// `open`: the axis is given per node. Throws InputError for an invalid expression.
  NodeProgram(const FormulaModel& model, const std::vector<formula::Wanted>& wanted,
              bool open = false);

  static constexpr std::size_t most = 128;  ///< nodes of one pass

  bool uses_column(std::size_t c) const { return uses_column_[c]; }
  bool uses_label(std::size_t l) const { return uses_label_[l]; }
  /// The running values of a unit's path, which pass from row to row, node by node.
  std::size_t running() const { return running_; }
  const std::vector<formula::Output>& outputs() const { return program_.outputs(); }

  /// How rows continue from an earlier one, and future rows that are replaced by one step
  /// (RunningPath).
  struct GoesOn {
    /// the position of the previous row, or the start of the path, SI
    std::optional<double> from = {};
    const std::vector<std::vector<double>>* carried =
        nullptr;  ///< by running value, then node; null for a path that starts
    /// columns that hold the distance from `from`
    const std::vector<std::size_t>* steps = nullptr;
    double row_length = 0;
  };

  /// One thread uses it at a time.
  class Scratch {
   public:
    explicit Scratch(const NodeProgram& program);

   private:
    friend class NodeProgram;
    formula::Workspace workspace_;
    formula::Data data_;
    std::vector<int> bound_labels_, shared_labels_;
    std::vector<std::array<double, most>> shared_;
    std::vector<const double*> by_row_, carried_;
    std::vector<double> numbers_;
    std::vector<std::vector<double>> columns_;
    std::vector<std::vector<int>> labels_;
  };

  /// Nodes begin .. begin + count - 1, count <= most. `place`: of each of them, if the axis is open
  /// (else may be null); `on` matters if the formula has a path or a state. `again`: the nodes are
  /// those of the last evaluation with this scratch.
  void evaluate(const Nodes& nodes, std::size_t begin, std::size_t count, const NodeRow& row,
                const double* place, const GoesOn& on, Scratch& scratch, bool again = false) const;
  /// Output o of the last evaluation; a single value if it is uniform.
  std::span<const double> values(std::size_t o, const Scratch& scratch) const {
    return scratch.workspace_.values(o);
  }
  /// The running values after the row of the last evaluation, of its node i.
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
  bool labelled_ = false;  // some label is compared, not only used as an index
  std::size_t axis_ = 0, running_ = 0;
};

}  // namespace wearwell::formula_model
