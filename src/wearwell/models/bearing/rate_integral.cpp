#include "wearwell/models/bearing/rate_integral.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "wearwell/math/constants.h"

// Longer than others: the integral, its panels and their nodes use one integrand.

namespace wearwell::bearing {
namespace {

constexpr double negligible = -23;  // 1e-10 of the top
constexpr int most_stretches = 60;
constexpr int most_tops = 20;

// Sums of the integrand and its derivatives over nodes, relative to exp(top).
struct Sums {
  double mass = 0, by_log_k = 0, by_sigma = 0, by_scatter = 0;

  void add(const Sums& other, double factor) {
    mass += factor * other.mass;
    by_log_k += factor * other.by_log_k;
    by_sigma += factor * other.by_sigma;
    by_scatter += factor * other.by_scatter;
  }
};

// The integrand as a function of z; its logarithm is g(z) = log L(log_k + scatter z) - z^2/2.
class Integrand {
 public:
  struct Value {
    double g;
    double likelihood;  // log L
    double slope;       // of g
    Inspected::Point at;
  };

  Integrand(const Inspected& bearing, double log_k, double sigma, double scatter)
      : bearing_(bearing),
        log_k_(log_k),
        sigma_(sigma),
        scatter_(scatter),
        shape_(bearing.shape(sigma)) {
    lowest_ = (shape_.lowest - log_k) / scatter;
    highest_ = (shape_.highest - log_k) / scatter;
    last_ = (shape_.limit - log_k) / scatter;
  }

  Value operator()(double z) const {
    const Inspected::Point p = bearing_.at(log_k_ + scatter_ * z, sigma_);
    return {p.value - 0.5 * z * z, p.value, scatter_ * p.by_log_k - z, p};
  }

  static void add(Sums& sums, double z, const Value& value, double weight, double top) {
    const double share = weight * std::exp(value.g - top);
    if (!(share > 0)) return;
    sums.mass += share;
    sums.by_log_k += share * value.at.by_log_k;
    sums.by_scatter += share * value.at.by_log_k * z;
    sums.by_sigma += share * value.at.by_sigma;
  }

  // Whether everything beyond z on `side` (+1 or -1) is negligible relative to `top`.
  bool nothing_beyond(double z, double side, const Value& value, double top) const {
    const double least = top + negligible;
    if (!(value.g < least)) return false;
    const double out = side * z;  // from the mean of all bearings
    const bool past_peaks = side > 0 ? z >= highest_ : z <= lowest_;
    constexpr double factor = 1.5;
    if (past_peaks) {
      // Between z and the mean, piece by piece, each bounded by its value at the start.
      double here = z, likelihood = largest_on(side, here, value.likelihood);
      if (out >= 0) return likelihood - 0.5 * z * z < least;
      for (int n = 0; n < most_stretches; ++n, here /= factor) {
        if (n > 0) likelihood = largest_on(side, here, (*this)(here).likelihood);
        if (likelihood < least) return true;
        if (!(likelihood - 0.5 * std::pow(here / factor, 2) < least)) return false;
      }
      return false;
    }
    if (out < 0) return false;
    if (shape_.largest - 0.5 * z * z < least) return true;
    if (!shape_.one_peak) return false;
    // Towards the single peak it increases: at most to the value at the end of the piece.
    double here = z;
    for (int n = 0; n < most_stretches; ++n, here *= factor) {
      const double next = factor * here;
      if (side * next >= side * highest_ || next > last_) return false;
      if (!((*this)(next).likelihood - 0.5 * here * here < least)) return false;
      if (shape_.largest - 0.5 * next * next < least) return true;
    }
    return false;
  }

  double peak_width() const { return 1 / std::sqrt(1 + shape_.curvature * scatter_ * scatter_); }
  const RateShape& shape() const { return shape_; }
  double lowest() const { return lowest_; }    // z of the likelihood's lowest peak
  double highest() const { return highest_; }  // and of its highest
  double last() const { return last_; }        // beyond it the integrand is zero
  double log_k() const { return log_k_; }
  double scatter() const { return scatter_; }

 private:
  // Upper bound at z and beyond on `side`, outside the peaks.
  double largest_on(double side, double z, double likelihood) const {
    return side > 0 ? likelihood : bearing_.largest_below(log_k_ + scatter_ * z, sigma_);
  }

