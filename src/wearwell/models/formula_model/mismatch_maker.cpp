#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/chebyshev_series.h"
#include "wearwell/models/formula_model/mismatch_table.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t terms = MismatchTable::terms;
constexpr double least_posterior =
    22;  // log of the posterior relative to its maximum, the lowest that a fit visits
constexpr double least_integrand = 36;  // log of a unit's integrand relative to its maximum

// From coefficients of Chebyshev polynomials to those of powers.
void make_powers(double* c) {
  static const auto table = [] {
    std::array<std::array<double, terms>, terms> t{};
    t[0][0] = t[1][1] = 1;
    for (std::size_t k = 2; k < terms; ++k) {
      for (std::size_t p = 0; p < terms; ++p) {
        t[k][p] = (p > 0 ? 2 * t[k - 1][p - 1] : 0) - t[k - 2][p];
      }
    }
    return t;
  }();
  std::array<double, terms> sum{};
  for (std::size_t k = 0; k < terms; ++k) {
    for (std::size_t p = k % 2; p <= k; p += 2) sum[p] += c[k] * table[k][p];
  }
  std::copy(sum.begin(), sum.end(), c);
}

// Factor by which the errors of readings may exceed their estimate: where the posterior of their
// size has fallen by `least_posterior`.
double most_size(double freedom) {
  double r = 1.2;
  while (r < 30 && freedom * (std::log(r) - 0.5 * (1 - 1 / (r * r))) < least_posterior) r *= 1.1;
  return r;
}

}  // namespace

class MismatchMaker {
 public:
  MismatchMaker(Mismatch& mismatch, const MismatchDomain& domain)
      : mismatch_(mismatch), domain_(domain), units_(mismatch.units()), x_(units_), s_(units_) {}

  std::shared_ptr<const MismatchTable> make() {
    const bool shared = domain_.theta_high > domain_.theta_low;
    Best best = shared ? lowest() : best_at(domain_.theta_low);
    const double freedom = std::max(3.0, domain_.freedom);
    variance_ = best.total / freedom;
    if (!(variance_ > 0 && std::isfinite(variance_))) return {};
    const double r = size_ = most_size(freedom);
    level_ = 2 * variance_ * r * r * (least_posterior + least_integrand);
    double low = best.theta, high = best.theta;
    if (shared) {
      const double theta_level = best.total + 2 * variance_ * r * r * least_posterior;
      low = end_of_theta(best.theta, domain_.theta_low, theta_level);
      high = end_of_theta(best.theta, domain_.theta_high, theta_level);
    }
    constexpr int most_tries = 5;
    for (int attempt = 0; attempt < most_tries; ++attempt) {
      for (const std::size_t panels : {16, 48}) {
        if (auto table = fill(low, high, panels, shared)) return table;
      }
      if (!shared) return {};
      low = best.theta + 0.6 * (low - best.theta);
      high = best.theta + 0.6 * (high - best.theta);
    }
    return {};
  }

 private:
  struct Best {
    double theta = 0, total = infinity;
    std::vector<double> x, sums;  // by unit
  };

