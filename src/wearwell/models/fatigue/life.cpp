#include "wearwell/models/fatigue/life.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "wearwell/math/constants.h"
#include "wearwell/math/root.h"
#include "wearwell/models/fatigue/random_limit.h"

namespace wearwell::fatigue {
namespace {

constexpr double most_decades = 300;

double normal_cdf(double z) {
  return 0.5 * std::erfc(-z * M_SQRT1_2);
}

double normal_density(double z) {
  return 0.3989422804014327 * std::exp(-0.5 * z * z);
}

// On the scale on which lives scatter; an infinite life stays infinite.
double center(const SnLaw& law, double log10_life) {
  if (std::isnan(log10_life) || log10_life == infinity) return log10_life;
  const double decades = std::clamp(log10_life, -most_decades, most_decades);
  return law.logarithmic() ? decades : std::pow(10, decades);
}

MixedLife life_of(const SnLaw& law, const double* x, double log10_reversed) {
  MixedLife life(law.family);
  add_life(life, 1, law, x, log10_reversed);
  return life;
}

}  // namespace

StandardDistribution MixedLife::standard() const {
  return family_ == LifeFamily::weibull ? StandardDistribution::smallest_extreme_value
                                        : StandardDistribution::normal;
}

void MixedLife::add(double weight, double center, double sigma) {
  if (weight <= 0 || center == infinity) return;
  if (std::isnan(center) || !(sigma > 0)) {
    undefined_ += weight;
    return;
  }
  weight_.push_back(weight);
  center_.push_back(center);
  inverse_sigma_.push_back(1 / sigma);
  ended_ += weight;
}

void MixedLife::merge() {
  // Of cells, in sigma. Normal distributions keep the variance of their parts: then the error is of
  // fourth order in the distance of their centers, and in the tails of second order in the width in
  // sigma; for other distributions it is of second order in both.
  const bool normal = standard() == StandardDistribution::normal;
  const double width = normal ? 0.01 : 0.005, across = normal ? 10 * width : width;
  // Weighted sums: of positions from the cell's edge and of second moments about it, or of sigmas.
  struct Cell {
    double weight = 0, center = 0, place = 0, second_moment = 0, sigma = 0;
  };
  std::unordered_map<std::uint64_t, std::size_t> known;
  std::vector<Cell> cells;
  double last = infinity, row = 0, width_there = 0;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    if (inverse_sigma_[i] != last) {
      last = inverse_sigma_[i];
      row = std::floor(-std::log(last) / width);
      width_there = across * std::exp(width * row);
    }
    const double column = std::floor(center_[i] / width_there);
    if (!(std::abs(row) < 1e9 && std::abs(column) < 1e9)) return;
    const auto key = static_cast<std::uint64_t>(static_cast<std::uint32_t>(int(row))) << 32 |
                     static_cast<std::uint32_t>(int(column));
    const auto [at, fresh] = known.try_emplace(key, cells.size());
    if (fresh) cells.emplace_back();
    Cell& cell = cells[at->second];
    const double off = center_[i] - column * width_there, sigma = 1 / inverse_sigma_[i];
    cell.weight += weight_[i];
    cell.center += weight_[i] * center_[i];
    cell.place += weight_[i] * off;
    cell.second_moment += weight_[i] * (off * off + sigma * sigma);
    cell.sigma += weight_[i] * sigma;
  }
  weight_.clear();
  center_.clear();
  inverse_sigma_.clear();
  for (const Cell& cell : cells) {
    const double place = cell.place / cell.weight;
    const double sigma = normal ? std::sqrt(cell.second_moment / cell.weight - place * place)
                                : cell.sigma / cell.weight;
    weight_.push_back(cell.weight);
    center_.push_back(cell.center / cell.weight);
    inverse_sigma_.push_back(1 / sigma);
  }
}

MixedLife::Sums MixedLife::sums(double at) const {
  Sums sums;
  const bool normal = standard() == StandardDistribution::normal;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    const double z = (at - center_[i]) * inverse_sigma_[i];
    if (normal) {
      constexpr double nothing = 9;  // beyond, less than 1e-18
      if (std::abs(z) > nothing) {
        if (z > 0) sums.cdf += weight_[i];
        continue;
      }
      sums.cdf += weight_[i] * normal_cdf(z);
      sums.density += weight_[i] * inverse_sigma_[i] * normal_density(z);
    } else {
      constexpr double all = 4, none = -50;  // beyond, less than 1e-21
      if (z > all) sums.cdf += weight_[i];
      if (z > all || z < none) continue;
      const double hazard = std::exp(z), failed = -std::expm1(-hazard);
      sums.cdf += weight_[i] * failed;
      sums.density += weight_[i] * inverse_sigma_[i] * hazard * (1 - failed);
    }
  }
  return sums;
}

