#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "wearwell/bayes/log_density.h"
#include "wearwell/latent/unit_integral.h"
#include "wearwell/models/formula_model/formula_extreme_value.h"
#include "wearwell/models/formula_model/formula_linear.h"
#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/models/formula_model/formula_steps.h"
#include "wearwell/models/formula_model/formula_tabled.h"
#include "wearwell/prob/response_block.h"

namespace wearwell::formula_model {

/// Rows of one measured column, bound to its program, unit by unit. Immutable.
struct BoundColumn {
  const Measured* measured = nullptr;
  formula::Data data;
  std::vector<std::size_t> unit;   ///< of each bound row
  std::vector<std::size_t> begin;  ///< of each unit among them; one more entry at the end
  ResponseColumn responses;        ///< of each bound row
  std::vector<double> count;       ///< 0 if the row has no observation of this column
  std::vector<std::size_t> term;   ///< index of the observation in `Observed`, if there is one
  std::size_t most_rows = 0;       ///< of one call
  std::vector<double> log_growth;  ///< of an increasing process, by bound row: ProcessRows
};

/// All columns of the first `rows` rows of the table.
std::vector<BoundColumn> bind_columns(const FormulaModel& model, std::size_t rows);

/// The units' likelihood at one point of the parameters; one thread uses it at a time.
class UnitRows final : public latent::UnitTerms {
 public:
  UnitRows(const FormulaModel& model, const std::vector<BoundColumn>& columns);

  /// All functions below are at these parameters, which must stay alive.
  void move_to(const double* x);
  const double* at() const { return x_; }
  const Population& population() const { return population_; }

  std::size_t units() const override { return model_.units.size(); }
  int effects() const override { return static_cast<int>(model_.effects.size()); }
  void evaluate(std::span<const double> z, std::span<const std::uint8_t> wanted,
                std::span<double> value, std::span<double> slope) override;

  /// Adds to `gradient` the sum over units of weight times the derivative of the unit's log
  /// likelihood at z by the study's parameters.
  void add_gradient(std::span<const double> z, std::span<const double> weight,
                    std::span<double> gradient);

  /// Outputs of all rows of column c with every unit's effects at `effects`: the mean and the
  /// standard deviation of a normal distribution, row by row; for a process its mean, scale or
  /// standard deviation, and the errors of readings.
  void means_at(const double* effects, std::size_t c, std::span<double> mean, std::span<double> sd,
                std::span<double> noise = {});
  /// Means of column c only, with the one effect of each unit at its value in `effects`.
  void means_of_units(std::span<const double> effects, std::size_t c, std::span<double> mean);
  /// Adds to `gradient` the sum over the rows of column c of adjoint times derivative of
  /// `means_at`, at fixed effects.
  void add_mean_gradient(const double* effects, std::size_t c, std::span<const double> by_mean,
                         std::span<const double> by_sd, std::span<double> gradient,
                         std::span<const double> by_noise = {});
  const std::vector<BoundColumn>& columns() const { return columns_; }
  const FormulaModel& model() const { return model_; }
  /// Adds the derivatives by medians, scatters and the correlation.
  void add_population_gradient(const Population& by, std::span<double> gradient) {
    population_at_.add_gradient(x_, by, gradient);
  }

  /// The log density of all rows of a model without integrated effects, to the last digits however many they are;
  /// NaN or infinite where that of a row is.
  double accurate_sum();
  /// log density of each observation at z, by column, in the order of `Observed`.
  std::vector<std::vector<double>> each_term(std::span<const double> z);

  /// The state of the units' paths of column c, a process, after their last rows.
  std::vector<Standing> standings(std::span<const double> z, std::size_t c);
  /// The scores of its readings, each given the earlier ones, in the order of `Observed`.
  std::vector<NormalScore> step_scores(std::span<const double> z, std::size_t c);

  /// The largest change of any unit's log density on a finer lattice, for hidden paths; for a model
  /// without integrated effects.
  double unsettled_paths();

