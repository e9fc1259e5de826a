#include "wearwell/fatigue/random_limit.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>

namespace wearwell::fatigue {
namespace {

using Rule = boost::math::quadrature::gauss_kronrod<double, 15>;
using Gauss = boost::math::quadrature::gauss<double, 7>;

constexpr double negligible = 42;  // e^-42 is 6e-19
constexpr double tolerance = 1e-12;
constexpr std::size_t most_panels = 400;

struct Panel {
  double low, high;
  double integral = 0, error = 0;  // of exp(log_f - reference)
};

class Adaptive {
 public:
  explicit Adaptive(const std::function<double(double)>& log_f) : log_f_(log_f) {}

  double reference = -std::numeric_limits<double>::infinity();

  Panel measured(double low, double high) {
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    const auto& x = Rule::abscissa();
    const auto& w = Rule::weights();
    const auto& g = Gauss::weights();
    double kronrod = 0, gauss = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      // Boost lists the nodes from the middle outward; every second one is Gauss's.
      double f = value(middle + half * x[i]);
      if (i > 0) f += value(middle - half * x[i]);
      kronrod += w[i] * f;
      if (i % 2 == 0) gauss += g[i / 2] * f;
    }
    return {low, high, half * kronrod, half * std::abs(kronrod - gauss)};
  }

  bool overflow = false;

 private:
  double value(double u) {
    const double g = log_f_(u);
    if (g > reference + 300) {
      overflow = true;
      reference = g;
    }
    return std::exp(g - reference);
  }

  const std::function<double(double)>& log_f_;
};

}  // namespace

void place_nodes(const std::function<double(double u)>& log_f,
                 const std::vector<std::pair<double, double>>& marks,
                 std::vector<std::pair<double, double>>& nodes) {
  thread_local std::vector<double> edges;
  thread_local std::vector<Panel> panels;
  edges.clear();
  for (const auto& [at, width] : marks) {
    for (const double reach : {-6.0, -2.0, 0.0, 2.0, 6.0}) edges.push_back(at + reach * width);
  }
  std::sort(edges.begin(), edges.end());
  Adaptive rule(log_f);
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

  double total = 0, error = 0;
  const auto start = [&] {
    panels.clear();
    total = error = 0;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      if (!(edges[i + 1] - edges[i] > 1e-12 * (1 + std::abs(edges[i])))) continue;
      panels.push_back(rule.measured(edges[i], edges[i + 1]));
      total += panels.back().integral;
      error += panels.back().error;
    }
  };
  for (int attempt = 0; attempt < 20; ++attempt) {
    rule.overflow = false;
    start();
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
      total += left.integral + right.integral - whole.integral;
      error += left.error + right.error - whole.error;
      *worst = left;
      panels.push_back(right);
    }
    if (!rule.overflow) break;
  }

  nodes.clear();
  const auto& x = Rule::abscissa();
  const auto& w = Rule::weights();
  for (const Panel& panel : panels) {
    if (panel.integral < 1e-16 * total) continue;
    const double middle = 0.5 * (panel.low + panel.high), half = 0.5 * (panel.high - panel.low);
    for (std::size_t i = 0; i < x.size(); ++i) {
      nodes.emplace_back(middle + half * x[i], half * w[i]);
      if (i > 0) nodes.emplace_back(middle - half * x[i], half * w[i]);
    }
  }
}

}  // namespace wearwell::fatigue
