#include "wearwell/models/fatigue/limit_lattice.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "wearwell/math/constants.h"

// Longer than others: one rule, whose nodes are found, filled and checked with the same table.
namespace wearwell::fatigue {
namespace {

constexpr double root_half = M_SQRT1_2, per_root_two_pi = 0.3989422804014327;
const double decade = std::log(10.0);

constexpr double negligible = 28;       // e^-28 is 7e-13
constexpr double no_digits = 1e12;      // logarithms beyond are replaced by their largest term
constexpr int finest = 15, reach = 64;  // steps of 2^-1 to 2^-finest, from -reach to reach
constexpr double narrowest = 0.01;      // features below are integrated around their own position
constexpr double farthest = 0.4;        // range of their series

/// Adjacent nodes, of which the machine's vectors (of any x86-64 and 64-bit ARM) hold two.
using Block [[gnu::vector_size(16)]] = double;
using Bits [[gnu::vector_size(16)]] = std::uint64_t;
constexpr int block = 2;

inline Block of_both(double x) {
  return Block{x, x};
}
inline Block at_most(Block z, double most) {
  return z > most ? of_both(most) : z;
}
inline double at_most(double z, double most) {
  return z > most ? most : z;
}

/// exp(x) to 1e-14 for -700 <= x <= 700, clipped beyond, with few multiplications: a study
/// evaluates it some 1e9 times.
inline Block exponential(Block x) {
  constexpr double per_two = 1.4426950408889634, high = 6.93147180369123816490e-01,
                   low = 1.90821492927058770002e-10, shift = 0x1.8p52;
  x = x < -700.0 ? of_both(-700) : at_most(x, 700);
  const Block shifted = x * per_two + shift, k = shifted - shift;
  const Block r = (x - k * high) - k * low, r2 = r * r, r4 = r2 * r2;
  // Taylor's series to the eleventh power, |r| <= 0.35.
  const Block sum =
      (1.0 + r + r2 * (1.0 / 2 + r * (1.0 / 6))) +
      r4 * ((1.0 / 24 + r * (1.0 / 120) + r2 * (1.0 / 720 + r * (1.0 / 5040))) +
            r4 * (1.0 / 40320 + r * (1.0 / 362880) + r2 * (1.0 / 3628800 + r * (1.0 / 39916800))));
  return std::bit_cast<Block>(std::bit_cast<Bits>(sum) + (std::bit_cast<Bits>(shifted) << 52));
}
inline double exponential(double x) {
  return std::exp(x);
}

/// For a location-scale distribution: its density, or the probability below or above.
enum class Role { density, below, above };

/// factor = exp(bound) value, its derivative exp(bound) slope.
struct Share {
  Block value, slope;
};

/// `log_bound`: the logarithm of a factor's bound at score z, for a number or a block; `share`
/// takes the remaining factor from `e`, an exponential that is needed again.
template <StandardDistribution law, Role role>
struct Factor;

template <>
struct Factor<StandardDistribution::normal, Role::density> {
  template <class T>
  static T log_bound(T z, T& /*e*/) {
    return -0.5 * z * z;
  }
  static Share share(Block z, Block /*e*/) {
    return {of_both(per_root_two_pi), -per_root_two_pi * z};
  }
};

/// P(Z > t) exp(t^2/2), t >= 0: by the series about the nearest entry of a table, whose derivatives
/// follow from m' = t m - 1/sqrt(2 pi) alone; far out by continued fractions.
class Mills {
 public:
  static double at(double t) {
    static const Mills mills;
    if (!(t < last)) {
      const double r = 1 / (t * t);  // Abramowitz and Stegun 26.2.12, to 1e-12
      return per_root_two_pi / t * (1 - r * (1 - 3 * r * (1 - 5 * r * (1 - 7 * r * (1 - 9 * r)))));
    }
    const int i = static_cast<int>(t * per_unit + 0.5);
    const double from = i * (1.0 / per_unit), d = t - from;
    const auto& m = mills.series_[static_cast<std::size_t>(i)];
    double sum = m[terms - 1];
    for (int k = terms - 2; k >= 0; --k) sum = sum * d + m[static_cast<std::size_t>(k)];
    return sum;
  }