double MixedLife::cdf(double life) const {
  if (family_ == LifeFamily::normal) return sums(life).cdf;
  return life > 0 ? sums(std::log10(life)).cdf : 0;
}

double MixedLife::quantile(double p) const {
  constexpr double negligible = 1e-8;
  if (undefined_ > negligible) return std::nan("");
  if (p >= ended_) return infinity;
  // Newton's method from the quantile of the distribution with the largest weight, between bounds
  // that close in: distributions of negligible weight may lie anywhere.
  const auto heaviest =
      static_cast<std::size_t>(std::max_element(weight_.begin(), weight_.end()) - weight_.begin());
  double step = 1 / inverse_sigma_[heaviest];
  // the remaining error of a Newton step is quadratic in the step
  const double small = 1e-6 * step;
  const auto life = [&](double at) {
    return family_ == LifeFamily::normal ? at : std::pow(10, at);
  };
  double at = center_[heaviest] + wearwell::quantile(standard(), p / ended_) * step;
  double low = -infinity, high = infinity;
  for (int i = 0; i < 2000; ++i) {
    if (!std::isfinite(at)) return std::nan("");
    const Sums here = sums(at);
    (here.cdf < p ? low : high) = at;
    double next = at - (here.cdf - p) / here.density;
    if (std::abs(next - at) <= small) return life(next);
    if (std::isinf(low) || std::isinf(high)) {
      // Far from all distributions Newton's step fails: it moves outward, ever faster.
      const double outward = here.cdf < p ? step : -step;
      if (!(std::abs(next - at) <= 4 * step)) next = at + outward;
      step *= 2;
    } else if (!(next > low && next < high)) {
      next = 0.5 * low + 0.5 * high;
    }
    const double moved = std::abs(next - at);
    at = next;
    if (moved <= 1e-11 * (1 + std::abs(at))) return life(at);
  }
  return std::nan("");
}

double MixedLife::density(double log10_life) const {
  if (family_ != LifeFamily::normal) return sums(log10_life).density;
  const double life = std::pow(10, log10_life);
  return sums(life).density * life * std::log(10.0);
}

namespace {

// For a random limit: the share of items that ever fail under a stress.
double reached(const SnLaw& law, const double* x, double log10_reversed) {
  return wearwell::cdf(*law.limit, law.limit_place(x, log10_reversed));
}

}  // namespace

double life_center(const SnLaw& law, const double* x, double log10_reversed) {
  return center(law, law.log10_life(x, log10_reversed));
}

void each_life(const SnLaw& law, const double* x, double log10_reversed, LimitStrata strata,
               const std::function<void(double share, double center, double sigma)>& take) {
  const double middle = life_center(law, x, log10_reversed);
  const double sigma = law.sigma_at(x, middle);
  if (!law.limit || std::isinf(log10_reversed)) return take(1, middle, sigma);
  if (!law.integrated()) return take(reached(law, x, log10_reversed), middle, sigma);
  // Slices of equal width reach into the tails, where the weak items are.
  constexpr double golden = 0.6180339887498949;  // its multiples are the most even modulo 1
  constexpr double negligible = 1e-9;
  double whole = 0;
  const double shift = std::modf((static_cast<double>(strata.index) + 0.5) * golden, &whole);
  const double first = wearwell::quantile(*law.limit, negligible);
  const double last = wearwell::quantile(*law.limit, 1 - negligible);
  const double width = (last - first) / static_cast<double>(strata.count);
  double below = 0;
  for (std::size_t i = 0; i <= strata.count; ++i) {
    // The first and the last slice include the tails.
    const double until = first + (static_cast<double>(i) + shift) * width;
    const double through = i == strata.count ? 1 : wearwell::cdf(*law.limit, until);
    take(through - below,
         center(law, law.log10_life_of_item(x, log10_reversed, until - 0.5 * width)), sigma);
    below = through;
  }
}

void add_life(MixedLife& lives, double weight, const SnLaw& law, const double* x,
              double log10_reversed, LimitStrata strata) {
  each_life(law, x, log10_reversed, strata, [&](double share, double center, double sigma) {
    lives.add(weight * share, center, sigma);
  });
}

