#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/models/formula_model/formula_running.h"

namespace wearwell::formula_model {

/// Expressions under fixed conditions, at any position on the axis and for any unit of the
/// population. Immutable; evaluations are thread-safe with one `PathAt` each.
struct Path {
  std::shared_ptr<const FormulaModel> model;
  formula::Program program;
  bool along = false;  ///< whether the axis is given by row, as the last of those
  formula::Symbols symbols;
  std::vector<std::size_t> shared;  ///< the study's parameters among those of the symbols
  formula::Data data;               ///< `most` rows, all identical
  static constexpr std::size_t most = 128;
  /// Conditions that differ between units, given by row; else null.
  std::shared_ptr<const VariedConditions> varied = {};
  /// If the formula has a state, or the expressions depend on earlier rows; `data` is then empty.
  std::optional<RunningPath> running = {};
  /// Whether it depends on earlier rows: then the path of a unit starts at its last row.
  bool goes_on() const { return running && running->running.count > 0; }
};

/// Compiles `wanted` under these conditions; `along` leaves the axis open. Throws InputError at
/// `key` of `table`: for an invalid expression, a missing condition, or an undetermined
/// continuation (`RunningPath`). `unit`: the one that continues from its last row, empty for a new
/// one.
std::shared_ptr<const Path> make_path(std::shared_ptr<const FormulaModel> model,
                                      const TomlReader& table, const std::string& key,
                                      const std::vector<formula::Wanted>& wanted, bool along,
                                      const Conditions& conditions,
                                      std::optional<std::size_t> unit = {});

/// Expressions in each row of a unit until now (`PathAt::retrace`), with or without dependence on
/// earlier rows.
std::shared_ptr<const Path> make_trace(std::shared_ptr<const FormulaModel> model,
                                       const TomlReader& table, const std::string& key,
                                       const std::vector<formula::Wanted>& wanted,
                                       std::size_t unit);

/// One thread's evaluation of a path.
class PathAt {
 public:
  explicit PathAt(const Path& path);
  /// All functions below are at these parameters, which must stay alive.
  void move_to(const double* x);
  const Population& population() const { return population_; }

  /// For a path that continues from a unit's last row, before `evaluate`: the state of `count`
  /// units at z there.
  void stand(std::size_t count, const double* z);

  /// The outputs in each row of that unit until now, at z; of a running path.
  void retrace(const double* z);
  double retraced(std::size_t o, std::size_t row) const;

  /// Computes the outputs for `count` units at z (effects() each; null for none) and positions on
  /// the axis (null if it is none), count <= Path::most. `varied` has the values of each varied condition.
  void evaluate(std::size_t count, const double* z, const double* place,
                std::span<const double* const> varied = {});
  double output(std::size_t o, std::size_t i) const;

 private:
  void fill_effects(std::size_t count, const double* z);

  const Path* path_;
  PopulationAt population_at_;
  Population population_;
  std::vector<double> inner_, effect_[2];
  formula::Workspace workspace_, history_workspace_;
  formula::Data ahead_;                       // of a running path
  std::vector<std::vector<double>> carried_;  // by running value, then unit
  std::vector<const double*> carried_at_;
};

}  // namespace wearwell::formula_model
