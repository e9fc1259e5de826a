#include "wearwell/infer/psis_loo.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "wearwell/infer/mode.h"
#include "wearwell/infer/pareto_smoothing.h"
#include "wearwell/math/log_sum_exp.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Numbers held at once: of few observations draws are thinned beyond, many are looked at block by block.
constexpr double most_numbers = 5e7;

// Of nodes and observations: beyond, draws serve instead of nodes, and fewer of them.
constexpr double most_at_nodes = 2e7, most_at_draws = 4e6, fewest_draws = 400;
constexpr std::size_t many_terms = 1000;

// With more doubtful observations than this the model is in doubt, not the weights.
constexpr std::ptrdiff_t most_refits = 20;

// All of a likelihood but one observation.
class Without final : public LogDensity {
 public:
  Without(std::shared_ptr<const LogDensity> whole, std::size_t term)
      : whole_(std::move(whole)), term_(term) {}

  int dimension() const override { return whole_->dimension(); }
  double value(std::span<const double> x) const override {
    const double all = whole_->value(x);
    return std::isfinite(all) ? all - whole_->pointwise(x)[term_] : all;
  }
  // By differences: no likelihood tells the gradients of its terms. Only searches for a peak ask.
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    constexpr double step = 6e-6;  // the cube root of the rounding error
    std::vector<double> moved(x.begin(), x.end());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double h = step * (x[i] != 0 ? std::abs(x[i]) : 1);
      moved[i] = x[i] + h;
      const double above = value(moved);
      moved[i] = x[i] - h;
      gradient[i] = (above - value(moved)) / (2 * h);
      moved[i] = x[i];
    }
    return value(x);
  }

 private:
  std::shared_ptr<const LogDensity> whole_;
  std::size_t term_;
};

// Sums over weighted points of a posterior that say how one term is predicted by all others: over
// w/p, p the term's density at a point of weight w. Relative to the largest of them so far.
class LeftOut {
 public:
  void add(double log_weight, double log_p, const NormalScore* score) {
    const double log_inverse = log_weight - log_p;
    if (!std::isfinite(log_inverse)) return;
    rescale(std::max(top_, log_inverse));
    const double weight = std::exp(log_inverse - top_);
    sum_ += weight;
    with_ += std::exp(log_weight + log_p - top_);
    if (!score) return;
    below_ += weight * normal_cdf(score->high);
    above_ += weight * normal_cdf(-score->low);
  }

  void add(const LeftOut& other) {
    if (other.sum_ == 0) return;
    rescale(std::max(top_, other.top_));
    const double factor = std::exp(other.top_ - top_);
    sum_ += factor * other.sum_;
    with_ += factor * other.with_;
    below_ += factor * other.below_;
    above_ += factor * other.above_;
  }

  double elpd() const { return -(top_ + std::log(sum_)); }
  double lpd() const { return top_ + std::log(with_); }
  double tail() const { return std::min(1.0, 2 * std::min(below_, above_) / sum_); }

 private:
  void rescale(double top) {
    if (top == top_) return;
    const double factor = std::exp(top_ - top);
    for (double* each : {&sum_, &with_, &below_, &above_}) *each *= factor;
    top_ = top;
  }

  double top_ = -infinity;
  double sum_ = 0, with_ = 0, below_ = 0, above_ = 0;
};

std::vector<NormalScore> scores_at(const Scores* scores, const double* x) {
  return scores ? (*scores)(x) : std::vector<NormalScore>{};
}