 private:
  static constexpr int per_unit = 16, last = 20, terms = 8;

  Mills() {
    for (int i = 0; i <= last * per_unit; ++i) {
      const double t = static_cast<double>(i) / per_unit;
      std::array<double, terms> m{};
      m[0] = 0.5 * std::erfc(t * root_half) * std::exp(0.5 * t * t);
      m[1] = t * m[0] - per_root_two_pi;
      // The derivative of order n + 1 is t times that of order n and n times the one before it.
      for (std::size_t n = 1; n + 1 < terms; ++n)
        m[n + 1] = (t * m[n] + m[n - 1]) / static_cast<double>(n + 1);
      series_.push_back(m);
    }
  }
  std::vector<std::array<double, terms>> series_;
};

template <>
struct Factor<StandardDistribution::normal, Role::below> {
  template <class T>
  static T log_bound(T z, T& /*e*/) {
    const T below = at_most(z, 0);
    return -0.5 * below * below;
  }
  static Share share(Block z, Block /*e*/) {
    Block mills;
    for (int i = 0; i < block; ++i) mills[i] = Mills::at(std::abs(z[i]));
    const Block e = exponential(-0.5 * z * z);
    return {z < 0.0 ? mills : 1.0 - e * mills,
            z < 0.0 ? of_both(per_root_two_pi) : per_root_two_pi * e};
  }
};

template <>
struct Factor<StandardDistribution::normal, Role::above> {
  using Mirror = Factor<StandardDistribution::normal, Role::below>;
  template <class T>
  static T log_bound(T z, T& e) {
    return Mirror::log_bound(-z, e);
  }
  static Share share(Block z, Block e) {
    const Share mirrored = Mirror::share(-z, e);
    return {mirrored.value, -mirrored.slope};
  }
};

// Beyond it exp(z) has no representable effect, and its square is still finite.
constexpr double far_above = 300;

template <>
struct Factor<StandardDistribution::smallest_extreme_value, Role::density> {
  template <class T>
  static T log_bound(T z, T& e) {
    const T near = at_most(z, far_above);
    e = exponential(near);
    return near - e;
  }
  static Share share(Block /*z*/, Block e) { return {of_both(1), 1.0 - e}; }
};

template <>
struct Factor<StandardDistribution::smallest_extreme_value, Role::below> {
  template <class T>
  static T log_bound(T z, T& /*e*/) {
    return at_most(z, 0);
  }
  static Share share(Block z, Block /*e*/) {
    constexpr double small = 0.02;
    const Block e = exponential(at_most(z, 6)),
                kept = exponential(-e);  // e^-403 is negligible beside 1
    const Block s = at_most(e, small);
    const Block left = 1.0 - s * (1.0 / 2 - s * (1.0 / 6 - s * (1.0 / 24 - s * (1.0 / 120))));
    return {z >= 0.0 ? 1.0 - kept : (e < small ? left : (1.0 - kept) / e),
            z >= 0.0 ? e * kept : (e < small ? 1.0 - s * left : kept)};
  }
};

template <>
struct Factor<StandardDistribution::smallest_extreme_value, Role::above> {
  template <class T>
  static T log_bound(T z, T& e) {
    e = exponential(at_most(z, far_above));
    return -e;
  }
  static Share share(Block /*z*/, Block e) { return {of_both(1), -e}; }
};

/// log of the limit's share of the stress, 1/(1 + exp(-u)), and of the remaining share.
struct Logs {
  double share, rest;
};
Logs logs_at(double u) {
  if (u < 0) {
    const double rest = -std::log1p(std::exp(u));
    return {rest + u, rest};
  }
  const double share = -std::log1p(std::exp(-u));
  return {share, share - u};
}

double step_of(int level) {
  static const std::array<double, finest + 1> steps = [] {
    std::array<double, finest + 1> all{};
    for (int each = 0; each <= finest; ++each) all[each] = std::exp2(-0.5 * (each + 1));
    return all;
  }();
  return steps[static_cast<std::size_t>(level)];
}

/// These at multiples of a level's step, from -reach to reach.
class Table {
 public:
  explicit Table(int level)
      : step(step_of(level)), middle(static_cast<std::ptrdiff_t>(reach / step)) {
    for (std::ptrdiff_t k = -middle; k <= middle; ++k) {
      const Logs logs = logs_at(static_cast<double>(k) * step);
      share.push_back(logs.share);
      rest.push_back(logs.rest);
    }
  }
  double step;
  std::ptrdiff_t middle;
  std::vector<double> share, rest;
};
const Table& table(int level) {
  static const std::vector<Table> tables = [] {
    std::vector<Table> all;
    for (int each = 1; each <= finest; ++each) all.emplace_back(each);
    return all;
  }();
  return tables[static_cast<std::size_t>(level - 1)];
}

/// The score w of the limit and the score z of the life, linear in the logarithms.
struct Places {
  double w0, w_slope, z0, z_slope;
  double w(const Logs& at) const { return w0 + w_slope * at.share; }
  double z(const Logs& at) const { return z0 + z_slope * at.rest; }
};

/// Where a distribution is at its location: u, and both scores there, one of them exactly 0.
struct Mark {
  double u = 0, share_log = 0, rest_log = 0;
  double w = 0, z = 0;
};

/// The nodes of one integral, evenly spaced in u, in blocks: outward from `origin` in both
/// directions.
struct Nodes {
  static constexpr int most = 1000, origin = most;
  struct At {
    Block w, z, bound, e_w, e_z;  // the last two: of `log_bound`
  };
  double step = 0;
  int first = origin, last = origin;  // block; the last: one past the end
  std::array<At, 2 * most + 1> at;
};

// Of a thread, made where it is first used: what is thread-local itself is cleared in every thread of every program.
Nodes& nodes_of_thread() {
  static thread_local const std::unique_ptr<Nodes> nodes = std::make_unique<Nodes>();
  return *nodes;
}

struct Sums {
  double mass = 0, of_w = 0, of_w_w = 0, of_z = 0, of_z_z = 0, reference = 0;
};

template <class OfLimit, class OfLife, bool by_rest>
class Lattice {
 public:
  explicit Lattice(const Places& places) : places_(places) {}

