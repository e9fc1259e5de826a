#include "wearwell/study/run_study.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/natural_mode.h"
#include "wearwell/infer/psis_loo.h"
#include "wearwell/infer/trust.h"
#include "wearwell/input/fingerprint.h"
#include "wearwell/predict/item_mixture.h"
#include "wearwell/study/plot_study.h"

namespace wearwell {
namespace {

std::vector<ParameterSummary> summarize_parameters(const Posterior& posterior, const Fit& fit) {
  std::vector<ParameterSummary> summaries;
  for (std::size_t i = 0; i < posterior.parameters().size(); ++i) {
    const Parameter& parameter = posterior.parameters()[i];
    const Function value = [&, i](const double* x) { return from_si(parameter.unit, x[i]); };
    const Distribution drawn(fit.pooled, value);
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
      const Distribution exact(fit.exact->nodes, value);
      const auto at = static_cast<Eigen::Index>(i);
      summary.exact = {from_si(parameter.unit, fit.exact->mean[at]),
                       fit.exact->sd[at] / parameter.unit.scale, exact.quantile(0.05),
                       exact.quantile(0.5), exact.quantile(0.95)};
    }
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

Prediction in_unit(const Unit& unit, Prediction p) {
  for (double* each : {&p.mean, &p.ci05, &p.ci95, &p.pi05, &p.pi95}) *each = from_si(unit, *each);
  return p;
}

PredictionSummary summarize(const PredictionRequest& request, const Fit& fit) {
  const auto predicted = [&](const WeightedDraws& draws) {
    return in_unit(request.unit,
                   predict(draws, request.mean, request.sd, request.family, request.item));
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
  return summary;
}

std::vector<PredictionSummary> summarize(const std::vector<PredictionRequest>& requests,
                                         const Fit& fit) {
  std::vector<PredictionSummary> summaries;
  for (const PredictionRequest& request : requests) summaries.push_back(summarize(request, fit));
  return summaries;
}

QuantityQuantiles in_unit(const Unit& unit, QuantityQuantiles q) {
  for (double* each : {&q.q05, &q.q50, &q.q95, &q.b1, &q.b10, &q.b50}) {
    *each = from_si(unit, *each);
  }
  for (std::optional<double>* each : {&q.predictive, &q.bound}) {
    if (*each) *each = from_si(unit, **each);
  }
  return q;
}

QuantityQuantiles quantiles(const QuantityRequest& request, const WeightedDraws& draws) {
  std::function<double(double p)> driver;
  if (request.scatter) {
    driver = [items = ItemMixture(draws, request.driver, request.scatter)](double p) {
      return items.quantile(p);
    };
  } else {
    driver = [known = Distribution(draws, request.driver)](double p) { return known.quantile(p); };
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
  return result;
}

QuantitySummary summary_of(const QuantityRequest& request, const QuantityQuantiles& drawn) {
  return {request.name,    request.of, request.at, request.unit.text,
          request.is_life, drawn,      {},         request.credible_level,
          request.safe_end};
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
    return predict_life(draws, request.life, request.now, request.risk);
  };
  LifeSummary summary{.unit = request.unit_name,
                      .limit = request.limit.value,
                      .limit_unit = request.limit.unit.text,
                      .now = request.now,
                      .risk = request.risk,
                      .drawn = life(fit.pooled),
                      .exact = {}};
  if (fit.exact) summary.exact = life(fit.exact->nodes);
  return summary;
}

constexpr double profile_level = 0.9;  // as the posterior's 5 and 95 % beside it

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
  const double deviance = -2 * mode.log_likelihood;
  const auto unknowns = static_cast<double>(posterior.dimension());
  summary.log_likelihood = mode.log_likelihood;
  summary.log_posterior = mode.log_posterior;
  summary.aic = deviance + 2 * unknowns;
  summary.bic = deviance + unknowns * std::log(observations);
  summary.maximum_likelihood = mode.maximum;
  summary.observations = observations;
  summary.starts = mode.starts;
  summary.reached = mode.reached;
  if (mode.maximum) add_profiles(study, posterior, fit, mode, summary);
  return summary;
}

std::vector<Check> all_checks(const PosteriorStudy& study, const Posterior& posterior,
                              const Fit& fit, const std::optional<LooSummary>& loo) {
  std::vector<Check> checks = trust_checks(posterior, fit);
  if (study.fit_data && proper(fit)) {
    checks.push_back(fit_check(judge_fit(*study.fit_data, fit.pooled, loo ? loo->loo : Loo{})));
  }
  if (loo) checks.push_back(loo_check(loo->loo, loo->observation, posterior.dimension()));
  if (const auto units = units_check(study.data_columns)) checks.push_back(*units);
  if (!study.reaches.empty()) checks.push_back(extrapolation_check(study.reaches));
  if (study.checks) {
    for (Check& check : study.checks(fit)) checks.push_back(std::move(check));
  }
  return checks;
}

// What is kept of the posterior of one stage.
StageSummary summarize_stage(const PosteriorStudy& study, std::size_t rows,
                             std::vector<ParameterSummary> parameters, std::vector<Check> checks,
                             const Fit& fit) {
  std::vector<PredictionRequest> requests = study.stage_predictions(rows);
  requests.insert(requests.end(), study.predictions.begin(), study.predictions.end());
  StageSummary summary{rows, std::move(parameters), summarize(requests, fit), std::move(checks),
                       true};
  summary.trusted = trusted(summary.checks);
  return summary;
}

// `density`, when given, takes the points of the posterior.
StageSummary run_stage(const PosteriorStudy& study, FitSettings settings, std::size_t rows,
                       WeightedDraws* density) {
  settings.run.first_stream = rows * max_chains;
  const Posterior posterior(study.parameters, study.likelihood(rows));
  Fit stage = fit(posterior, settings);
  StageSummary summary = summarize_stage(study, rows, summarize_parameters(posterior, stage),
                                         trust_checks(posterior, stage), stage);
  if (density) *density = std::move(stage.exact ? stage.exact->nodes : stage.pooled);
  return summary;
}

Draws in_units(const PosteriorStudy& study, Draws draws) {
  for (Chain& chain : draws) {
    for (std::size_t i = 0; i < study.parameters.size(); ++i) {
      const Unit& unit = study.parameters[i].unit;
      auto column = chain.values.col(static_cast<Eigen::Index>(i));
      column = column.unaryExpr([&](double x) { return from_si(unit, x); }).eval();
    }
  }
  return draws;
}

}  // namespace

FitSettings fit_settings(const PosteriorStudy& study, const SamplerChoice& choice) {
  const auto chosen = [](const auto& first, const auto& second, auto otherwise) {
    return first ? *first : second ? *second : otherwise;
  };
  FitSettings settings;
  settings.nuts = study.nuts;
  settings.metropolis = study.metropolis;
  settings.method = chosen(choice.method, study.sampler.method, Method::nuts);
  const bool metropolis = settings.method == Method::metropolis;
  RunSettings& run = settings.run;
  run.chains = chosen(choice.chains, study.sampler.chains, 4);
  run.warmup = chosen(choice.warmup, study.sampler.warmup, metropolis ? 4000 : 1000);
  run.draws = chosen(choice.draws, study.sampler.draws, metropolis ? 6000 : 1000);
  settings.extend =
      !choice.warmup && !study.sampler.warmup && !choice.draws && !study.sampler.draws;
  run.seed = chosen(choice.seed, study.sampler.seed, std::uint64_t{1});
  return settings;
}

const char* method_name(Method method) {
  switch (method) {
    case Method::exact:
      return "exact";
    case Method::metropolis:
      return "metropolis";
    case Method::nuts:
      break;
  }
  return "nuts";
}

void require_posterior(const PosteriorStudy& study) {
  for (std::size_t rows = study.stages ? 1 : study.data_rows; rows <= study.data_rows; ++rows)
    static_cast<void>(Posterior(study.parameters, study.likelihood(rows)));
}

PosteriorSummary run_study(const PosteriorStudy& study, const SamplerChoice& choice,
                           const Monitor& monitor, bool with_plots) {
  const auto start = std::chrono::steady_clock::now();
  std::optional<tbb::global_control> limit;
  if (monitor.threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism,
                  static_cast<std::size_t>(monitor.threads));
  }
  FitSettings settings = fit_settings(study, choice);
  Progress progress(monitor, "iterations");
  settings.run.progress = &progress;
  settings.exact.stop = monitor.stop;
  if (settings.method != Method::exact) {
    const RunSettings& run = settings.run;
    const long long fits = study.stages && study.data_rows <= most_stages
                               ? static_cast<long long>(study.data_rows)
                               : 1;
    progress.expect(fits * run.chains * (run.warmup + run.draws));
  }
  const Posterior whole(study.parameters, study.likelihood(study.data_rows));
  Fit final = fit(whole, settings);
  const std::shared_ptr<const Posterior> quick = final.quick;
  const Posterior& posterior = quick ? *quick : whole;
  std::optional<Plots> plots;
  if (with_plots) plots = plot_study(study, posterior, final);

