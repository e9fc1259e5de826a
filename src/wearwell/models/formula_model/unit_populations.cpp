// One unit in each possible population: its lines, each by itself.
#include <algorithm>
#include <cmath>

#include "wearwell/models/formula_model/tracked_unit.h"

#include "wearwell/math/constants.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t dense =
    160;  // nodes of a line over two effects, where each line alone has too few

// Normalizes the weights of each line; their sums.
std::vector<double> by_line(std::vector<double>& log_weight, std::size_t per_line) {
  std::vector<double> sums;
  for (std::size_t begin = 0; begin < log_weight.size(); begin += per_line) {
    const auto first = log_weight.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto end = first + static_cast<std::ptrdiff_t>(per_line);
    const double top = *std::max_element(first, end);
    double sum = 0;
    for (auto each = first; each != end; ++each)
      sum += * each = top > -infinity ? std::exp(*each - top) : 0;
    if (sum > 0) std::for_each(first, end, [&](double& each) { each /= sum; });
    sums.push_back(sum > 0 ? top + std::log(sum) : -infinity);
  }
  return sums;
}

}  // namespace

std::optional<prognosis::InPopulations> TrackedUnit::in_populations(
    const prognosis::History& history) const {
  if (nodes_.own || !(effective_ > 0)) return {};
  std::vector<double> weight = log_weight_;
  std::vector<NodePath> paths = paths_;
  UnitNodes denser;
  const UnitNodes* nodes = &nodes_;
  if (tracked_->population.effects() == 2) {
    denser = nodes_;
    denser.fill(*tracked_->model, dense);
    weight = denser.log_before;
    std::vector<UnitReading> all = all_of(history);
    all.insert(all.begin(), seen_.begin(), seen_.end());
    sort_along(all);
    paths = look_at_all(denser, all, weight);
    nodes = &denser;
  }
  std::vector<double> log_likelihood = by_line(weight, nodes->nodes.per_line);
  prognosis::InPopulations found = lives().by_line(
      nodes->nodes, weight, any_row_ ? last_ : tracked_->lives.before_rows(), paths);
  for (std::size_t k = 0; k < log_likelihood.size(); ++k) {
    // The weights of populations already contain the study's rows.
    log_likelihood[k] = readings_ == 0 ? 0 : log_likelihood[k] - nodes->log_point[k];
  }
  found.log_likelihood = std::move(log_likelihood);
  return found;
}

}  // namespace wearwell::formula_model
