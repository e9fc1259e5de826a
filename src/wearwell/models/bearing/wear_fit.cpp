#include "wearwell/models/bearing/wear_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "wearwell/base/error.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/dual.h"
#include "wearwell/models/bearing/inspected.h"
#include "wearwell/models/bearing/rate_integral.h"

namespace wearwell::bearing {
namespace {

// log of the integral over the rates of one bearing, for the scalars of a formula.
double scattered(const Inspected& bearing, double log_k, double sigma, double scatter) {
  return log_rate_integral(bearing, log_k, sigma, scatter).value;
}
template <int N>
Dual<N> scattered(const Inspected& bearing, const Dual<N>& log_k, const Dual<N>& sigma,
                  const Dual<N>& scatter) {
  const RateIntegral log_l = log_rate_integral(bearing, log_k.a, sigma.a, scatter.a);
  return Dual<N>(log_l.value, log_l.by_log_k * log_k.v + log_l.by_sigma * sigma.v +
                                  log_l.by_scatter * scatter.v);
}

double alike(const Inspected& bearing, double log_k, double sigma) {
  return bearing.at(log_k, sigma).value;
}
template <int N>
Dual<N> alike(const Inspected& bearing, const Dual<N>& log_k, const Dual<N>& sigma) {
  const Inspected::Point log_l = bearing.at(log_k.a, sigma.a);
  return Dual<N>(log_l.value, log_l.by_log_k * log_k.v + log_l.by_sigma * sigma.v);
}

class WearLikelihood final : public LogDensity {
 public:
  WearLikelihood(const WearModel& model, std::vector<Inspected> groups)
      : model_(model), groups_(std::move(groups)) {}

  int dimension() const override { return model_.dimension(); }

  double value(std::span<const double> x) const override { return formula(x.data()); }

  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    return wearwell::value_and_gradient<3>([this](const auto* p) { return formula(p); }, x,
                                           gradient);
  }

  // By bearing if they vary, else by inspection.
  std::vector<double> pointwise(std::span<const double> x) const override {
    const double log_k = std::log(x[0]), sigma = model_.sigma(x.data());
    if (!model_.has_scatter) return groups_.front().pointwise(log_k, sigma);
    const double log_scale =
        model_.family == ObservationFamily::normal ? std::log(sigma) + half_log_two_pi : 0;
    std::vector<double> terms;
    for (const Inspected& group : groups_) {
      terms.push_back(scattered(group, log_k, sigma, model_.scatter(x.data())) -
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
    for (const Inspected& group : groups_) {
      count += group.size();
      sum += model_.has_scatter ? scattered(group, log_k, sigma, x[model_.dimension() - 1])
                                : alike(group, log_k, sigma);
      if (scalar(sum) == -infinity) return sum;
    }
    if (model_.family == ObservationFamily::normal) {
      sum -= static_cast<double>(count) * (log(sigma) + half_log_two_pi);
    }
    return sum;
  }

  WearModel model_;
  std::vector<Inspected> groups_;
};

}  // namespace

std::shared_ptr<const LogDensity> wear_likelihood(const WearModel& model,
                                                  const Inspections& inspections,
                                                  std::size_t count) {
  const double k = guess(inspections).k;
  const std::vector<DepthFunction> curves = depth_functions(inspections.duty, k);
  std::vector<std::vector<std::size_t>> rows;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t group = model.has_scatter ? inspections.bearing[i] : 0;
    rows.resize(std::max(rows.size(), group + 1));
    rows[group].push_back(i);
  }
  std::vector<Inspected> groups;
  for (const auto& each : rows) {
    if (each.empty()) continue;
    std::vector<DepthFunction> own_curves;
    std::vector<Duty> duties;
    std::vector<double> depths;
    for (const std::size_t row : each) {
      own_curves.push_back(curves[row]);
      duties.push_back(inspections.duty[row]);
      depths.push_back(inspections.depth[row]);
    }
    groups.emplace_back(model.family, std::move(own_curves), std::move(duties), std::move(depths));
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
  if (n == 0) throw InputError("no measured depth is positive; the data show no wear");
  WearGuess result{wear / loading, 0, 0};
  result.scatter = std::sqrt(std::max(0.0, log_squares / n - std::pow(log_sum / n, 2)));
  const std::vector<DepthFunction> curves = depth_functions(inspections.duty, result.k);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const double log_k = std::min(std::log(result.k), curves[i].limit());
    result.sigma += std::pow(inspections.depth[i] - curves[i].depth(log_k), 2);
  }
  result.sigma = std::sqrt(result.sigma / static_cast<double>(curves.size()));
  return result;
}

}  // namespace wearwell::bearing
