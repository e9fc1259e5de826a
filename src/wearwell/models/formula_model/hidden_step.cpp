#include "wearwell/models/formula_model/hidden_step.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/math/boost_policy.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/quadrature.h"

namespace wearwell::formula_model {
namespace {

constexpr int of_panel = 12, of_pole = 16, panel_width = 8, known_panels = 256, known_lags = 2048,
              most_halves = 48;
constexpr int stencil = HiddenStep::stencil, before = HiddenStep::before;
constexpr double smooth_shape = 6;  // above this shape a gamma density is smooth enough at 0

// Weights of the polynomial through places -5 .. 6, at t in [0, 1).
void interpolate(double t, double* weight) {
  static const std::array<double, stencil> divisor = [] {
    std::array<double, stencil> all{};
    for (int k = 0; k < stencil; ++k) {
      double product = 1;
      for (int m = 0; m < stencil; ++m) product *= m == k ? 1 : k - m;
      all[static_cast<std::size_t>(k)] = 1 / product;
    }
    return all;
  }();
  double product = 1;
  for (int k = 0; k < stencil; ++k) {
    weight[k] = product * divisor[static_cast<std::size_t>(k)];
    product *= t + before - k;
  }
  product = 1;
  for (int k = stencil; k-- > 0;) {
    weight[k] *= product;
    product *= t + before - k;
  }
}

// Nodes in units of the lattice width.
struct Places {
  std::vector<double> at, log_at, weight;
  std::vector<std::array<double, stencil>> by;  // polynomials there
  std::vector<int> from;

  void add(double place, double share) {
    at.push_back(place);
    log_at.push_back(std::log(place));
    weight.push_back(share);
    by.emplace_back();
    interpolate(place - std::floor(place), by.back().data());
    from.push_back(static_cast<int>(std::floor(place)) - before);
  }
};

Places places(int count, double low, double high) {
  const GaussLegendre rule = gauss_legendre(count);
  Places all;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    all.add(0.5 * (low + high) + 0.5 * (high - low) * rule.node[i],
            0.5 * (high - low) * rule.weight[i]);
  }
  return all;
}

struct Tables {
  Places panel = places(of_panel, 0, panel_width), pole = places(of_pole, 0, panel_width);
  std::vector<Places> halves;
  std::vector<double> log_at;   // of the nodes of each panel
  std::vector<double> log_lag;  // of whole numbers
  // Of the nodes at the pole: weight times (2n + 1) times Legendre's polynomial on [0, 1], by node,
  // then n.
  std::array<std::array<double, of_pole>, of_pole> legendre{};

  Tables() {
    for (int m = 0; m < most_halves; ++m) {
      const double high = panel_width * std::ldexp(1.0, -m);
      halves.push_back(places(of_panel, 0.5 * high, high));
    }
    for (int p = 0; p < known_panels; ++p) {
      for (const double at : panel.at) log_at.push_back(std::log(at + panel_width * p));
    }
    for (int k = 0; k < known_lags; ++k) log_lag.push_back(std::log(k));
    for (std::size_t q = 0; q < of_pole; ++q) {
      const double t = pole.at[q] / panel_width, x = 2 * t - 1;
      double last = 0, now = 1;
      for (std::size_t n = 0; n < of_pole; ++n) {
        const auto k = static_cast<double>(n);
        legendre[q][n] = pole.weight[q] / panel_width * (2 * k + 1) * now;
        const double next = ((2 * k + 1) * x * now - k * last) / (k + 1);
        last = now;
        now = next;
      }
    }
  }
};

const Tables& tables() {
  static const Tables all;
  return all;
}

}  // namespace

struct HiddenStep::Distribution {
  bool gamma;
  double mean, scale, log_scale, shape = 0, rest = 0, digamma = 0;

