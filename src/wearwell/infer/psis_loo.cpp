#include "wearwell/infer/psis_loo.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Numbers held at once: draws are thinned beyond.
constexpr double most_numbers = 5e7;

// With more doubtful observations than this the model is in doubt, not the weights.
constexpr std::size_t most_refits = 20;

double log_sum_exp(std::span<const double> values) {
  const double highest = *std::max_element(values.begin(), values.end());
  if (!std::isfinite(highest)) return highest;
  double sum = 0;
  for (const double value : values) sum += std::exp(value - highest);
  return highest + std::log(sum);
}

// Over observations: their number, the sum of a value and that of squared distances from its mean.
struct Sums {
  double n = 0, sum = 0, scatter = 0;
};
template <class Value>
Sums sums_of(std::size_t terms, const Value& value, const auto& count) {
  Sums sums;
  for (std::size_t i = 0; i < terms; ++i) {
    sums.n += count(i);
    sums.sum += count(i) * value(i);
  }
  for (std::size_t i = 0; i < terms; ++i) {
    sums.scatter += count(i) * std::pow(value(i) - sums.sum / sums.n, 2);
  }
  return sums;
}

// sqrt(n) times the standard deviation.
double standard_error(const Sums& sums) {
  return std::sqrt(sums.n * sums.scatter / (sums.n - 1));
}

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
  double value_and_gradient(std::span<const double>, std::span<double>) const override {
    throw std::logic_error("a likelihood without one observation is only for quadrature");
  }

 private:
  std::shared_ptr<const LogDensity> whole_;
  std::size_t term_;
};

}  // namespace

double GeneralizedPareto::quantile(double p) const {
  const double survival = std::log1p(-p);
  return std::abs(k) < 1e-12 ? -sigma * survival : sigma * std::expm1(-k * survival) / k;
}

GeneralizedPareto fit_generalized_pareto(std::span<const double> ascending) {
  const auto n = static_cast<double>(ascending.size());
  const int grid = 30 + static_cast<int>(std::floor(std::sqrt(n)));
  const double quartile = ascending[static_cast<std::size_t>(std::floor(n / 4 + 0.5)) - 1];
  std::vector<double> theta, log_profile;
  for (int j = 1; j <= grid; ++j) {
    theta.push_back(1 / ascending.back() + (1 - std::sqrt(grid / (j - 0.5))) / (3 * quartile));
    double shape = 0;
    for (const double x : ascending) shape += std::log1p(-theta.back() * x);
    shape /= n;
    log_profile.push_back(n * (std::log(-theta.back() / shape) - shape - 1));
  }
  const double total = log_sum_exp(log_profile);
  double mean = 0;
  for (std::size_t j = 0; j < theta.size(); ++j)
    mean += theta[j] * std::exp(log_profile[j] - total);
  GeneralizedPareto law;
  law.k = 0;
  for (const double x : ascending) law.k += std::log1p(-mean * x);
  law.k /= n;
  law.sigma = -law.k / mean;
  constexpr double prior_weight = 10, prior_k = 0.5;
  law.k = (law.k * n + prior_weight * prior_k) / (n + prior_weight);
  if (std::isnan(law.k)) law.k = infinity;
  return law;
}

double pareto_smooth(std::vector<double>& log_weights) {
  const auto draws = static_cast<double>(log_weights.size());
  const auto tail =
      static_cast<std::size_t>(std::ceil(std::min(0.2 * draws, 3 * std::sqrt(draws))));
  const double highest = *std::max_element(log_weights.begin(), log_weights.end());
  for (double& each : log_weights) each -= highest;
  if (tail < 5) return infinity;
  std::vector<std::size_t> order(log_weights.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::make_pair(log_weights[a], a) < std::make_pair(log_weights[b], b);
  });
  const std::size_t first = order.size() - tail;
  const double cutoff = std::exp(log_weights[order[first - 1]]);
  // All alike: the observation does not matter.
  if (!(log_weights[order[first]] < 0)) return 0;
  std::vector<double> excess;
  for (std::size_t i = first; i < order.size(); ++i) {
    excess.push_back(std::exp(log_weights[order[i]]) - cutoff);
  }
  const GeneralizedPareto law = fit_generalized_pareto(excess);
  if (std::isfinite(law.k)) {
    for (std::size_t i = 0; i < tail; ++i) {
      const double p = (static_cast<double>(i) + 0.5) / static_cast<double>(tail);
      log_weights[order[first + i]] = std::min(0.0, std::log(law.quantile(p) + cutoff));
    }
  }
  return law.k;
}

double khat_threshold(double draws) {
  return std::min(1 - 1 / std::log10(draws), 0.7);
}

double Loo::observations() const {
  double n = 0;
  for (const LooTerm& term : terms) n += term.count;
  return n;
}

double Loo::elpd() const {
  double sum = 0;
  for (const LooTerm& term : terms) sum += term.count * term.elpd;
  return sum;
}

double Loo::se() const {
  return standard_error(sums_of(
      terms.size(), [&](std::size_t i) { return terms[i].elpd; },
      [&](std::size_t i) { return terms[i].count; }));
}

double Loo::p_loo() const {
  double sum = 0;
  for (const LooTerm& term : terms) sum += term.count * (term.lpd - term.elpd);
  return sum;
}

double Loo::khat_max() const {
  double highest = -infinity;
  for (const LooTerm& term : terms) highest = std::max(highest, term.khat);
  return highest;
}

bool Loo::doubtful(const LooTerm& term) const {
  return !term.refitted && !(term.khat <= threshold);
}

