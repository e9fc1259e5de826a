#include "wearwell/infer/independence_sampler.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "wearwell/infer/nuts.h"
#include "wearwell/infer/warmup.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr int most_proposals = 8;  // proposed before each transition
constexpr int deepest = 3;         // tree depth of a transition: at most 7 steps
constexpr int adapting = 100;      // transitions in which steps adapt
constexpr double near_share = 0.6, middle_share = 0.3, middle_factor = 2.5;
constexpr std::uint64_t own_streams = 1ULL << 40;  // streams that NUTS does not use

// Draws per chain for the final mixture, and the width of its widest component. Expensive
// likelihoods use fewer draws and fewer proposals; in a narrow funnel chains may then stay in the
// neck, which the checks report.
struct Manner {
  int learning;
  double wide_scale;
};
constexpr Manner thorough{300, 1.5}, sparing{150, 2.5};

// The number of proposals for which about every second draw moves, at this acceptance rate.
int proposals_for(double share_taken) {
  if (!(share_taken > 0)) return most_proposals;
  const double enough = std::ceil(std::log(0.5) / std::log1p(-share_taken));
  return std::clamp(static_cast<int>(std::min<double>(enough, most_proposals)), 2, most_proposals);
}

// An isotropic multivariate Student distribution. Its degrees of freedom make the density an
// integer power.
class Student {
 public:
  Student(int dimension, int least_freedom, double scale)
      : dimension_(dimension),
        freedom_(least_freedom + (least_freedom + dimension) % 2),
        power_((freedom_ + dimension) / 2),
        scale_(scale),
        factor_(std::exp(std::lgamma(power_) - std::lgamma(0.5 * freedom_) -
                         0.5 * dimension * std::log(freedom_ * M_PI) -
                         dimension * std::log(scale))) {}

  // The sum of its densities at squared distances from its center.
  double density(const Eigen::ArrayXd& squares) const {
    const Eigen::ArrayXd base = (1 + squares / (scale_ * scale_ * freedom_)).inverse();
    Eigen::ArrayXd product = base;
    for (int i = 1; i < power_; ++i) product *= base;
    return factor_ * product.sum();
  }

  void add_draw(Eigen::VectorXd& at, Rng& rng) const {
    double chi_squared = 0;
    for (int i = 0; i < freedom_; ++i) {
      const double z = rng.normal();
      chi_squared += z * z;
    }
    const double stretch = scale_ * std::sqrt(freedom_ / chi_squared);
    for (int i = 0; i < dimension_; ++i) at[i] += stretch * rng.normal();
  }

 private:
  int dimension_, freedom_, power_;
  double scale_, factor_;
};

// The proposal distribution, in the whitened coordinates of the pilot.
class Mixture {
 public:
  // `pilot`: one column per draw.
  Mixture(const Eigen::MatrixXd& pilot, double wide_scale)
      : middles_(thinned(pilot)),
        near_(static_cast<int>(pilot.rows()), 3, width(pilot.rows(), middles_.rows())),
        middle_(static_cast<int>(pilot.rows()), 3,
                middle_factor * width(pilot.rows(), middles_.rows())),
        wide_(static_cast<int>(pilot.rows()), 3, wide_scale) {}

  double log_density(const Eigen::VectorXd& u) const {
    Eigen::ArrayXd squares = (middles_.col(0) - u[0]).square();
    for (Eigen::Index i = 1; i < u.size(); ++i) squares += (middles_.col(i) - u[i]).square();
    const double about =
        near_share * near_.density(squares) + middle_share * middle_.density(squares);
    return std::log(about / static_cast<double>(middles_.rows()) +
                    (1 - near_share - middle_share) *
                        wide_.density(Eigen::ArrayXd::Constant(1, u.squaredNorm())));
  }

  Eigen::VectorXd draw(Rng& rng) const {
    const double which = rng.uniform() - near_share - middle_share;
    Eigen::VectorXd u = Eigen::VectorXd::Zero(middles_.cols());
    if (which >= 0) {
      wide_.add_draw(u, rng);
      return u;
    }
    const auto count = static_cast<double>(middles_.rows());
    u = middles_.row(static_cast<Eigen::Index>(rng.uniform() * count));
    (which < -middle_share ? near_ : middle_).add_draw(u, rng);
    return u;
  }

 private:
  static Eigen::ArrayXXd thinned(const Eigen::MatrixXd& pilot) {
    const Eigen::Index most = std::min<Eigen::Index>(600, pilot.cols());
    Eigen::ArrayXXd some(most, pilot.rows());
    for (Eigen::Index k = 0; k < most; ++k) some.row(k) = pilot.col(k * pilot.cols() / most);
    return some;
  }
  // Somewhat less than optimal for a normal distribution (Scott 1992), because a curved posterior
  // is narrower.
  static double width(Eigen::Index dimension, Eigen::Index count) {
    return 0.85 * std::pow(static_cast<double>(count), -1 / (static_cast<double>(dimension) + 4));
  }

