#include "wearwell/infer/loo_at_points.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "wearwell/base/stop_scope.h"
#include "wearwell/infer/left_out.h"
#include "wearwell/infer/pareto_smoothing.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr int most_parameters = 4;
constexpr double most_moved = 0.05, most_error = 0.1;
constexpr std::size_t most_with_khat = 1000;

// Points in units of the posterior's widths, the middle first, with the weights of the rule.
struct Rule {
  std::vector<Eigen::VectorXd> points;
  std::vector<double> weights;
};

Rule rule_of_degree_5(int d) {
  const double away = std::sqrt(3.0);
  const Eigen::VectorXd middle = Eigen::VectorXd::Zero(d);
  Rule rule{{middle}, {1 + d * (d - 7) / 18.0}};
  const auto add = [&](const Eigen::VectorXd& at, double weight) {
    rule.points.push_back(at);
    rule.weights.push_back(weight);
  };
  for (int a = 0; a < d; ++a) {
    const Eigen::VectorXd along = away * Eigen::VectorXd::Unit(d, a);
    add(along, (4 - d) / 18.0);
    add(-along, (4 - d) / 18.0);
    for (int b = 0; b < a; ++b) {
      const Eigen::VectorXd other = away * Eigen::VectorXd::Unit(d, b);
      for (const double sign : {1.0, -1.0}) {
        add(along + sign * other, 1 / 36.0);
        add(-along - sign * other, 1 / 36.0);
      }
    }
  }
  return rule;
}

// The rule's points as parameters, about mean and covariance of the nodes on the real line.
std::vector<Eigen::VectorXd> placed(const Rule& rule, const Posterior& posterior,
                                    const WeightedDraws& nodes) {
  const Eigen::Index d = posterior.dimension(), count = nodes.values.rows();
  Eigen::MatrixXd z(count, d);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::VectorXd x = nodes.values.row(i);
    z.row(i) = posterior.to_real(view(x));
  }
  const Eigen::VectorXd mean = z.transpose() * nodes.weights;
  const Eigen::MatrixXd off = z.rowwise() - mean.transpose();
  const Eigen::MatrixXd covariance = off.transpose() * nodes.weights.asDiagonal() * off;
  const Eigen::MatrixXd scale = covariance.llt().matrixL();
  std::vector<Eigen::VectorXd> points;
  for (const Eigen::VectorXd& u : rule.points) {
    const Eigen::VectorXd at = mean + scale * u;
    Eigen::VectorXd x(d);
    posterior.to_natural(view(at), view(x));
    points.push_back(x);
  }
  return points;
}

