#include "wearwell/study/summarize.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/input/fingerprint.h"
#include "wearwell/predict/item_mixture.h"
#include "wearwell/study/describe.h"
#include "wearwell/study/mean_tail.h"

namespace wearwell {
namespace {

constexpr std::size_t item_points = 200'000;  // for 4 digits

Prediction in_unit(const Unit& unit, Prediction p) {
  for (double* each : {&p.mean, &p.ci05, &p.ci95, &p.pi05, &p.pi95}) *each = from_si(unit, *each);
  return p;
}

// Posteriors with the unknowns of items, each computed once.
class ItemDraws {
 public:
  const WeightedDraws& of(const PredictionRequest& request, const WeightedDraws& draws) {
    if (!request.with_item) return draws;
    const auto key = std::pair(request.with_item.get(), &draws);
    auto found = made_.find(key);
    if (found == made_.end()) found = made_.emplace(key, (*request.with_item)(draws)).first;
    return found->second;
  }

 private:
  std::map<std::pair<const void*, const WeightedDraws*>, WeightedDraws> made_;
};

PredictionSummary summarize(const PredictionRequest& request, const Fit& fit, const Ends& ends,
                            ItemDraws& items) {
  const auto predicted = [&](const WeightedDraws& draws) {
    return in_unit(request.unit, predict(items.of(request, draws), request.mean, request.sd,
                                         request.family, request.item, item_points, ends));
  };
  PredictionSummary summary{.at_name = request.at_name,
                            .at = request.at,
                            .quantity = request.quantity,
                            .unit = request.unit.text,
                            .drawn = predicted(fit.pooled),
                            .exact = {},
                            .measured = {}};
  if (fit.exact) summary.exact = predicted(fit.exact->nodes);
  if (request.measured) summary.measured = from_si(request.unit, *request.measured);
  summary.mean_of = request.mean_of;
  summary.measured_of = request.measured_of;
  summary.at_unit = request.at_unit;
  return summary;
}

QuantityQuantiles in_unit(const Unit& unit, QuantityQuantiles q) {
  for (double* each : {&q.q05, &q.q50, &q.q95, &q.b1, &q.b10, &q.b50}) {
    *each = from_si(unit, *each);
  }
  for (std::optional<double>* each : {&q.predictive, &q.bound, &q.upper_bound, &q.mean}) {
    if (*each) *each = from_si(unit, **each);
  }
  if (q.mean_tail && q.mean_tail->longest)
    q.mean_tail->longest = from_si(unit, *q.mean_tail->longest);
  refuse_endless_mean(q);
  return q;
}

// Whether a pure number is 0 at some points of the posterior and 1 at all others: it has a probability, but no quantiles.
bool is_indicator(const QuantityRequest& request, const WeightedDraws& draws) {
  if (request.unit.text != "1" && request.unit.text != "%") return false;
  const double least = QuantityDistribution::least_weight(draws);
  bool any = false, none = false;
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
    if (!(draws.cell_weight(i) > least)) continue;
    const double value = request.value(request.driver(draws.values.row(i).data()));
    if (value != 0 && value != 1) return false;
    (value == 1 ? any : none) = true;
  }
  return any && none;
}

QuantityQuantiles quantiles(const QuantityRequest& request, const WeightedDraws& draws) {
  std::function<double(double p)> driver;
  if (request.scatter) {
    driver = [items = ItemMixture(draws, request.driver, request.scatter)](double p) {
      return items.quantile(p);
    };
  } else {
    driver = [known = QuantityDistribution(draws, request.driver)](double p) {
      return known.quantile(p);
    };
  }
  const auto quantile = [&](double p) {
    return from_si(request.unit, request.value(driver(request.increasing ? p : 1 - p)));
  };
  QuantityQuantiles result{quantile(0.05), quantile(0.5), quantile(0.95), 0, 0, 0};
  if (request.is_life) {
    result.b1 = quantile(0.01);
    result.b10 = quantile(0.1);
    result.b50 = result.q50;
  }
  if (request.with_mean) {
    const auto of_value = [&](const double* x) { return request.value(request.driver(x)); };
    const QuantityDistribution known(draws, of_value);
    result.mean = from_si(request.unit, known.mean());
    // A share is bounded, and the mean of an indicator is a probability: their tails do not matter.
    bool is_share = request.unit.text == "1" || request.unit.text == "%";
    known.visit([&](double, double value, double) { is_share &= value >= 0 && value <= 1; });
    if (const auto highest = share_of_highest(known); highest && !is_share)
      result.mean_tail = MeanTail{*highest, {}, {}};
    refuse_endless_mean(result);
    if (is_indicator(request, draws)) result.q05 = result.q50 = result.q95 = std::nan("");
  }
  return result;
}

QuantitySummary summary_of(const QuantityRequest& request, const QuantityQuantiles& drawn) {
  return {request.name,
          request.of,
          request.at,
          request.unit.text,
          request.is_life,
          drawn,
          {},
          request.credible_level,
          request.safe_end,
          request.headline,
          request.sides};
}

QuantitySummary summarize(const QuantityRequest& request, const Fit& fit) {
  QuantitySummary summary = summary_of(request, quantiles(request, fit.pooled));
  if (fit.exact) summary.exact = quantiles(request, fit.exact->nodes);
  return summary;
}

std::vector<QuantitySummary> summarize(const QuantityGroup& group, const Fit& fit) {
  std::vector<QuantitySummary> summaries;
  const std::vector<QuantityQuantiles> drawn = group.from_draws(fit.pooled);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const QuantityRequest& request = group.requests[i];
    summaries.push_back(summary_of(request, in_unit(request.unit, drawn[i])));
  }
  if (!fit.exact) return summaries;
  const std::vector<QuantityQuantiles> exact = group.from_draws(fit.exact->nodes);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    summaries[i].exact = in_unit(group.requests[i].unit, exact[i]);
  }
  return summaries;
}

