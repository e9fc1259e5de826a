#include "wearwell/models/formula_model/effect_pair.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/lognormal_unit.h"
#include "wearwell/models/formula_model/unit_rule.h"

// Longer than others: one integral over two effects, its quadrature rules, and the derivatives of
// each.
namespace wearwell::formula_model {
namespace {

// log of the integrand relative to its maximum: smaller values are negligible
constexpr double fallen = 21;
constexpr double most_of_half = 1e-4;
constexpr std::size_t most_even_nodes = 2500;  // units with more are left to other rules
constexpr int most_rounds = 60;

// The step of an effect by its standard normal variable, and its derivatives.
struct Step {
  double value, slope, bend;
};

Step step_of(const EffectPair& pair, int e, double v) {
  const double s = pair.scatter[e];
  if (!pair.lognormal[e]) return {s * v, s, 0};
  const double factor = std::exp(s * v);
  return {factor - 1, s * factor, s * s * factor};
}

// log p - top - z'z/2 at steps d0 and d1 from the best.
double log_f_at(const EffectPair& pair, double d0, double d1, double z0, double z1) {
  const auto& H = pair.H;
  return -0.5 * ((H[0] * d0 + 2 * H[1] * d1) * d0 + H[2] * d1 * d1 + z0 * z0 + z1 * z1);
}

class Rule {
 public:
  Rule(const EffectPair& pair, EffectPair::Nodes& nodes)
      : pair_(pair),
        nodes_(nodes),
        r_(pair.correlation),
        rest_(std::sqrt(1 - r_ * r_)),
        exponent_(pair.scatter[1] * rest_) {}

  bool find_mode();
  std::optional<double> integral(double gap);
  std::optional<double> one_after_the_other(int stride, double& open);

 private:
  struct Place {
    double log_f, slope, bend;  // by z1
  };
  Step step(int e, double v) const { return step_of(pair_, e, v); }
  double log_f(double z0, double z1) const { return pair_.log_f(z0, z1); }
  void start(double& z0, double& z1) const;
  Place place(double d0, double z0, double z1) const;
  bool go_to_mode(double d0, double z0, double& z1, Place& at) const;
  bool add_line(double z0, double& z1, double gap);
  std::optional<double> line_integral(double d0, double z0,
                                      std::vector<LognormalUnit::Node>& kept) const;