// Over all nodes of a quadrature, in parts of fixed size: the sums do not depend on threads.
std::vector<LeftOut> left_out(const LogDensity& likelihood, const WeightedDraws& nodes,
                              std::size_t terms, const Scores* scores) {
  constexpr Eigen::Index part = 512;
  const Eigen::Index count = nodes.values.rows();
  std::vector<std::vector<LeftOut>> parts(static_cast<std::size_t>((count + part - 1) / part));
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    parts[i].resize(terms);
    const Eigen::Index first = static_cast<Eigen::Index>(i) * part;
    for (Eigen::Index row = first; row < std::min(count, first + part); ++row) {
      if (!(nodes.weights[row] > 0)) continue;
      const double log_weight = std::log(nodes.weights[row]);
      const Eigen::VectorXd x = nodes.values.row(row);
      const std::vector<double> log_p = likelihood.pointwise(view(x));
      const std::vector<NormalScore> z = scores_at(scores, x.data());
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

struct Refitted {
  double elpd = 0, tail = 1, error = 0;
};

// Empty where the quadrature fails.
std::optional<Refitted> fitted_without(const Posterior& posterior, const Whitening& whitening,
                                       std::size_t term, const Scores* scores,
                                       std::stop_token stop) {
  const Posterior others(posterior.parameters(),
                         std::make_shared<Without>(posterior.likelihood(), term));
  ExactSettings settings;
  settings.tolerance = 1e-3;
  settings.max_evaluations = 4'000'000;
  settings.second_moments = false;
  settings.stop = std::move(stop);
  ExactPosterior exact = integrate(others, whitening, settings, posterior);
  if (!exact.failure.empty()) {
    // Without an observation that pulled it far away the posterior lies elsewhere.
    const Mode mode = find_mode(others, whitening.center);
    if (mode.found) exact = integrate(others, whitening_at(mode), settings);
  }
  if (!exact.failure.empty()) return {};
  std::vector<double> log_density;
  double below = 0, above = 0;
  for (Eigen::Index i = 0; i < exact.nodes.values.rows(); ++i) {
    const Eigen::VectorXd x = exact.nodes.values.row(i);
    const double weight = exact.nodes.weights[i];
    if (!(weight > 0)) continue;
    log_density.push_back(std::log(weight) + posterior.likelihood()->pointwise(view(x))[term]);
    if (!scores) continue;
    const NormalScore score = (*scores)(x.data())[term];
    below += weight * normal_cdf(score.high);
    above += weight * normal_cdf(-score.low);
  }
  const double elpd = log_sum_exp(log_density);
  if (!std::isfinite(elpd)) return {};
  return Refitted{elpd, scores ? std::min(1.0, 2 * std::min(below, above)) : 1, exact.error};
}

// Every so manieth draw is used. Each of many observations moves the posterior so little that some hundred draws
// tell how it is predicted.
Eigen::Index thinning(const WeightedDraws& draws, std::size_t terms) {
  const double all = static_cast<double>(draws.values.rows()) * static_cast<double>(terms);
  const double wanted = terms < many_terms
                            ? most_numbers
                            : std::max(most_at_draws, fewest_draws * static_cast<double>(terms));
  return static_cast<Eigen::Index>(std::ceil(all / wanted));
}

// Some terms at all draws that are used: log densities, a column a term, and scores, by draw.
struct Block {
  Eigen::MatrixXd log_density;
  std::vector<std::vector<NormalScore>> scores;

  // The likelihood gives all its terms at once, and so does what scores them: each block asks for them anew.
  Block(const LogDensity& likelihood, const WeightedDraws& draws, Eigen::Index thin,
        std::size_t first, std::size_t count, const Scores* scores_of) {
    const Eigen::Index used = (draws.values.rows() + thin - 1) / thin;
    const auto columns = static_cast<Eigen::Index>(count);
    log_density.resize(used, columns);
    scores.resize(scores_of ? static_cast<std::size_t>(used) : 0);
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, used, 64), [&](const auto& part) {
      for (Eigen::Index row = part.begin(); row != part.end(); ++row) {
        const Eigen::VectorXd x = draws.values.row(row * thin);
        const std::vector<double> each = likelihood.pointwise(view(x));
        log_density.row(row) = Eigen::Map<const Eigen::RowVectorXd>(each.data() + first, columns);
        if (!scores_of) continue;
        const std::vector<NormalScore> z = (*scores_of)(x.data());
        const auto begin = z.begin() + static_cast<std::ptrdiff_t>(first);
        scores[static_cast<std::size_t>(row)].assign(begin, begin + columns);
      }
    });
  }
};

// Draws that count for fewer independent ones, on the average over the bulk of all parameters.
double efficiency_of(const Fit& fit) {
  double least = 1;
  for (const Diagnostics& each : fit.diagnostics) {
    const double share = each.ess_bulk / static_cast<double>(fit.pooled.values.rows());
    if (share > 0) least = std::min(least, share);
  }
  return least;
}

}  // namespace

