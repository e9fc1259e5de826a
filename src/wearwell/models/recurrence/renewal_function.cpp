#include "wearwell/models/recurrence/renewal_function.h"

#include <algorithm>
#include <cmath>

#include "wearwell/models/recurrence/process.h"

namespace wearwell::recurrence {
namespace {

constexpr double steps_per_scale = 20, fewest_steps = 100, most_steps = 1000, far_scales = 50;
// The asymptote is within 1 % beyond so many means times 1 + cv^2, if cv is large.
constexpr double far_means = 6;

}  // namespace

RenewalFunction::RenewalFunction(double beta, double eta, double horizon)
    : beta_(beta), eta_(eta), horizon_(horizon) {
  const double mean = std::tgamma(1 + 1 / beta), square = std::tgamma(1 + 2 / beta);
  near_ = std::min(horizon, eta * std::max(far_scales, far_means * square / mean));
  const auto n = static_cast<std::size_t>(
      std::clamp(std::ceil(steps_per_scale * near_ / eta), fewest_steps, most_steps));
  step_ = near_ / static_cast<double>(n);
  std::vector<double> failed(2 * n + 1);  // F at multiples of half a step
  for (std::size_t k = 0; k < failed.size(); ++k)
    failed[k] = -std::expm1(-hazard(0.5 * step_ * static_cast<double>(k)));
  m_.assign(n + 1, 0);
  for (std::size_t i = 1; i <= n; ++i) {
    double sum = failed[2 * i] - failed[1] * m_[i - 1];
    for (std::size_t j = 1; j < i; ++j) sum += failed[2 * (i - j) + 1] * (m_[j] - m_[j - 1]);
    m_[i] = sum / (1 - failed[1]);
  }
}

double RenewalFunction::hazard(double gap) const {
  const double x[] = {beta_, eta_};
  return weibull_hazard(x, gap);
}

double RenewalFunction::asymptote(double t) const {
  const double mean = eta_ * std::tgamma(1 + 1 / beta_);
  const double square = eta_ * eta_ * std::tgamma(1 + 2 / beta_);
  return std::max(0.0, t / mean + 0.5 * square / (mean * mean) - 1);
}

double RenewalFunction::operator()(double t) const {
  if (t > near_) return asymptote(t);
  const double at = std::clamp(t / step_, 0.0, static_cast<double>(m_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(at), m_.size() - 2);
  return std::lerp(m_[i], m_[i + 1], at - static_cast<double>(i));
}

double RenewalFunction::expected(double since_repair) const {
  if (!(since_repair > 0)) return (*this)(horizon_);
  // The first failure ends the current gap; renewals follow it.
  const double now = hazard(since_repair);
  const auto failed = [&](double t) { return -std::expm1(now - hazard(since_repair + t)); };
  constexpr int parts = 400;
  double sum = failed(horizon_), before = 0;
  for (int i = 1; i <= parts; ++i) {
    const double until = failed(horizon_ * i / parts);
    sum += (until - before) * (*this)(horizon_ * (1 - (i - 0.5) / parts));
    before = until;
  }
  return sum;
}

}  // namespace wearwell::recurrence