  const Inspected& bearing_;
  double log_k_, sigma_, scatter_;
  RateShape shape_;
  double lowest_, highest_, last_;
};

struct Top {
  double z, width;
  Integrand::Value value;
};

// Climbs from `start` to a maximum: Newton's steps with the curvature from the last two slopes,
// halved where they leave the bracket.
Top climb(const Integrand& integrand, Top start) {
  double curvature = std::min(1 / (start.width * start.width), std::numeric_limits<double>::max());
  double low = -infinity, high = integrand.last();
  Top here = start, best = start;
  for (int step = 0; step < 100 && std::isfinite(here.value.g); ++step) {
    const double slope = here.value.slope;
    (slope > 0 ? low : high) = here.z;
    double next = here.z + slope / curvature;
    const double width = 1 / std::sqrt(curvature);
    if (!(next > low && next < high) || step > 8) {
      next = std::isinf(low)    ? here.z - std::ldexp(width, std::min(step, 60))
             : std::isinf(high) ? here.z + std::ldexp(width, std::min(step, 60))
                                : 0.5 * (low + high);
    }
    if (!(next < high)) next = std::isinf(low) ? high : 0.5 * (low + high);
    const double moved = next - here.z;
    if (moved == 0) break;
    const Integrand::Value value = integrand(next);
    const double bend = (slope - value.slope) / moved;
    if (bend > 0 && std::isfinite(bend)) curvature = bend;
    here = {next, 1, value};
    if (value.g > best.value.g) best = here;
    if (std::abs(moved) < 0.2 / std::sqrt(curvature)) break;
  }
  best.width = 1 / std::sqrt(curvature);
  return best;
}

// A maximum near that of a likelihood linear in ln k; if there is none, near the peak of the
// likelihood or of the population, whichever is higher.
Top find_top(const Integrand& integrand) {
  const RateShape& shape = integrand.shape();
  const double pull = shape.curvature * integrand.scatter() * integrand.scatter();
  const double own = (shape.peak - integrand.log_k()) / integrand.scatter();
  constexpr double likely = -50;
  double z = 0;
  if (std::isfinite(own) && pull > 0) z = std::isinf(pull) ? own : pull / (1 + pull) * own;
  z = std::min(z, integrand.last());
  Top start{z, integrand.peak_width(), integrand(z)};
  for (const double other : {0.0, std::min(own, integrand.last())}) {
    if (start.value.g > likely) break;
    if (!std::isfinite(other) || other > integrand.last()) continue;
    const Integrand::Value value = integrand(other);
    if (!(start.value.g >= value.g)) start = {other, start.width, value};
  }
  return climb(integrand, start);
}

// The trapezoidal rule around `top` with the given step; empty if it does not resolve the peak or
// the peak does not end.
std::optional<Sums> trapezoids(const Integrand& integrand, const Top& top, double step) {
  constexpr int most_nodes = 100;        // to either side
  constexpr double halves_agree = 3e-4;  // the error of the whole is about the square of theirs
  Sums even, odd;
  Integrand::add(even, top.z, top.value, step, top.value.g);
  for (const double side : {1.0, -1.0}) {
    for (int n = 1;; ++n) {
      const double z = top.z + side * n * step;
      if (n > most_nodes || z == top.z || z > integrand.last()) return {};
      const Integrand::Value value = integrand(z);
      if (value.g > top.value.g + 30) return {};  // no maximum at all
      Integrand::add(n % 2 == 0 ? even : odd, z, value, step, top.value.g);
      if (integrand.nothing_beyond(z, side, value, top.value.g)) break;
    }
  }
  if (!(std::abs(even.mass - odd.mass) <= halves_agree * (even.mass + odd.mass))) return {};
  even.add(odd, 1);
  return even;
}

// Gauss-Kronrod nodes of one half, and their weights.
constexpr std::array<double, 8> gauss_kronrod = {
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144691693013, 0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0};
constexpr std::array<double, 8> kronrod = {
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr std::array<double, 4> gauss = {
    0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
    0.381830050505118944950369775488975, 0.417959183673469387755102040816327};

// A panel integrated by the Gauss-Kronrod rule with 7 and 15 nodes; `error` is their difference.
struct Panel {
  double from, to;
  Sums sums;
  double error;
  double highest, at;  // the largest g of its nodes
  bool operator<(const Panel& other) const { return error < other.error; }
};

Panel panel(const Integrand& integrand, double from, double to, double top) {
  Panel result{from, to, {}, 0, -infinity, from};
  const double half = 0.5 * (to - from), middle = 0.5 * (from + to);
  double coarse = 0;
  for (std::size_t i = 0; i < gauss_kronrod.size(); ++i) {
    for (const double side : {-1.0, 1.0}) {
      if (gauss_kronrod[i] == 0 && side > 0) continue;
      const double z = middle + side * half * gauss_kronrod[i];
      const Integrand::Value value = integrand(z);
      if (value.g > result.highest) result.highest = value.g, result.at = z;
      Integrand::add(result.sums, z, value, half * kronrod[i], top);
      if (i % 2 == 1) coarse += half * gauss[i / 2] * std::exp(value.g - top);
    }
  }
  result.error = std::abs(result.sums.mass - coarse);
  return result;
}

// Where the integrand's mass begins or ends on `side`, from `z` on.
double end(const Integrand& integrand, double z, double side, double top) {
  double stride = 0.5;
  for (int n = 0; n < 60; ++n, stride *= 1.5) {
    if (side > 0 && z >= integrand.last()) return integrand.last();
    const Integrand::Value value = integrand(z);
    if (integrand.nothing_beyond(z, side, value, top)) break;
    z += side * stride;
  }
  return z;
}

// The initial panels: split at the features of the integrand.
std::vector<double> cuts(const Integrand& integrand, const Top& top) {
  const double from = end(integrand, std::min(top.z, 0.0), -1, top.value.g);
  const double to =
      end(integrand, std::max(std::min(top.z, integrand.last()), 0.0), 1, top.value.g);
  std::vector<double> result = {from, to};
  const auto cut = [&](double z) {
    if (z > from && z < to) result.push_back(z);
  };
  cut(0);
  const double peak = (integrand.shape().peak - integrand.log_k()) / integrand.scatter();
  for (const double widths : {-30.0, -10.0, -4.0, -1.5, 0.0, 1.5, 4.0, 10.0, 30.0}) {
    cut(top.z + widths * top.width);
    for (const double z : {integrand.lowest(), peak, integrand.highest()})
      cut(z + widths * integrand.peak_width());
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

void add_nodes(const Integrand& integrand, const Panel& panel, std::vector<RateNode>& nodes) {
  const double half = 0.5 * (panel.to - panel.from), middle = 0.5 * (panel.from + panel.to);
  for (std::size_t i = 0; i < gauss_kronrod.size(); ++i) {
    for (const double side : {-1.0, 1.0}) {
      if (gauss_kronrod[i] == 0 && side > 0) continue;
      const double z = middle + side * half * gauss_kronrod[i];
      nodes.push_back({z, integrand(z).g - half_log_two_pi + std::log(half * kronrod[i])});
    }
  }
}

// Empty, with `top` moved there, if a much higher maximum is found. `nodes`, if requested, are
// those of all panels.
std::optional<Sums> adaptive(const Integrand& integrand, Top& top,
                             std::vector<RateNode>* nodes = nullptr) {
  constexpr std::size_t most_panels = 400;
  constexpr double tolerance = 1e-9;
  constexpr double much = 20;  // far from overflow, but nodes were placed for a lower maximum
  const std::vector<double> edges = cuts(integrand, top);
  std::vector<Panel> panels;
  double highest = -infinity, at = 0;
  const auto add = [&](double a, double b) {
    panels.push_back(panel(integrand, a, b, top.value.g));
    if (panels.back().highest > highest) highest = panels.back().highest, at = panels.back().at;
  };
  for (std::size_t i = 1; i < edges.size(); ++i) add(edges[i - 1], edges[i]);
  while (!panels.empty() && panels.size() < most_panels && highest < top.value.g + much) {
    double mass = 0, error = 0;
    for (const Panel& each : panels) mass += each.sums.mass, error += each.error;
    if (!(error > tolerance * mass)) break;
    const auto worst = std::max_element(panels.begin(), panels.end());
    const double from = worst->from, to = worst->to, middle = 0.5 * (from + to);
    if (!(middle > from && middle < to)) break;
    panels.erase(worst);
    add(from, middle);
    add(middle, to);
  }
  if (highest >= top.value.g + much) {
    top = climb(integrand, {at, top.width, integrand(at)});
    return {};
  }
  Sums sums;
  for (const Panel& each : panels) sums.add(each.sums, 1);
  for (const Panel& each : panels) {
    if (nodes) add_nodes(integrand, each, *nodes);
  }
  if (edges.back() == integrand.last()) {  // the edge moves with ln k and the scatter
    const double density = std::exp(integrand(edges.back()).g - top.value.g) / integrand.scatter();
    if (std::isfinite(density)) {
      sums.by_log_k -= density;
      sums.by_scatter -= density * edges.back();
    }
  }
  return sums;
}

// So far below any posterior the exponentiated differences would be rounding errors.
constexpr double lost = -1e9;
constexpr double shortest_edge = 0.35;  // in ln k, of the plateau of depths below the noise

// The even rule around `top`, shifted by `shift` of a step; empty if it does not resolve the peak
// or the peak does not end.
std::vector<RateNode> even_nodes(const Integrand& integrand, const Top& top, double step,
                                 double shift) {
  constexpr int most_nodes = 200;        // to either side
  constexpr double halves_agree = 1e-3;  // of every second node
  std::vector<RateNode> nodes;
  double sums[2] = {};
  for (const int side : {1, -1}) {
    for (int n = side > 0 ? 0 : -1;; n += side) {
      const double z = top.z + (n + shift) * step;
      if (std::abs(n) > most_nodes || z + step == z || z > integrand.last()) return {};
      const Integrand::Value value = integrand(z);
      if (value.g > top.value.g + 30) return {};
      nodes.push_back({z, value.g - half_log_two_pi + std::log(step)});
      sums[n & 1] += std::exp(value.g - top.value.g);
      if (integrand.nothing_beyond(z, side, value, top.value.g)) break;
    }
  }
  if (!(std::abs(sums[0] - sums[1]) <= halves_agree * (sums[0] + sums[1]))) return {};
  return nodes;
}

}  // namespace

RateIntegral log_rate_integral(const Inspected& bearing, double log_k, double sigma,
                               double scatter) {
  constexpr double step_over_width = 0.7;
  const RateIntegral nothing{-infinity, 0, 0, 0};
  const Integrand integrand(bearing, log_k, sigma, scatter);
  Top top = find_top(integrand);
  if (!(top.value.g > lost)) return nothing;
  // So narrow that its nodes differ only by rounding: it is then a normal density.
  constexpr double narrow = 1e-9;
  std::optional<Sums> sums;
  if (top.width * scatter < narrow) {
    sums.emplace();
    Integrand::add(*sums, top.z, top.value, top.width * std::sqrt(2 * std::numbers::pi),
                   top.value.g);
  }
  double step = std::min(step_over_width * top.width, shortest_edge / scatter);
  for (int halving = 0; halving < 3 && !sums; ++halving, step *= 0.5)
    sums = trapezoids(integrand, top, step);
  for (int tops = 0; tops < most_tops && !sums; ++tops) sums = adaptive(integrand, top);
  if (!sums || !(sums->mass > 0)) return nothing;
  return {std::log(sums->mass) + top.value.g - half_log_two_pi, sums->by_log_k / sums->mass,
          sums->by_sigma / sums->mass, sums->by_scatter / sums->mass};
}

std::vector<RateNode> rate_nodes(const Inspected& bearing, double log_k, double sigma,
                                 double scatter, double step, double shift) {
  const Integrand integrand(bearing, log_k, sigma, scatter);
  Top top = find_top(integrand);
  if (!(top.value.g > lost)) return {};
  double width = std::min(step * top.width, shortest_edge / scatter);
  for (int halving = 0; halving < 3; ++halving, width *= 0.5) {
    std::vector<RateNode> nodes = even_nodes(integrand, top, width, shift);
    if (!nodes.empty()) return nodes;
  }
  std::vector<RateNode> nodes;
  for (int tops = 0; tops < most_tops; ++tops) {
    if (adaptive(integrand, top, &nodes)) break;
  }
  return nodes;
}

}  // namespace wearwell::bearing
