#include "wearwell/bearing/wear_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "wearwell/base/error.h"
#include "wearwell/bearing/wear_number.h"
#include "wearwell/math/dual.h"

namespace wearwell::bearing {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double half_log_two_pi = 0.91893853320467274178;

double value_of(double x) {
  return x;
}
template <int N>
double value_of(const Dual<N>& x) {
  return x.a;
}

// f(x) where its value and slope are known.
double chain(const HermiteTable::Point& f, double) {
  return f.value;
}
template <int N>
Dual<N> chain(const HermiteTable::Point& f, const Dual<N>& x) {
  return Dual<N>(f.value, f.slope * x.v);
}

// ln k of one inspection for itself; none when there is no wear.
std::optional<double> single_log_k(const Duty& duty, double depth) {
  if (!(depth > 0)) return {};
  const double w = wear_number(duty.contact, duty.clearance / duty.radius, depth / duty.radius);
  return std::log(w / (duty.pressure * duty.revolutions));
}

// The inspections of one bearing.
class Group {
 public:
  /// `log_k` is about where ln k will be.
  Group(ObservationFamily family, const std::vector<DepthLaw>& laws, const Inspections& inspections,
        const std::vector<std::size_t>& rows, double log_k) {
    double sum = 0;
    for (const std::size_t row : rows) {
      const DepthLaw& law = laws[row];
      laws_.push_back(law);
      depths_.push_back(inspections.depth[row]);
      limit_ = std::min(limit_, law.limit());
      const auto own = single_log_k(inspections.duty[row], inspections.depth[row]);
      if (!own) continue;
      const double weight = std::pow(law.depth(Dual<1>(*own, 0)).v[0], 2);
      sum += weight * *own;
      information_ += weight;
    }
    if (information_ > 0) own_log_k_ = sum / information_;
    if (family == ObservationFamily::normal) {
      // Around the bearing's own ln k, where the sum is small and counts.
      constexpr double reach = 6, nodes_per_unit = 512;
      const double center = information_ > 0 ? own_log_k_ : log_k;
      squares_ = HermiteTable(center - reach, std::min(center + reach, limit_), nodes_per_unit,
                              [this](double x) { return sum_of_squares(x); });
    } else {
      observations_.emplace(family, depths_);
    }
  }

  std::size_t size() const { return depths_.size(); }

  /// log of the likelihood of ln k; for the normal family without its factors of sigma.
  template <class T>
  T log_likelihood(const T& log_k, const T& sigma) const {
    if (!(value_of(log_k) <= limit_)) return T(-infinity);
    if (observations_) {
      return observations_->log_likelihood([&](std::size_t i) { return laws_[i].depth(log_k); },
                                           sigma);
    }
    const double x = value_of(log_k);
    const HermiteTable::Point squares = squares_.covers(x) ? squares_(x) : sum_of_squares(x);
    return -0.5 * chain(squares, log_k) / (sigma * sigma);
  }

  /// log of the density of each depth at ln k.
  std::vector<double> pointwise(double log_k, double sigma) const {
    if (!(log_k <= limit_)) return std::vector<double>(size(), -infinity);
    const auto mean = [&](std::size_t i) { return laws_[i].depth(log_k); };
    const ObservationFamily family =
        observations_ ? ObservationFamily::lognormal : ObservationFamily::normal;
    return Observations(family, depths_).pointwise(mean, sigma);
  }

