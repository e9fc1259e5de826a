#include "wearwell/models/formula_model/formula_first_passage.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/math/boost_policy.h"
#include "wearwell/math/root.h"

namespace wearwell::formula_model {
namespace {

constexpr double low_log = -9, high_log = 14, step_log = 0.05;  // of distance/scale
constexpr int places = 461;

double score(int edge) {
  return ScoreTable::first_score + ScoreTable::score_step * edge;
}

// exp(e + x^2/2) Phi(-x), x > 0.
double scaled_tail(double e, double x) {
  if (x < 10) return std::exp(e + 0.5 * x * x) * normal_cdf(-x);
  // Laplace's continued fraction of Mills' ratio.
  double fraction = x;
  for (int k = 40; k > 0; --k) fraction = x + k / fraction;
  return std::exp(e) / (2.50662827463100050 * fraction);
}

// The probability that a path with scale 1 has grown by `d` when its mean is m.
double passed(Process process, double m, double d) {
  if (process == Process::gamma) return boost::math::gamma_q(m, d, Quiet());
  const bool wiener = process == Process::wiener;
  const double r = std::sqrt(wiener ? m : d), off = (m - d) / r;
  const double tail = scaled_tail(-0.5 * off * off, (m + d) / r);
  return wiener ? normal_cdf(off) + tail : normal_cdf(off) - tail;
}

// Of a process with scale 1.
double unit_quantile(Process process, double d, double p) {
  if (d > 1e6) return d - std::sqrt(2 * d) * boost::math::erfc_inv(2 * p, Quiet());
  // In the logarithm: it may be far below the distance if the scale is large.
  const double root =
      solve_increasing([&](double x) { return passed(process, std::exp(x), d) - p; }, std::log(d),
                       0.5 / std::sqrt(1 + d), {.absolute = 1e-11}, -600, 600);
  return std::exp(root);
}

}  // namespace

double passage_quantile(Process process, double distance, double scale, double p) {
  return scale * unit_quantile(process, distance / scale, p);
}

double increment_quantile(Process process, double mean, double scale, double p) {
  const double m = mean / scale;
  if (process == Process::wiener) {
    return mean - scale * std::sqrt(2 * m) * boost::math::erfc_inv(2 * p, Quiet());
  }
  if (m > 1e6) return increment_quantile(Process::wiener, mean, scale, p);
  if (process == Process::gamma) return scale * boost::math::gamma_p_inv(m, p, Quiet());
  const auto below = [&](double log_x) {
    const double x = std::exp(log_x), r = std::sqrt(x), off = (x - m) / r;
    return normal_cdf(off) + scaled_tail(-0.5 * off * off, (x + m) / r);
  };
  const double root = solve_increasing([&](double x) { return below(x) - p; }, std::log(m),
                                       0.5 / std::sqrt(1 + m), {.absolute = 1e-11}, -600, 600);
  return scale * std::exp(root);
}

ScoreTable::ScoreTable(Process process, Quantile quantile)
    : process_(process), quantile_(quantile) {
  constexpr double least = 1e-300;
  for (int i = 0; i < places; ++i) {
    for (int k = 0; k < edges; ++k) {
      const double value =
          quantile(process, std::exp(low_log + i * step_log), 1, normal_cdf(score(k)));
      log_value_.push_back(std::log(std::max(value, least)));
    }
  }
}

const ScoreTable& ScoreTable::passages(Process process) {
  if (process == Process::wiener) {
    static const ScoreTable wiener(process, passage_quantile);
    return wiener;
  }
  if (process == Process::gamma) {
    static const ScoreTable gamma(process, passage_quantile);
    return gamma;
  }
  static const ScoreTable inverse_gaussian(process, passage_quantile);
  return inverse_gaussian;
}

const ScoreTable& ScoreTable::increments(Process process) {
  if (process == Process::gamma) {
    static const ScoreTable gamma(process, increment_quantile);
    return gamma;
  }
  static const ScoreTable inverse_gaussian(Process::inverse_gaussian, increment_quantile);
  return inverse_gaussian;
}

const std::vector<double>& ScoreTable::shares() {
  static const std::vector<double> all = [] {
    std::vector<double> each;
    double sum = 0;
    for (int k = 0; k < edges; ++k) {
      each.push_back(std::exp(-0.5 * score(k) * score(k)));
      sum += each.back();
    }
    for (double& share : each) share /= sum;
    return each;
  }();
  return all;
}

void ScoreTable::look_up(double size, double scale, double* values) const {
  const double x = (std::log(size / scale) - low_log) / step_log;
  if (!(x >= 1 && x < places - 3)) {
    for (int k = 0; k < edges; ++k) {
      values[k] = quantile_(process_, size, scale, normal_cdf(score(k)));
    }
    return;
  }
  // The cubic through four neighbours.
  const auto i = static_cast<std::size_t>(x);
  const double t = x - static_cast<double>(i);
  const double weight[] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                           -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
  for (int k = 0; k < edges; ++k) {
    double sum = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      sum += weight[j] * log_value_[(i + j - 1) * edges + static_cast<std::size_t>(k)];
    }
    values[k] = scale * std::exp(sum);
  }
}

}  // namespace wearwell::formula_model
