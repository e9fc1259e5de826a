#include "wearwell/latent/unit_integral.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"

// Longer than others: one integrand, its mode, its nodes, and the sums over them.
namespace wearwell::latent {
namespace {

constexpr double negligible = -36;        // of log f relative to its maximum
constexpr double farthest = 1000;         // of z; the integrand is negligible beyond
constexpr double most_difference = 3e-6;  // between a rule and the rule with every second node
constexpr double most_difference_of_colours = 3e-5;
constexpr int most_halvings = 5, most_steps = 40;

// A pair of numbers for each unit; with one effect only the first is used.
using Pair = std::array<double, 2>;

// The approximate mode of a unit's integrand, and its width there.
struct LaplaceApproximation {
  Pair center{};
  // Columns of the lattice: z = center + sinh(s) across[0] + sinh(t) across[1].
  std::array<Pair, 2> across{{{1, 0}, {0, 1}}};
};

class Search {
 public:
  Search(UnitTerms& terms)
      : terms_(terms),
        units_(terms.units()),
        effects_(static_cast<std::size_t>(terms.effects())),
        z_(units_ * effects_),
        value_(units_),
        slope_(units_ * effects_),
        wanted_(units_, 1) {}

  std::vector<LaplaceApproximation> approximations() {
    return effects_ == 1 ? along_line(std::vector<Pair>(units_)) : over_plane();
  }

  // One effect: searches again for these units only, from other starts.
  std::vector<LaplaceApproximation> approximations(const std::vector<std::uint8_t>& whose,
                                                   std::vector<Pair> from) {
    wanted_ = whose;
    return along_line(std::move(from));
  }

 private:
  // log f and its derivatives at `at` for the wanted units.
  void look(const std::vector<Pair>& at, std::vector<double>& log_f, std::vector<Pair>& slope) {
    for (std::size_t u = 0; u < units_; ++u) {
      for (std::size_t e = 0; e < effects_; ++e) z_[u * effects_ + e] = at[u][e];
    }
    terms_.evaluate(z_, wanted_, value_, slope_);
    for (std::size_t u = 0; u < units_; ++u) {
      if (!wanted_[u]) continue;
      log_f[u] = value_[u];
      for (std::size_t e = 0; e < effects_; ++e) {
        log_f[u] -= 0.5 * at[u][e] * at[u][e];
        slope[u][e] = slope_[u * effects_ + e] - at[u][e];
      }
    }
  }

  // Units with zero density at 0 start elsewhere.
  void begin(std::vector<Pair>& at, std::vector<double>& log_f, std::vector<Pair>& slope) {
    look(at, log_f, slope);
    const std::vector<std::uint8_t> whose = wanted_;
    const auto lost = [&](std::size_t u) { return whose[u] && !(log_f[u] > -infinity); };
    for (const double away : {1.0, -1.0, 2.5, -2.5, 5.0, -5.0}) {
      bool any = false;
      for (std::size_t u = 0; u < units_; ++u) {
        wanted_[u] = lost(u);
        any |= lost(u);
      }
      if (!any) break;
      for (std::size_t u = 0; u < units_; ++u) {
        if (wanted_[u]) at[u] = {away, away};
      }
      look(at, log_f, slope);
    }
    for (std::size_t u = 0; u < units_; ++u) wanted_[u] = whose[u] && !lost(u);
  }