namespace {

// Newton's method in the logarithm of the failed share, which is concave: starting from the life of
// items without a limit, which is a lower bound, no step overshoots.
double limited_quantile(const LimitedLife<double>& item, double p) {
  double low =
      (item.log10_reversed - item.log10_a) / item.b + item.sigma * wearwell::quantile(item.life, p);
  double high = infinity, at = low;
  for (int i = 0; i < 200; ++i) {
    const LimitedLifeSlopes y = log_probability_and_slopes(item, Outcome::left, at, 0);
    const double excess = y.value - std::log(p);
    // The share depends on the life only through z = (life - center)/sigma.
    const double slope = y.by_log10_a * item.b;
    (excess < 0 ? low : high) = at;
    double next = at - excess / slope;
    const double reach = 10 * item.sigma + 1;
    if (!std::isfinite(next) || next < low)
      next = std::isfinite(high) ? 0.5 * (low + high) : low + reach;
    if (next >= high) next = 0.5 * (low + high);
    const double moved = std::abs(next - at);
    at = next;
    // The remaining error is of the order of the square of the step, in parts of sigma.
    if (moved <= 1e-6 * item.sigma || moved <= 1e-11 * (1 + std::abs(at))) return at;
    if (at > most_decades) return infinity;
  }
  return at;
}

}  // namespace

double life_quantile(const SnLaw& law, const double* x, const Stress& stress, double p) {
  const double log10_reversed = law.log10_reversed(x, stress);
  if (law.limit) {
    if (std::isnan(log10_reversed)) return log10_reversed;
    const double ever = reached(law, x, log10_reversed);
    if (p >= ever) return infinity;
    if (law.integrated()) return limited_quantile(limited_life(law, x, log10_reversed), p);
    p /= ever;
  }
  const double middle = life_center(law, x, log10_reversed);
  return middle + law.sigma_at(x, middle) * wearwell::quantile(law.standard(), p);
}

double cycles(const SnLaw& law, double at) {
  return law.logarithmic() ? std::pow(10, at) : at;
}

double survival(const SnLaw& law, const double* x, const Stress& stress, double life) {
  const double log10_reversed = law.log10_reversed(x, stress);
  if (law.integrated() && std::isfinite(log10_reversed)) {
    return std::exp(log_probability_and_slopes(limited_life(law, x, log10_reversed),
                                               Outcome::runout, std::log10(life), 0)
                        .value);
  }
  return 1 - life_of(law, x, log10_reversed).cdf(life);
}

double log10_reversed_allowed(const SnLaw& law, const double* x, double life, double reliability) {
  if (!law.straight() && !law.integrated()) {
    // A higher stress shortens all lives.
    const auto excess = [&](double log10_reversed) {
      return life_of(law, x, log10_reversed).cdf(life) - (1 - reliability);
    };
    const double root =
        solve_increasing(excess, 8, 0.25, {.absolute = 1e-9}, -most_decades, most_decades);
    return std::abs(root) == most_decades ? std::copysign(infinity, root) : root;
  }
  const double scatter = x[law.sigma_index()] * wearwell::quantile(law.standard(), 1 - reliability);
  // Normal lives may scatter so much that this share outlasts it even about a mean of 0.
  if (!law.logarithmic() && scatter >= life) return infinity;
  const double log10_life =
      law.logarithmic() ? std::log10(life) - scatter : std::log10(life - scatter);
  const double unlimited = x[0] + x[1] * log10_life;
  if (!law.limit) return unlimited;
  // Logarithms of stresses: beyond some hundred decades there is none.
  if (std::isnan(unlimited)) return unlimited;
  if (std::abs(unlimited) > most_decades) return std::copysign(infinity, unlimited);
  // The limit increases the allowable stress: at least that without a limit, at most that plus the
  // limit of nearly the strongest item.
  const double at = std::log10(life);
  const auto excess = [&](double log10_reversed) {
    const auto y =
        log_probability_and_slopes(limited_life(law, x, log10_reversed), Outcome::runout, at, 0);
    return reliability - std::exp(y.value);
  };
  const int i = law.limit_index();
  const double high = std::max(unlimited, x[i] + 8 * x[i + 1]) + std::log10(2.0);
  if (std::isnan(high)) return high;
  const double step = std::min(0.5 * (high - unlimited), most_decades);
  const double root = solve_increasing(excess, unlimited + step, step, {.absolute = 1e-9},
                                       -most_decades, most_decades);
  return std::abs(root) == most_decades ? std::copysign(infinity, root) : root;
}

double alternating_allowed(const SnLaw& law, const double* x, const StressLine& line,
                           double log10_reversed) {
  if (log10_reversed == infinity) return infinity;
  const double strength =
      law.has_strength() ? std::pow(10, x[law.strength_index()]) : law.strength.value_or(1);
  const double gamma = law.has_gamma() ? x[law.gamma_index()] : law.gamma.value_or(1);
  return alternating_stress(law.correction, std::pow(10, log10_reversed), line, strength, gamma);
}

}  // namespace wearwell::fatigue
