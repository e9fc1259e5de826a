#include "wearwell/models/formula_model/rate_change.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/input/median_factor.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/log_sum_exp.h"
#include "wearwell/models/formula_model/node_points.h"

namespace wearwell::formula_model {
namespace {

void append_to(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

std::shared_ptr<const Points> joined_rows(const Points& a, const Points& b) {
  auto both = std::make_shared<Points>(a.rows() + b.rows(), a.cols());
  *both << a, b;
  return both;
}

void refuse_running(const TomlReader& predict) {
  predict.fail("rate_change",
               "is not possible with cum() or a state: it changes how use counts, which their sums "
               "over rows contain; write the path in closed form, or leave rate_change out");
}

}  // namespace

void refuse_rate_change(const TomlReader& root) {
  const auto predict = root.table("predict");
  if (predict && predict->has("rate_change"))
    predict->fail(
        "rate_change",
        "is not in exported code, whose units have one rate: fit the study without it (the "
        "fit is the same) and export that result");
}

std::pair<double, double> change_fractions(std::size_t i) {
  return {fraction(i, 0.8191725133961645), fraction(i, 0.6710436067037893)};
}

std::vector<double> picked(const std::vector<double>& from, std::span<const std::size_t> which) {
  std::vector<double> to;
  if (from.empty()) return to;
  to.reserve(which.size());
  for (const std::size_t i : which) to.push_back(from[i]);
  return to;
}

double RateChangePrior::factor(double z) const {
  return median * std::exp(log_sd * z);
}

double RateChangePrior::log_density(double place, double start, double z) const {
  if (!(place >= start)) return -infinity;
  return -hazard * (place - start) - 0.5 * z * z;
}

std::optional<RateChangePrior> read_rate_change(const TomlReader& predict,
                                                const FormulaModel& model) {
  const std::string key = "rate_change";
  if (!predict.has(key)) return {};
  if (!predict.has("limit") || !model.along)
    predict.fail(key,
                 "needs predict.along and predict.limit: it is for units on line, which wear "
                 "towards a failure threshold");
  for (const Measured& each : model.measured) {
    if (NodeProgram(model, each.wanted, true).running() > 0) refuse_running(predict);
  }
  const TomlReader table = predict.required_table(key);
  std::string si;
  for (const formula::ColumnSymbol& each : model.row_symbols.columns)
    if (each.name == *model.along) si = formula::si_text(each.powers);
  RateChangePrior prior;
  const double every = table.required_quantity("every", si).si();
  if (!(every > 0)) table.fail("every", "must be positive: the mean use until a rate changes");
  prior.hazard = 1 / every;
  try {
    const MedianFactor factor = read_median_factor("factor", table.required_text("factor"));
    prior.median = factor.median;
    prior.log_sd = std::log(factor.factor);
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (!message.starts_with("factor: ")) throw;
    table.fail("factor", message.substr(std::string("factor: ").size()));
  }
  if (prior.log_sd == 0)
    table.fail("factor",
               "needs its spread: \"1 x/ 2\" means that two thirds of changes lie between "
               "half and twice the earlier rate");
  return prior;
}

RateChanges::RateChanges(std::shared_ptr<const Tracked> of, const RateChangePrior& change,
                         const TomlReader& root)
    : tracked(std::move(of)), prior(change), rows(tracked->model, tracked->lives.wanted(), true) {
  if (rows.runs()) refuse_running(root.required_table("predict"));
}

ChangedUnits ChangedUnits::taken(std::span<const std::size_t> which) const {
  ChangedUnits to;
  const auto count = static_cast<Eigen::Index>(which.size());
  auto parameters = std::make_shared<Points>(count, nodes.parameters->cols());
  for (Eigen::Index i = 0; i < count; ++i)
    parameters->row(i) =
        nodes.parameters->row(static_cast<Eigen::Index>(which[static_cast<std::size_t>(i)]));
  to.nodes.parameters = std::move(parameters);
  for (int e = 0; e < 2; ++e) {
    to.nodes.effect[e] = picked(nodes.effect[e], which);
    to.z[e] = picked(z[e], which);
  }
  to.axis = {picked(axis.since, which), picked(axis.factor, which)};
  to.score = picked(score, which);
  to.log_weight.assign(which.size(), 0);
  to.paths = paths;
  for (NodePath& path : to.paths)
    for (auto* each : {&path.mean, &path.spread, &path.at, &path.variance})
      *each = picked(*each, which);
  return to;
}

namespace {

// Every column of numbers but the parameters: `visit(that of one list, that of the other)`.
template <class Visit>
void visit_columns(ChangedUnits& to, const ChangedUnits& from, const Visit& visit) {
  for (int e = 0; e < 2; ++e) {
    visit(to.nodes.effect[e], from.nodes.effect[e]);
    visit(to.z[e], from.z[e]);
  }
  visit(to.axis.since, from.axis.since);
  visit(to.axis.factor, from.axis.factor);
  visit(to.score, from.score);
  visit(to.log_weight, from.log_weight);
  for (std::size_t m = 0; m < to.paths.size(); ++m) {
    visit(to.paths[m].mean, from.paths[m].mean);
    visit(to.paths[m].spread, from.paths[m].spread);
    visit(to.paths[m].at, from.paths[m].at);
    visit(to.paths[m].variance, from.paths[m].variance);
  }
}

}  // namespace

void ChangedUnits::append(const ChangedUnits& other) {
  if (other.count() == 0) return;
  if (count() == 0) {
    *this = other;
    return;
  }
  nodes.parameters = joined_rows(*nodes.parameters, *other.nodes.parameters);
  visit_columns(*this, other, append_to);
}

void ChangedUnits::replace(std::span<const std::size_t> which, const ChangedUnits& by) {
  if (nodes.parameters != by.nodes.parameters) {
    auto parameters = std::make_shared<Points>(*nodes.parameters);
    for (const std::size_t i : which) {
      const auto row = static_cast<Eigen::Index>(i);
      parameters->row(row) = by.nodes.parameters->row(row);
    }
    nodes.parameters = std::move(parameters);
  }
  visit_columns(*this, by, [&](std::vector<double>& to, const std::vector<double>& from) {
    if (from.empty()) return;
    for (const std::size_t i : which) to[i] = from[i];
  });
}

std::vector<double> ChangedUnits::places(double place) const {
  std::vector<double> at(count());
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = axis.at(i, place);
  return at;
}

std::vector<std::size_t> resampled(std::span<const double> log_weight, std::size_t count,
                                   double offset) {
  std::vector<std::size_t> drawn;
  const double all = log_sum_exp(log_weight);
  if (!(all > -infinity)) return drawn;
  drawn.reserve(count);
  double before = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < log_weight.size(); ++i) {
    const double share = std::exp(log_weight[i] - all);
    if (share > 0) last = i;
    before += share * static_cast<double>(count);
    while (drawn.size() < count && before > static_cast<double>(drawn.size()) + offset)
      drawn.push_back(i);
  }
  while (drawn.size() < count) drawn.push_back(last);  // rounding of the sum
  return drawn;
}

}  // namespace wearwell::formula_model
