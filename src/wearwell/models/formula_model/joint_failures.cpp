#include "wearwell/models/formula_model/joint_failures.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_row_columns.h"

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
  std::map<std::pair<double, double>, std::size_t> intervals;
  for (std::size_t i = 0; i < joint_.size(); ++i) {
    const JointFailure& each = joint_[i];
    const auto [first, is_new] = seen.try_emplace({each.possible, each.from, each.until}, i);
    first_.push_back(first->second);
    if (!is_new) continue;
    const auto [at, begins] = intervals.try_emplace({each.from, each.until}, equal_.size());
    if (begins) equal_.push_back({each.from, each.until, {}, {}});
    equal_[at->second].possible.push_back(each.possible);
    equal_[at->second].which.push_back(i);
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

void JointFailures::compute(const Interval& interval, bool with_slopes) {
  const std::size_t stride = families_.size() * most_response_parameters;
  const std::size_t sets = interval.possible.size(), size = with_slopes ? stride : 0;
  const ModeLives lives{families_, family_parameters(interval.which.front())};
  terms_.resize(sets);
  set_slopes_.resize(sets * size);
  if (interval.from == interval.until) {
    for (std::size_t s = 0; s < sets; ++s)
      terms_[s] = log_hazard(lives, interval.possible[s], interval.from,
                             std::span(set_slopes_).subspan(s * size, size));
  } else {
    log_failures(lives, interval.possible, interval.from, interval.until, terms_, set_slopes_);
  }
  for (std::size_t s = 0; s < sets; ++s) {
    const std::size_t i = interval.which[s];
    value_[i] = terms_[s].value;
    open_of_[i] = terms_[s].open;
    std::copy_n(&set_slopes_[s * size], size, &slope_[i * stride]);
  }
}

std::span<const double> JointFailures::evaluate(std::span<const double> x,
                                                std::span<double> gradient) {
  sum_ = open_ = 0;
  if (joint_.empty()) return {};
  forward(x);
  const bool with_slopes = !gradient.empty();
  if (!uniform_ && single_.empty()) {
    for (std::size_t i = 0; i < joint_.size(); ++i)
      single_.push_back({joint_[i].from, joint_[i].until, {joint_[i].possible}, {i}});
  }
  for (const Interval& interval : uniform_ ? equal_ : single_) compute(interval, with_slopes);
  const std::size_t stride = families_.size() * most_response_parameters;
  for (std::size_t i = 0; i < joint_.size(); ++i) {
    if (const std::size_t first = first_[i]; uniform_ && first < i) {
      value_[i] = value_[first];
      open_of_[i] = open_of_[first];
      std::copy_n(&slope_[first * stride], with_slopes ? stride : 0, &slope_[i * stride]);
    }
    sum_ += count_[i] * value_[i];
    open_ += count_[i] * open_of_[i];
  }
  if (with_slopes && sum_ > -infinity && sum_ < infinity) reverse(x, gradient);
  return value_;
}

}  // namespace wearwell::formula_model
