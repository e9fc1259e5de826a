#include "wearwell/infer/left_out.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "wearwell/base/stop_scope.h"
#include "wearwell/infer/pareto_smoothing.h"
#include "wearwell/math/log_sum_exp.h"
#include "wearwell/math/view.h"

namespace wearwell {

std::vector<LeftOut> left_out(const LogDensity& likelihood, const WeightedDraws& points,
                              std::size_t terms, const Scores* scores, Eigen::Index part) {
  const Eigen::Index count = points.values.rows();
  std::vector<std::vector<LeftOut>> parts(static_cast<std::size_t>((count + part - 1) / part));
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    parts[i].resize(terms);
    const Eigen::Index first = static_cast<Eigen::Index>(i) * part;
    for (Eigen::Index row = first; row < std::min(count, first + part); ++row) {
      check_stop();
      if (!(points.weights[row] > 0)) continue;
      const double log_weight = std::log(points.weights[row]);
      const Eigen::VectorXd x = points.values.row(row);
      const std::vector<double> log_p = likelihood.pointwise(view(x));
      const std::vector<NormalScore> z = scores ? (*scores)(x.data()) : std::vector<NormalScore>{};
      for (std::size_t t = 0; t < terms; ++t) {
        parts[i][t].add(log_weight, log_p[t], scores ? &z[t] : nullptr);
      }
    }
  });
  std::vector<LeftOut> sums(terms);
  for (const auto& each : parts) {
    for (std::size_t t = 0; t < terms; ++t) sums[t].add(each[t]);
  }
  return sums;
}

double influence(const LooTerm& term, double log_weight, double log_p) {
  return term.count * std::exp(log_weight) * (std::exp(log_p - term.elpd) - 1);
}

void leave_out_smoothed(LooTerm& term, Eigen::Ref<Eigen::VectorXd> log_p, const ScoreAt& score) {
  const std::vector<double> densities(log_p.begin(), log_p.end());
  std::vector<double> weights = densities;
  for (double& each : weights) each = -each;
  term.khat = pareto_smooth(weights);
  term.lpd = log_sum_exp(densities) - std::log(static_cast<double>(densities.size()));
  const double total = log_sum_exp(weights);
  std::vector<double> with = weights;
  for (std::size_t s = 0; s < with.size(); ++s) with[s] += densities[s];
  term.elpd = log_sum_exp(with) - total;
  double below = 0, above = 0;
  for (std::size_t s = 0; s < weights.size(); ++s) {
    log_p[static_cast<Eigen::Index>(s)] = influence(term, weights[s] - total, densities[s]);
    if (!score) continue;
    const double weight = std::exp(weights[s] - total);
    const NormalScore z = score(s);
    below += weight * normal_cdf(z.high);
    above += weight * normal_cdf(-z.low);
  }
  if (score) term.tail = std::min(1.0, 2 * std::min(below, above));
}

}  // namespace wearwell