  /// log of the integral over z ~ N(0, 1) of the likelihood of log_k + scatter z.
  template <class T>
  T log_integral(const T& log_k, const T& sigma, const T& scatter) const {
    using std::exp;
    using std::log;
    const Bell bell = find_bell(value_of(log_k), value_of(sigma), value_of(scatter));
    // So far below any posterior the differences that are exponentiated here would be rounding.
    constexpr double lost = -1e9;
    if (!(bell.top > lost)) return T(-infinity);
    T sum(0);
    double top = bell.top;
    const auto add = [&](double z, double weight) {
      constexpr double negligible = -23;  // 1e-10 of the top
      const T above = log_likelihood(T(log_k + scatter * z), sigma) - (0.5 * z * z + top);
      if (!(value_of(above) > negligible)) return false;
      if (value_of(above) > 0) {  // higher than all before
        top += value_of(above);
        sum = sum * std::exp(-value_of(above)) + weight * exp(T(above - value_of(above)));
      } else {
        sum += weight * exp(above);
      }
      return true;
    };
    add(bell.center, bell.step);
    for (const double side : {1.0, -1.0}) {
      double step = bell.step, z = bell.center + side * step;
      for (int n = 1;; ++n) {
        // A bell has ended long before; what goes on is a plateau (depths within the noise of no
        // wear at all), ever flatter.
        const double next = n > 48 && n % 16 == 0 ? 2 * step : step;
        if (!add(z, 0.5 * (step + next))) break;
        step = next;
        z += side * step;
      }
    }
    return log(sum) + (top - 0.5 * std::log(2 * std::numbers::pi));
  }

 private:
  // The integrand over z: its highest node, and the distance of nodes.
  struct Bell {
    double center, step, top;
  };

  // Of the depths about those of ln k, with its slope by ln k.
  HermiteTable::Point sum_of_squares(double log_k) const {
    HermiteTable::Point sum{0, 0};
    for (std::size_t i = 0; i < laws_.size(); ++i) {
      const Dual<1> excess = laws_[i].depth(Dual<1>(log_k, 0)) - depths_[i];
      sum.value += excess.a * excess.a;
      sum.slope += 2 * excess.a * excess.v[0];
    }
    return sum;
  }

  // Starts from the bell as it would be if depths were linear in ln k, and looks for the zero of
  // the slope; steps are halved where the bell is narrower than that.
  Bell find_bell(double log_k, double sigma, double scatter) const {
    constexpr double step_over_width = 0.6;
    constexpr double shortest_edge = 0.35;  // in ln k, of the plateau of depths below the noise
    const auto term = [&](const auto& z) {
      using T = std::decay_t<decltype(z)>;
      return log_likelihood(T(log_k + scatter * z), T(sigma)) - 0.5 * z * z;
    };
    const auto slope = [&](double z) { return term(Dual<1>(z, 0)).v[0]; };
    const double last = (limit_ - log_k) / scatter;
    double curvature = 1 + information_ * std::pow(scatter / sigma, 2);
    Bell bell{(1 - 1 / curvature) * (own_log_k_ - log_k) / scatter, 0, 0};
    // Far from its own ln k a bearing may be likelier to lie near that of all.
    if (term(0.0) > term(bell.center)) bell.center = 0;
    for (int halvings = 0; halvings < 60; ++halvings) {
      bell.step = std::min(step_over_width / std::sqrt(curvature), shortest_edge / scatter);
      double low = -infinity, high = last, reach = bell.step;
      if (!(bell.center < last)) bell.center = last - bell.step;
      for (int i = 0; i < 200; ++i) {
        const double rise = slope(bell.center);
        (rise > 0 ? low : high) = bell.center;
        double next = bell.center + rise / curvature;
        if (std::abs(next - bell.center) < 0.1 * bell.step) break;
        // Newton's step first, then safe ones.
        if (i >= 4 || !(next > low && next < high)) {
          next = std::isinf(low)    ? high - (reach *= 2)
                 : std::isinf(high) ? low + (reach *= 2)
                                    : 0.5 * (low + high);
        }
        bell.center = next;
        if (high - low < 0.1 * bell.step) break;
      }
      bell.top = term(bell.center);
      double above = term(bell.center + bell.step), below = term(bell.center - bell.step);
      // Where the curvature was far from the guess, the slope was small before the top.
      for (double stride = bell.step; above > bell.top || below > bell.top;) {
        const double to = bell.center + (above > below ? stride : -stride);
        const double there = term(to);
        if (there > bell.top) {
          bell = {to, bell.step, there};
          stride *= 2;
        } else {
          stride = bell.step;
          above = term(bell.center + stride);
          below = term(bell.center - stride);
        }
      }
      if (!(above + below - 2 * bell.top < -1.5 * step_over_width * step_over_width)) break;
      curvature *= 4;
    }
    return bell;
  }

