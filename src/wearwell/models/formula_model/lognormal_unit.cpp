#include "wearwell/models/formula_model/lognormal_unit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wearwell/models/formula_model/unit_rule.h"

namespace wearwell::formula_model {
namespace {

constexpr double negligible = -36;  // of log f below its maximum
constexpr double most_difference = 3e-6;

// Nodes of the finest rule in t: sinh(t) and log cosh(t); the coarser rule takes every second.
struct SinhNodes {
  static constexpr int most = 600;
  static constexpr double step = 0.05;
  double place[most], stretch[most];

  SinhNodes() {
    for (int n = 0; n < most; ++n) {
      place[n] = std::sinh(n * step);
      stretch[n] = std::log(std::cosh(n * step));
    }
  }
};

// The n-th node to the right (above 0) or to the left.
std::size_t place_of(int n) {
  return static_cast<std::size_t>(n > 0 ? 2 * n - 1 : -2 * n);
}

}  // namespace

double LognormalUnit::at(double z) const {
  return at(z, std::exp(s * z) - 1);
}

// Approximate position of the maximum, and the width there.
LognormalUnit::LaplaceApproximation LognormalUnit::approximation() const {
  const double top = 1 + best, informed = s * s * top * top * h;
  double z = top > 0 ? std::log(top) / s * informed / (1 + informed) : 0, bend = 1;
  if (!std::isfinite(z)) z = 0;
  for (int step = 0; step < 12; ++step) {
    const double e = std::exp(s * z), off = e - 1 - best, slope = -s * e * h * off - z;
    bend = std::max(1 + s * s * e * h * (e + off), 0.5 * (1 + s * s * e * e * h));
    const double move = std::clamp(slope / bend, -2.0, 2.0);
    if (std::abs(slope) < 0.1 * std::sqrt(bend)) break;
    z += move;
  }
  return {z, 1 / std::sqrt(bend)};
}

std::optional<double> LognormalUnit::log_integral(std::vector<Node>* kept, double gap) const {
  const LaplaceApproximation about = approximation();
  // The last rules are for populations that scatter much more than the rows determine: the
  // integrand follows the normal density up to a point, and falls off within 1/s.
  for (const double share : {1.0, 0.5, 0.15, 0.05}) {
    if (const auto integral = by_even_steps(about, share * gap, kept)) return integral;
  }
  // Steps of 0.1: with 0.2 every second node would miss the tolerance even for a normal density.
  for (const int stride : {2, 1}) {
    if (const auto integral = by_rule(about, stride, kept)) return integral;
  }
  return {};
}

// The trapezoidal rule in z, all nodes at once, between bounds of the relevant range: where log f
// is within `fallen` of its maximum, both the likelihood's part and z^2/2 are bounded.
std::optional<double> LognormalUnit::by_even_steps(const LaplaceApproximation& approximation,
                                                   double gap, std::vector<Node>* kept) const {
  constexpr int most = 600;
  constexpr double fallen = 30;
  // The error is about the square of the difference that every second node makes.
  constexpr double most_of_half = 3e-5;
  const double room = 2 * (fallen - at(approximation.center)), far = std::sqrt(room);
  const double reach = std::sqrt(room / h), least = 1 + best - reach;
  const double left = least > 0 ? std::max(-far, std::log(least) / s) : -far;
  const double right = std::min(far, std::log(1 + best + reach) / s),
               width = gap * approximation.width;
  const int before =
      static_cast<int>(std::min(1e4, std::ceil((approximation.center - left) / width)));
  const int after =
      static_cast<int>(std::min(1e4, std::ceil((right - approximation.center) / width)));
  const int count = before + after + 1;
  if (!(before >= 0 && after >= 0 && count <= most)) return {};
  double z[most], step[most], log_f[most], f[most];
  for (int i = 0; i < count; ++i) z[i] = approximation.center + width * (i - before);
  for (int i = 0; i < count; ++i) f[i] = s * z[i];
  exp_all(f, step, static_cast<std::size_t>(count));
  double highest = -INFINITY;
  for (int i = 0; i < count; ++i) {
    step[i] -= 1;
    log_f[i] = at(z[i], step[i]);
    highest = log_f[i] > highest ? log_f[i] : highest;
  }
  for (int i = 0; i < count; ++i) log_f[i] -= highest;
  exp_all(log_f, f, static_cast<std::size_t>(count));
  double even = 0, odd = 0;
  for (int i = 0; i < count; i += 2) even += f[i];
  for (int i = 1; i < count; i += 2) odd += f[i];
  const double sum = even + odd;
  if (!(std::abs(even - odd) < most_of_half * sum)) return {};
  if (kept) {
    kept->clear();
    for (int i = 0; i < count; ++i) {
      if (log_f[i] > negligible) {
        kept->push_back({place_of(i - before), z[i], step[i], f[i] / sum});
      }
    }
  }
  return highest + std::log(sum * width);
}

// In t, where z is sinh(t) widths from the middle: for integrands with one heavy tail.
std::optional<double> LognormalUnit::by_rule(const LaplaceApproximation& approximation, int stride,
                                             std::vector<Node>* kept) const {
  static const SinhNodes nodes;
  const auto [center, width] = approximation;
  double highest = at(center), sums[2] = {1, 0};
  if (kept) kept->assign(1, {0, center, std::exp(s * center) - 1, highest});
  for (const int sign : {1, -1}) {
    for (int n = 1;; ++n) {
      if (n * stride >= SinhNodes::most) return {};
      const double z = center + sign * width * nodes.place[n * stride];
      const double step = std::exp(s * z) - 1;
      const double log_f = at(z, step) + nodes.stretch[n * stride];
      if (!(log_f > highest + negligible)) break;
      if (kept) kept->push_back({place_of(sign * n), z, step, log_f});
      if (log_f > highest) {
        const double scale = std::exp(highest - log_f);
        sums[0] *= scale;
        sums[1] *= scale;
        highest = log_f;
      }
      sums[n % 2] += std::exp(log_f - highest);
    }
  }
  const double sum = sums[0] + sums[1];
  if (!(std::abs(sums[0] - sums[1]) < most_difference * sum)) return {};
  if (kept) {
    for (Node& node : *kept) node.weight = std::exp(node.weight - highest) / sum;
  }
  return highest + std::log(sum * SinhNodes::step * stride * width);
}

}  // namespace wearwell::formula_model
