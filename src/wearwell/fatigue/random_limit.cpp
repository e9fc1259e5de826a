#include "wearwell/fatigue/random_limit.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace wearwell::fatigue {
namespace {

using Rule = boost::math::quadrature::gauss_kronrod<double, 15>;
using Gauss = boost::math::quadrature::gauss<double, 7>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double negligible = 42;  // e^-42 is 6e-19
/// Of the difference between Kronrod's and Gauss's sums; the error of Kronrod's is far smaller,
/// about (200 difference)^1.5.
constexpr double tolerance = 1e-10;
constexpr std::size_t most_panels = 400;
const double decade = std::log(10.0);

/// What was seen of a life, given its centre: log of a density or probability, with its slopes by
/// the centre and by sigma.
struct Seen {
  double value = 0;
  double by_center = 0, by_sigma = 0;
};

class Observed {
 public:
  Observed(const LimitedLife<double>& item, Outcome outcome, double at, double until)
      : item_(item), outcome_(outcome), at_(at), until_(until), log_sigma_(std::log(item.sigma)) {}

  Seen operator()(double center) const {
    const double z = (at_ - center) / item_.sigma;
    switch (outcome_) {
      case Outcome::runout:
        return by(z, log_survival_and_slope(item_.life, z));
      case Outcome::left:
        return by(z, log_cdf_and_slope(item_.life, z));
      case Outcome::interval: {
        const double end = (until_ - center) / item_.sigma;
        const LogBetween y = log_between_and_slopes(item_.life, z, end);
        return {y.value, -(y.slope_a + y.slope_b) / item_.sigma,
                -(y.slope_a * z + y.slope_b * end) / item_.sigma};
      }
      case Outcome::failure:
        break;
    }
    Seen seen = by(z, log_density_and_slope(item_.life, z));
    seen.value -= log_sigma_;
    seen.by_sigma -= 1 / item_.sigma;
    return seen;
  }

 private:
  Seen by(double z, const ValueAndSlope& y) const {
    return {y.value, -y.slope / item_.sigma, -y.slope * z / item_.sigma};
  }

  const LimitedLife<double>& item_;
  Outcome outcome_;
  double at_, until_, log_sigma_;
};

/// The joint density of u and what was seen, where 10^V/S_f = 1/(1 + exp(-u)): on the whole line of
/// u it is smooth and falls off at both ends. By it and by it times its slopes is integrated.
constexpr std::size_t integrals = 6;
using Integrals = std::array<double, integrals>;
enum Which : std::size_t { mass, of_w, of_w_w, of_center, of_center_center, of_sigma };

struct Integrand {
  const LimitedLife<double>& item;
  Observed seen;
  double log_scale;

  /// The logarithm; `slopes` are the factors of each of Integrals.
  double operator()(double u, Integrals* slopes = nullptr) const {
    // log of the limit's share of the stress and of what remains, without cancellation.
    const double log_share = -(u > 0 ? std::log1p(std::exp(-u)) : std::log1p(std::exp(u)) - u);
    const double log_rest = log_share - u;
    const double w = (item.log10_reversed + log_share / decade - item.location) / item.scale;
    const double center = (item.log10_reversed + log_rest / decade - item.log10_a) / item.b;
    const ValueAndSlope limit = log_density_and_slope(item.limit, w);
    const Seen life = seen(center);
    if (slopes) {
      *slopes = {
          1, limit.slope, limit.slope * w, life.by_center, life.by_center * center, life.by_sigma};
    }
    return limit.value - log_scale + life.value + log_rest - std::log(decade);
  }
};

struct Panel {
  double low, high;
  Integrals sums{};  // times exp(-reference)
  double error = 0;  // of the mass
};

class Adaptive {
 public:
  explicit Adaptive(const Integrand& log_f) : log_f_(log_f) {}

  double reference = -infinity;
  bool overflow = false;

  Panel measured(double low, double high) {
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    const auto& x = Rule::abscissa();
    const auto& w = Rule::weights();
    const auto& g = Gauss::weights();
    Panel panel{low, high};
    double gauss = 0;
    const auto add = [&](double u, std::size_t i) {
      Integrals slopes;
      const double f = value(u, slopes);
      if (f == 0) return;  // its slopes may be infinite
      for (std::size_t k = 0; k < integrals; ++k) panel.sums[k] += half * w[i] * f * slopes[k];
      if (i % 2 == 0) gauss += half * g[i / 2] * f;
    };
    for (std::size_t i = 0; i < x.size(); ++i) {
      // Boost lists the nodes from the middle outward; every second one is Gauss's.
      add(middle + half * x[i], i);
      if (i > 0) add(middle - half * x[i], i);
    }
    panel.error = std::abs(panel.sums[mass] - gauss);
    return panel;
  }

 private:
  double value(double u, Integrals& slopes) {
    const double g = log_f_(u, &slopes);
    if (g > reference + 300) {
      overflow = true;
      reference = g;
    }
    return std::exp(g - reference);
  }