Loo psis_loo(const LogDensity& likelihood, const WeightedDraws& draws, double efficiency,
             const Scores* scores) {
  Loo loo;
  const Eigen::VectorXd any = draws.values.row(0);
  const std::size_t terms = likelihood.pointwise(view(any)).size();
  if (terms == 0) return loo;
  const std::vector<int> counts = likelihood.pointwise_counts();
  const Eigen::Index thin = thinning(draws, terms);
  const Eigen::Index used = (draws.values.rows() + thin - 1) / thin;
  loo.threshold = khat_threshold(static_cast<double>(used));
  loo.terms.resize(terms);
  const std::size_t most = terms < many_terms
                               ? terms
                               : static_cast<std::size_t>(most_numbers / static_cast<double>(used));
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(used);
  for (std::size_t first = 0; first < terms; first += most) {
    const std::size_t count = std::min(most, terms - first);
    Block block(likelihood, draws, thin, first, count, scores);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      auto column = block.log_density.col(static_cast<Eigen::Index>(i));
      std::vector<double> weights(column.begin(), column.end());
      for (double& each : weights) each = -each;
      LooTerm& term = loo.terms[first + i];
      term.khat = pareto_smooth(weights);
      const std::vector<double> log_p(column.begin(), column.end());
      term.lpd = log_sum_exp(log_p) - std::log(static_cast<double>(used));
      const double total = log_sum_exp(weights);
      std::vector<double> with = weights;
      for (std::size_t s = 0; s < with.size(); ++s) with[s] += log_p[s];
      term.elpd = log_sum_exp(with) - total;
      if (!counts.empty()) term.count = counts[first + i];
      double below = 0, above = 0;
      for (std::size_t s = 0; s < weights.size(); ++s) {
        const double weight = std::exp(weights[s] - total);
        // What this draw adds to the error of elpd, to the first order.
        column[static_cast<Eigen::Index>(s)] =
            term.count * weight * (std::exp(log_p[s] - term.elpd) - 1);
        if (!scores) continue;
        below += weight * normal_cdf(block.scores[s][i].high);
        above += weight * normal_cdf(-block.scores[s][i].low);
      }
      if (scores) term.tail = std::min(1.0, 2 * std::min(below, above));
    });
    const Eigen::VectorXd sums = block.log_density.rowwise().sum();
    errors = first == 0 ? sums : Eigen::VectorXd(errors + sums);
  }
  loo.error = std::sqrt(errors.squaredNorm() / efficiency);
  return loo;
}

double exact_elpd(const Posterior& posterior, const Whitening& whitening, std::size_t term) {
  const auto refitted = fitted_without(posterior, whitening, term, nullptr, {});
  return refitted ? refitted->elpd : std::numeric_limits<double>::quiet_NaN();
}

Loo leave_one_out(const Posterior& posterior, const Fit& fit, const Scores* scores,
                  const std::stop_token& stop) {
  const LogDensity& likelihood = *posterior.likelihood();
  if (!fit.exact) return psis_loo(likelihood, fit.pooled, efficiency_of(fit), scores);
  Loo loo = psis_loo(likelihood, fit.pooled);
  if (loo.terms.empty()) return loo;
  const double numbers =
      static_cast<double>(fit.exact->nodes.values.rows()) * static_cast<double>(loo.terms.size());
  if (loo.terms.size() >= many_terms && numbers > most_at_nodes) {
    return scores ? psis_loo(likelihood, fit.pooled, 1, scores) : loo;
  }
  const std::vector<LeftOut> sums =
      left_out(likelihood, fit.exact->nodes, loo.terms.size(), scores);
  loo.by_quadrature = true;
  loo.error = 0;
  // The worst first: those whose weights reach beyond the nodes.
  std::vector<std::size_t> uneven;
  for (std::size_t i = 0; i < loo.terms.size(); ++i) {
    LooTerm& term = loo.terms[i];
    term.elpd = sums[i].elpd();
    term.lpd = sums[i].lpd();
    if (scores) term.tail = sums[i].tail();
    if (!(term.khat <= std::min(loo.threshold, refit_above))) uneven.push_back(i);
  }
  std::stable_sort(uneven.begin(), uneven.end(), [&](std::size_t a, std::size_t b) {
    return loo.terms[a].khat > loo.terms[b].khat;
  });
  const bool too_many = std::count_if(loo.terms.begin(), loo.terms.end(), [&](const LooTerm& term) {
                          return loo.doubtful(term);
                        }) > most_refits;
  for (std::size_t i = 0; i < std::min<std::size_t>(uneven.size(), most_refits) && !too_many; ++i) {
    LooTerm& term = loo.terms[uneven[i]];
    const auto refitted = fitted_without(posterior, fit.whitening, uneven[i], scores, stop);
    if (!refitted) continue;
    term.elpd = refitted->elpd;
    term.tail = refitted->tail;
    term.refitted = true;
    loo.error += term.count * refitted->error;
  }
  for (const LooTerm& term : loo.terms) {
    if (!term.refitted) loo.error += term.count * fit.exact->error;
  }
  return loo;
}

}  // namespace wearwell
