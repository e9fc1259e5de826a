#include "wearwell/models/formula_model/extreme_value_unit.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/unit_rule.h"

namespace wearwell::formula_model {
namespace {

constexpr double sharp = 8;  // rates of which even nodes are many

// The y with y + e^y = b: Wright's omega function is e^y.
double log_wright_omega(double b) {
  if (!(b > -700)) return b;
  double y = b > 2 ? std::log(b - std::log(b)) : b > -2 ? 0.5 * (b - 1) : b;
  for (int round = 0; round < 20; ++round) {
    const double e = std::exp(y), move = (b - y - e) / (1 + e);
    y += move;
    if (std::abs(move) < 1e-12 * (1 + std::abs(y))) break;
  }
  return y;
}

}  // namespace

double ExtremeValueUnit::at(double z) const {
  return -failures * rate * z - std::exp(log_sum - rate * z) - 0.5 * z * z;
}

// Where the slope is 0, v = log_sum - rate z solves v + rate^2 e^v = log_sum + failures rate^2.
ExtremeValueUnit::Mode ExtremeValueUnit::mode() const {
  if (rate == 0) return {0, 1};
  const double square = rate * rate, log_square = 2 * std::log(std::abs(rate));
  const double y = log_wright_omega(log_sum + failures * square + log_square);
  return {rate * (std::exp(y - log_square) - failures), 1 / std::sqrt(1 + std::exp(y))};
}

// Nodes on both sides of the mode until the integrand is negligible; false if they are too many.
bool ExtremeValueUnit::fill(Nodes& nodes, const Mode& mode, double width) const {
  constexpr double most_factor = 30;  // of log hazard from node to node: its products stay finite
  if (!(std::abs(rate) * width < most_factor)) return false;
  nodes.count = 0;
  const double middle = std::exp(log_sum - rate * mode.z), top = at(mode.z);
  if (!std::isfinite(top)) return false;
  for (const int way : {1, -1}) {
    const double factor = std::exp(-way * rate * width);
    double hazard = way > 0 ? middle : middle * factor;
    for (int n = way > 0 ? 0 : 1;; ++n, hazard *= factor) {
      if (nodes.count == Nodes::most) return false;
      const double z = mode.z + way * n * width;
      const double log_f = -failures * rate * z - hazard - 0.5 * z * z;
      if (!(log_f > top - rule_fallen)) break;
      nodes.z[nodes.count] = z;
      nodes.f[nodes.count] = log_f;
      nodes.hazard[nodes.count] = hazard;
      nodes.odd[nodes.count++] = n % 2 != 0;
    }
  }
  return true;
}

// Without failures: the normal density times a Gumbel distribution function, which rises within 1/rate.
// Nodes are dense there: z is the place of the rise + 2 sinh(t)/rate.
std::optional<double> ExtremeValueUnit::sharply_cut(Nodes& nodes) const {
  constexpr double step = 0.05, stretch = 2, farthest = 40;  // farthest of t
  const double steep = std::abs(rate), rise = log_sum / steep, per = stretch / steep;
  double highest = -infinity;
  nodes.count = 0;
  for (const int way : {1, -1}) {
    for (int n = way > 0 ? 0 : 1;; ++n) {
      const double t = way * n * step, off = std::sinh(t), hazard = std::exp(-stretch * off);
      const double z = rise + per * off;
      const double log_f = std::log(std::cosh(t)) - hazard - 0.5 * z * z;
      if (nodes.count == Nodes::most || !(std::abs(t) < farthest)) return {};
      if (!(log_f > highest - rule_fallen)) break;
      highest = std::max(highest, log_f);
      nodes.z[nodes.count] = rate > 0 ? z : -z;
      nodes.f[nodes.count] = log_f;
      nodes.hazard[nodes.count] = hazard;
      nodes.odd[nodes.count++] = n % 2 != 0;
    }
  }
  const auto integral = settled(nodes, step * per);
  return integral ? std::optional(*integral - half_log_two_pi) : std::nullopt;
}

std::optional<double> ExtremeValueUnit::log_integral(Nodes& nodes,
                                                     std::span<const double> gaps) const {
  // Where a normal integrand is cut off in its tail, half of the nodes do not tell how sharply: the
  // error is that of the cut, at most exp(-pi^2/(rate width)).
  constexpr double cut = 0.7, most_of_cut = 0.5;
  const Mode about = mode();
  if (!(std::isfinite(about.z) && about.width > 0)) return {};
  constexpr double farthest = 8.3, nothing = -37;  // of z; of the logarithm of a hazard
  const bool is_cut =
      std::exp(log_sum - rate * about.z) < cut && log_sum + farthest * std::abs(rate) > nothing;
  if (is_cut && failures == 0 && std::abs(rate) > sharp) return sharply_cut(nodes);
  for (const double gap : gaps) {
    const double width = gap * about.width;
    if (is_cut && std::abs(rate) * width > most_of_cut) continue;
    if (!fill(nodes, about, width)) continue;
    if (const auto integral = settled(nodes, width)) return *integral - half_log_two_pi;
  }
  return {};
}

}  // namespace wearwell::formula_model
