#include "wearwell/models/formula_model/subpopulation_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/formula_row_columns.h"

namespace wearwell::formula_model {
namespace {

struct OrderTerm {
  double value;
  std::vector<double> slope;  // by each log median
};

// log of exp(sharpness sum k m_k) over the sum of the same over all orders of m.
OrderTerm log_share_of_order(std::span<const double> log_median, double sharpness) {
  const std::size_t count = log_median.size();
  std::vector<std::size_t> rank(count);
  std::iota(rank.begin(), rank.end(), std::size_t{0});
  const auto height = [&] {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += static_cast<double>(rank[k]) * log_median[k];
    return sharpness * sum;
  };
  const double named = height();
  double sum = 0;
  std::vector<double> mean_rank(count);
  // Relative to the highest, which is that of the sorted medians.
  std::vector<double> sorted(log_median.begin(), log_median.end());
  std::sort(sorted.begin(), sorted.end());
  double most = 0;
  for (std::size_t k = 0; k < count; ++k) most += sharpness * static_cast<double>(k) * sorted[k];
  do {
    const double weight = std::exp(height() - most);
    sum += weight;
    for (std::size_t k = 0; k < count; ++k) mean_rank[k] += weight * static_cast<double>(rank[k]);
  } while (std::next_permutation(rank.begin(), rank.end()));
  OrderTerm term{named - most - std::log(sum), std::vector<double>(count)};
  for (std::size_t k = 0; k < count; ++k)
    term.slope[k] = sharpness * (static_cast<double>(k) - mean_rank[k] / sum);
  return term;
}

}  // namespace

SubpopulationOrder::SubpopulationOrder(const FormulaModel& model)
    : measured_(model.measured.front()),
      data_(measured_.program.bind(
          RowColumns(model, {measured_.observed.rows.front()}, measured_.program).rows)),
      workspace_(measured_.program.workspace(1)),
      family_parameters_(measured_.life.parameters()),
      log_median_(measured_.life.families.size()) {}

void SubpopulationOrder::find_medians(std::span<const double> x) {
  measured_.program.forward(data_, 0, 1, {x, {}}, workspace_);
  for (std::size_t o = 0; o < measured_.wanted.size(); ++o)
    family_parameters_[measured_.family_parameter[o]] = workspace_.values(o)[0];
  for (std::size_t k = 0; k < log_median_.size(); ++k) {
    log_median_[k] = std::log(quantile(measured_.life.families[k], 0.5,
                                       &family_parameters_[k * most_response_parameters]));
  }
}

bool SubpopulationOrder::holds(std::span<const double> x) {
  find_medians(x);
  return std::is_sorted(log_median_.begin(), log_median_.end());
}

double SubpopulationOrder::value(std::span<const double> x, std::span<double> gradient) {
  find_medians(x);
  for (const double each : log_median_)
    if (!std::isfinite(each)) return -infinity;
  const OrderTerm term = log_share_of_order(log_median_, sharpness);
  if (!gradient.empty()) add_gradient(x, term.slope, gradient);
  return term.value;
}

// The median m solves F(m) = 1/2, so d ln m = -dF / (m f).
void SubpopulationOrder::add_gradient(std::span<const double> x,
                                      std::span<const double> by_log_median,
                                      std::span<double> gradient) {
  std::vector<double> slope(family_parameters_.size());
  for (std::size_t k = 0; k < log_median_.size(); ++k) {
    const double* const own = &family_parameters_[k * most_response_parameters];
    const double median = std::exp(log_median_[k]);
    const ResponseFamily family = measured_.life.families[k];
    const ResponseTerm below = log_response(family, {.seen = Censoring::left, .at = median}, own);
    const double density = std::exp(log_response_value(family, {.at = median}, own));
    for (std::size_t s = 0; s < most_response_parameters; ++s)
      slope[k * most_response_parameters + s] =
          -by_log_median[k] * std::exp(below.value) * below.slope[s] / (median * density);
  }
  for (std::size_t o = 0; o < measured_.wanted.size(); ++o)
    workspace_.adjoints(o)[0] = slope[measured_.family_parameter[o]];
  measured_.program.reverse(data_, 0, 1, {x, {}}, workspace_, gradient);
}

Check distinguished(const FormulaModel& model, const Fit& fit) {
  // Names in the other order throughout are distinguished as well.
  constexpr double sure = 0.99, enough = 0.95;
  const WeightedDraws& draws = fit.exact ? fit.exact->nodes : fit.pooled;
  SubpopulationOrder order(model);
  double share = 0;
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
    const std::span<const double> x(draws.values.row(i).data(),
                                    static_cast<std::size_t>(draws.values.cols()));
    if (order.holds(x)) share += draws.weights[i];
  }
  share /= draws.weights.sum();
  const double apart = std::max(share, 1 - share);
  Findings findings("subpopulations");
  if (apart < sure) {
    const bool exchangeable = model.subpopulations->exchangeable;
    findings.add(
        apart < enough && !exchangeable ? Verdict::fail : Verdict::warn,
        fmt::format(
            "the median lives are in the order of the names with a probability of {:.2g}: "
            "parameters and lives of single subpopulations mix both; those of the part do not",
            share),
        exchangeable
            ? "The data do not show several subpopulations clearly: compare with one distribution."
            : "Give the subpopulations the same expressions and priors, so that they are ordered "
              "by "
              "their median lives, or priors that say which one is which.");
  }
  return findings.result(
      fmt::format("the median lives are in {} order with a probability of {:.4g}",
                  share > 0.5 ? "the named" : "the opposite", apart));
}

namespace {

// The priors of the shares that are parameters; empty if an expression is another.
std::vector<const Distribution*> priors_of_shares(const FormulaModel& model) {
  const Measured& measured = model.measured.front();
  std::vector<const Distribution*> priors;
  for (std::size_t k = 0; k < measured.life.families.size(); ++k) {
    if (k == measured.life.rest) continue;
    for (std::size_t o = 0; o < measured.wanted.size(); ++o) {
      if (measured.family_parameter[o] != measured.life.share(k)) continue;
      const auto parameter =
          std::find_if(model.parameters.begin(), model.parameters.end(),
                       [&](const Parameter& each) { return each.name == measured.wanted[o].text; });
      if (parameter == model.parameters.end() || !parameter->prior.proper) return {};
      priors.push_back(&parameter->prior);
    }
  }
  return priors;
}

// The prior probability that these shares leave a rest, by the midpoint rule in probability.
double probability_of_rest(std::span<const Distribution* const> priors, double rest) {
  if (!(rest > priors.front()->lower)) return 0;
  if (priors.size() == 1) {
    double low = 0, high = 1;
    for (int step = 0; step < 40; ++step) {
      const double p = 0.5 * (low + high);
      (quantile(*priors.front(), p) < rest ? low : high) = p;
    }
    return 0.5 * (low + high);
  }
  constexpr int points = 128;
  double sum = 0;
  for (int i = 0; i < points; ++i)
    sum += probability_of_rest(priors.subspan(1),
                               rest - quantile(*priors.front(), (i + 0.5) / points));
  return sum / points;
}

}  // namespace

double log_orders(const FormulaModel& model) {
  if (!model.subpopulations) return 0;
  const std::vector<const Distribution*> shares = priors_of_shares(model);
  const double rest = shares.size() > 1 ? std::log(probability_of_rest(shares, 1)) : 0;
  if (!model.subpopulations->exchangeable) return -rest;
  return std::lgamma(static_cast<double>(model.subpopulations->names.size()) + 1) - rest;
}

}  // namespace wearwell::formula_model
