#include "wearwell/infer/model_weights.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "wearwell/base/stop_scope.h"

namespace wearwell {

std::vector<double> model_weights(const std::vector<const Loo*>& models) {
  const auto k = static_cast<Eigen::Index>(models.size());
  if (k == 0) return {};
  const auto n = std::ssize(models.front()->terms);
  Eigen::MatrixXd density(n, k);  // of each observation relative to the largest of all models
  Eigen::VectorXd count(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    double highest = -INFINITY;
    for (const Loo* model : models) {
      if (std::ssize(model->terms) != n || model->terms[at].count != models[0]->terms[at].count)
        throw std::invalid_argument("the models leave out different observations");
      highest = std::max(highest, model->terms[at].elpd);
    }
    // An observation with zero density in all models does not distinguish them.
    for (Eigen::Index j = 0; j < k; ++j)
      density(i, j) = std::isfinite(highest)
                          ? std::exp(models[static_cast<std::size_t>(j)]->terms[at].elpd - highest)
                          : 1;
    count[i] = models[0]->terms[at].count;
  }
  count /= count.sum();
  // The sum is concave. Each EM step increases it; at the maximum no weight has a gain above 1
  // (Kuhn and Tucker), and the largest gain minus 1 bounds the distance to the maximum.
  Eigen::VectorXd weights = Eigen::VectorXd::Constant(k, 1.0 / static_cast<double>(k));
  constexpr double near_enough = 1e-9;
  constexpr int most_steps = 200'000;
  for (int step = 0; step < most_steps; ++step) {
    check_stop();
    const Eigen::VectorXd mixture = density * weights;
    const Eigen::VectorXd gain = density.transpose() * count.cwiseQuotient(mixture);
    weights.array() *= gain.array();
    if (gain.maxCoeff() < 1 + near_enough) break;
  }
  weights /= weights.sum();
  return {weights.begin(), weights.end()};
}

}  // namespace wearwell