  /// Without constant factors; `marks` are where each distribution is at its location, if anywhere.
  std::optional<Sums> operator()(std::span<const Mark> marks, bool extreme) {
    const Mark* best = &marks.front();
    double highest = -infinity;
    for (const Mark& mark : marks) {
      const double here = bound(mark);
      if (std::isnan(here)) return {};
      if (!(here > highest)) continue;
      highest = here;
      best = &mark;
    }
    const double resolution = extreme ? 0.4 : 0.63;
    const double wide = width(1 / (1 + std::exp(-best->u)));
    if (!(wide > narrowest)) return about(*best, resolution * wide);
    for (int level = level_of(resolution * wide); level <= finest;) {
      const int finer = fill(level, best->u, marks, resolution);
      if (finer < 0) return {};
      if (finer > level) {
        level = finer;
        continue;
      }
      if (const auto sums = summed()) return sums;
      ++level;
    }
    return {};
  }

 private:
  static int level_of(double step) {
    int level = 1;
    while (level <= finest && step_of(level) > step) ++level;
    return level;
  }

  double bound(const Logs& at) const {
    double e = 0;
    return OfLimit::log_bound(places_.w(at), e) + OfLife::log_bound(places_.z(at), e) +
           (by_rest ? at.rest : at.share);
  }