  /// The distribution parameters of each observation at z, three each, by column in the order of
  /// `Observed`.
  std::vector<std::vector<double>> each_family_parameter(std::span<const double> z);

 private:
  struct Chunk {
    const BoundColumn* column;
    std::size_t index, begin, end;  // of columns; of bound rows
  };
  template <class Visit>
  void visit(std::span<const std::uint8_t> wanted, const Visit& visit);
  void run(const Chunk& chunk, std::span<const double> z);  // the distribution parameters only
  void forward(const Chunk& chunk, std::span<const double> z, bool sloped);
  void fill_adjoints(const Chunk& chunk, const double* weight);
  void forward_process(const Chunk& chunk, bool sloped);
  template <class Visit>
  void visit_processes(const Chunk& chunk, const Visit& visit);
  double weight_of(const Chunk& chunk, std::size_t i, const double* weight) const;

  const FormulaModel& model_;
  const std::vector<BoundColumn>& columns_;
  PopulationAt population_at_;
  Population population_;
  const double* x_ = nullptr;
  std::vector<double> inner_;  // parameters of the rows' symbols
  std::vector<double> inner_gradient_;
  std::vector<formula::Workspace> workspaces_;
  std::vector<double> value_, slope_;
  std::vector<double> effect_[2], by_effect_[2];  // of the rows of a chunk
  const double* effect_at_[2] = {};
  double* by_effect_at_[2] = {};
  std::vector<ParameterValues> family_parameters_;
  double zero_ = 0;
  const double* held_ = nullptr;  // effects, if they are fixed: the same for all units, or by unit
  bool held_by_unit_ = false;
};

/// The rows of a model, for any thread.
class FormulaRows {
 public:
  /// `again_and_again`: at so many points that building a table of the units (formula_tabled.h) pays.
  FormulaRows(std::shared_ptr<const FormulaModel> model, std::size_t rows,
              bool again_and_again = false);

  struct Scratch {
    UnitRows rows;
    std::unique_ptr<LinearUnits> linear;  ///< if means are linear in the random effects
    /// for a process whose mean is proportional to its effect
    std::unique_ptr<StepUnits> steps;
    std::unique_ptr<TabledUnits> tabled;  ///< for a curve with one random effect
    /// for Weibull and extreme value lives with one effect on their log scale
    std::unique_ptr<ExtremeValueUnits> extreme;
    latent::UnitIntegrals integrals;
    std::vector<double> value;
    std::unique_ptr<UnitRows>
        gathered;  ///< few rows for many, where there are (formula_gathered.h)

    /// For sums over all rows of a law without effects.
    UnitRows& to_sum() { return gathered ? *gathered : rows; }
  };
  /// This thread's own.
  Scratch& mine() const;
  /// For a model with random effects: integrates them out at x, into this thread's `integrals`.
  const latent::UnitIntegrals& integrate(const double* x) const;
  const FormulaModel& model() const { return *model_; }
  std::size_t rows() const { return rows_; }  ///< of the table, from the first
  /// Holds sums over gathered rows against those over all at these parameters, and sums over all from then on
  /// where they differ. Before other threads ask.
  void keep_gathered_at(const double* x);
  bool is_gathered() const { return !gathered_.empty(); }

 private:
  std::shared_ptr<const FormulaModel> model_;
  std::size_t rows_;
  std::vector<BoundColumn> columns_, gathered_;
  bool linear_ = false, proportional_ = false, extreme_ = false;
  std::optional<TabledForm> tabled_;
  mutable std::once_flag table_made_;
  mutable std::shared_ptr<const MismatchTable> table_;
  mutable tbb::enumerable_thread_specific<std::unique_ptr<Scratch>> scratch_;
};

/// The likelihood of a formula study; effects of units are integrated out (latent/unit_integral.h).
std::shared_ptr<const LogDensity> formula_likelihood(std::shared_ptr<const FormulaRows> rows);

}  // namespace wearwell::formula_model