constexpr double profile_level = 0.9;  // the level of the posterior's 5 to 95 % interval

ProfileSummary summarize(const ProfileInterval& interval, const auto& in_unit) {
  return {profile_level, in_unit(interval.lower.value), in_unit(interval.upper.value),
          interval.lower.open, interval.upper.open};
}

void add_profiles(const PosteriorStudy& study, const Posterior& posterior, const Fit& fit,
                  const NaturalMode& mode, ModeSummary& summary) {
  const auto intervals = profile_intervals(posterior, fit, mode, profile_level);
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const Unit& unit = posterior.parameters()[i].unit;
    summary.parameters[i].profile =
        summarize(intervals[i], [&](double x) { return from_si(unit, x); });
  }
  summary.quantities.resize(study.profiled.size());
  tbb::parallel_for(std::size_t{0}, study.profiled.size(), [&](std::size_t i) {
    const ProfileRequest& request = study.profiled[i];
    const auto in_unit = [&](double x) { return from_si(request.unit, request.si(x)); };
    summary.quantities[i] = {
        request.name,
        request.of,
        request.at,
        request.unit.text,
        in_unit(request.quantity.value(mode.position.data())),
        summarize(profile_interval(posterior, fit, mode, request.quantity, profile_level),
                  in_unit)};
  });
}

}  // namespace

std::vector<ParameterSummary> summarize_parameters(const Posterior& posterior, const Fit& fit) {
  std::vector<ParameterSummary> summaries(posterior.parameters().size());
  tbb::parallel_for(std::size_t{0}, summaries.size(), [&](std::size_t i) {
    const Parameter& parameter = posterior.parameters()[i];
    const Function value = [&, i](const double* x) { return from_si(parameter.unit, x[i]); };
    const QuantityDistribution drawn(fit.pooled, value);
    const Diagnostics& d = fit.diagnostics[i];
    ParameterSummary summary{.name = parameter.name,
                             .unit = parameter.unit.text,
                             .mean = drawn.mean(),
                             .sd = drawn.sd(),
                             .mcse = d.mcse_mean / parameter.unit.scale,
                             .q05 = drawn.quantile(0.05),
                             .q50 = drawn.quantile(0.5),
                             .q95 = drawn.quantile(0.95),
                             .ess_bulk = d.ess_bulk,
                             .ess_tail = d.ess_tail,
                             .rhat = d.rhat,
                             .exact = {}};
    if (fit.exact) {
      const auto at = static_cast<Eigen::Index>(i);
      const auto quantile = [&](double p) {
        return from_si(parameter.unit, fit.marginals[i].quantile(p));
      };
      summary.exact = {from_si(parameter.unit, fit.exact->mean[at]),
                       fit.exact->sd[at] / parameter.unit.scale, quantile(0.05), quantile(0.5),
                       quantile(0.95)};
    }
    summaries[i] = std::move(summary);
  });
  return summaries;
}

