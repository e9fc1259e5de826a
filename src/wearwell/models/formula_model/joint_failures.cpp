#include "wearwell/models/formula_model/joint_failures.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_row_columns.h"
#include "wearwell/models/formula_model/mode_probability.h"

namespace wearwell::formula_model {

JointFailures::JointFailures(const FormulaModel& model, std::size_t rows) : model_(model) {
  std::vector<std::size_t> which;
  for (const JointFailure& each : model.joint) {
    if (each.row >= rows) continue;
    joint_.push_back(each);
    count_.push_back(model.lives.counts[each.row]);
    which.push_back(each.row);
  }
  if (which.empty()) return;
  for (const Measured& mode : model.measured) {
    families_.push_back(mode.form->family);
    data_.push_back(mode.program.bind(RowColumns(model, which, mode.program).rows));
    workspaces_.push_back(mode.program.workspace(which.size()));
  }
  value_.resize(joint_.size());
  open_of_.resize(joint_.size());
  family_parameters_.resize(joint_.size() * families_.size() * most_response_parameters);
  slope_.resize(family_parameters_.size());
  find_equal();
}

void JointFailures::find_equal() {
  std::map<std::tuple<std::uint32_t, double, double>, std::size_t> seen;
  for (std::size_t i = 0; i < joint_.size(); ++i) {
    const JointFailure& each = joint_[i];
    first_.push_back(seen.try_emplace({each.possible, each.from, each.until}, i).first->second);
  }
}

const double* JointFailures::family_parameters(std::size_t i) const {
  return &family_parameters_[i * families_.size() * most_response_parameters];
}

void JointFailures::forward(std::span<const double> x) {
  uniform_ = true;
  const std::size_t stride = families_.size() * most_response_parameters;
  for (std::size_t k = 0; k < families_.size(); ++k) {
    const Measured& mode = model_.measured[k];
    mode.program.forward(data_[k], 0, joint_.size(), {x, {}}, workspaces_[k]);
    for (std::size_t o = 0; o < mode.wanted.size(); ++o) {
      const std::span<const double> values = workspaces_[k].values(o);
      uniform_ = uniform_ && values.size() == 1;
      const std::size_t at = k * most_response_parameters + mode.family_parameter[o];
      for (std::size_t i = 0; i < joint_.size(); ++i)
        family_parameters_[i * stride + at] = values[values.size() == 1 ? 0 : i];
    }
  }
}

void JointFailures::reverse(std::span<const double> x, std::span<double> gradient) {
  const std::size_t stride = families_.size() * most_response_parameters;
  for (std::size_t k = 0; k < families_.size(); ++k) {
    const Measured& mode = model_.measured[k];
    for (std::size_t o = 0; o < mode.wanted.size(); ++o) {
      const std::span<double> adjoints = workspaces_[k].adjoints(o);
      std::fill(adjoints.begin(), adjoints.end(), 0.0);
      const std::size_t at = k * most_response_parameters + mode.family_parameter[o];
      for (std::size_t i = 0; i < joint_.size(); ++i)
        adjoints[adjoints.size() == 1 ? 0 : i] += count_[i] * slope_[i * stride + at];
    }
    mode.program.reverse(data_[k], 0, joint_.size(), {x, {}}, workspaces_[k], gradient);
  }
}

std::span<const double> JointFailures::evaluate(std::span<const double> x,
                                                std::span<double> gradient) {
  sum_ = open_ = 0;
  if (joint_.empty()) return {};
  forward(x);
  const std::size_t stride = families_.size() * most_response_parameters;
  for (std::size_t i = 0; i < joint_.size(); ++i) {
    if (const std::size_t first = first_[i]; uniform_ && first < i) {
      value_[i] = value_[first];
      std::copy_n(&slope_[first * stride], gradient.empty() ? 0 : stride, &slope_[i * stride]);
      sum_ += count_[i] * value_[i];
      open_ += count_[i] * open_of_[first];
      continue;
    }
    const JointFailure& each = joint_[i];
    const ModeLives lives{families_, family_parameters(i)};
    const std::span<double> slope =
        gradient.empty() ? std::span<double>() : std::span(slope_).subspan(i * stride, stride);
    const ModeTerm term = each.from == each.until
                              ? log_hazard(lives, each.possible, each.from, slope)
                              : log_failure(lives, each.possible, each.from, each.until, slope);
    value_[i] = term.value;
    sum_ += count_[i] * term.value;
    open_of_[i] = term.open;
    open_ += count_[i] * term.open;
  }
  if (!gradient.empty() && sum_ > -infinity && sum_ < infinity) reverse(x, gradient);
  return value_;
}

}  // namespace wearwell::formula_model