  static double bound(const Mark& at) {
    double e = 0;
    return OfLimit::log_bound(at.w, e) + OfLife::log_bound(at.z, e) +
           (by_rest ? at.rest_log : at.share_log);
  }

  // `measure`: the logarithm of the further factor of the integrand.
  Block put(int node, Block w, Block z, Block measure) {
    Nodes::At& at = nodes_.at[static_cast<std::size_t>(node)];
    at.w = w;
    at.z = z;
    at.bound = OfLimit::log_bound(w, at.e_w) + OfLife::log_bound(z, at.e_z) + measure;
    return at.bound;
  }

  // Of the narrowest feature possible where the limit has this share of the stress.
  double width(double share) const {
    const double of_limit = places_.w_slope * (1 - share), of_life = places_.z_slope * share;
    return 1 / std::sqrt(of_limit * of_limit + of_life * of_life);
  }

  // All non-negligible nodes of a level. Returns the level, a finer one if needed, or -1.
  int fill(int level, double near, std::span<const Mark> marks, double resolution) {
    const Table& t = table(level);
    const std::ptrdiff_t last = 2 * t.middle;
    const auto index = [&](double u) {
      return std::clamp<std::ptrdiff_t>(t.middle + std::lround(std::clamp(u, -1e3, 1e3) / t.step),
                                        0, last);
    };
    const auto at = [&](std::ptrdiff_t i) {
      const auto k = static_cast<std::size_t>(i);
      return bound(Logs{t.share[k], t.rest[k]});
    };
    // Uphill in steps that double while the value increases.
    std::ptrdiff_t top = index(near);
    double highest = at(top);
    for (std::ptrdiff_t stride = 1; stride > 0;) {
      bool moved = false;
      for (const std::ptrdiff_t way : {stride, -stride}) {
        const std::ptrdiff_t next = top + way;
        if (next < 0 || next > last) continue;
        const double there = at(next);
        if (!(there > highest)) continue;
        highest = there;
        top = next;
        moved = true;
        break;
      }
      stride = moved ? 2 * stride : stride / 2;
    }
    if (!std::isfinite(highest)) return -1;
    // Another peak may lie at another mark.
    std::ptrdiff_t low = top, high = top;
    for (const Mark& mark : marks) {
      const std::ptrdiff_t i = index(mark.u);
      const double there = at(i);
      if (!(there > highest - negligible)) continue;
      low = std::min(low, i);
      high = std::max(high, i);
      highest = std::max(highest, there);
    }
    // Blocks outward from the maximum, until the outermost node of one is negligible.
    const auto walked = [&](bool ahead, std::ptrdiff_t must) {
      for (int k = 0; k < Nodes::most; ++k) {
        const std::ptrdiff_t from = top + block * (ahead ? k : -k - 1);
        if (from <= 0 || from + block > last) return -1;
        const auto i = static_cast<std::size_t>(from);
        const Block share{t.share[i], t.share[i + 1]}, rest{t.rest[i], t.rest[i + 1]};
        const Block bounds =
            put(Nodes::origin + (ahead ? k : -k - 1), places_.w0 + places_.w_slope * share,
                places_.z0 + places_.z_slope * rest, by_rest ? rest : share);
        const double outermost = bounds[ahead ? block - 1 : 0];
        if (!(outermost > highest - negligible) && block * (k + 1) > must) return k + 1;
      }
      return -1;
    };
    const int up = walked(true, high - top), down = walked(false, top - low);
    if (up < 0 || down < 0) return -1;
    nodes_.step = t.step;
    nodes_.first = Nodes::origin - down;
    nodes_.last = Nodes::origin + up;
    // Where a distribution is steep at an edge of the region it has little mass: its middle half
    // decides.
    const auto width_at = [&](std::ptrdiff_t i) {
      return width(std::exp(t.share[static_cast<std::size_t>(i)]));
    };
    const int needed = level_of(
        resolution * std::min(width_at(top + block / 2 * up), width_at(top - block / 2 * down)));
    if (needed <= level) return level;
    return needed <= finest ? needed : -1;
  }