  Eigen::ArrayXXd middles_;  // one row per draw
  Student near_, middle_, wide_;
};

// The Gaussianized real line of each parameter about its center, in units of its width: t = w
// sqrt(1 + (w/2)^2) makes the tail exp(t) of a logarithm (of a quantity that may be 0) normal.
class Bent final : public LogDensity {
 public:
  Bent(const Posterior& posterior, Eigen::VectorXd middle, Eigen::VectorXd width)
      : posterior_(posterior), middle_(std::move(middle)), width_(std::move(width)) {}

  int dimension() const override { return posterior_.dimension(); }
  double value(std::span<const double> w) const override {
    const Eigen::VectorXd z = to_real(w);
    return posterior_.value(view(z)) + log_slope(w);
  }
  double value_above(std::span<const double> w, double least) const override {
    const Eigen::VectorXd z = to_real(w);
    const double slope = log_slope(w);
    return posterior_.value_above(view(z), least - slope) + slope;
  }
  double value_and_gradient(std::span<const double> w, std::span<double> gradient) const override {
    const Eigen::VectorXd z = to_real(w);
    const double value = posterior_.value_and_gradient(view(z), gradient);
    for (std::size_t i = 0; i < w.size(); ++i) {
      const double q = quarter(w[i]);
      gradient[i] = gradient[i] * width_[static_cast<Eigen::Index>(i)] * slope(q) +
                    w[i] / (1 + 2 * q) - 0.25 * w[i] / (1 + q);
    }
    return value + log_slope(w);
  }

  Eigen::VectorXd to_real(std::span<const double> w) const {
    Eigen::VectorXd z = middle_;
    for (std::size_t i = 0; i < w.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      z[at] += width_[at] * w[i] * std::sqrt(1 + quarter(w[i]));
    }
    return z;
  }
  Eigen::VectorXd from_real(const Eigen::VectorXd& z) const {
    Eigen::VectorXd w = (z - middle_).cwiseQuotient(width_);
    for (double& each : w)
      each = std::copysign(std::sqrt(2 * each * each / (1 + std::sqrt(1 + each * each))), each);
    return w;
  }
  // log of the product of the slopes of t.
  static double log_slope(std::span<const double> w) {
    double slopes = 1;
    for (const double each : w) slopes *= slope(quarter(each));
    return std::log(slopes);
  }

 private:
  static double quarter(double w) { return 0.25 * w * w; }
  static double slope(double q) { return (1 + 2 * q) / std::sqrt(1 + q); }

  const Posterior& posterior_;
  Eigen::VectorXd middle_, width_;
};

// Whitened coordinates of earlier draws.
struct Pilot {
  Bent bent;
  Whitening round;                    // of the Gaussianized line
  Eigen::MatrixXd places;             // one column per draw
  std::vector<Eigen::VectorXd> last;  // last draw of each chain
};

Pilot pilot_of(const Posterior& posterior, const Draws& draws) {
  const Eigen::Index length = draws.front().values.rows();
  Eigen::MatrixXd all(posterior.dimension(), length * std::ssize(draws));
  Eigen::Index at = 0;
  for (const Chain& chain : draws) {
    for (Eigen::Index row = 0; row < length; ++row) {
      const Eigen::VectorXd x = chain.values.row(row);
      all.col(at++) = posterior.to_real(view(x));
    }
  }
  const auto count = static_cast<double>(all.cols());
  const Eigen::VectorXd middle = all.rowwise().mean();
  const Eigen::VectorXd width =
      ((all.colwise() - middle).rowwise().squaredNorm() / count).cwiseSqrt();
  Bent bent(posterior, middle, width);
  for (Eigen::Index k = 0; k < all.cols(); ++k) all.col(k) = bent.from_real(all.col(k));
  const Eigen::VectorXd center = all.rowwise().mean();
  all.colwise() -= center;
  const Eigen::MatrixXd covariance = all * all.transpose() / count;
  const Eigen::MatrixXd scale = covariance.llt().matrixL();
  scale.triangularView<Eigen::Lower>().solveInPlace(all);
  std::vector<Eigen::VectorXd> last;
  for (Eigen::Index k = length - 1; k < all.cols(); k += length) last.push_back(all.col(k));
  return {std::move(bent), {center, scale}, std::move(all), std::move(last)};
}

