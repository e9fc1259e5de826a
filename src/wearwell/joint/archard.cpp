#include "wearwell/joint/archard.h"

#include <cmath>
#include <limits>
#include <numeric>

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
