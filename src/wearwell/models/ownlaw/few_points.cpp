#include "wearwell/models/ownlaw/few_points.h"

#include <algorithm>
#include <numeric>

#include "wearwell/predict/prediction.h"

namespace wearwell::ownlaw {

FewPoints::FewPoints(const WeightedDraws& draws, std::size_t most) {
  const DominantDraws dominant(draws);
  const std::size_t n = dominant.rows.size();
  std::vector<std::size_t> chosen(n);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  weights = dominant.weights;
  if (n > most) {
    // In the order in which the quadrature has them neighbours are alike.
    std::sort(chosen.begin(), chosen.end(),
              [&](std::size_t a, std::size_t b) { return dominant.rows[a] < dominant.rows[b]; });
    std::vector<std::size_t> few;
    double sum = 0;
    const double share = 1 / static_cast<double>(most);
    for (const std::size_t each : chosen) {
      sum += dominant.weights[each];
      while (few.size() < most && sum > (static_cast<double>(few.size()) + 0.5) * share) {
        few.push_back(each);
      }
    }
    chosen = few;
    weights.assign(few.size(), 1 / static_cast<double>(few.size()));
  }
  values.resize(static_cast<Eigen::Index>(chosen.size()), draws.values.cols());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    values.row(static_cast<Eigen::Index>(i)) = draws.values.row(dominant.rows[chosen[i]]);
  }
}

}  // namespace wearwell::ownlaw