  Distribution(bool of_gamma, double dm, double u)
      : gamma(of_gamma), mean(dm), scale(u), log_scale(std::log(u)), shape(dm / u) {
    if (gamma && large()) {
      rest = 0.5 * (std::log(shape) - log_two_pi) - 1 / (12 * shape);
    } else if (gamma) {
      rest = -std::lgamma(shape);
      digamma = wearwell::digamma(shape);
    } else {
      rest = std::log(dm) - 0.5 * (log_two_pi + log_scale);
    }
  }
  // For large arguments by Stirling's series, to avoid cancellation.
  bool large() const { return shape > 1e4; }
  double density(double x, double log_x) const {
    if (gamma && large()) {
      const double off = (x - mean) / mean;
      return std::exp(rest - log_x - shape * (off - std::log1p(off)));
    }
    if (gamma) return std::exp((shape - 1) * (log_x - log_scale) - x / scale - log_scale + rest);
    return std::exp(rest - 1.5 * log_x - (x - mean) * (x - mean) / (2 * scale * x));
  }
  // Of the log density.
  double by_mean(double x, double log_x) const {
    if (gamma && large()) {
      return (std::log1p((x - mean) / mean) + (0.5 + 1 / (12 * shape)) / shape) / scale;
    }
    if (gamma) return (log_x - log_scale - digamma) / scale;
    return 1 / mean + (x - mean) / (scale * x);
  }
  double by_scale(double x, double slope_by_mean) const {
    if (gamma) return -shape * slope_by_mean + (x / scale - shape) / scale;
    const double off = x - mean;
    return -0.5 / scale + off * off / (2 * scale * scale * x);
  }
};

const double* HiddenStep::own_stencil(double place, int& from) {
  if (own_used_ == own_.size()) own_.emplace_back(stencil);
  double* weight = own_[own_used_++].data();
  const double whole = std::floor(place);
  from = static_cast<int>(whole) - before;
  interpolate(place - whole, weight);
  return weight;
}

// `place` is in lattice widths.
void HiddenStep::add(const Distribution& increments, double place, double log_place, double weight,
                     double shrink, int from, const double* by) {
  const double x = place * h_, log_x = log_place + log_h_;
  const double share = weight * h_ * increments.density(x, log_x);
  if (!(share > 0)) return;
  if (shrink < 1) by = own_stencil(place, from);
  const double slope = increments.by_mean(x, log_x);
  nodes_.push_back({share, share * slope, share * increments.by_scale(x, slope), from, by});
}

void HiddenStep::add_panel(const Distribution& increments, int panel, double shrink) {
  const Tables& table = tables();
  const double log_shrink = shrink < 1 ? std::log(shrink) : 0;
  for (std::size_t q = 0; q < of_panel; ++q) {
    const double at = table.panel.at[q] + panel_width * panel;
    const double log_at = panel < known_panels
                              ? table.log_at[static_cast<std::size_t>(panel) * of_panel + q]
                              : std::log(at);
    add(increments, shrink * at, log_shrink + log_at, shrink * table.panel.weight[q], shrink,
        table.panel.from[q] + panel_width * panel, table.panel.by[q].data());
  }
}

// Of a gamma step, from 0 on.
void HiddenStep::add_pole(const Distribution& increments, double shrink) {
  const Tables& table = tables();
  const double a = increments.shape, width = panel_width * shrink * h_;
  // Moments of Legendre's polynomials on [0, 1] with weight t^(a - 1), and their derivatives by a.
  std::array<double, of_pole> moment{}, by_shape{};
  moment[0] = 1 / a;
  by_shape[0] = -1 / (a * a);
  for (std::size_t n = 1; n < of_pole; ++n) {
    const auto k = static_cast<double>(n);
    const double factor = (a - k) / (a + k);
    moment[n] = moment[n - 1] * factor;
    by_shape[n] = by_shape[n - 1] * factor + moment[n - 1] * 2 * k / ((a + k) * (a + k));
  }
  const double ratio = std::log(width) - increments.log_scale,
               front = std::exp(a * ratio + increments.rest);
  for (std::size_t q = 0; q < of_pole; ++q) {
    double weight = 0, slope = 0;
    for (std::size_t n = 0; n < of_pole; ++n) {
      weight += table.legendre[q][n] * moment[n];
      slope += table.legendre[q][n] * by_shape[n];
    }
    const double x = table.pole.at[q] * shrink * h_;
    const double factor = front * std::exp(-x / increments.scale);
    const double share = factor * weight;
    slope = share * (ratio - increments.digamma) + factor * slope;  // by shape
    int from = table.pole.from[q];
    const double* by = table.pole.by[q].data();
    if (shrink < 1) by = own_stencil(table.pole.at[q] * shrink, from);
    nodes_.push_back({share, slope / increments.scale,
                      (-a * slope + share * (x / increments.scale - a)) / increments.scale, from,
                      by});
  }
}

