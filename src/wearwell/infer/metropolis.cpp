#include "wearwell/infer/metropolis.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// The covariance of a window of the walk.
class Window {
 public:
  explicit Window(Eigen::Index dimension)
      : mean_(Eigen::VectorXd::Zero(dimension)),
        squares_(Eigen::MatrixXd::Zero(dimension, dimension)) {}

  void add(const Eigen::VectorXd& u, bool moved) {
    ++count_;
    moves_ += moved;
    const Eigen::VectorXd delta = u - mean_;
    mean_ += delta / count_;
    squares_ += delta * (u - mean_).transpose();
  }

  /// A walk without enough movement gives no directions.
  bool tells() const { return moves_ >= 10 * mean_.size(); }

  /// The Cholesky factor, shrunk towards a small multiple of the identity as in NUTS.
  Eigen::MatrixXd factor() const {
    const Eigen::Index d = mean_.size();
    const Eigen::MatrixXd covariance = squares_ / (count_ - 1) * (count_ / (count_ + 5)) +
                                       1e-3 * (5 / (count_ + 5)) * Eigen::MatrixXd::Identity(d, d);
    return covariance.llt().matrixL();
  }

 private:
  double count_ = 0;
  Eigen::Index moves_ = 0;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd squares_;
};

// The length and directions of steps, adapted in warm-up.
class Steps {
 public:
  Steps(Eigen::Index dimension, int warmup)
      : warmup_(warmup),
        factor_(Eigen::MatrixXd::Identity(dimension, dimension)),
        window_(dimension),
        z_(dimension) {
    restart();
  }

  void propose(const Eigen::VectorXd& u, Rng& rng, Eigen::VectorXd& proposal) {
    for (double& each : z_) each = rng.normal();
    proposal = u;
    proposal.noalias() += std::exp(log_length_) * factor_.lazyProduct(z_);
  }

  /// After warm-up iteration i, counted from 0.
  void adapt(int i, const Eigen::VectorXd& u, bool accepted) {
    constexpr double target = 0.35;
    // Robbins-Monro with decreasing steps.
    log_length_ += (accepted - target) / std::sqrt(++count_);
    if (i >= warmup_ / 8 && i < warmup_ / 2) window_.add(u, accepted);
    if (i + 1 == warmup_ / 4 || i + 1 == warmup_ / 2) {
      if (window_.tells()) {
        factor_ = window_.factor();
        restart();
      }
      window_ = Window(u.size());
    }
    // Keeps the average over the last quarter.
    const int first = warmup_ - warmup_ / 4;
    if (i >= first) log_length_sum_ += log_length_;
    if (i + 1 == warmup_ && first < warmup_) log_length_ = log_length_sum_ / (warmup_ - first);
  }

  double length() const { return std::exp(log_length_); }

 private:
  void restart() {
    log_length_ = std::log(2.38 / std::sqrt(static_cast<double>(z_.size())));
    count_ = 0;
  }

  int warmup_;
  Eigen::MatrixXd factor_;
  Window window_;
  Eigen::VectorXd z_;
  double log_length_ = 0, log_length_sum_ = 0;
  double count_ = 0;
};

}  // namespace

Chain metropolis_chain(const Posterior& posterior, const Eigen::VectorXd& start,
                       const Eigen::VectorXd& half_width, const RunSettings& settings, Rng& rng) {
  const Eigen::Index d = start.size();
  Eigen::VectorXd x = start, proposal(d);
  double log_density = posterior.natural_value(view(x));
  // The reported density of a draw includes the Jacobian, as for all other methods.
  const auto on_real_line = [&] { return posterior.value(view(posterior.to_real(view(x)))); };
  double reported = on_real_line();
  long accepted = 0;

  Chain chain;
  chain.values.resize(settings.draws, d);
  chain.log_density.reserve(static_cast<std::size_t>(settings.draws));
  ProgressSteps steps(settings.progress);
  bool moved = true;
  for (int i = -settings.warmup; i < settings.draws; ++i) {
    steps.step();
    for (Eigen::Index j = 0; j < d; ++j) {
      proposal[j] = x[j] + half_width[j] * rng.uniform(-1, 1);
    }
    const double proposed = posterior.natural_value(view(proposal));
    const bool accept = std::log(rng.uniform()) < proposed - log_density;
    if (accept) {
      x = proposal;
      log_density = proposed;
      moved = true;
    }
    if (i < 0) continue;
    accepted += accept;
    if (moved) reported = on_real_line();
    moved = false;
    chain.values.row(i) = x;
    chain.log_density.push_back(reported);
  }
  chain.accept_rate = static_cast<double>(accepted) / settings.draws;
  for (Eigen::Index j = 0; j < d; ++j) {
    const Parameter& parameter = posterior.parameters()[static_cast<std::size_t>(j)];
    chain.notes.push_back(fmt::format("Half width of {} = {:.6g} {}", parameter.name,
                                      half_width[j] / parameter.unit.scale, parameter.unit.text));
  }
  return chain;
}

Chain whitened_metropolis_chain(const Posterior& posterior, const Whitening& whitening,
                                const Eigen::VectorXd& start, const RunSettings& settings,
                                Rng& rng) {
  const WhitenedDensity density(posterior, whitening);
  const Eigen::Index d = start.size();
  Eigen::VectorXd u = start, proposal(d), x(d);
  double log_density = density.value(view(u));
  Steps steps(d, settings.warmup);
  long accepted = 0;

  Chain chain;
  chain.values.resize(settings.draws, d);
  chain.log_density.reserve(static_cast<std::size_t>(settings.draws));
  ProgressSteps progress(settings.progress);
  for (int i = -settings.warmup; i < settings.draws; ++i) {
    progress.step();
    steps.propose(u, rng, proposal);
    const double proposed = density.value(view(proposal));
    const bool accept = std::log(rng.uniform()) < proposed - log_density;
    if (accept) {
      u = proposal;
      log_density = proposed;
    }
    if (i < 0) {
      steps.adapt(i + settings.warmup, u, accept);
      continue;
    }
    accepted += accept;
    if (accept || i == 0) posterior.to_natural(view(whitening(u)), view(x));
    chain.values.row(i) = x;
    chain.log_density.push_back(log_density);
  }
  chain.accept_rate = static_cast<double>(accepted) / settings.draws;
  chain.notes.push_back(fmt::format(
      "Normal proposals along the posterior, {:.6g} of its widths long", steps.length()));
  return chain;
}

}  // namespace wearwell