  std::optional<LooSummary> loo;
  if (proper(final)) {
    const bool scored = study.fit_data && study.fit_data->terms && study.fit_data->cheap;
    Loo each = leave_one_out(posterior, final, scored ? &study.fit_data->scores : nullptr);
    if (!each.terms.empty()) loo = {study.observation, std::move(each)};
  }
  const NaturalMode natural = natural_mode(posterior, final);
  const ModeSummary mode =
      summarize_mode(study, posterior, final, natural,
                     loo ? loo->loo.observations() : static_cast<double>(study.data_rows));
  for (Shortfall& each : later_shortfalls(whole, final, natural)) {
    final.shortfalls.push_back(std::move(each));
  }

  PosteriorSummary result;
  result.version = WEARWELL_VERSION;
  result.title = study.title;
  result.model = study.model;
  result.equation = study.equation;
  result.data_file = study.data_file;
  result.data_rows = study.data_rows;
  result.method = method_name(final.method);
  result.chains = settings.run.chains;
  result.warmup = final.method == Method::exact ? 0 : final.run.warmup;
  result.draws = final.run.draws;
  result.seed = settings.run.seed;
  result.parameters = summarize_parameters(posterior, final);
  result.predictions = summarize(study.predictions, final);
  result.quantities = summarize_quantities(study, final);
  result.pointwise = study.pointwise;
  result.log_evidence = final.exact ? final.exact->log_evidence : std::nullopt;
  result.checks = all_checks(study, posterior, final, loo);
  result.posterior_draws = in_units(study, std::move(final.draws));
  if (final.exact) {
    result.quadrature = {settings.exact.tolerance, final.exact->error,
                         static_cast<std::size_t>(final.exact->nodes.values.rows())};
  }
  result.data_fingerprint = fingerprint(study.quantity, study.observed);
  result.mode = mode;
  result.loo = std::move(loo);
  if (study.life) {
    result.life = summarize(*study.life, final);
    result.checks.push_back(limit_check(*result.life));
  }
  result.checks.push_back(sense_check(result));
  result.trusted = trusted(result.checks);
  if (study.coverage) {
    result.coverage = study.coverage(final.exact ? final.exact->nodes : final.pooled);
  }
  if (study.stages && study.data_rows > most_stages) {
    result.checks.push_back(
        {"stages", Verdict::warn,
         fmt::format("none: one fit for each of {} data sets is too much; at most {} are updated "
                     "one by one",
                     study.data_rows, most_stages),
         "Leave update.stages out."});
  } else if (study.stages) {
    // After the last data set the stage is the whole.
    const std::size_t last = study.data_rows - 1;
    result.stages.resize(study.data_rows);
    result.stages[last] =
        summarize_stage(study, study.data_rows, result.parameters, result.checks, final);
    std::vector<WeightedDraws> densities(plots ? study.data_rows : 0);
    tbb::parallel_for(std::size_t{0}, last, [&](std::size_t i) {
      result.stages[i] = run_stage(study, settings, i + 1, plots ? &densities[i] : nullptr);
    });
    if (plots) {
      densities[last] = final.exact ? std::move(final.exact->nodes) : std::move(final.pooled);
      plots->stages = stage_densities(study.parameters.front(), 0, densities);
    }
  }
  if (plots) {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    plots->seconds = taken.count();
  }
  result.plots = std::move(plots);
  return result;
}

}  // namespace wearwell