  const Integrand& log_f_;
};

/// Where panels begin and end: around `marks` (where, how wide) of the features to expect, and out
/// to where nothing is left. Sets the rule's reference to the highest value met.
void place_edges(const Integrand& log_f, const std::vector<std::pair<double, double>>& marks,
                 Adaptive& rule, std::vector<double>& edges) {
  edges.clear();
  for (const auto& [at, width] : marks) {
    for (const double reach : {-6.0, -2.0, 0.0, 2.0, 6.0}) edges.push_back(at + reach * width);
  }
  std::sort(edges.begin(), edges.end());
  for (const double u : edges) rule.reference = std::max(rule.reference, log_f(u));
  for (const bool up : {false, true}) {
    double end = up ? edges.back() : edges.front();
    for (double step = 1; log_f(end) > rule.reference - negligible && step < 1e6; step *= 2) {
      end += up ? step : -step;
      rule.reference = std::max(rule.reference, log_f(end));
      if (up) {
        edges.push_back(end);
      } else {
        edges.insert(edges.begin(), end);
      }
    }
  }
}

/// All integrals over the whole line, times exp(-rule.reference).
Integrals integrate(Adaptive& rule, const std::vector<double>& edges) {
  thread_local std::vector<Panel> panels;
  for (int attempt = 0; attempt < 20; ++attempt) {
    rule.overflow = false;
    panels.clear();
    double total = 0, error = 0;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      if (!(edges[i + 1] - edges[i] > 1e-12 * (1 + std::abs(edges[i])))) continue;
      panels.push_back(rule.measured(edges[i], edges[i + 1]));
      total += panels.back().sums[mass];
      error += panels.back().error;
    }
    while (!rule.overflow && error > tolerance * total && panels.size() < most_panels) {
      const auto worst =
          std::max_element(panels.begin(), panels.end(),
                           [](const Panel& a, const Panel& b) { return a.error < b.error; });
      const Panel whole = *worst;
      // At the rounding error of its own sum a panel does not become better.
      if (whole.error < 1e-15 * total) break;
      const double middle = 0.5 * (whole.low + whole.high);
      const Panel left = rule.measured(whole.low, middle),
                  right = rule.measured(middle, whole.high);
      total += left.sums[mass] + right.sums[mass] - whole.sums[mass];
      error += left.error + right.error - whole.error;
      *worst = left;
      panels.push_back(right);
    }
    if (!rule.overflow) break;
  }
  Integrals all{};
  for (const Panel& panel : panels) {
    for (std::size_t k = 0; k < integrals; ++k) all[k] += panel.sums[k];
  }
  return all;
}

}  // namespace

LimitedLifeSlopes log_probability_and_slopes(const LimitedLife<double>& item, Outcome outcome,
                                             double at, double until) {
  thread_local std::vector<std::pair<double, double>> marks;
  thread_local std::vector<double> edges;
  marks.assign(1, {0.0, 1.0});
  // Where the limit is the usual one, and where the life seen is.
  const double log_share = decade * (item.location - item.log10_reversed);
  if (log_share < -1e-12) {
    const double rest = -std::expm1(log_share);
    marks.emplace_back(log_share - std::log(rest), item.scale * decade / rest);
  }
  for (const double y : {at, outcome == Outcome::interval ? until : at}) {
    const double log_rest = decade * (item.b * y + item.log10_a - item.log10_reversed);
    if (log_rest < -1e-12) {
      const double share = -std::expm1(log_rest);
      marks.emplace_back(std::log(share) - log_rest,
                         item.sigma * std::abs(item.b) * decade / share);
    }
  }
  const Integrand log_f{item, {item, outcome, at, until}, std::log(item.scale)};
  Adaptive rule(log_f);
  place_edges(log_f, marks, rule, edges);
  const Integrals sums = integrate(rule, edges);

  LimitedLifeSlopes y;
  y.value = std::log(sums[mass]) + rule.reference;
  if (sums[mass] > 0) {
    const auto mean = [&](Which which) { return sums[which] / sums[mass]; };
    y.by_log10_reversed = mean(of_w) / item.scale + mean(of_center) / item.b;
    y.by_log10_a = -mean(of_center) / item.b;
    y.by_b = -mean(of_center_center) / item.b;
    y.by_sigma = mean(of_sigma);
    y.by_location = -mean(of_w) / item.scale;
    y.by_scale = -(mean(of_w_w) + 1) / item.scale;
  } else {
    y.value = -infinity;  // an empty integral has no reference either
  }
  if (outcome != Outcome::runout) return y;

  // Those whose limit the stress does not reach outlast it as well.
  const double w = (item.log10_reversed - item.location) / item.scale;
  const ValueAndSlope safe = log_survival_and_slope(item.limit, w);
  const double larger = std::max(y.value, safe.value), smaller = std::min(y.value, safe.value);
  if (larger == -infinity) return y;
  const double all = larger + std::log1p(std::exp(smaller - larger));
  const double broken = std::exp(y.value - all), spared = std::exp(safe.value - all);
  for (double* slope :
       {&y.by_log10_reversed, &y.by_log10_a, &y.by_b, &y.by_sigma, &y.by_location, &y.by_scale}) {
    *slope *= broken;
  }
  y.by_log10_reversed += spared * safe.slope / item.scale;
  y.by_location -= spared * safe.slope / item.scale;
  y.by_scale -= spared * safe.slope * w / item.scale;
  y.value = all;
  return y;
}

}  // namespace wearwell::fatigue