  std::vector<DepthLaw> laws_;
  std::vector<double> depths_;
  HermiteTable squares_;                      // the sum of squares by ln k, for the normal family:
                                              // the only way in which k enters, at any sigma
  std::optional<Observations> observations_;  // for the lognormal
  double limit_ = infinity;
  double own_log_k_ = 0;    // the bearing's ln k by its own depths
  double information_ = 0;  // sum of (d depth/d ln k)^2, m^2
};

class WearLikelihood final : public LogDensity {
 public:
  WearLikelihood(const WearModel& model, std::vector<Group> groups)
      : model_(model), groups_(std::move(groups)) {}

  int dimension() const override { return model_.dimension(); }

  double value(std::span<const double> x) const override { return formula(x.data()); }

  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    return wearwell::value_and_gradient<3>([this](const auto* p) { return formula(p); }, x,
                                           gradient);
  }

  // Of bearings where they differ, else of inspections.
  std::vector<double> pointwise(std::span<const double> x) const override {
    const double log_k = std::log(x[0]), sigma = model_.sigma(x.data());
    if (!model_.has_scatter) return groups_.front().pointwise(log_k, sigma);
    const double log_scale =
        model_.family == ObservationFamily::normal ? std::log(sigma) + half_log_two_pi : 0;
    std::vector<double> terms;
    for (const Group& group : groups_) {
      terms.push_back(group.log_integral(log_k, sigma, model_.scatter(x.data())) -
                      static_cast<double>(group.size()) * log_scale);
    }
    return terms;
  }

 private:
  template <class T>
  T formula(const T* x) const {
    using std::log;
    const T log_k = log(x[0]);
    const T sigma = model_.depth_error ? T(*model_.depth_error) : x[1];
    T sum(0);
    std::size_t count = 0;
    for (const Group& group : groups_) {
      count += group.size();
      sum += model_.has_scatter ? group.log_integral(log_k, sigma, x[model_.dimension() - 1])
                                : group.log_likelihood(log_k, sigma);
      if (value_of(sum) == -infinity) return sum;
    }
    if (model_.family == ObservationFamily::normal) {
      sum -= static_cast<double>(count) * (log(sigma) + half_log_two_pi);
    }
    return sum;
  }

  WearModel model_;
  std::vector<Group> groups_;
};

}  // namespace

std::shared_ptr<const LogDensity> wear_likelihood(const WearModel& model,
                                                  const Inspections& inspections,
                                                  std::size_t count) {
  const double k = guess(inspections).k;
  const std::vector<DepthLaw> laws = depth_laws(inspections.duty, k);
  std::vector<std::vector<std::size_t>> rows;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t group = model.has_scatter ? inspections.bearing[i] : 0;
    rows.resize(std::max(rows.size(), group + 1));
    rows[group].push_back(i);
  }
  std::vector<Group> groups;
  for (const auto& each : rows) {
    if (!each.empty()) groups.emplace_back(model.family, laws, inspections, each, std::log(k));
  }
  return std::make_shared<WearLikelihood>(model, std::move(groups));
}

WearGuess guess(const Inspections& inspections) {
  double wear = 0, loading = 0, log_sum = 0, log_squares = 0, n = 0;
  for (std::size_t i = 0; i < inspections.depth.size(); ++i) {
    const Duty& duty = inspections.duty[i];
    const auto log_k = single_log_k(duty, inspections.depth[i]);
    if (!log_k) continue;
    const double here = duty.pressure * duty.revolutions;
    wear += std::exp(*log_k) * here;
    loading += here;
    log_sum += *log_k;
    log_squares += *log_k * *log_k;
    ++n;
  }
  if (n == 0) throw InputError("no measured depth is positive; there is no wear to learn from");
  WearGuess result{wear / loading, 0, 0};
  result.scatter = std::sqrt(std::max(0.0, log_squares / n - std::pow(log_sum / n, 2)));
  const std::vector<DepthLaw> laws = depth_laws(inspections.duty, result.k);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const double log_k = std::min(std::log(result.k), laws[i].limit());
    result.sigma += std::pow(inspections.depth[i] - laws[i].depth(log_k), 2);
  }
  result.sigma = std::sqrt(result.sigma / static_cast<double>(laws.size()));
  return result;
}

}  // namespace wearwell::bearing