  // The logarithms about u by their series: well within the distance pi to the logarithm's
  // singularity.
  std::optional<Sums> about(const Mark& center, double step) {
    if (!(step > 0)) return {};
    const auto of_rest = series(1 / (1 + std::exp(-center.u))),
               of_share = series(1 / (1 + std::exp(center.u)));
    const auto put_at = [&](int node, Block d) {
      Block r{}, s{};
      for (std::size_t k = terms; k-- > 0;) {
        r = (r + of_rest[k]) * d;
        s = (s + of_share[k]) * -d;
      }
      return put(node, center.w + places_.w_slope * s, center.z + places_.z_slope * r,
                 by_rest ? center.rest_log + r : center.share_log + s);
    };
    const Block within{0, 1};
    for (int attempt = 0; attempt < 2; ++attempt, step *= 0.5) {
      double highest = -infinity;
      nodes_.step = step;
      for (const bool ahead : {true, false}) {
        for (int k = 0;; ++k) {
          if (k == Nodes::most || block * (k + 1) * step > farthest) return {};
          const int from = ahead ? k : -k - 1;
          const Block bounds = put_at(Nodes::origin + from, step * (block * from + within));
          highest = std::max(highest, std::max(bounds[0], bounds[1]));
          (ahead ? nodes_.last : nodes_.first) = Nodes::origin + (ahead ? k + 1 : -k - 1);
          if (!(bounds[ahead ? block - 1 : 0] > highest - negligible)) break;
        }
      }
      if (!std::isfinite(highest)) return {};
      if (const auto sums = summed()) return sums;
    }
    return {};
  }

  static constexpr std::size_t terms = 14;

  // Of -log(1 - p + p exp(d)) = -log(1 + exp(u + d)) + log(1 + exp(u)), p = 1/(1 + exp(-u)): each
  // derivative is a polynomial in p, as dp/dd = p (1 - p).
  static std::array<double, terms> series(double p) {
    std::array<double, terms> c{};
    const auto& polynomials = derivatives();
    for (std::size_t k = 0; k < terms; ++k) {
      double value = 0;
      for (std::size_t i = polynomials[k].size(); i-- > 0;) value = value * p + polynomials[k][i];
      c[k] = value;
    }
    return c;
  }
  using Polynomial = std::array<double, terms + 1>;
  static const std::array<Polynomial, terms>& derivatives() {
    static const std::array<Polynomial, terms> all = [] {
      std::array<Polynomial, terms> each{};
      Polynomial now{};
      now[1] = -1;
      double factorial = 1;
      for (std::size_t k = 0; k < terms; ++k) {
        factorial *= static_cast<double>(k + 1);
        for (std::size_t i = 0; i <= terms; ++i) each[k][i] = now[i] / factorial;
        Polynomial next{};
        for (std::size_t i = 1; i <= terms; ++i) {
          next[i] += static_cast<double>(i) * now[i];
          if (i < terms) next[i + 1] -= static_cast<double>(i) * now[i];
        }
        now = next;
      }
      return each;
    }();
    return all;
  }

