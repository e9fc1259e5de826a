#include "wearwell/prognosis/reweighted.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <span>

#include "wearwell/math/constants.h"

namespace wearwell::prognosis {
namespace {

double effective_of(const Eigen::VectorXd& weights) {
  return 1 / weights.squaredNorm();
}

}  // namespace

Reweighted reweighted(const WeightedDraws& draws, const Posterior& before, const Posterior& after) {
  const Eigen::Index n = draws.values.rows();
  const auto d = static_cast<std::size_t>(draws.values.cols());
  Eigen::VectorXd log_ratio = Eigen::VectorXd::Constant(n, -infinity);
  tbb::parallel_for(Eigen::Index{0}, n, [&](Eigen::Index i) {
    if (!(draws.weights[i] > 0) && !(draws.cell_weight(i) > 0)) return;
    const std::span<const double> x(draws.values.row(i).data(), d);
    const double was = before.natural_value(x), is = after.natural_value(x);
    if (std::isfinite(was) && std::isfinite(is)) log_ratio[i] = is - was;
  });
  const double highest = log_ratio.maxCoeff();
  Reweighted moved{draws};
  if (!std::isfinite(highest)) return moved;
  const Eigen::VectorXd ratio = (log_ratio.array() - highest).exp();
  moved.draws.weights = draws.weights.cwiseProduct(ratio);
  moved.draws.weights /= moved.draws.weights.sum();
  if (draws.has_cells()) {
    moved.draws.cells.mass = draws.cells.mass.cwiseProduct(ratio.head(draws.cells.mass.size()));
    moved.draws.cells.mass /= moved.draws.cells.mass.sum();
  }
  moved.effective = effective_of(moved.draws.weights);
  moved.kept = moved.effective / effective_of(draws.weights);
  return moved;
}

bool resolves(const Reweighted& moved) {
  constexpr double least_kept = 0.2, least = 400;
  return moved.kept >= least_kept && moved.effective >= least;
}

}  // namespace wearwell::prognosis