  // One effect: the root of the derivative by the secant method within a bracket.
  std::vector<LaplaceApproximation> along_line(std::vector<Pair> at) {
    std::vector<Pair> slope(units_), next(units_), next_slope(units_);
    std::vector<double> log_f(units_, -infinity), next_f(units_, -infinity);
    std::vector<double> curvature(units_, 1), low(units_, -infinity), high(units_, infinity);
    begin(at, log_f, slope);
    constexpr double probe = 0.02, close = 0.1;
    bool first = true;
    for (int step = 0; step < most_steps; ++step) {
      check_stop();
      bool any = false;
      for (std::size_t u = 0; u < units_; ++u) {
        next[u] = at[u];
        if (!wanted_[u]) continue;
        any = true;
        const double g = slope[u][0];
        if (g > 0) low[u] = at[u][0];
        if (g < 0) high[u] = at[u][0];
        double move = first ? std::copysign(probe, g) : std::clamp(g / curvature[u], -3.0, 3.0);
        double to = at[u][0] + move;
        if (!(to > low[u] && to < high[u]) && !first) to = 0.5 * (low[u] + high[u]);
        to = std::clamp(to, -farthest, farthest);
        next[u][0] = to;
      }
      if (!any) break;
      look(next, next_f, next_slope);
      for (std::size_t u = 0; u < units_; ++u) {
        if (!wanted_[u]) continue;
        const double moved = next[u][0] - at[u][0];
        if (!(next_f[u] > -infinity) || !std::isfinite(next_slope[u][0])) {
          (moved > 0 ? high : low)[u] = next[u][0];  // zero density there
          curvature[u] *= 4;
          if (std::abs(moved) < 1e-12) wanted_[u] = 0;
          continue;
        }
        const double by_secant = -(next_slope[u][0] - slope[u][0]) / moved;
        curvature[u] = by_secant > 0 ? by_secant : std::max(1.0, std::abs(by_secant));
        at[u] = next[u];
        slope[u] = next_slope[u];
        log_f[u] = next_f[u];
        const bool there = std::abs(slope[u][0]) < close * std::sqrt(curvature[u]);
        if (!first && by_secant > 0 && there) wanted_[u] = 0;
        if (std::abs(moved) < 1e-13 * (1 + std::abs(at[u][0]))) wanted_[u] = 0;
      }
      first = false;
    }
    std::vector<LaplaceApproximation> approximations(units_);
    for (std::size_t u = 0; u < units_; ++u) {
      approximations[u].center = at[u];
      approximations[u].across[0] = {1 / std::sqrt(curvature[u]), 0};
    }
    return approximations;
  }

  // Two effects: Newton's method, with the curvature from differences, kept positive definite.
  std::vector<LaplaceApproximation> over_plane() {
    std::vector<Pair> at(units_), slope(units_), one(units_), two(units_), probe(units_);
    std::vector<Pair> to_slope(units_);
    std::vector<double> log_f(units_, -infinity), other(units_, -infinity), to_f(units_, -infinity);
    std::vector<LaplaceApproximation> approximations(units_);
    std::vector<double> share(units_, 1);
    begin(at, log_f, slope);
    constexpr double width = 1e-3;
    for (int step = 0; step < most_steps; ++step) {
      check_stop();
      if (std::none_of(wanted_.begin(), wanted_.end(), [](auto w) { return w; })) break;
      for (std::size_t u = 0; u < units_; ++u) probe[u] = {at[u][0] + width, at[u][1]};
      look(probe, other, one);
      for (std::size_t u = 0; u < units_; ++u) probe[u] = {at[u][0], at[u][1] + width};
      look(probe, other, two);
      for (std::size_t u = 0; u < units_; ++u) {
        if (!wanted_[u]) continue;
        double a = -(one[u][0] - slope[u][0]) / width, d = -(two[u][1] - slope[u][1]) / width;
        double b = -0.5 * (one[u][1] - slope[u][1] + two[u][0] - slope[u][0]) / width;
        if (!(std::isfinite(a) && std::isfinite(b) && std::isfinite(d))) a = d = 1, b = 0;
        // Eigenvalues below half of the prior's are raised to that value.
        const double middle = 0.5 * (a + d), off = std::hypot(0.5 * (a - d), b);
        if (middle - off < 0.5) {
          const double raise = 0.5 - (middle - off);
          a += raise;
          d += raise;
        }
        // Inverse of the Cholesky factor of the curvature: z = center + L^-T (i, j).
        const double l11 = std::sqrt(a), l21 = b / l11, l22 = std::sqrt(d - l21 * l21);
        approximations[u].across = {{{1 / l11, 0}, {-l21 / (l11 * l22), 1 / l22}}};
        const double det = a * d - b * b;
        Pair move = {(d * slope[u][0] - b * slope[u][1]) / det,
                     (a * slope[u][1] - b * slope[u][0]) / det};
        const double length = std::hypot(move[0], move[1]);
        const double most = std::min(1.0, 3 / length) * share[u];
        const double promise = move[0] * slope[u][0] + move[1] * slope[u][1];
        approximations[u].center = at[u];
        if (!(promise > 0.01)) {
          wanted_[u] = 0;
          probe[u] = at[u];
          continue;
        }
        probe[u] = {at[u][0] + most * move[0], at[u][1] + most * move[1]};
      }
      look(probe, to_f, to_slope);
      for (std::size_t u = 0; u < units_; ++u) {
        if (!wanted_[u]) continue;
        if (to_f[u] > log_f[u]) {
          at[u] = probe[u];
          log_f[u] = to_f[u];
          slope[u] = to_slope[u];
          share[u] = std::min(1.0, 2 * share[u]);
        } else if ((share[u] *= 0.25) < 1e-8) {
          wanted_[u] = 0;
        }
        approximations[u].center = at[u];
      }
    }
    return approximations;
  }

