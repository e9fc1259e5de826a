#include "wearwell/study/prior_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/infer/fit.h"
#include "wearwell/study/summarize.h"

namespace wearwell {
namespace {

constexpr double shown_tail = 0.005, wide = 100;
constexpr int curve_points = 120;

// One stratum of probability for each draw and parameter.
WeightedDraws draws_of(const std::vector<Parameter>& parameters) {
  WeightedDraws draws;
  draws.values.resize(prior_draws, static_cast<Eigen::Index>(parameters.size()));
  draws.weights = Eigen::VectorXd::Constant(prior_draws, 1.0 / prior_draws);
  std::vector<int> strata(prior_draws);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    Rng rng(0, p);
    std::iota(strata.begin(), strata.end(), 0);
    for (std::size_t i = strata.size(); i-- > 1;)
      std::swap(strata[i],
                strata[static_cast<std::size_t>(rng.uniform() * static_cast<double>(i + 1))]);
    for (int i = 0; i < prior_draws; ++i)
      draws.values(i, static_cast<Eigen::Index>(p)) = quantile(
          parameters[p].prior, (strata[static_cast<std::size_t>(i)] + rng.uniform()) / prior_draws);
  }
  return draws;
}

}  // namespace

PriorPicture prior_picture(const Parameter& parameter, const std::string& meaning) {
  PriorPicture picture{parameter.name, meaning, parameter.unit.text, parameter.prior.proper};
  if (!picture.proper) return picture;
  const auto at = [&](double p) { return quantile(parameter.prior, p); };
  picture.q05 = from_si(parameter.unit, at(0.05));
  picture.q50 = from_si(parameter.unit, at(0.5));
  picture.q95 = from_si(parameter.unit, at(0.95));
  const double low = at(shown_tail), high = at(1 - shown_tail);
  picture.log = low > 0 && parameter.unit.offset == 0 && high > wide * low;
  for (int i = 0; i <= curve_points; ++i) {
    const double share = static_cast<double>(i) / curve_points;
    const double si = picture.log ? low * std::pow(high / low, share) : std::lerp(low, high, share);
    const bool inside = parameter.prior.lower <= si && si <= parameter.prior.upper;
    const double density = inside ? std::exp(log_density(parameter.prior, si).value) : 0;
    picture.curve.x.push_back(from_si(parameter.unit, si));
    picture.curve.y.push_back(density * (picture.log ? si : parameter.unit.scale));
  }
  return picture;
}

PriorView prior_view(const PosteriorStudy& study) {
  PriorView view;
  for (std::size_t i = 0; i < study.parameters.size(); ++i) {
    const Parameter& each = study.parameters[i];
    if (each.of_model) continue;
    view.priors.push_back(
        prior_picture(each, i < study.meanings.size() ? study.meanings[i] : std::string()));
    if (!each.prior.proper && view.obstacle.empty())
      view.obstacle = fmt::format(
          "The prior of {} is improper: before any data it implies no life.", each.name);
  }
  if (view.obstacle.empty() && study.log_prior_constant != 0)
    view.obstacle =
        "The priors are those of ordered subpopulations, which are not drawn one by one.";
  if (!view.obstacle.empty()) return view;
  try {
    Fit before;
    before.pooled = draws_of(study.parameters);
    view.quantities = summarize_quantities(study, before);
  } catch (const InputError& error) {
    view.obstacle = error.what();
  }
  return view;
}

}  // namespace wearwell
