#include "wearwell/infer/warmup.h"

#include <algorithm>
#include <cmath>

namespace wearwell {

void DualAveraging::restart(double step_size) {
  mu_ = std::log(10 * step_size);
  error_ = log_average_ = 0;
  count_ = 0;
}

double DualAveraging::update(double accept_stat) {
  constexpr double gamma = 0.05, kappa = 0.75, t0 = 10;
  ++count_;
  const double eta = 1 / (count_ + t0);
  error_ = (1 - eta) * error_ + eta * (target_ - std::min(1.0, accept_stat));
  const double log_step = mu_ - std::sqrt(count_) / gamma * error_;
  const double weight = std::pow(count_, -kappa);
  log_average_ = (1 - weight) * log_average_ + weight * log_step;
  return std::exp(log_step);
}

double DualAveraging::adapted() const {
  return std::exp(log_average_);
}

template <int N>
WindowedWarmup<N>::WindowedWarmup(int iterations, double target_accept)
    : initial_(75), last_(50), window_(25), iterations_(iterations), step_size_(target_accept) {
  // Stan's proportions if the usual windows do not fit.
  if (iterations < initial_ + last_ + window_) {
    initial_ = static_cast<int>(0.15 * iterations);
    last_ = static_cast<int>(0.1 * iterations);
    window_ = iterations - initial_ - last_;
  }
  window_end_ = initial_ + window_;
}

template <int N>
void WindowedWarmup<N>::adapt(int iteration, const NutsStep& step, Nuts<N>& nuts, Rng& rng) {
  if (!started_) {
    step_size_.restart(nuts.step_size);
    started_ = true;
  }
  nuts.step_size = step_size_.update(step.accept_stat);
  if (iteration < initial_ || iteration >= iterations_ - last_) return;

  const SmallVector<N> x = nuts.point().position;
  if (count_ == 0) {
    mean_.setZero(x.size());
    squares_.setZero(x.size(), x.size());
  }
  ++count_;
  const SmallVector<N> delta = x - mean_;
  mean_ += delta / static_cast<double>(count_);
  squares_ += delta * (x - mean_).transpose();
  if (iteration + 1 < window_end_ || count_ < 2) return;

  // Shrunk towards a small multiple of the identity, as Stan does.
  const auto n = static_cast<double>(count_);
  const SmallMatrix<N> covariance =
      squares_ / (n - 1) * (n / (n + 5)) +
      1e-3 * (5 / (n + 5)) * SmallMatrix<N>::Identity(x.size(), x.size());
  if (nuts.metric.dense()) {
    nuts.metric.set_covariance(covariance);
  } else {
    nuts.metric.set_variances(covariance.diagonal());
  }
  nuts.find_reasonable_step_size(rng);
  step_size_.restart(nuts.step_size);

  // The next window is twice as long, and includes a remainder that is too short for another
  // window.
  count_ = 0;
  window_ *= 2;
  const int slow_end = iterations_ - last_;
  window_end_ += window_;
  if (window_end_ + 2 * window_ > slow_end) window_end_ = slow_end;
}

template class WindowedWarmup<1>;
template class WindowedWarmup<2>;
template class WindowedWarmup<3>;
template class WindowedWarmup<4>;
template class WindowedWarmup<Eigen::Dynamic>;

}  // namespace wearwell
