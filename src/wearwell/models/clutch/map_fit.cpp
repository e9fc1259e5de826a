#include "wearwell/models/clutch/map_fit.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "wearwell/base/rng.h"
#include "wearwell/infer/loo.h"

namespace wearwell::clutch {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index draws_judged = 400;
constexpr std::uint64_t seed = 20261128;

// With X over sd = Q R, the coefficients of (Q'w/sd + z) are draws for standard normal z.
WeightedDraws coefficient_draws(const WearPoints& points, const MatrixXd& x, const VectorXd& sd) {
  const Eigen::HouseholderQR<MatrixXd> qr(sd.cwiseInverse().asDiagonal() * x);
  const VectorXd w = points.w.cwiseQuotient(sd);
  const VectorXd mean = (qr.householderQ().adjoint() * w).head(x.cols());
  const auto r = qr.matrixQR().topRows(x.cols()).triangularView<Eigen::Upper>();
  WeightedDraws draws;
  draws.values.resize(draws_judged, x.cols());
  draws.weights.setConstant(draws_judged, 1.0 / draws_judged);
  Rng rng(seed, 0);
  for (Index s = 0; s < draws_judged; ++s) {
    VectorXd drawn = mean;
    for (double& each : drawn) each += rng.normal();
    draws.values.row(s) = r.solve(drawn).transpose();
  }
  return draws;
}

// A copy of a block has the same wear rate before compensation. Digits beyond these are of the division by the factor.
double as_measured(const WearPoints& points, Index j) {
  constexpr double digits = 1e10;
  const double factor = points.factor.size() == 0 ? 1 : points.factor[j];
  const double w = points.w[j] * factor / mm3_per_MJ;
  if (!(std::abs(w) > 0)) return w;
  const double last = std::pow(10, std::floor(std::log10(std::abs(w)))) / digits;
  return std::round(w / last) * last;
}

FitData fit_data(const WearPoints& points, const MatrixXd& x, const VectorXd& sd) {
  const VectorXd w = points.w;
  const auto at = [x](const double* b) -> VectorXd {
    return x * Eigen::Map<const VectorXd>(b, x.cols());
  };
  FitData data;
  data.noun = "point";
  data.scores = [=](const double* b) {
    const VectorXd z = (w - at(b)).cwiseQuotient(sd);
    std::vector<NormalScore> scores;
    for (const double each : z) scores.push_back({each, each});
    return scores;
  };
  data.fitted = [=](const double* b) {
    const VectorXd mean = at(b);
    return std::vector<double>(mean.begin(), mean.end());
  };
  for (const Input& input : inputs) {
    Driver driver{input.name, {}};
    for (const OperatingPoint& each : points.at) driver.value.push_back(each.*input.value);
    data.drivers.push_back(driver);
  }
  if (!points.plate.empty()) {
    Label label{"plate", {}};
    for (const int plate : points.plate) label.level.push_back(static_cast<std::size_t>(plate));
    data.labels = {label};
  }
  for (Index j = 0; j < points.size(); ++j) {
    data.measured.value.push_back(as_measured(points, j));
    data.measured.unit.push_back(mm3_per_MJ);
  }
  data.measured.log_density = [sd, factor = points.factor, scores = data.scores](const double* b) {
    std::vector<double> log_density;
    for (const NormalScore& each : scores(b)) {
      const Index row = std::ssize(log_density);
      const double of_row = sd[row] * (factor.size() == 0 ? 1 : factor[row]);
      log_density.push_back(-0.5 * each.low * each.low -
                            std::log(of_row * std::sqrt(2 * std::numbers::pi)));
    }
    return log_density;
  };
  data.remedies.scatter =
      "None of the formulas of sigma_w follows the scatter of these points; intervals rest on it. "
      "Look at the points where residuals are largest, and at how they were weighed.";
  data.remedies.heavy_tails =
      "Look at the normal probability plot, and at the traces and weighings of the points at its "
      "ends; intervals rest on normal scatter.";
  return data;
}

}  // namespace

FitOutcome judge_map(const WearPoints& points, const WearMap& map, const ScatterLaw& scatter) {
  const VectorXd sd = point_sd(scatter, points, map.fit.fitted);
  const MatrixXd x = map.design.columns(Eigen::all, map.terms);
  FitOutcome outcome = judge_fit(fit_data(points, x, sd), coefficient_draws(points, x, sd), Loo{});
  // A point goes by its number in the design, not by its row.
  const auto farthest =
      std::max_element(outcome.residuals.begin(), outcome.residuals.end(),
                       [](double a, double b) { return std::abs(a) < std::abs(b); });
  for (FitTest& test : outcome.tests) {
    // The search omits terms that do not improve predictions, even if the residuals show them: the check `wear map`
    // judges whether predictions suffice.
    test.may_fail = !test.name.starts_with("trend") && !test.name.starts_with("order");
    if (test.name == "extreme residual")
      test.finding = fmt::format(
          "point {} lies farther out than the others let expect",
          points.number[static_cast<std::size_t>(farthest - outcome.residuals.begin())]);
  }
  return outcome;
}

}  // namespace wearwell::clutch
