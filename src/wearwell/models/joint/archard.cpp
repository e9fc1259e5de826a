#include "wearwell/models/joint/archard.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "wearwell/math/constants.h"
#include "wearwell/math/dual.h"

namespace wearwell::joint {
namespace {

class ArchardLikelihood final : public LogDensity {
 public:
  ArchardLikelihood(const Archard& law, Observations observations, std::vector<double> work)
      : law_(law), observations_(std::move(observations)), work_(std::move(work)) {}

  int dimension() const override { return law_.dimension(); }

  double value(std::span<const double> x) const override { return formula(x.data()); }

  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    return wearwell::value_and_gradient<4>([this](const auto* p) { return formula(p); }, x,
                                           gradient);
  }

  std::vector<double> pointwise(std::span<const double> x) const override {
    return observations_.pointwise(
        [&](std::size_t i) { return law_.mean_volume(x.data(), work_[i]); }, x[1]);
  }

 private:
  template <class T>
  T formula(const T* x) const {
    return observations_.log_likelihood(
        [&](std::size_t i) { return law_.mean_volume(x, work_[i]); }, x[1]);
  }

  Archard law_;
  Observations observations_;
  std::vector<double> work_;
};

// For many inspections with normal scatter and wear that is linear in the work: the likelihood
// depends on the data only through sums, here relative to the least-squares line, to avoid
// cancellation.
//
//   sum (V_i - V0 - k W_i)^2 = R - 2 dk P - 2 dV Q + dk^2 A + 2 dk dV B + n dV^2
class SummedLikelihood final : public LogDensity {
 public:
  SummedLikelihood(const Archard& law, ObservationFamily family, std::vector<double> volume,
                   std::vector<double> work)
      : rows_(law, Observations(family, volume), work),
        constant_(law.has_constant),
        n_(static_cast<double>(work.size())) {
    long double mean_work = 0, mean_volume = 0, across = 0, along = 0;
    for (std::size_t i = 0; constant_ && i < work.size(); ++i) {
      mean_work += work[i] / n_;
      mean_volume += volume[i] / n_;
    }
    for (std::size_t i = 0; i < work.size(); ++i) {
      across += (work[i] - mean_work) * (volume[i] - mean_volume);
      along += (work[i] - mean_work) * (work[i] - mean_work);
    }
    if (along > 0) k_ = static_cast<double>(across / along);
    constant_guess_ = static_cast<double>(mean_volume - k_ * mean_work);
    long double r2 = 0, rw = 0, r = 0, w2 = 0, w1 = 0;
    for (std::size_t i = 0; i < work.size(); ++i) {
      const long double residual = static_cast<long double>(volume[i]) - constant_guess_ -
                                   static_cast<long double>(k_) * work[i],
                        w = work[i];
      r2 += residual * residual;
      rw += residual * w;
      r += residual;
      w2 += w * w;
      w1 += w;
    }
    r2_ = static_cast<double>(r2);
    rw_ = static_cast<double>(rw);
    r_ = static_cast<double>(r);
    w2_ = static_cast<double>(w2);
    w1_ = static_cast<double>(w1);
  }

  int dimension() const override { return rows_.dimension(); }

  double value(std::span<const double> x) const override { return formula(x.data()); }

  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    return wearwell::value_and_gradient<4>([this](const auto* p) { return formula(p); }, x,
                                           gradient);
  }

  std::vector<double> pointwise(std::span<const double> x) const override {
    return rows_.pointwise(x);
  }

 private:
  template <class T>
  T formula(const T* x) const {
    using std::log;
    const T dk = x[0] - k_;
    T squares = r2_ + dk * (dk * w2_ - 2 * rw_);
    if (constant_) {
      const T dv = x[2] - constant_guess_;
      squares += dv * (dv * n_ + 2.0 * (dk * w1_ - r_));
    }
    return -n_ * (log(x[1]) + half_log_two_pi) - 0.5 * squares / (x[1] * x[1]);
  }

  ArchardLikelihood rows_;
  bool constant_;
  double n_, k_ = 0, constant_guess_ = 0, r2_ = 0, rw_ = 0, r_ = 0, w2_ = 0, w1_ = 0;
};

// Few inspections are evaluated one by one.
constexpr std::size_t most_one_by_one = 500;

}  // namespace

double Archard::work_at(const double* x, double limit) const {
  const double worn = limit - (has_constant ? x[2] : 0);
  if (worn <= 0) return 0;
  const double exponent = has_exponent ? x[dimension() - 1] : 1;
  if (!(x[0] > 0) || !(exponent > 0)) return std::numeric_limits<double>::infinity();
  return reference_work * std::pow(worn / (x[0] * reference_work), 1 / exponent);
}

std::shared_ptr<const LogDensity> archard_likelihood(const Archard& law, ObservationFamily family,
                                                     const Inspections& inspections,
                                                     std::size_t count) {
  const auto first = [count](const std::vector<double>& all) {
    return std::vector(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  };
  if (count > most_one_by_one && family == ObservationFamily::normal && !law.has_exponent) {
    return std::make_shared<SummedLikelihood>(law, family, first(inspections.volume),
                                              first(inspections.work));
  }
  return std::make_shared<ArchardLikelihood>(law, Observations(family, first(inspections.volume)),
                                             first(inspections.work));
}

Scores archard_scores(const Archard& law, ObservationFamily family,
                      const Inspections& inspections) {
  return [law, observations = Observations(family, inspections.volume),
          work = inspections.work](const double* x) {
    return observations.scores([&](std::size_t i) { return law.mean_volume(x, work[i]); }, x[1]);
  };
}

LeastSquares least_squares(const Inspections& inspections) {
  const auto& w = inspections.work;
  const auto& v = inspections.volume;
  const double k = std::inner_product(w.begin(), w.end(), v.begin(), 0.0) /
                   std::inner_product(w.begin(), w.end(), w.begin(), 0.0);
  double rss = 0;
  for (std::size_t i = 0; i < w.size(); ++i) rss += std::pow(v[i] - k * w[i], 2);
  return {k, std::sqrt(rss / static_cast<double>(w.size()))};
}

}  // namespace wearwell::joint