  // Empty if the transform of the integrand at the nodes' frequency is not small
  // (limit_integral.cpp).
  std::optional<Sums> summed() const {
    const std::span<const Nodes::At> nodes(&nodes_.at[static_cast<std::size_t>(nodes_.first)],
                                           &nodes_.at[static_cast<std::size_t>(nodes_.last)]);
    Block highest = nodes.front().bound;
    for (const Nodes::At& at : nodes) highest = at.bound > highest ? at.bound : highest;
    Sums sums;
    sums.reference = std::max(highest[0], highest[1]);
    Block of_w{}, of_w_w{}, of_z{}, of_z_z{};
    std::array<Block, 3> every_sixth{};
    std::size_t part = 0;
    for (const auto& [w, z, bound, e_w, e_z] : nodes) {
      const Block below = bound - sums.reference;
      const Block e = below > -negligible ? nodes_.step * exponential(below) : Block{};
      const Share limit = OfLimit::share(w, e_w), life = OfLife::share(z, e_z);
      const Block dw = e * limit.slope * life.value, dz = e * limit.value * life.slope;
      every_sixth[part] += e * limit.value * life.value;
      of_w += dw;
      of_w_w += dw * w;
      of_z += dz;
      of_z_z += dz * z;
      part = part == 2 ? 0 : part + 1;
    }
    sums.of_w = of_w[0] + of_w[1];
    sums.of_w_w = of_w_w[0] + of_w_w[1];
    sums.of_z = of_z[0] + of_z[1];
    sums.of_z_z = of_z_z[0] + of_z_z[1];
    const double a = every_sixth[0][0], b = every_sixth[0][1], c = every_sixth[1][0],
                 d = every_sixth[1][1], e = every_sixth[2][0], f = every_sixth[2][1];
    sums.mass = a + b + c + d + e + f;
    // A node out of range has zero weight, and must not contribute a slope.
    if (!(sums.mass > 0 && std::isfinite(sums.of_w_w + sums.of_z_z))) return {};
    const double p = a + d, q = b + e, r = c + f;
    const double half = std::abs(a - b + c - d + e - f) / sums.mass;
    const double third =
        std::sqrt(std::max(0.0, p * p + q * q + r * r - p * q - q * r - r * p)) / sums.mass;
    // The integrand is no more precise than its logarithm.
    const double noise = 1e-15 * std::abs(sums.reference);
    if (sums.reference < -no_digits || (third <= 3e-2 + noise && half <= 1e-5 + noise)) return sums;
    return {};
  }

