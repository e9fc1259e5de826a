#include "wearwell/models/fatigue/lives_under.h"

#include <cmath>

#include "wearwell/models/fatigue/life.h"
#include "wearwell/models/fatigue/reversed_at.h"
#include "wearwell/prognosis/weighted_quantiles.h"
#include "wearwell/study/plot_study.h"

namespace wearwell::fatigue {

WeightedDraws curve_nodes(const SnLaw& law, const WeightedDraws& posterior,
                          Eigen::Index most_with_limit) {
  constexpr double gathered_share = 3e-7;
  return law.integrated() ? thinned(posterior, most_with_limit)
                          : gathered(posterior, gathered_share);
}

LivesUnder::LivesUnder(const SnLaw& law, const WeightedDraws& draws, const Stress& stress)
    : law_(law), draws_(draws), stress_(stress) {
  if (law.limit) return;
  ReversedAt reversed(law, stress);
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
    const double* x = draws.values.row(i).data();
    center_.push_back(life_center(law, x, reversed(x)));
    sigma_.push_back(law.sigma_at(x, center_.back()));
  }
}

std::vector<double> LivesUnder::at_points(double reliability) const {
  const double z = quantile(law_.standard(), 1 - reliability);
  std::vector<double> lives;
  lives.reserve(static_cast<std::size_t>(draws_.values.rows()));
  for (Eigen::Index i = 0; i < draws_.values.rows(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    lives.push_back(law_.limit
                        ? life_quantile(law_, draws_.values.row(i).data(), stress_, 1 - reliability)
                        : center_[at] + z * sigma_[at]);
  }
  return lives;
}

std::vector<double> LivesUnder::outlasted(double reliability,
                                          std::span<const double> levels) const {
  const std::vector<double> lives = at_points(reliability);
  for (const double life : lives) {
    if (std::isnan(life)) return std::vector<double>(levels.size(), life);
  }
  return prognosis::weighted_quantiles(
      lives, {draws_.weights.data(), static_cast<std::size_t>(draws_.weights.size())}, levels);
}

}  // namespace wearwell::fatigue
