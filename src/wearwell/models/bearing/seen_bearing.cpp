#include "wearwell/models/bearing/seen_bearing.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "wearwell/math/constants.h"
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

std::size_t last_inspection(const Inspections& all, std::size_t bearing) {
  std::size_t last = all.bearing.size();
  for (std::size_t i = 0; i < all.bearing.size(); ++i) {
    if (all.bearing[i] != bearing) continue;
    if (last == all.bearing.size() || all.duty[i].revolutions >= all.duty[last].revolutions)
      last = i;
  }
  return last;
}

namespace {

// One point of the posterior, over the integral of the bearing's rows at it.
struct Share {
  double log_k, sigma, scatter, weight, log_integral, from, to;
};

Share share_of(const Inspected& inspected, const WearModel& model, const double* x, double weight) {
  // of a width; log of the omitted part relative to the maximum
  constexpr double step = 0.8, tail = -20;
  Share share{std::log(x[0]), model.sigma(x), model.scatter(x), weight, 0, 0, 0};
  const std::vector<RateNode> nodes =
      rate_nodes(inspected, share.log_k, share.sigma, share.scatter, step);
  double top = -INFINITY, sum = 0;
  for (const RateNode& each : nodes) top = std::max(top, each.log_weight);
  share.from = INFINITY, share.to = -INFINITY;
  for (const RateNode& each : nodes) {
    sum += std::exp(each.log_weight - top);
    if (each.log_weight < top + tail) continue;
    share.from = std::min(share.from, share.log_k + share.scatter * each.z);
    share.to = std::max(share.to, share.log_k + share.scatter * each.z);
  }
  share.log_integral = top + std::log(sum);
  if (nodes.empty()) share.weight = 0;
  return share;
}

// Adds the density of ln k at one point, at even places.
void add_share(const Share& share, const Inspected& inspected, double first, double step,
               std::vector<double>& density) {
  const double before =
      std::log(share.weight * step / share.scatter) - share.log_integral - half_log_two_pi;
  const auto begin =
      static_cast<std::size_t>(std::max(0.0, std::ceil((share.from - first) / step)));
  for (std::size_t n = begin; n < density.size(); ++n) {
    const double u = first + static_cast<double>(n) * step;
    if (u > share.to) break;
    const double z = (u - share.log_k) / share.scatter;
    density[n] += std::exp(before + inspected.at(u, share.sigma).value - 0.5 * z * z);
  }
}

}  // namespace

BearingRate bearing_rate(const WearModel& model, const Inspections& own, double k,
                         const WeightedDraws& posterior) {
  constexpr std::size_t places = 600;
  const DominantDraws dominant(posterior);
  BearingRate rate;
  if (!model.has_scatter) {
    for (const Eigen::Index row : dominant.rows)
      rate.log_k.push_back(std::log(posterior.values(row, 0)));
    rate.weight = dominant.weights;
    return rate;
  }
  const Inspected inspected(model.family, depth_functions(own.duty, k), own.duty, own.depth);
  std::vector<Share> shares;
  double from = INFINITY, to = -INFINITY;
  for (std::size_t i = 0; i < dominant.rows.size(); ++i) {
    const double* x = posterior.values.row(dominant.rows[i]).data();
    const Share share = share_of(inspected, model, x, dominant.weights[i]);
    if (!(share.weight > 0)) continue;
    shares.push_back(share);
    from = std::min(from, share.from);
    to = std::max(to, share.to);
  }
  const double step = (to - from) / static_cast<double>(places - 1);
  rate.weight.assign(places, 0);
  for (const Share& each : shares) add_share(each, inspected, from, step, rate.weight);
  for (std::size_t n = 0; n < places; ++n)
    rate.log_k.push_back(from + static_cast<double>(n) * step);
  return rate;
}

double life_at(const GoingOn& bearing, double log_k) {
  const double now = bearing.now.pressure * bearing.now.revolutions;
  const double loading = bearing.wear_number / std::exp(log_k);
  if (loading < now) return bearing.begin * loading / now;
  return bearing.begin + (loading - now) / bearing.pressure * bearing.per_turn;
}

LifeDistribution formula_life(const GoingOn& bearing, const BearingRate& rate) {
  std::vector<double> life;
  life.reserve(rate.log_k.size());
  for (const double log_k : rate.log_k) life.push_back(life_at(bearing, log_k));
  const auto lives = std::make_shared<const prognosis::WeightedLives>(life, rate.weight);
  return {[lives](double at) { return lives->cdf(at); },
          [lives](double p) { return lives->quantile(p); }};
}

}  // namespace wearwell::bearing