  const Places& places_;
  Nodes& nodes_ = nodes_of_thread();
};

/// Where each distribution is at its location, if that is on the line; else the middle.
struct Marks {
  std::array<Mark, 2> at{};
  std::size_t count = 0;
  bool narrow_life =
      // the life's distribution is the narrower, where the limit or the life is the usual one
      false;
};
Marks marks_of(const LimitedLife<double>& item, const Places& places, double at) {
  Marks marks;
  const auto add = [&](double share_log, double rest_log) {
    Mark& mark = marks.at[marks.count++];
    mark = {share_log - rest_log, share_log, rest_log, places.w({share_log, rest_log}),
            places.z({share_log, rest_log})};
    if (marks.count == 1)
      marks.narrow_life =
          places.z_slope * std::exp(share_log) > places.w_slope * std::exp(rest_log);
    return &mark;
  };
  const double log_share = decade * (item.location - item.log10_reversed);
  if (log_share < -1e-12) add(log_share, std::log(-std::expm1(log_share)))->w = 0;
  const double log_rest = decade * (item.b * at + item.log10_a - item.log10_reversed);
  if (log_rest < -1e-12) add(std::log(-std::expm1(log_rest)), log_rest)->z = 0;
  if (marks.count == 0) add(-std::log(2.0), -std::log(2.0));
  return marks;
}

template <Role of_limit, Role of_life, bool by_rest>
std::optional<Sums> integral(const LimitedLife<double>& item, const Places& places,
                             const Marks& marks) {
  constexpr auto normal = StandardDistribution::normal,
                 extreme = StandardDistribution::smallest_extreme_value;
  const std::span<const Mark> at(marks.at.data(), marks.count);
  const auto by = [&]<StandardDistribution limit, StandardDistribution life>() {
    return Lattice<Factor<limit, of_limit>, Factor<life, of_life>, by_rest>(places)(
        at, limit == extreme || life == extreme);
  };
  if (item.limit == normal) {
    if (item.life == normal) return by.template operator()<normal, normal>();
    if (item.life == extreme) return by.template operator()<normal, extreme>();
  } else if (item.limit == extreme) {
    if (item.life == normal) return by.template operator()<extreme, normal>();
    if (item.life == extreme) return by.template operator()<extreme, extreme>();
  }
  return {};
}

}  // namespace

std::optional<LimitedLifeSlopes> on_lattice(const LimitedLife<double>& item, Outcome outcome,
                                            double at) {
  if (outcome == Outcome::interval || !(item.b < 0)) return {};
  const double by_log10_s = 1 / item.scale, by_y = 1 / item.sigma, by_b = 1 / item.b;
  const double longest = (item.log10_reversed - item.log10_a) * by_b;  // for an item without limit
  const Places places{(item.log10_reversed - item.location) * by_log10_s, by_log10_s / decade,
                      (at - longest) * by_y, -by_b * by_y / decade};
  const Marks marks = marks_of(item, places, at);
  std::optional<Sums> found;
  bool dense_limit = true;
  double log_factor = 0;
  if (outcome == Outcome::failure) {
    found = integral<Role::density, Role::density, true>(item, places, marks);
    log_factor = std::log(places.w_slope * by_y);
  } else {
    dense_limit = !marks.narrow_life;
    const bool runout = outcome == Outcome::runout;
    if (dense_limit) {
      found = runout ? integral<Role::density, Role::above, true>(item, places, marks)
                     : integral<Role::density, Role::below, true>(item, places, marks);
    } else {
      found = runout ? integral<Role::above, Role::density, false>(item, places, marks)
                     : integral<Role::below, Role::density, false>(item, places, marks);
    }
    log_factor = std::log(dense_limit ? places.w_slope : places.z_slope);
  }
  if (!found) return {};
  const Sums& sums = *found;
  LimitedLifeSlopes y;
  y.value = std::log(sums.mass) + sums.reference + log_factor;
  const double of_w = sums.of_w / sums.mass, of_z = sums.of_z / sums.mass,
               of_z_z = sums.of_z_z / sums.mass;
  y.by_log10_reversed = of_w * by_log10_s - of_z * by_b * by_y;
  y.by_location = -of_w * by_log10_s;
  y.by_scale = -sums.of_w_w / sums.mass * by_log10_s;
  y.by_log10_a = of_z * by_b * by_y;
  y.by_sigma = -of_z_z * by_y;
  // z = (at - center)/sigma, and the center decreases with b as center/b.
  y.by_b = (of_z * at * by_y - of_z_z) * by_b;
  if (dense_limit) y.by_scale -= by_log10_s;
  if (outcome == Outcome::failure) y.by_sigma -= by_y;
  if (!dense_limit) {
    y.by_sigma -= by_y;
    y.by_b -= by_b;
  }
  if (outcome != Outcome::runout) return y;

  // Those whose limit is above the stress, or the life of items without one.
  const double place = dense_limit ? places.w0 : places.z0;
  const ValueAndSlope safe = log_survival_and_slope(dense_limit ? item.limit : item.life, place);
  const double larger = std::max(y.value, safe.value), smaller = std::min(y.value, safe.value);
  const double all = larger + std::log1p(std::exp(smaller - larger));
  const double kept = std::exp(y.value - all), spared = std::exp(safe.value - all);
  for (double* slope :
       {&y.by_log10_reversed, &y.by_log10_a, &y.by_b, &y.by_sigma, &y.by_location, &y.by_scale}) {
    *slope *= kept;
  }
  if (spared > 0 && dense_limit) {
    y.by_log10_reversed += spared * safe.slope * by_log10_s;
    y.by_location -= spared * safe.slope * by_log10_s;
    y.by_scale -= spared * safe.slope * place * by_log10_s;
  } else if (spared > 0) {
    y.by_log10_reversed -= spared * safe.slope * by_b * by_y;
    y.by_log10_a += spared * safe.slope * by_b * by_y;
    y.by_b += spared * safe.slope * longest * by_b * by_y;
    y.by_sigma -= spared * safe.slope * place * by_y;
  }
  y.value = all;
  return y;
}

}  // namespace wearwell::fatigue
