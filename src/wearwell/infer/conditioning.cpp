#include "wearwell/infer/conditioning.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "wearwell/math/view.h"

namespace wearwell {
namespace {

constexpr double fewest_doubles = 1e4;
constexpr double most_noise = 1e-3;

const char* const advice =
    "The data agree with each other, or with the model, to their last digits, so rounding has "
    "removed their scatter. Give more digits, measure from a closer zero point, or state the "
    "scatter.";

// Rounding noise of the log density at `center`, along one direction.
double noise(const Posterior& posterior, const Eigen::VectorXd& center,
             const Eigen::VectorXd& direction) {
  constexpr std::array binomials = {1., -8., 28., -56., 70., -56., 28., -8., 1.};
  constexpr double step = 0.02, sum_of_squares = 12870;  // of the binomials
  double difference = 0;
  for (int i = 0; i < 9; ++i) {
    const Eigen::VectorXd z = center + (i - 4) * step * direction;
    difference += binomials[static_cast<std::size_t>(i)] * posterior.value(view(z));
  }
  return std::abs(difference) / std::sqrt(sum_of_squares);
}

}  // namespace

std::vector<StageDiagnostic> digits(const Posterior& posterior, const Whitening& whitening,
                                    const WeightedDraws& points) {
  std::vector<StageDiagnostic> found;
  const Eigen::RowVectorXd mean = points.weights.transpose() * points.values;
  const Eigen::RowVectorXd variance =
      points.weights.transpose() * (points.values.rowwise() - mean).cwiseAbs2();
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    const double doubles =
        std::sqrt(variance[i]) / (std::numeric_limits<double>::epsilon() * std::abs(mean[i]));
    if (!(doubles < fewest_doubles)) continue;
    found.push_back(
        {Stage::digits, Verdict::fail,
         fmt::format("{} is known to a relative {:.2g}, which double precision does not resolve",
                     posterior.parameters()[static_cast<std::size_t>(i)].name,
                     std::sqrt(variance[i]) / std::abs(mean[i])),
         advice});
  }
  double loudest = 0;
  for (Eigen::Index a = 0; a < whitening.scale.cols(); ++a) {
    const double here = noise(posterior, whitening.center, whitening.scale.col(a));
    if (std::isfinite(here)) loudest = std::max(loudest, here);
  }
  if (loudest > most_noise) {
    found.push_back({Stage::digits, Verdict::fail,
                     fmt::format("rounding errors change the log density by {:.2g}", loudest),
                     advice});
  }
  return found;
}

}  // namespace wearwell