std::vector<PredictionSummary> summarize(const std::vector<PredictionRequest>& requests,
                                         const Fit& fit, const Ends& ends) {
  std::vector<PredictionSummary> summaries;
  ItemDraws items;
  for (const PredictionRequest& request : requests)
    summaries.push_back(summarize(request, fit, ends, items));
  return summaries;
}

PosteriorSummary asked_later(const PosteriorStudy& asked, const PosteriorSummary& fitted,
                             const Ends& ends) {
  bool same = asked.equation == fitted.equation &&
              asked.parameters.size() == fitted.parameters.size() &&
              fingerprint(asked.quantity, asked.observed) == fitted.data_fingerprint;
  for (std::size_t i = 0; same && i < asked.parameters.size(); ++i) {
    same = asked.parameters[i].name == fitted.parameters[i].name &&
           prior_text(asked.parameters[i]) == fitted.parameters[i].prior;
  }
  if (!same || !fitted.fit)
    throw InputError("a later request must use the same data, model and priors as the fit");
  PosteriorSummary answers;
  answers.predictions = summarize(asked.predictions, *fitted.fit, ends);
  answers.quantities = summarize_quantities(asked, *fitted.fit);
  if (asked.life) answers.life = summarize(*asked.life, *fitted.fit);
  return answers;
}

std::vector<QuantitySummary> summarize_quantities(const PosteriorStudy& study, const Fit& fit) {
  std::vector<QuantitySummary> summaries;
  for (const QuantityRequest& request : study.quantities) {
    summaries.push_back(summarize(request, fit));
  }
  std::vector<std::vector<QuantitySummary>> groups(study.quantity_groups.size());
  tbb::parallel_for(std::size_t{0}, groups.size(),
                    [&](std::size_t i) { groups[i] = summarize(study.quantity_groups[i], fit); });
  for (auto& group : groups) std::move(group.begin(), group.end(), std::back_inserter(summaries));
  return summaries;
}

LifeSummary summarize(const LifeRequest& request, const Fit& fit) {
  const auto life = [&](const WeightedDraws& draws) {
    return predict_life(request.distribution(draws), request.now, request.risk);
  };
  LifeSummary summary{.unit = request.unit_name,
                      .limit = request.limit.value,
                      .limit_unit = request.limit.unit.text,
                      .now = request.now,
                      .risk = request.risk,
                      .drawn = life(fit.pooled),
                      .exact = {},
                      .of = request.of};
  if (fit.exact) summary.exact = life(fit.exact->nodes);
  return summary;
}

ModeSummary summarize_mode(const PosteriorStudy& study, const Posterior& posterior, const Fit& fit,
                           const NaturalMode& mode, double observations) {
  ModeSummary summary;
  summary.problem = mode.problem;
  if (!mode.problem.empty()) return summary;
  static constexpr const char* places[] = {"inside", "lower bound", "upper bound"};
  for (std::size_t i = 0; i < posterior.parameters().size(); ++i) {
    const Parameter& parameter = posterior.parameters()[i];
    const auto at = static_cast<Eigen::Index>(i);
    summary.parameters.push_back({parameter.name,
                                  parameter.unit.text,
                                  from_si(parameter.unit, mode.position[at]),
                                  mode.standard_error[at] / parameter.unit.scale,
                                  places[static_cast<int>(mode.place[i])],
                                  {}});
  }
  summary.density_unit = study.density.text;
  summary.log_likelihood = mode.log_likelihood + study.density.total;
  const double deviance = -2 * summary.log_likelihood;
  const auto unknowns = static_cast<double>(posterior.dimension());
  summary.log_posterior = mode.log_posterior + study.density.total;
  summary.aic = deviance + 2 * unknowns;
  summary.bic = deviance + unknowns * std::log(observations);
  summary.maximum_likelihood = mode.maximum;
  summary.observations = observations;
  summary.starts = mode.starts;
  summary.reached = mode.reached;
  if (mode.maximum) add_profiles(study, posterior, fit, mode, summary);
  return summary;
}

}  // namespace wearwell