  // The best x of each unit: the lowest of a grid, refined between its neighbours.
  Best best_at(double theta) {
    constexpr int places = 120, rounds = 30;
    constexpr double golden = 0.381966011250105;
    Best best{theta, 0, std::vector<double>(units_, domain_.x_low),
              std::vector<double>(units_, infinity)};
    const double step = (domain_.x_high - domain_.x_low) / places;
    for (int i = 0; i <= places; ++i) {
      std::fill(x_.begin(), x_.end(), domain_.x_low + i * step);
      mismatch_(theta, x_, s_);
      for (std::size_t u = 0; u < units_; ++u) {
        if (!(s_[u] < best.sums[u])) continue;
        best.sums[u] = s_[u];
        best.x[u] = x_[u];
      }
    }
    std::vector<double> low(units_), high(units_), inner = best.x, sums = best.sums;
    for (std::size_t u = 0; u < units_; ++u) {
      low[u] = best.x[u] - step;
      high[u] = best.x[u] + step;
    }
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t u = 0; u < units_; ++u) {
        const bool right = high[u] - inner[u] > inner[u] - low[u];
        x_[u] = inner[u] + golden * (right ? high[u] - inner[u] : low[u] - inner[u]);
      }
      mismatch_(theta, x_, s_);
      for (std::size_t u = 0; u < units_; ++u) {
        if (s_[u] < sums[u]) {
          (x_[u] > inner[u] ? low : high)[u] = inner[u];
          inner[u] = x_[u];
          sums[u] = s_[u];
        } else {
          (x_[u] > inner[u] ? high : low)[u] = x_[u];
        }
      }
    }
    best.x = inner;
    best.sums = sums;
    for (const double each : sums) best.total += each;
    return best;
  }

  // The lowest total over theta.
  Best lowest() {
    constexpr int places = 40, rounds = 24;
    constexpr double golden = 0.381966011250105;
    const double step = (domain_.theta_high - domain_.theta_low) / places;
    Best best;
    for (int i = 0; i <= places; ++i) {
      Best here = best_at(domain_.theta_low + i * step);
      if (here.total < best.total) best = std::move(here);
    }
    double low = std::max(domain_.theta_low, best.theta - step),
           high = std::min(domain_.theta_high, best.theta + step);
    for (int round = 0; round < rounds && std::isfinite(best.total); ++round) {
      const bool right = high - best.theta > best.theta - low;
      Best next = best_at(best.theta + golden * (right ? high - best.theta : low - best.theta));
      if (next.total < best.total) {
        (right ? low : high) = best.theta;
        best = std::move(next);
      } else {
        (right ? high : low) = next.theta;
      }
    }
    return best;
  }

  // Towards a bound, the approximate point where the total reaches a level.
  double end_of_theta(double from, double bound, double level) {
    double inside = from, share = 1.0 / 1024;
    while (share <= 1 && best_at(from + share * (bound - from)).total < level) {
      inside = from + share * (bound - from);
      share *= 2;
    }
    if (share > 1) return bound;
    double outside = from + share * (bound - from);
    for (int round = 0; round < 3; ++round) {
      const double middle = 0.5 * (inside + outside);
      (best_at(middle).total < level ? inside : outside) = middle;
    }
    return outside;
  }

  // The x between the best and a bound at which S has risen by this much; the bound if it has not.
  std::vector<double> risen_by(const Best& best, const std::vector<double>& bound, double by) {
    std::vector<double> inside = best.x, outside = bound;
    x_ = bound;
    mismatch_(best.theta, x_, s_);
    std::vector<std::uint8_t> open(units_);
    for (std::size_t u = 0; u < units_; ++u) open[u] = s_[u] < best.sums[u] + by;
    for (int round = 0; round < 40; ++round) {
      for (std::size_t u = 0; u < units_; ++u) x_[u] = 0.5 * (inside[u] + outside[u]);
      mismatch_(best.theta, x_, s_);
      for (std::size_t u = 0; u < units_; ++u) {
        (s_[u] < best.sums[u] + by ? inside : outside)[u] = x_[u];
      }
    }
    for (std::size_t u = 0; u < units_; ++u) {
      if (open[u]) inside[u] = bound[u];
    }
    return inside;
  }

  // The x on one side of the best at which S reaches the level, or a maximum number of widths away:
  // for a slow unit S flattens at some distance.
  std::vector<double> end_of_x(const Best& best, double bound) {
    constexpr double most_widths = 14;
    std::vector<double> ends = risen_by(best, std::vector<double>(units_, bound), variance_);
    for (std::size_t u = 0; u < units_; ++u) {
      const double farthest = best.x[u] + most_widths * size_ * (ends[u] - best.x[u]);
      ends[u] = bound > best.x[u] ? std::min(bound, farthest) : std::max(bound, farthest);
    }
    return risen_by(best, ends, level_);
  }

  // Centers and widths of x over theta.
  bool map(MismatchTable& table, bool shared) {
    const std::size_t n = shared ? MismatchTable::map_orders : 1;
    std::vector<double> center(units_ * n), half(units_ * n), lowest(units_ * n);
    for (std::size_t i = 0; i < n; ++i) {
      const Best best = best_at(theta_of(table, n == 1 ? 0 : chebyshev_node(i, n)));
      const std::vector<double> low = end_of_x(best, domain_.x_low),
                                high = end_of_x(best, domain_.x_high);
      for (std::size_t u = 0; u < units_; ++u) {
        center[u * n + i] = 0.5 * (low[u] + high[u]);
        half[u * n + i] = 0.5 * (high[u] - low[u]);
        lowest[u * n + i] = best.x[u];
        if (!(half[u * n + i] > 0 && std::isfinite(center[u * n + i]))) return false;
      }
    }
    for (std::size_t u = 0; u < units_; ++u) {
      table.center_.push_back(chebyshev_series(&center[u * n], n, 1));
      table.half_.push_back(chebyshev_series(&half[u * n], n, 1));
      table.best_.push_back(chebyshev_series(&lowest[u * n], n, 1));
    }
    return true;
  }

  static double theta_of(const MismatchTable& table, double t) {
    return table.theta_low_ + 0.5 * (t + 1) * (table.theta_high_ - table.theta_low_);
  }

  std::shared_ptr<const MismatchTable> fill(double low, double high, std::size_t panels,
                                            bool shared) {
    auto table = std::make_shared<MismatchTable>();
    table->units_ = units_;
    table->panels_ = panels;
    table->theta_low_ = low;
    table->theta_high_ = high;
    if (!map(*table, shared)) return {};
    for (const std::size_t orders : {17, 33}) {
      table->orders_ = shared ? orders : 1;
      switch (fill_nodes(*table)) {
        case Outcome::fits:
          return tried(table) ? table : nullptr;
        case Outcome::rough_in_theta:
          if (shared) continue;
          return {};
        case Outcome::rough:
          return {};
      }
    }
    return {};
  }

  enum class Outcome { fits, rough_in_theta, rough };

  Outcome fill_nodes(MismatchTable& table) {
    const std::size_t orders = table.orders_, block = orders * terms;
    table.coefficients_.assign(units_ * table.panels_ * block, 0);
    const auto at = [&](std::size_t u, std::size_t p) {
      return &table.coefficients_[(u * table.panels_ + p) * block];
    };
    std::vector<double> order(MismatchTable::map_orders), slope(MismatchTable::map_orders);
    for (std::size_t k = 0; k < orders; ++k) {
      const double t = orders == 1 ? 0 : chebyshev_node(k, orders), theta = theta_of(table, t);
      chebyshev_polynomials(t, order, slope);
      for (std::size_t p = 0; p < table.panels_; ++p) {
        for (std::size_t i = 0; i < terms; ++i) {
          const double s = (2 * static_cast<double>(p) + 1 + chebyshev_node(i, terms)) /
                               static_cast<double>(table.panels_) -
                           1;
          for (std::size_t u = 0; u < units_; ++u) {
            x_[u] =
                chebyshev_sum(table.center_[u], order) + s * chebyshev_sum(table.half_[u], order);
          }
          mismatch_(theta, x_, s_);
          for (std::size_t u = 0; u < units_; ++u) {
            if (!std::isfinite(s_[u])) return Outcome::rough;
            at(u, p)[k * terms + i] = s_[u];
          }
        }
      }
    }
    double worst_in_x = 0, worst_in_theta = 0;
    for (std::size_t u = 0; u < units_; ++u) {
      for (std::size_t p = 0; p < table.panels_; ++p) {
        double* c = at(u, p);
        for (std::size_t k = 0; k < orders; ++k) {
          const std::vector<double> of = chebyshev_series(c + k * terms, terms, 1);
          std::copy(of.begin(), of.end(), c + k * terms);
          worst_in_x = std::max({worst_in_x, std::abs(of[terms - 1]), std::abs(of[terms - 2])});
        }
        for (std::size_t i = 0; i < terms && orders > 1; ++i) {
          const std::vector<double> of = chebyshev_series(c + i, orders, terms);
          for (std::size_t k = 0; k < orders; ++k) c[k * terms + i] = of[k];
          worst_in_theta =
              std::max({worst_in_theta, std::abs(of[orders - 1]), std::abs(of[orders - 2])});
        }
        for (std::size_t k = 0; k < orders; ++k) make_powers(c + k * terms);
      }
    }
    const double tolerance = 1e-8 * 2 * variance_;
    if (!(worst_in_x < tolerance)) return Outcome::rough;
    return worst_in_theta < tolerance ? Outcome::fits : Outcome::rough_in_theta;
  }

  // Checks between the nodes.
  bool tried(const std::shared_ptr<const MismatchTable>& table) {
    MismatchSlice slice(table);
    Rng rng(20261123, 0);
    for (int trial = 0; trial < 40; ++trial) {
      const double theta = theta_of(*table, rng.uniform(-1, 1));
      if (!slice.move(theta)) return false;
      for (std::size_t u = 0; u < units_; ++u) {
        x_[u] = slice.low(u) + rng.uniform(0, 1) * (slice.high(u) - slice.low(u));
      }
      mismatch_(theta, x_, s_);
      for (std::size_t u = 0; u < units_; ++u) {
        if (!slice.holds(u, x_[u])) continue;
        if (!(std::abs(slice.value(u, x_[u]) - s_[u]) < 4e-8 * 2 * variance_)) return false;
      }
    }
    return true;
  }

  Mismatch& mismatch_;
  const MismatchDomain& domain_;
  std::size_t units_;
  double variance_ = 0, level_ = 0, size_ = 1;
  std::vector<double> x_, s_;
};

std::shared_ptr<const MismatchTable> MismatchTable::make(Mismatch& mismatch,
                                                         const MismatchDomain& domain) {
  return MismatchMaker(mismatch, domain).make();
}

}  // namespace wearwell::formula_model
