#include "wearwell/models/fatigue/lives_under.h"

#include <cmath>

#include "wearwell/models/fatigue/life.h"

namespace wearwell::fatigue {

LivesUnder::LivesUnder(const SnLaw& law, const WeightedDraws& draws, const Stress& stress)
    : law_(law), draws_(draws), stress_(stress) {
  if (law.limit) return;
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
    const double* x = draws.values.row(i).data();
    center_.push_back(life_center(law, x, law.log10_reversed(x, stress)));
    sigma_.push_back(law.sigma_at(x, center_.back()));
  }
}

std::vector<WeightedValue> LivesUnder::outlasted(double reliability) const {
  const double z = quantile(law_.standard(), 1 - reliability);
  std::vector<WeightedValue> lives;
  lives.reserve(static_cast<std::size_t>(draws_.values.rows()));
  for (Eigen::Index i = 0; i < draws_.values.rows(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double life =
        law_.limit ? life_quantile(law_, draws_.values.row(i).data(), stress_, 1 - reliability)
                   : center_[at] + z * sigma_[at];
    if (std::isnan(life)) return {{life, 1}};
    lives.push_back({life, draws_.weights[i]});
  }
  return lives;
}

}  // namespace wearwell::fatigue
