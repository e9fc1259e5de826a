#include "wearwell/infer/psis_loo.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "wearwell/base/stop_scope.h"
#include "wearwell/infer/left_out.h"
#include "wearwell/infer/loo_at_points.h"
#include "wearwell/infer/loo_of_many.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/pareto_smoothing.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/log_sum_exp.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// Limit of stored numbers; more draws are thinned.
constexpr double most_numbers = 5e7;

// Limit of nodes times observations; beyond it fewer draws replace the nodes.
constexpr double most_at_nodes = 2e7, most_at_draws = 4e6, fewest_draws = 400;
constexpr std::size_t many_terms = 1000;

// With more unreliable terms than this, the model is the problem, not the weights.
constexpr std::ptrdiff_t most_refits = 20;

// A likelihood without one observation: the sum of all other factors. If the likelihood is not such
// a sum (it integrates the product of factors by its own rule), subtracts the observation's factor.
class Without final : public LogDensity {
 public:
  Without(std::shared_ptr<const LogDensity> whole, std::size_t term, std::span<const double> at)
      : whole_(std::move(whole)), term_(term), counts_(whole_->pointwise_counts()) {
    constexpr double rounding = 1e-9;
    const std::vector<double> each = whole_->pointwise(at);
    counts_.resize(each.size(), 1);
    double sum = 0, size = 1;
    for (std::size_t i = 0; i < each.size(); ++i) {
      sum += counts_[i] * each[i];
      size += counts_[i] * std::abs(each[i]);
    }
    sums_ = std::abs(whole_->value(at) - sum) < rounding * size;
    --counts_[term];
  }

  int dimension() const override { return whole_->dimension(); }
  double value(std::span<const double> x) const override {
    if (!sums_) {
      const double all = whole_->value(x);
      return std::isfinite(all) ? all - whole_->pointwise(x)[term_] : all;
    }
    const std::vector<double> each = whole_->pointwise(x);
    double sum = 0;
    for (std::size_t i = 0; i < each.size(); ++i) {
      if (counts_[i] > 0) sum += counts_[i] * each[i];
    }
    return sum < infinity ? sum : -infinity;
  }
  // By differences, because likelihoods do not provide gradients of single terms. Only mode
  // searches need it.
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
  std::vector<int> counts_;  // counts of the others
  bool sums_ = false;
};

std::shared_ptr<const LogDensity> without(const std::shared_ptr<const LogDensity>& whole,
                                          std::size_t term, std::span<const double> at) {
  if (auto others = whole->without(term)) return others;
  return std::make_shared<Without>(whole, term, at);
}

struct Refitted {
  double elpd = 0, tail = 1, error = 0;
};

// Empty if the quadrature fails.
std::optional<Refitted> fitted_without(const Posterior& posterior, const Whitening& whitening,
                                       std::size_t term, const Scores* scores,
                                       std::optional<bool> along_ridge, std::vector<Mode> maxima,
                                       std::stop_token stop) {
  Eigen::VectorXd center(posterior.dimension());
  posterior.to_natural(view(whitening.center), view(center));
  const Posterior others(posterior.parameters(),
                         without(posterior.likelihood(), term, view(center)));
  ExactSettings settings;
  settings.tolerance = 1e-3;
  settings.max_evaluations = 4'000'000;
  settings.second_moments = false;
  settings.cells = false;
  settings.along_ridge = along_ridge;
  settings.maxima = std::move(maxima);
  settings.stop = std::move(stop);
  ExactPosterior exact = integrate(others, whitening, settings, posterior);
  if (!exact.failure.empty()) {
    // Without an influential observation the posterior may be elsewhere.
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

// Log densities of the terms at draws, one column per term.
Eigen::MatrixXd log_densities(const LogDensity& likelihood, const WeightedDraws& draws,
                              std::size_t terms) {
  // Each of many observations has so little influence that some hundred draws suffice.
  const double rows = static_cast<double>(draws.values.rows()),
               all = rows * static_cast<double>(terms);
  const double wanted = terms < many_terms
                            ? most_numbers
                            : std::max(most_at_draws, fewest_draws * static_cast<double>(terms));
  const auto thin = static_cast<Eigen::Index>(std::ceil(all / wanted));
  const Eigen::Index used = (draws.values.rows() + thin - 1) / thin;
  Eigen::MatrixXd log_density(used, static_cast<Eigen::Index>(terms));
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, used, 64), [&](const auto& part) {
    for (Eigen::Index row = part.begin(); row != part.end(); ++row) {
      check_stop();
      const Eigen::VectorXd x = draws.values.row(row * thin);
      const std::vector<double> each = likelihood.pointwise(view(x));
      log_density.row(row) =
          Eigen::Map<const Eigen::RowVectorXd>(each.data(), static_cast<Eigen::Index>(each.size()));
    }
  });
  return log_density;
}

