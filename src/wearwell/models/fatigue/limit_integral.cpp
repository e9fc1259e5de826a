#include "wearwell/models/fatigue/limit_integral.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <optional>

#include "wearwell/math/constants.h"

namespace wearwell::fatigue {
namespace {

using Rule = boost::math::quadrature::gauss_kronrod<double, 15>;
using Gauss = boost::math::quadrature::gauss<double, 7>;

constexpr double negligible = 34;  // e^-34 is 2e-15
/// For the difference between Kronrod's and Gauss's sums; the error of Kronrod's is far smaller,
/// about (200 difference)^1.5.
constexpr double tolerance = 1e-10;
constexpr std::size_t most_panels = 400;

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

struct Edge {
  double u, log_f;
};

/// Around `marks` (position and width) of the expected features, and out to where the integrand is
/// negligible.
void place_edges(const Integrand& log_f, const std::vector<std::pair<double, double>>& marks,
                 std::vector<Edge>& edges) {
  edges.clear();
  for (const auto& [at, width] : marks) {
    for (const double reach : {-6.0, -2.0, 0.0, 2.0, 6.0}) edges.push_back({at + reach * width, 0});
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.u < b.u; });
  double highest = -infinity;
  for (Edge& edge : edges) highest = std::max(highest, edge.log_f = log_f(edge.u));
  for (const bool up : {false, true}) {
    Edge end = up ? edges.back() : edges.front();
    for (double step = 1; end.log_f > highest - negligible && step < 1e6; step *= 2) {
      end.u += up ? step : -step;
      end.log_f = log_f(end.u);
      highest = std::max(highest, end.log_f);
      edges.insert(up ? edges.end() : edges.begin(), end);
    }
  }
}

/// The trapezoidal rule. Its error for a smooth function that vanishes at both ends is the
/// function's Fourier transform at the frequency of the nodes, 1/h, and decreases at least
/// exponentially with it (Trefethen and Weideman 2014): about the third power of the transform at
/// 1/(3h), which the same nodes give. Most integrands have one peak, for which some 40 nodes are
/// enough.
class Trapezoid {
 public:
  explicit Trapezoid(const Integrand& log_f) : log_f_(log_f) {}

  double reference = -infinity;

  /// All integrals over the whole line, times exp(-reference); empty if it needs many nodes.
  std::optional<Integrals> operator()(const std::vector<Edge>& edges) {
    const double low = end(edges.begin(), edges.end()), high = end(edges.rbegin(), edges.rend());
    const double step = std::min(0.5, resolution() * std::min(width(low), width(high)));
    const double cells = std::ceil((high - low) / step);
    if (!(cells >= 1 && cells <= most_nodes)) return {};
    for (auto n = static_cast<std::size_t>(cells); n <= most_nodes; n *= 2) {
      const Sums sums = at_nodes(low, (high - low) / static_cast<double>(n), n);
      // A peak that the edges missed may lie at an end.
      if (!(nodes_.front().log_f < reference - gone && nodes_.back().log_f < reference - gone))
        break;
      if (sums.third <= 3e-4 && sums.half <= 1e-5) return sums.all;
    }
    return {};
  }

 private:
  static constexpr std::size_t most_nodes = 250;
  static constexpr double gone = 30;

  struct Node {
    double log_f;
    Integrals slopes;
  };

  // Of the narrowest feature possible at u, from the limit or the life.
  double width(double u) const {
    const LimitedLife<double>& item = log_f_.item;
    const double rest = 1 / (1 + std::exp(u)), share = 1 / (1 + std::exp(-u));
    return decade / std::hypot(rest / item.scale, share / (item.sigma * item.b));
  }

  // Steps in widths. The extreme value distribution is steeper on one side.
  double resolution() const {
    const LimitedLife<double>& item = log_f_.item;
    return item.life == StandardDistribution::normal && item.limit == StandardDistribution::normal
               ? 0.5
               : 0.4;
  }

  // The outer bounds, from the first edges that are not negligible.
  template <class Iterator>
  double end(Iterator first, Iterator last) const {
    double highest = -infinity;
    for (Iterator i = first; i != last; ++i) highest = std::max(highest, i->log_f);
    const double least = highest - negligible;
    Iterator inside = first;
    while (inside != last && !(inside->log_f > least)) ++inside;
    if (inside == first || inside == last) return first->u;
    double out = std::prev(inside)->u, in = inside->u;
    for (int i = 0; i < 6 && std::abs(in - out) > width(in); ++i) {
      const double middle = 0.5 * (in + out);
      (log_f_(middle) > least ? in : out) = middle;
    }
    return out;
  }

  // Of all nodes; and the transform of the mass at 1/(2h) and 1/(3h), relative to the mass.
  struct Sums {
    Integrals all{};
    double half = 0, third = 0;
  };

  Sums at_nodes(double low, double step, std::size_t n) {
    nodes_.resize(n + 1);
    reference = -infinity;
    for (std::size_t i = 0; i <= n; ++i) {
      Node& node = nodes_[i];
      node.log_f = log_f_(low + static_cast<double>(i) * step, &node.slopes);
      reference = std::max(reference, node.log_f);
    }
    Sums sums;
    std::array<double, 6> every_sixth{};
    for (std::size_t i = 0; i <= n; ++i) {
      const Node& node = nodes_[i];
      if (!(node.log_f > reference - negligible)) continue;  // its slopes may be infinite
      const double f = step * std::exp(node.log_f - reference);
      for (std::size_t k = 0; k < integrals; ++k) sums.all[k] += f * node.slopes[k];
      every_sixth[i % 6] += f;
    }
    const auto& [a, b, c, d, e, f] = every_sixth;
    const double p = a + d, q = b + e, r = c + f;
    const double whole = sums.all[mass];
    sums.half = std::abs(a - b + c - d + e - f) / whole;
    sums.third = std::sqrt(std::max(0.0, p * p + q * q + r * r - p * q - q * r - r * p)) / whole;
    return sums;
  }

  const Integrand& log_f_;
  inline static thread_local std::vector<Node> nodes_;
};

/// The same in panels between the edges, which are halved as needed: for several peaks, or very
/// narrow ones.
Integrals integrate(Adaptive& rule, const std::vector<Edge>& edges) {
  thread_local std::vector<Panel> panels;
  for (const Edge& edge : edges) rule.reference = std::max(rule.reference, edge.log_f);
  for (int attempt = 0; attempt < 20; ++attempt) {
    rule.overflow = false;
    panels.clear();
    double total = 0, error = 0;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      const double low = edges[i].u, high = edges[i + 1].u;
      if (!(high - low > 1e-12 * (1 + std::abs(low)))) continue;
      panels.push_back(rule.measured(low, high));
      total += panels.back().sums[mass];
      error += panels.back().error;
    }
    while (!rule.overflow && error > tolerance * total && panels.size() < most_panels) {
      const auto worst =
          std::max_element(panels.begin(), panels.end(),
                           [](const Panel& a, const Panel& b) { return a.error < b.error; });
      const Panel whole = *worst;
      // A panel cannot improve beyond the rounding error of its own sum.
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

ScaledIntegrals integrals_of(const Integrand& log_f,
                             const std::vector<std::pair<double, double>>& marks) {
  thread_local std::vector<Edge> edges;
  place_edges(log_f, marks, edges);
  Trapezoid trapezoid(log_f);
  if (const auto sums = trapezoid(edges)) return {*sums, trapezoid.reference};
  Adaptive rule(log_f);
  const Integrals sums = integrate(rule, edges);
  return {sums, rule.reference};
}

}  // namespace wearwell::fatigue