class IndependenceChain {
 public:
  IndependenceChain(const Posterior& posterior, const Pilot& pilot, const Mixture& mixture,
                    const NutsSettings& options, int independence, const Eigen::VectorXd& start,
                    Rng rng)
      : posterior_(posterior),
        pilot_(pilot),
        mixture_(mixture),
        density_(pilot.bent, pilot.round),
        proposals_(independence),
        nuts_(density_, false, std::min(options.max_treedepth, deepest)),
        rng_(rng) {
    nuts_.set_position(start);
    nuts_.find_reasonable_step_size(rng_);
    DualAveraging step(options.target_accept);
    step.restart(nuts_.step_size);
    for (int i = 0; i < adapting; ++i) nuts_.step_size = step.update(transition().accept_stat);
    nuts_.step_size = step.adapted();
  }

  Chain drawn(const RunSettings& settings) {
    ProgressSteps steps(settings.progress);
    Chain chain;
    chain.values.resize(settings.draws, posterior_.dimension());
    chain.step_size = nuts_.step_size;
    taken_ = 0;
    Eigen::VectorXd x(posterior_.dimension());
    double accept = 0;
    for (int i = 0; i < settings.draws; ++i) {
      chain.nuts.push_back(transition());
      accept += chain.nuts.back().accept_stat;
      const Eigen::VectorXd w = pilot_.round(nuts_.point().position);
      const Eigen::VectorXd z = pilot_.bent.to_real(view(w));
      posterior_.to_natural(view(z), view(x));
      chain.values.row(i) = x;
      chain.log_density.push_back(nuts_.point().log_density - Bent::log_slope(view(w)));
      steps.step();
    }
    chain.accept_rate = accept / settings.draws;
    chain.notes.push_back(
        fmt::format("Before each transition {} independence proposals from a mixture about earlier "
                    "draws are made; {:.0f} % are accepted",
                    proposals_, 100 * share_taken(settings)));
    return chain;
  }
  double share_taken(const RunSettings& settings) const {
    return static_cast<double>(taken_) / (proposals_ * settings.draws);
  }

 private:
  NutsStep transition() {
    Eigen::VectorXd at = nuts_.point().position;
    double here = nuts_.point().log_density - mixture_.log_density(at);
    bool moved = false;
    for (int i = 0; i < proposals_; ++i) {
      const Eigen::VectorXd next = mixture_.draw(rng_);
      // Most proposals are rejected; an expensive density can stop as soon as rejection is certain.
      const double proposed = mixture_.log_density(next), least = here + std::log(rng_.uniform());
      const double there = density_.value_above(view(next), least + proposed) - proposed;
      if (!(there > least)) continue;
      at = next;
      here = there;
      moved = true;
      ++taken_;
    }
    if (moved) nuts_.move_to(at);
    return nuts_.step(rng_);
  }

  const Posterior& posterior_;
  const Pilot& pilot_;
  const Mixture& mixture_;
  WhitenedDensity density_;
  int proposals_;
  Nuts<Eigen::Dynamic> nuts_;
  Rng rng_;
  int taken_ = 0;
};

struct IndependenceRun {
  Draws draws;
  double share_taken = 0;  // of the proposals
};

IndependenceRun accepted(const Posterior& posterior, const Pilot& pilot, double wide_scale,
                         const NutsSettings& options, int independence,
                         const RunSettings& settings) {
  const Mixture mixture(pilot.places, wide_scale);
  IndependenceRun all{Draws(pilot.last.size())};
  std::vector<double> shares(all.draws.size());
  tbb::parallel_for(std::size_t{0}, all.draws.size(), [&](std::size_t c) {
    const Rng rng(settings.seed, settings.first_stream + c + own_streams);
    IndependenceChain chain(posterior, pilot, mixture, options, independence, pilot.last[c], rng);
    all.draws[c] = chain.drawn(settings);
    shares[c] = chain.share_taken(settings);
  });
  // The chain with the lowest acceptance determines the number of proposals.
  all.share_taken = *std::min_element(shares.begin(), shares.end());
  return all;
}

}  // namespace

Draws run_independence(const Posterior& posterior, const Draws& pilot, const NutsSettings& nuts,
                       const RunSettings& settings) {
  const bool slow = posterior.likelihood()->is_slow();
  const Manner manner = slow ? sparing : thorough;
  RunSettings few = settings;
  few.draws = manner.learning;
  few.first_stream += own_streams;
  few.progress = nullptr;
  const auto proposal = [&](const Draws& about, int independence, const RunSettings& run) {
    return accepted(posterior, pilot_of(posterior, about), manner.wide_scale, nuts, independence,
                    run);
  };
  const IndependenceRun learned = proposal(pilot, most_proposals, few);
  return proposal(learned.draws, slow ? proposals_for(learned.share_taken) : most_proposals,
                  settings)
      .draws;
}

}  // namespace wearwell