Loo psis_loo(const LogDensity& likelihood, const WeightedDraws& draws) {
  Loo loo;
  const Eigen::VectorXd first = draws.values.row(0);
  const std::size_t terms = likelihood.pointwise(view(first)).size();
  if (terms == 0) return loo;
  const std::vector<int> counts = likelihood.pointwise_counts();
  const auto thin = static_cast<Eigen::Index>(std::ceil(static_cast<double>(draws.values.rows()) *
                                                        static_cast<double>(terms) / most_numbers));
  const Eigen::Index used = (draws.values.rows() + thin - 1) / thin;
  loo.threshold = khat_threshold(static_cast<double>(used));
  Eigen::MatrixXd log_density(used, static_cast<Eigen::Index>(terms));  // a column a term
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, used, 64), [&](const auto& part) {
    for (Eigen::Index row = part.begin(); row != part.end(); ++row) {
      const Eigen::VectorXd x = draws.values.row(row * thin);
      const std::vector<double> each = likelihood.pointwise(view(x));
      log_density.row(row) =
          Eigen::Map<const Eigen::RowVectorXd>(each.data(), static_cast<Eigen::Index>(each.size()));
    }
  });
  loo.terms.resize(terms);
  tbb::parallel_for(std::size_t{0}, terms, [&](std::size_t i) {
    const Eigen::VectorXd column = log_density.col(static_cast<Eigen::Index>(i));
    std::vector<double> weights(column.begin(), column.end());
    for (double& each : weights) each = -each;
    LooTerm& term = loo.terms[i];
    term.khat = pareto_smooth(weights);
    term.lpd = log_sum_exp(view(column)) - std::log(static_cast<double>(used));
    const double total = log_sum_exp(weights);
    for (std::size_t s = 0; s < weights.size(); ++s) {
      weights[s] += column[static_cast<Eigen::Index>(s)];
    }
    term.elpd = log_sum_exp(weights) - total;
    if (!counts.empty()) term.count = counts[i];
  });
  return loo;
}

double exact_elpd(const Posterior& posterior, const Whitening& whitening, std::size_t term) {
  const Posterior others(posterior.parameters(),
                         std::make_shared<Without>(posterior.likelihood(), term));
  ExactSettings settings;
  settings.tolerance = 1e-3;
  settings.max_evaluations = 4'000'000;
  settings.second_moments = false;
  const ExactPosterior exact = integrate(others, whitening, settings);
  if (!exact.failure.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (Eigen::Index i = 0; i < exact.nodes.values.rows(); ++i) {
    const Eigen::VectorXd x = exact.nodes.values.row(i);
    sum += exact.nodes.weights[i] * std::exp(posterior.likelihood()->pointwise(view(x))[term]);
  }
  return std::log(sum);
}

Loo leave_one_out(const Posterior& posterior, const Fit& fit) {
  Loo loo = psis_loo(*posterior.likelihood(), fit.pooled);
  const auto bad = static_cast<std::size_t>(std::count_if(
      loo.terms.begin(), loo.terms.end(), [&](const LooTerm& term) { return loo.doubtful(term); }));
  if (!fit.exact || bad > most_refits) return loo;
  for (std::size_t i = 0; i < loo.terms.size(); ++i) {
    LooTerm& term = loo.terms[i];
    if (!loo.doubtful(term)) continue;
    const double elpd = exact_elpd(posterior, fit.whitening, i);
    if (!std::isfinite(elpd)) continue;
    term.elpd = elpd;
    term.refitted = true;
  }
  return loo;
}

Check loo_check(const Loo& loo, const std::string& noun) {
  Findings findings("leave-one-out");
  std::vector<std::string> doubtful, refitted;
  for (std::size_t i = 0; i < loo.terms.size(); ++i) {
    const LooTerm& term = loo.terms[i];
    const std::string name = fmt::format("{} {} ({:.2f})", noun, i + 1, term.khat);
    if (term.refitted) refitted.push_back(name);
    if (loo.doubtful(term)) doubtful.push_back(name);
  }
  constexpr std::size_t most = 8;
  const auto list = [&](std::vector<std::string> names) {
    const std::size_t all = names.size();
    names.resize(std::min(all, most));
    return fmt::format("{}{}", fmt::join(names, ", "),
                       all > most ? fmt::format(" and {} more", all - most) : "");
  };
  if (!doubtful.empty()) {
    findings.add(Verdict::warn,
                 fmt::format("leaving out one observation changes the posterior too much for its "
                             "draws to say how well it is predicted: Pareto k above {:.2f} for {}",
                             loo.threshold, list(doubtful)),
                 fmt::format("Do not compare models by elpd here; look whether such a {} is a "
                             "mistake, or whether the model cannot expect it.",
                             noun));
  }
  return findings.result(
      refitted.empty()
          ? fmt::format("Pareto k at most {:.2f} (up to {:.2f} is good)", loo.khat_max(),
                        loo.threshold)
          : fmt::format("Pareto k above {:.2f} for {}: fitted anew without each, by quadrature",
                        loo.threshold, list(refitted)));
}

ElpdDifference elpd_difference(std::span<const LooTerm> a, std::span<const LooTerm> b) {
  const auto alike = [](const LooTerm& x, const LooTerm& y) { return x.count == y.count; };
  if (!std::equal(a.begin(), a.end(), b.begin(), b.end(), alike)) {
    throw std::invalid_argument("elpd of different observations");
  }
  const Sums sums = sums_of(
      a.size(), [&](std::size_t i) { return a[i].elpd - b[i].elpd; },
      [&](std::size_t i) { return a[i].count; });
  return {sums.sum, standard_error(sums)};
}

}  // namespace wearwell
