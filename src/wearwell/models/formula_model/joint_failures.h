#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "wearwell/models/formula_model/formula_model.h"
#include "wearwell/models/formula_model/mode_probability.h"

namespace wearwell::formula_model {

/// What failures of unknown mode, and failures within an interval, add to the likelihood of the modes taken
/// one by one (failure_modes.h). One thread uses it at a time.
class JointFailures {
 public:
  /// Those among the first `rows` rows of the table. The model must outlive this.
  JointFailures(const FormulaModel& model, std::size_t rows);

  bool empty() const { return joint_.empty(); }
  const std::vector<JointFailure>& failures() const { return joint_; }

  /// The log factor of each at these parameters, once; with a gradient, adds the derivatives of the sum,
  /// counts included.
  std::span<const double> evaluate(std::span<const double> x, std::span<double> gradient = {});
  /// The sum of the factors with their counts, and of their estimated errors, of the last `evaluate`.
  double sum() const { return sum_; }
  double open() const { return open_; }
  /// Parameters of the mode lives at failure i of the last `evaluate`: mode by mode,
  /// `most_response_parameters` each.
  const double* family_parameters(std::size_t i) const;
  const std::vector<ResponseFamily>& families() const { return families_; }

 private:
  // Failures within one interval, or at one age: one of each set of possible modes.
  struct Interval {
    double from = 0, until = 0;
    std::vector<std::uint32_t> possible;
    std::vector<std::size_t> which;
  };
  void find_equal();
  void compute(const Interval& interval, bool with_slopes);
  void forward(std::span<const double> x);
  void reverse(std::span<const double> x, std::span<double> gradient);

  const FormulaModel& model_;
  std::vector<JointFailure> joint_;
  std::vector<double> count_, value_, open_of_, family_parameters_, slope_;
  std::vector<ResponseFamily> families_;
  // Rows of a triangle of returns repeat ages: where no parameter depends on the row, equal failures are computed once.
  std::vector<std::size_t> first_;
  std::vector<Interval> equal_;   // where parameters are equal in all rows
  std::vector<Interval> single_;  // one for each row, once rows differ in their parameters
  bool uniform_ = false;
  std::vector<formula::Data> data_;  // by mode
  std::vector<formula::Workspace> workspaces_;
  std::vector<ModeTerm> terms_;  // of one interval
  std::vector<double> set_slopes_;
  double sum_ = 0, open_ = 0;
};

}  // namespace wearwell::formula_model