  UnitTerms& terms_;
  std::size_t units_, effects_;
  std::vector<double> z_, value_, slope_;
  std::vector<std::uint8_t> wanted_;
};

// Sums of exp(log f) over the even and the odd nodes of a lattice, relative to the maximum.
struct Sum {
  double highest = -infinity;
  double even = 0, odd = 0;

  void add(double log_f, bool is_odd) {
    if (!(log_f > -infinity)) return;
    if (log_f > highest) {
      const double scale = std::exp(highest - log_f);
      even *= scale;
      odd *= scale;
      highest = log_f;
    }
    (is_odd ? odd : even) += std::exp(log_f - highest);
  }
  double difference() const { return std::abs(even - odd) / (even + odd); }
};

class Lattice {
 public:
  Lattice(UnitTerms& terms, std::vector<LaplaceApproximation>& approximations,
          UnitIntegrals& result)
      : terms_(terms),
        approximations_(approximations),
        result_(result),
        units_(terms.units()),
        effects_(static_cast<std::size_t>(terms.effects())),
        wanted_(units_),
        log_area_(units_),
        sums_(units_) {}

  void run() {
    result_.log_likelihood.assign(units_, -infinity);
    result_.settled = true;
    result_.unsettled = 0;
    used_ = 0;
    for (std::size_t u = 0; u < units_; ++u) note_area(u);
    effects_ == 1 ? line() : plane();
    result_.sweeps.resize(used_);
    for (Sweep& sweep : result_.sweeps) {
      for (std::size_t u = 0; u < units_; ++u) {
        sweep.weight[u] = std::exp(sweep.log_f[u] + sweep.weight[u] - result_.log_likelihood[u]);
        if (!(result_.log_likelihood[u] > -infinity)) sweep.weight[u] = 0;
      }
    }
  }

 private:
  double area(std::size_t u) const {
    const LaplaceApproximation& approximation = approximations_[u];
    return effects_ == 1 ? approximation.across[0][0]
                         : approximation.across[0][0] * approximation.across[1][1];
  }
  void note_area(std::size_t u) { log_area_[u] = std::log(area(u)); }

  // Nodes (i, j) widths from the mode of each wanted unit; `weight` keeps the log of the area of a
  // cell.
  Sweep& sweep(double i, double j, double log_cell) {
    if (used_ == result_.sweeps.size()) result_.sweeps.emplace_back();
    Sweep& s = result_.sweeps[used_++];
    s.z.resize(units_ * effects_);
    s.log_f.assign(units_, -infinity);
    s.weight.resize(units_);
    for (std::size_t u = 0; u < units_; ++u) {
      const LaplaceApproximation& approximation = approximations_[u];
      s.weight[u] = log_cell + log_area_[u];
      for (std::size_t e = 0; e < effects_; ++e) {
        double& z = s.z[u * effects_ + e];
        z = approximation.center[e] + i * approximation.across[0][e] +
            j * approximation.across[1][e];
        if (std::abs(z) > farthest) wanted_[u] = 0;
      }
    }
    value_.assign(units_, -infinity);
    terms_.evaluate(s.z, wanted_, value_, {});
    for (std::size_t u = 0; u < units_; ++u) {
      if (!wanted_[u]) continue;
      s.log_f[u] = value_[u] - static_cast<double>(effects_) * half_log_two_pi;
      for (std::size_t e = 0; e < effects_; ++e) {
        s.log_f[u] -= 0.5 * s.z[u * effects_ + e] * s.z[u * effects_ + e];
      }
    }
    return s;
  }