// The average bulk efficiency of the draws over all parameters.
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
  const Eigen::VectorXd first = draws.values.row(0);
  const std::size_t terms = likelihood.pointwise(view(first)).size();
  if (terms == 0) return loo;
  if (terms >= terms_are_many) return loo_of_many(likelihood, draws, terms, efficiency, scores);
  const std::vector<int> counts = likelihood.pointwise_counts();
  Eigen::MatrixXd columns = log_densities(likelihood, draws, terms);
  const Eigen::Index used = columns.rows();
  const Eigen::Index thin = (draws.values.rows() + used - 1) / used;
  std::vector<std::vector<NormalScore>> z(scores ? static_cast<std::size_t>(used) : 0);
  tbb::parallel_for(std::size_t{0}, z.size(), [&](std::size_t s) {
    check_stop();
    const Eigen::VectorXd x = draws.values.row(static_cast<Eigen::Index>(s) * thin);
    z[s] = (*scores)(x.data());
  });
  loo.threshold = khat_threshold(static_cast<double>(used));
  loo.terms.resize(terms);
  tbb::parallel_for(std::size_t{0}, terms, [&](std::size_t i) {
    check_stop();
    if (!counts.empty()) loo.terms[i].count = counts[i];
    leave_out_smoothed(loo.terms[i], columns.col(static_cast<Eigen::Index>(i)),
                       scores ? [&](std::size_t s) { return z[s][i]; } : ScoreAt());
  });
  loo.error = std::sqrt(columns.rowwise().sum().squaredNorm() / efficiency);
  return loo;
}

double exact_elpd(const Posterior& posterior, const Whitening& whitening, std::size_t term) {
  const auto refitted = fitted_without(posterior, whitening, term, nullptr, {}, {}, {});
  return refitted ? refitted->elpd : std::numeric_limits<double>::quiet_NaN();
}

Loo leave_one_out(const Posterior& posterior, const Fit& fit, const Scores* scores,
                  const std::stop_token& stop) {
  const LogDensity& likelihood = *posterior.likelihood();
  if (!fit.exact) return psis_loo(likelihood, fit.pooled, efficiency_of(fit), scores);
  const Eigen::VectorXd first = fit.pooled.values.row(0);
  const std::size_t terms = likelihood.pointwise(view(first)).size();
  const double numbers =
      static_cast<double>(fit.exact->nodes.values.rows()) * static_cast<double>(terms);
  if (terms >= many_terms && numbers > most_at_nodes) {
    // A likelihood that has polynomials in its place is nearly normal, and cheap to ask for its mean.
    if (terms >= terms_are_many && fit.quick) {
      if (auto loo = loo_at_points(posterior, fit, scores)) return *std::move(loo);
    }
    return psis_loo(likelihood, fit.pooled, 1, scores);
  }
  Loo loo = psis_loo(likelihood, fit.pooled);
  if (loo.terms.empty()) return loo;
  const std::vector<LeftOut> sums =
      left_out(likelihood, fit.exact->nodes, loo.terms.size(), scores);
  loo.by_quadrature = true;
  loo.error = 0;
  // The worst terms first, whose weights extend beyond the nodes.
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
  uneven.resize(too_many ? 0 : std::min<std::size_t>(uneven.size(), most_refits));
  std::vector<std::optional<Refitted>> refitted(uneven.size());
  tbb::parallel_for(std::size_t{0}, uneven.size(), [&](std::size_t i) {
    refitted[i] = fitted_without(posterior, fit.whitening, uneven[i], scores,
                                 fit.exact->along_ridge, fit.other_maxima(), stop);
  });
  for (std::size_t i = 0; i < uneven.size(); ++i) {
    if (!refitted[i]) continue;
    LooTerm& term = loo.terms[uneven[i]];
    term.elpd = refitted[i]->elpd;
    term.tail = refitted[i]->tail;
    term.refitted = true;
    loo.error += term.count * refitted[i]->error;
  }
  for (const LooTerm& term : loo.terms) {
    if (!term.refitted) loo.error += term.count * fit.exact->error;
  }
  return loo;
}

}  // namespace wearwell
