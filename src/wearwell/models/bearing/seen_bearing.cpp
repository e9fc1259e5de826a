#include "wearwell/models/bearing/seen_bearing.h"

#include <cmath>
#include <memory>

#include "wearwell/models/bearing/inspected.h"
#include "wearwell/models/bearing/rate_integral.h"
#include "wearwell/prognosis/weighted_lives.h"

namespace wearwell::bearing {

Inspections inspections_of(const Inspections& all, std::size_t bearing) {
  Inspections own;
  for (std::size_t i = 0; i < all.depth.size(); ++i) {
    if (all.bearing[i] != bearing) continue;
    own.duty.push_back(all.duty[i]);
    own.depth.push_back(all.depth[i]);
    own.bearing.push_back(0);
  }
  return own;
}

double fraction(std::size_t i) {
  constexpr double golden = 0.6180339887498949;
  const double x = golden * static_cast<double>(i);
  return x - std::floor(x);
}

OwnRate own_rate(const WearModel& model, const Inspections& own, double k,
                 const WeightedDraws& posterior) {
  constexpr double step = 0.25;  // of a width
  const DominantDraws dominant(posterior);
  const Inspected inspected(model.family, depth_laws(own.duty, k), own.duty, own.depth);
  OwnRate rate;
  for (std::size_t i = 0; i < dominant.rows.size(); ++i) {
    const double* x = posterior.values.row(dominant.rows[i]).data();
    const double log_k = std::log(x[0]), scatter = model.scatter(x);
    if (!(scatter > 0)) {
      rate.log_k.push_back(log_k);
      rate.weight.push_back(dominant.weights[i]);
      continue;
    }
    const std::vector<RateNode> nodes =
        rate_nodes(inspected, log_k, model.sigma(x), scatter, step, fraction(i));
    double top = -INFINITY, sum = 0;
    for (const RateNode& each : nodes) top = std::max(top, each.log_weight);
    for (const RateNode& each : nodes) sum += std::exp(each.log_weight - top);
    for (const RateNode& each : nodes) {
      rate.log_k.push_back(log_k + scatter * each.z);
      rate.weight.push_back(dominant.weights[i] * std::exp(each.log_weight - top) / sum);
    }
  }
  return rate;
}

double life_at(const GoingOn& bearing, double log_k) {
  const double now = bearing.now.pressure * bearing.now.revolutions;
  const double loading = bearing.wear_number / std::exp(log_k);
  if (loading < now) return bearing.begin * loading / now;
  return bearing.begin + (loading - now) / bearing.pressure * bearing.per_turn;
}

LifeLaw own_life_law(const GoingOn& bearing, const OwnRate& rate) {
  std::vector<double> life;
  life.reserve(rate.log_k.size());
  for (const double log_k : rate.log_k) life.push_back(life_at(bearing, log_k));
  const auto lives = std::make_shared<const prognosis::WeightedLives>(life, rate.weight);
  return {[lives](double at) { return lives->cdf(at); },
          [lives](double p) { return lives->quantile(p); }};
}

}  // namespace wearwell::bearing