  bool any_wanted() const {
    return std::any_of(wanted_.begin(), wanted_.end(), [](auto w) { return w != 0; });
  }

  // One effect. With `offset`: the nodes between those of a coarser lattice, for the units in
  // `whose`.
  void walk(const std::vector<std::uint8_t>& whose, double step, bool between) {
    constexpr int most = 2000;
    for (const int sign : {1, -1}) {
      std::copy(whose.begin(), whose.end(), wanted_.begin());
      for (int n = sign > 0 || between ? 0 : 1; n < most && any_wanted(); ++n) {
        const double t = sign * (between ? 2 * n + 1 : n) * step, stretch = std::log(std::cosh(t));
        const Sweep& s = sweep(std::sinh(t), 0, std::log(step) + stretch);
        for (std::size_t u = 0; u < units_; ++u) {
          if (!wanted_[u]) continue;
          const double log_f = s.log_f[u] + stretch;
          sums_[u].add(log_f, between || n % 2 == 1);
          if (log_f < sums_[u].highest + negligible) wanted_[u] = 0;
        }
      }
    }
  }

  bool agrees(std::size_t u) const {
    return !(sums_[u].highest > -infinity) || sums_[u].difference() <= most_difference;
  }

  // Units with a node far above the mode that was found: searches again from there.
  void look_again(double step) {
    constexpr double above = 1;
    std::vector<std::uint8_t> whose(units_, 0);
    std::vector<Pair> from(units_);
    bool any = false;
    for (std::size_t u = 0; u < units_; ++u) {
      if (agrees(u)) continue;
      double highest = result_.sweeps[0].log_f[u] + above;
      for (std::size_t n = 1; n < used_; ++n) {
        const Sweep& each = result_.sweeps[n];
        if (!(each.log_f[u] > highest)) continue;
        highest = each.log_f[u];
        from[u][0] = each.z[u];
        whose[u] = 1;
        any = true;
      }
    }
    if (!any) return;
    const std::vector<LaplaceApproximation> approximations =
        Search(terms_).approximations(whose, from);
    for (std::size_t u = 0; u < units_; ++u) {
      if (!whose[u]) continue;
      approximations_[u] = approximations[u];
      note_area(u);
      sums_[u] = {};
      for (std::size_t n = 0; n < used_; ++n) result_.sweeps[n].log_f[u] = -infinity;
    }
    walk(whose, step, false);
  }

  void line() {
    // The longest step at which the rule and the rule with every second node agree for a normal
    // integrand.
    double step = 0.14;
    std::vector<std::uint8_t> whose(units_, 1);
    walk(whose, step, false);
    look_again(step);
    for (int halving = 0;; ++halving) {
      bool again = false;
      for (std::size_t u = 0; u < units_; ++u) {
        if (!whose[u]) continue;
        finish(u, step);
        whose[u] = !agrees(u);
        again |= whose[u] != 0;
      }
      if (!again) return;
      if (halving == most_halvings) return leave(whose);
      for (std::size_t u = 0; u < units_; ++u) {
        if (!whose[u]) continue;  // the nodes so far are the even nodes of the finer lattice
        sums_[u].even += sums_[u].odd;
        sums_[u].odd = 0;
      }
      for (std::size_t n = 0; n < used_; ++n) {
        for (std::size_t u = 0; u < units_; ++u) {
          if (whose[u]) result_.sweeps[n].weight[u] -= std::log(2.0);
        }
      }
      step *= 0.5;
      walk(whose, step, true);
    }
  }