  const EffectPair& pair_;
  EffectPair::Nodes& nodes_;
  double r_, rest_, exponent_;
  double center_[2] = {}, width_ = 1, tilt_ = 0;  // of z0 at the mode; of z1 by z0
  double highest_ = -infinity;
};

// From the best steps and their precision: the mode, if the steps were linear in v.
void Rule::start(double& z0, double& z1) const {
  constexpr double least = 0.1;
  double v[2], slope[2];
  for (int e = 0; e < 2; ++e) {
    const double top = std::max(1 + pair_.best[e], least), s = pair_.scatter[e];
    v[e] = pair_.lognormal[e] ? std::log(top) / s : pair_.best[e] / s;
    slope[e] = pair_.lognormal[e] ? s * top : s;
  }
  const double p00 = slope[0] * slope[0] * pair_.H[0], p01 = slope[0] * slope[1] * pair_.H[1];
  const double p11 = slope[1] * slope[1] * pair_.H[2];
  // (I + R P) x = R P v, with R the covariance of v.
  const double b0 = p00 * v[0] + p01 * v[1], b1 = p01 * v[0] + p11 * v[1];
  const double a00 = 1 + p00 + r_ * p01, a01 = p01 + r_ * p11;
  const double a10 = p01 + r_ * p00, a11 = 1 + p11 + r_ * p01;
  const double det = a00 * a11 - a01 * a10, c0 = b0 + r_ * b1, c1 = r_ * b0 + b1;
  z0 = (a11 * c0 - a01 * c1) / det;
  z1 = ((a00 * c1 - a10 * c0) / det - r_ * z0) / rest_;
  if (!(std::isfinite(z0) && std::isfinite(z1) && log_f(z0, z1) > log_f(0, 0))) z0 = z1 = 0;
}

// Newton's method; without the second derivatives of the steps where the curvature is not positive.
bool Rule::find_mode() {
  constexpr double close = 0.01, longest = 3;
  const auto& H = pair_.H;
  double z0 = 0, z1 = 0;
  start(z0, z1);
  double here = log_f(z0, z1);
  for (int round = 0; round < most_rounds; ++round) {
    const Step a = step(0, z0), b = step(1, r_ * z0 + rest_ * z1);
    const double d0 = a.value - pair_.best[0], d1 = b.value - pair_.best[1];
    const double by0 = H[0] * d0 + H[1] * d1, by1 = H[1] * d0 + H[2] * d1;
    const double j0 = r_ * b.slope, j1 = rest_ * b.slope;  // of step 1 by z
    const double slope0 = -by0 * a.slope - by1 * j0 - z0, slope1 = -by1 * j1 - z1;
    double B00 = 1 + H[0] * a.slope * a.slope + 2 * H[1] * a.slope * j0 + H[2] * j0 * j0;
    double B01 = H[1] * a.slope * j1 + H[2] * j0 * j1, B11 = 1 + H[2] * j1 * j1;
    const double least = 0.25 * (B00 * B11 - B01 * B01);
    const double c00 = B00 + by0 * a.bend + by1 * r_ * r_ * b.bend;
    const double c01 = B01 + by1 * r_ * rest_ * b.bend, c11 = B11 + by1 * rest_ * rest_ * b.bend;
    if (c00 > 0 && c00 * c11 - c01 * c01 > least) B00 = c00, B01 = c01, B11 = c11;
    const double det = B00 * B11 - B01 * B01;
    const double m0 = (B11 * slope0 - B01 * slope1) / det, m1 = (B00 * slope1 - B01 * slope0) / det;
    const double promise = m0 * slope0 + m1 * slope1;
    if (!std::isfinite(promise)) return false;
    if (promise < close) {
      center_[0] = z0;
      center_[1] = z1;
      width_ = std::sqrt(B11 / det);
      tilt_ = -B01 / B11;
      return true;
    }
    // In the far tail of the population modes are far from 0.
    const double most = longest + std::hypot(z0, z1);
    double share = std::min(1.0, most / std::hypot(m0, m1)), there = -infinity;
    for (; share > 1e-8; share *= 0.25) {
      there = log_f(z0 + share * m0, z1 + share * m1);
      if (there > here) break;
    }
    if (!(there > here)) return false;
    z0 += share * m0;
    z1 += share * m1;
    here = there;
  }
  return false;
}

Rule::Place Rule::place(double d0, double z0, double z1) const {
  const Step b = step(1, r_ * z0 + rest_ * z1);
  const double d1 = b.value - pair_.best[1], by = pair_.H[1] * d0 + pair_.H[2] * d1;
  const double j = rest_ * b.slope, known = 1 + pair_.H[2] * j * j;
  return {log_f_at(pair_, d0, d1, z0, z1), -by * j - z1,
          std::max(known + by * rest_ * rest_ * b.bend, 0.5 * known)};
}

// Along z1, starting from the extrapolated modes of the neighbours.
bool Rule::go_to_mode(double d0, double z0, double& z1, Place& at) const {
  constexpr double close = 0.3, longest = 3;
  at = place(d0, z0, z1);
  for (int round = 0; round < most_rounds; ++round) {
    if (!std::isfinite(at.slope) || !std::isfinite(at.bend)) return false;
    if (std::abs(at.slope) < close * std::sqrt(at.bend)) return true;
    double move = std::clamp(at.slope / at.bend, -longest, longest);
    for (int halving = 0;; ++halving) {
      const Place there = place(d0, z0, z1 + move);
      if (there.log_f > at.log_f) {
        z1 += move;
        at = there;
        break;
      }
      if (halving == 30) return false;
      move *= 0.25;
    }
  }
  return false;
}

// The nodes at one z0, outward from the mode there on both sides; false if the mode is not found or
// there are too many nodes.
bool Rule::add_line(double z0, double& z1, double gap) {
  const double d0 = step(0, z0).value - pair_.best[0], step0 = d0 + pair_.best[0];
  Place middle{};
  if (!go_to_mode(d0, z0, z1, middle)) return false;
  const double width = gap / std::sqrt(middle.bend);
  highest_ = std::max(highest_, middle.log_f);
  nodes_.lines.push_back({nodes_.count, z0, step0, width, false});
  const bool lognormal = pair_.lognormal[1];
  const double first = pair_.scatter[1] * r_ * z0 + exponent_ * z1, step = exponent_ * width;
  const double h11 = pair_.H[2], by1 = 2 * pair_.H[1] * d0, best = pair_.best[1];
  const double all = pair_.H[0] * d0 * d0 + z0 * z0;
  double highest = highest_;
  std::size_t count = nodes_.count;
  double *const at = nodes_.z1.data(), *const steps = nodes_.step1.data();
  double* const log_f = nodes_.share.data();
  for (const int way : {1, -1}) {
    double own = lognormal ? std::exp(first) : first;
    const double up = lognormal ? std::exp(way * step) : way * step;
    for (int n = 0;; ++n) {
      if (n > 0) own = lognormal ? own * up : own + up;
      if (n == 0 && way < 0) continue;
      const double z = z1 + way * n * width, value = lognormal ? own - 1 : own, d1 = value - best;
      const double f = -0.5 * (all + (by1 + h11 * d1) * d1 + z * z);
      if (!(f > highest - fallen)) break;
      if (count == most_even_nodes) return false;
      at[count] = z;
      steps[count] = value;
      log_f[count] = f;
      nodes_.odd[count] = n % 2 != 0;
      highest = std::max(highest, f);
      ++count;
    }
  }
  highest_ = highest;
  nodes_.count = count;
  return true;
}

std::optional<double> Rule::integral(double gap) {
  nodes_.lines.clear();
  nodes_.count = 0;
  highest_ = -infinity;
  const double width = gap * width_;
  for (const int way : {1, -1}) {
    double z1 = center_[1], before = z1 - way * tilt_ * width;
    for (int n = 0;; ++n) {
      if (n > 0) {
        const double next = 2 * z1 - before;
        before = z1;
        z1 = next;
      }
      if (n == 0 && way < 0) continue;
      const std::size_t count = nodes_.count;
      if (!add_line(center_[0] + way * n * width, z1, gap)) return {};
      nodes_.lines.back().odd = n % 2 != 0;
      if (nodes_.count > count) continue;
      nodes_.lines.pop_back();
      break;
    }
  }
  if (nodes_.count == 0) return {};
  double* const f = nodes_.share.data();
  for (std::size_t i = 0; i < nodes_.count; ++i) f[i] -= highest_;
  exp_all(f, f, nodes_.count);
  double across[2] = {}, along[2] = {};
  for (std::size_t l = 0; l < nodes_.lines.size(); ++l) {
    const EffectPair::Nodes::Line& line = nodes_.lines[l];
    double sums[2] = {};
    for (std::size_t i = line.begin; i < nodes_.end(l); ++i) {
      f[i] *= line.width;
      sums[nodes_.odd[i]] += f[i];
    }
    along[0] += sums[0];
    along[1] += sums[1];
    across[line.odd] += sums[0] + sums[1];
  }
  const double sum = across[0] + across[1];
  const auto agree = [&](const double* halves) {
    return std::abs(halves[0] - halves[1]) < most_of_half * sum;
  };
  if (!agree(across) || !agree(along)) return {};
  for (std::size_t i = 0; i < nodes_.count; ++i) f[i] /= sum;
  return highest_ + std::log(sum * width) - log_two_pi;
}

// The integral over z1 at one z0, without z0^2/2 and the constants of a normal distribution, with
// its nodes: given the first effect, the unit is quadratic in the second alone.
std::optional<double> Rule::line_integral(double d0, double z0,
                                          std::vector<LognormalUnit::Node>& kept) const {
  const auto& H = pair_.H;
  const double best = H[2] > 0 ? pair_.best[1] - H[1] / H[2] * d0 : 0;
  const double left = H[2] > 0 ? H[0] - H[1] * (H[1] / H[2]) : H[0];
  const double middle = pair_.scatter[1] * r_ * z0;
  const double base = -0.5 * std::max(0.0, left) * d0 * d0;
  kept.clear();
  if (pair_.lognormal[1]) {
    const double factor = std::exp(middle);
    const LognormalUnit unit{(1 + best) / factor - 1, H[2] * factor * factor, exponent_};
    if (!std::isfinite(unit.best) || !std::isfinite(unit.h)) return {};
    const auto log_integral = unit.log_integral(&kept);
    if (!log_integral) return {};
    for (auto& node : kept) node.step = factor * (node.step + 1) - 1;
    return base + *log_integral;
  }
  // Normal: -H11/2 (middle + exponent z - best)^2 - z^2/2.
  constexpr int most = 12;
  constexpr double step = 0.6;
  const double precision = 1 + H[2] * exponent_ * exponent_, off = best - middle;
  const double mean = H[2] * exponent_ * off / precision, width = 1 / std::sqrt(precision);
  double all = 0;
  for (int i = -most; i <= most; ++i) {
    const double z = mean + i * step * width, weight = std::exp(-0.5 * i * i * step * step);
    kept.push_back({0, z, middle + exponent_ * z, weight});
    all += weight;
  }
  for (auto& node : kept) node.weight /= all;
  return base - 0.5 * H[2] * off * off / precision + 0.5 * (log_two_pi - std::log(precision));
}

// Nodes z0 lie sinh(t) widths from the mode: dense there, and as far out as the population's
// distribution reaches.
std::optional<double> Rule::one_after_the_other(int stride, double& open) {
  constexpr double finest = 0.05, negligible = -36;
  constexpr int most = 600;
  static thread_local std::vector<LognormalUnit::Node> kept;
  nodes_.lines.clear();
  nodes_.count = 0;
  static thread_local std::vector<double> log_line;
  log_line.clear();
  double highest = -infinity;
  for (const int way : {1, -1}) {
    for (int n = way > 0 ? 0 : 1; n * stride < most; ++n) {
      const double t = way * n * stride * finest, z0 = center_[0] + width_ * std::sinh(t);
      const double step0 = step(0, z0).value, d0 = step0 - pair_.best[0];
      const auto line = line_integral(d0, z0, kept);
      if (!line) return {};
      const double log_f = *line - 0.5 * z0 * z0 + std::log(std::cosh(t));
      if (!(log_f > highest + negligible)) break;
      highest = std::max(highest, log_f);
      nodes_.lines.push_back({nodes_.count, z0, step0, 1, n % 2 != 0});
      log_line.push_back(log_f);
      for (const auto& node : kept) {
        if (!(node.weight > 1e-12)) continue;
        if (nodes_.count == EffectPair::Nodes::most) return {};
        nodes_.z1[nodes_.count] = node.z;
        nodes_.step1[nodes_.count] = node.step;
        nodes_.share[nodes_.count++] = node.weight;
      }
    }
  }
  double sums[2] = {};
  for (std::size_t l = 0; l < nodes_.lines.size(); ++l) {
    sums[nodes_.lines[l].odd] += log_line[l] = std::exp(log_line[l] - highest);
  }
  const double sum = sums[0] + sums[1];
  if (!(sum > 0)) return {};
  for (std::size_t l = 0; l < nodes_.lines.size(); ++l) {
    for (std::size_t i = nodes_.lines[l].begin; i < nodes_.end(l); ++i)
      nodes_.share[i] *= log_line[l] / sum;
  }
  open = std::abs(sums[0] - sums[1]) / sum;
  return highest + std::log(sum * finest * stride * width_) - log_two_pi;
}

}  // namespace

double EffectPair::log_f(double z0, double z1) const {
  const double r = correlation, v1 = r * z0 + std::sqrt(1 - r * r) * z1;
  const double d0 = step_of(*this, 0, z0).value - best[0];
  const double d1 = step_of(*this, 1, v1).value - best[1];
  return log_f_at(*this, d0, d1, z0, z1);
}

std::optional<double> EffectPair::log_integral(Nodes& nodes, double gap, double* open) const {
  constexpr double most_open = 3e-6;
  Rule rule(*this, nodes);
  if (open) *open = 0;
  if (!(scatter[0] > 0 && scatter[1] > 0) || !rule.find_mode()) return {};
  for (const double share : {1.0, 0.7, 0.5}) {
    if (const auto integral = rule.integral(share * gap)) return integral;
  }
  std::optional<double> last;
  for (const int stride : {2, 1}) {
    double left = 0;
    const auto integral = rule.one_after_the_other(stride, left);
    if (!integral) return last;
    if (left < most_open) return integral;
    last = integral;
    if (open) *open = left;
  }
  return last;
}

double EffectPair::log_bound() const {
  constexpr double most_v = 1e12;
  double lowest = 0;
  for (int e = 0; e < 2; ++e) {
    const double other = H[2 - 2 * e], h = H[2 * e] - (other > 0 ? H[1] * (H[1] / other) : 0);
    for (double v = 1; v < most_v; v *= 1.25) {
      const double from = step_of(*this, e, -v).value, to = step_of(*this, e, v).value;
      const double distance = std::max({0.0, from - best[e], best[e] - to});
      lowest = std::min(lowest,
                        std::numbers::ln2 + std::max(-0.5 * h * distance * distance, -0.5 * v * v));
    }
  }
  return lowest;
}

EffectPair::Moments EffectPair::moments(const Nodes& nodes) const {
  const double r = correlation, rest = std::sqrt(1 - r * r);
  Moments m;
  for (std::size_t l = 0; l < nodes.lines.size(); ++l) {
    const Nodes::Line& line = nodes.lines[l];
    // Of 1, s1, s1^2, and of these times z1.
    double one = 0, s = 0, ss = 0, z = 0, sz = 0, ssz = 0;
    for (std::size_t i = line.begin; i < nodes.end(l); ++i) {
      const double weight = nodes.share[i], step = nodes.step1[i], by_step = weight * step;
      const double z1 = nodes.z1[i];
      one += weight;
      s += by_step;
      ss += by_step * step;
      z += weight * z1;
      sz += by_step * z1;
      ssz += by_step * step * z1;
    }
    const double a = line.step0, z0 = line.z0, d0 = a - best[0];
    m.first[0] += a * one;
    m.first[1] += s;
    m.second[0] += a * a * one;
    m.second[1] += a * s;
    m.second[2] += ss;
    const double slope0 =
        -(H[0] * d0 * one + H[1] * (s - best[1] * one)) * (lognormal[0] ? 1 + a : 1);
    m.slope[0] += slope0;
    m.slope_v[0] += slope0 * z0;
    // Of step 1 the slope is -(H01 d0 + H11 (s1 - best)), times 1 + s1 where it is lognormal.
    const double at0 = H[1] * d0 - H[2] * best[1];
    double slope1 = -(at0 * one + H[2] * s), slope1_z = -(at0 * z + H[2] * sz);
    if (lognormal[1]) {
      slope1 -= at0 * s + H[2] * ss;
      slope1_z -= at0 * sz + H[2] * ssz;
    }
    m.slope[1] += slope1;
    m.slope_v[1] += r * z0 * slope1 + rest * slope1_z;
    m.by_correlation += scatter[1] * (z0 * slope1 - r / rest * slope1_z);
  }
  return m;
}

}  // namespace wearwell::formula_model