// Of an inverse Gaussian step, down to where its density is negligible.
void HiddenStep::add_halves(const Distribution& increments, double shrink) {
  const double nothing = increments.mean * increments.shape / 90, log_shrink = std::log(shrink);
  double low = panel_width * shrink * h_;
  for (const Places& half : tables().halves) {
    low *= 0.5;
    for (std::size_t q = 0; q < of_panel; ++q) {
      add(increments, shrink * half.at[q], log_shrink + half.log_at[q], shrink * half.weight[q],
          shrink, half.from[q], half.by[q].data());
    }
    if (low < nothing) break;
  }
}

void HiddenStep::place_nothing() {
  none_ = true;
  nodes_.clear();
  first = 0;
  lag.assign(1, 1.0);
}

void HiddenStep::rebuild(Process process, double mean, double scale, double h, int least,
                         int most) {
  // A step with less variance counts as certain.
  const Distribution increments(process == Process::gamma, mean, std::max(scale, 1e-16 * mean));
  scale = increments.scale;
  none_ = false;
  h_ = h;
  log_h_ = std::log(h);
  nodes_.clear();
  own_used_ = 0;
  const double sd = std::sqrt(mean * scale), wide = std::max(sd, scale);
  const double shrink = std::min(1.0, wide / (1.3 * h)), width = panel_width * shrink * h;
  const double far = shrink < 1 ? 12 * sd + 80 * scale : 38 * sd + 700 * scale;
  const double low = std::max(std::max(least, 0) * h, mean - (shrink < 1 ? 12 : 38) * sd);
  const double high = std::min(std::max(most, 0) * h, mean + far);
  first = std::max(least, 0) - before;
  lag.clear();
  if (!(low <= high && high < 1e9 * width)) return;
  static const std::array<double, stencil> itself = [] {
    std::array<double, stencil> all{};
    all[before] = 1;
    return all;
  }();
  const int panel = static_cast<int>(low / width), panels = static_cast<int>(high / width) + 1;
  if (panel > 0 && shrink == 1) {
    // Far from 0: the trapezoidal rule.
    const int end = static_cast<int>(high / h) + 1;
    for (int k = static_cast<int>(low / h); k <= end; ++k) {
      const double log_k =
          k < known_lags ? tables().log_lag[static_cast<std::size_t>(k)] : std::log(k);
      add(increments, k, log_k, 1, 1, k - before, itself.data());
    }
  } else {
    for (int p = panel; p < panels; ++p) {
      if (p > 0 || (increments.gamma && increments.shape >= smooth_shape)) {
        add_panel(increments, p, shrink);
      } else if (increments.gamma) {
        add_pole(increments, shrink);
      } else {
        add_halves(increments, shrink);
      }
    }
  }
  int end = first;
  for (const Node& node : nodes_) {
    first = std::min(first, node.from);
    end = std::max(end, node.from + stencil);
  }
  lag.assign(static_cast<std::size_t>(end - first), 0.0);
  for (const Node& node : nodes_) {
    double* at = &lag[static_cast<std::size_t>(node.from - first)];
    for (int k = 0; k < stencil; ++k) at[k] += node.weight * node.stencil[k];
  }
}

HiddenStep::Slopes HiddenStep::slopes(const std::vector<double>& by) const {
  Slopes sum;
  for (const Node& node : nodes_) {
    const double* at = &by[static_cast<std::size_t>(node.from - first)];
    double met = 0;
    for (int k = 0; k < stencil; ++k) met += at[k] * node.stencil[k];
    sum.by_mean += node.by_mean * met;
    sum.by_scale += node.by_scale * met;
  }
  return sum;
}

}  // namespace wearwell::formula_model