  // Records the remaining difference of these units.
  void leave(const std::vector<std::uint8_t>& whose) {
    result_.settled = false;
    for (std::size_t u = 0; u < units_; ++u) {
      if (whose[u]) result_.unsettled += sums_[u].difference();
    }
  }

  void finish(std::size_t u, double step) {
    const double cell = effects_ == 1 ? step * area(u) : step * step * area(u);
    result_.log_likelihood[u] = sums_[u].highest + std::log((sums_[u].even + sums_[u].odd) * cell);
  }

  // Two effects: rings about the mode until one adds nothing. The step is reduced if the sums over
  // the two colors of the checkerboard of nodes do not agree.
  void plane() {
    double step = 0.24;
    std::vector<std::uint8_t> whose(units_, 1);
    for (int attempt = 0;; ++attempt) {
      std::copy(whose.begin(), whose.end(), wanted_.begin());
      for (std::size_t u = 0; u < units_; ++u) {
        if (!whose[u]) continue;
        sums_[u] = {};
        for (std::size_t n = 0; n < used_; ++n) result_.sweeps[n].log_f[u] = -infinity;
      }
      const int most = static_cast<int>(12 / step);
      for (int ring = 0; ring <= most && any_wanted(); ++ring) walk_ring(ring, step);
      bool again = false;
      for (std::size_t u = 0; u < units_; ++u) {
        if (!whose[u]) continue;
        finish(u, step);
        whose[u] =
            sums_[u].highest > -infinity && sums_[u].difference() > most_difference_of_colours;
        again |= whose[u] != 0;
      }
      if (!again) return;
      if (attempt == 4) return leave(whose);
      step *= 0.6;
    }
  }

  void walk_ring(int ring, double step) {
    std::vector<std::uint8_t> more(units_, 0), before(wanted_);
    for (int i = -ring; i <= ring; ++i) {
      for (int j = -ring; j <= ring; ++j) {
        if (std::max(std::abs(i), std::abs(j)) != ring) continue;
        std::copy(before.begin(), before.end(), wanted_.begin());
        const double stretch = std::log(std::cosh(i * step) * std::cosh(j * step));
        const Sweep& s =
            sweep(std::sinh(i * step), std::sinh(j * step), 2 * std::log(step) + stretch);
        for (std::size_t u = 0; u < units_; ++u) {
          if (!before[u]) continue;
          const double log_f = s.log_f[u] + stretch;
          sums_[u].add(log_f, (i + j) % 2 != 0);
          more[u] |= log_f > sums_[u].highest + negligible + 8;
        }
      }
    }
    wanted_ = more;
  }

  UnitTerms& terms_;
  std::vector<LaplaceApproximation>& approximations_;
  UnitIntegrals& result_;
  std::size_t units_, effects_, used_ = 0;
  std::vector<std::uint8_t> wanted_;
  std::vector<double> value_, log_area_;  // of each unit
  std::vector<Sum> sums_;
};

}  // namespace

double UnitIntegrals::sum() const {
  double total = 0;
  for (const double each : log_likelihood) total += each;
  return total;
}

void UnitIntegrals::restart(std::size_t units, std::size_t effects) {
  units_ = units;
  effects_ = effects;
  used_ = 0;
  settled = true;
  unsettled = 0;
  log_likelihood.assign(units, -infinity);
}

void UnitIntegrals::put(std::size_t unit, std::size_t place, const double* z,
                        double weight_of_node) {
  if (place >= sweeps.size()) sweeps.resize(place + 1);
  for (; used_ <= place; ++used_) {
    sweeps[used_].z.assign(units_ * effects_, 0);
    sweeps[used_].log_f.assign(units_, -infinity);
    sweeps[used_].weight.assign(units_, 0);
  }
  std::copy_n(z, effects_, &sweeps[place].z[unit * effects_]);
  sweeps[place].weight[unit] = weight_of_node;
}

void integrate(UnitTerms& terms, UnitIntegrals& result) {
  std::vector<LaplaceApproximation> approximations = Search(terms).approximations();
  Lattice(terms, approximations, result).run();
}

}  // namespace wearwell::latent