// The largest share of the posterior's precision in any direction that one term has: 1/p has a tail of that k under a
// normal posterior. From the term at the points, by differences.
double largest_share(const Rule& rule, const std::vector<double>& log_p) {
  const Eigen::Index d = rule.points.front().size();
  constexpr double square = 3;  // of the distance of points from the middle, along an axis
  Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(d, d);
  for (std::size_t s = 1; s < log_p.size(); ++s) {
    const Eigen::VectorXd& u = rule.points[s];
    const bool on_axis = u.squaredNorm() < 1.5 * square;
    for (Eigen::Index a = 0; a < d; ++a) {
      if (on_axis && u[a] != 0) curvature(a, a) += (log_p[s] - log_p[0]) / square;
      for (Eigen::Index b = 0; b < d && !on_axis; ++b) {
        const double sides = u[a] * u[b];
        if (a != b && sides != 0)
          curvature(a, b) += (sides > 0 ? log_p[s] : -log_p[s]) / (4 * square);
      }
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(-curvature, Eigen::EigenvaluesOnly);
  return solved.eigenvalues().maxCoeff();
}

void add_tails(const std::vector<NormalScore>& scores, std::vector<LooTerm>& terms) {
  for (std::size_t i = 0; i < terms.size(); ++i) {
    check_stop();
    const double below = normal_cdf(scores[i].high), above = normal_cdf(-scores[i].low);
    terms[i].tail = std::min(1.0, 2 * std::min(below, above));
  }
}

double mean_log_likelihood(const LogDensity& likelihood, const WeightedDraws& nodes) {
  const Eigen::Index count = nodes.values.rows();
  std::vector<double> each(static_cast<std::size_t>(count));
  tbb::parallel_for(Eigen::Index{0}, count, [&](Eigen::Index i) {
    if (!(nodes.weights[i] > 0)) return;
    check_stop();
    const Eigen::VectorXd x = nodes.values.row(i);
    each[static_cast<std::size_t>(i)] = nodes.weights[i] * likelihood.value(view(x));
  });
  return std::accumulate(each.begin(), each.end(), 0.0);
}

}  // namespace

std::optional<Loo> loo_at_points(const Posterior& posterior, const Fit& fit, const Scores* scores) {
  const int d = posterior.dimension();
  if (!fit.exact || d > most_parameters) return {};
  const LogDensity& likelihood = *posterior.likelihood();
  const Rule rule = rule_of_degree_5(d);
  const std::vector<Eigen::VectorXd> points = placed(rule, posterior, fit.exact->nodes);
  const std::size_t count = points.size();
  std::vector<std::vector<double>> log_p(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t s) {
    check_stop();
    log_p[s] = likelihood.pointwise(view(points[s]));
  });
  const std::size_t terms = log_p.front().size();
  const std::vector<int> counts = likelihood.pointwise_counts();
  Loo loo;
  loo.by_quadrature = true;
  loo.threshold = khat_threshold(static_cast<double>(fit.pooled.values.rows()));
  // The first writing of large memory takes long: term by term a request to stop ends it.
  loo.terms.reserve(terms);
  for (std::size_t i = 0; i < terms; ++i) {
    check_stop();
    loo.terms.emplace_back();
  }
  std::vector<double> third(terms);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, terms, 4096), [&](const auto& part) {
    for (std::size_t i = part.begin(); i != part.end(); ++i) {
      check_stop();
      LeftOut sums;
      double mean = 0, square = 0;
      for (std::size_t s = 0; s < count; ++s) {
        sums.add(std::log(rule.weights[s]), log_p[s][i], nullptr);
        mean += rule.weights[s] * log_p[s][i];
      }
      for (std::size_t s = 0; s < count; ++s)
        square += rule.weights[s] * std::pow(log_p[s][i] - mean, 2);
      LooTerm& term = loo.terms[i];
      term.elpd = sums.elpd();
      term.lpd = sums.lpd();
      term.khat = -std::numeric_limits<double>::infinity();
      if (!counts.empty()) term.count = counts[i];
      third[i] = term.count * std::abs(term.elpd - (mean - 0.5 * square));
    }
  });
  const auto moved = [&](std::size_t i) { return loo.terms[i].lpd - loo.terms[i].elpd; };
  std::vector<std::size_t> order(terms);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto uneven = order.begin() + static_cast<std::ptrdiff_t>(std::min(terms, most_with_khat));
  std::partial_sort(order.begin(), uneven, order.end(), [&](std::size_t a, std::size_t b) {
    check_stop();
    return moved(a) != moved(b) ? moved(a) > moved(b) : a < b;
  });
  if (!(moved(order.front()) <= most_moved)) return {};
  for (auto i = order.begin(); i != uneven; ++i) {
    check_stop();
    std::vector<double> own;
    for (const auto& each : log_p) own.push_back(each[*i]);
    loo.terms[*i].khat = largest_share(rule, own);
  }
  double of_points = 0;
  for (std::size_t s = 0; s < count; ++s) {
    check_stop();
    of_points += rule.weights[s] * likelihood.value(view(points[s]));
  }
  loo.error = std::abs(of_points - mean_log_likelihood(likelihood, fit.exact->nodes)) +
              std::accumulate(third.begin(), third.end(), 0.0);
  if (!(loo.error <= most_error)) return {};
  if (scores) add_tails((*scores)(points.front().data()), loo.terms);
  return loo;
}

}  // namespace wearwell
