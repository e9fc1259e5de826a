#include "wearwell/study/run_study.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/constrained_mode.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/psis_loo.h"
#include "wearwell/infer/trust.h"
#include "wearwell/input/fingerprint.h"
#include "wearwell/study/describe.h"
#include "wearwell/study/mean_tail.h"
#include "wearwell/study/plot_study.h"
#include "wearwell/study/summarize.h"

namespace wearwell {
namespace {

std::vector<Check> all_checks(const PosteriorStudy& study, const Posterior& posterior,
                              const Fit& fit, const std::optional<LooSummary>& loo) {
  std::vector<Check> checks = trust_checks(posterior, fit);
  if (study.fit_data && proper(fit)) {
    checks.push_back(fit_check(judge_fit(*study.fit_data, fit.pooled, loo ? loo->loo : Loo{})));
  }
  if (loo) checks.push_back(loo_check(loo->loo, loo->observation, posterior.dimension()));
  if (const NothingSeen& nothing = study.nothing_seen; !nothing.check.empty()) {
    checks.push_back({nothing.check, Verdict::warn, nothing.clause, nothing.advice});
  }
  if (const auto units = units_check(study.data_columns)) checks.push_back(*units);
  if (!study.reaches.empty()) checks.push_back(extrapolation_check(study.reaches));
  if (study.checks) {
    for (Check& check : study.checks(fit)) checks.push_back(std::move(check));
  }
  return checks;
}

// The part of one stage's posterior that is kept.
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

// `density`, if given, receives the points of the posterior.
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

std::optional<LooSummary> left_out_one_by_one(const PosteriorStudy& study,
                                              const Posterior& posterior, const Fit& fit,
                                              const std::stop_token& stop) {
  if (!proper(fit)) return std::nullopt;
  const bool scored = study.fit_data && study.fit_data->terms && study.fit_data->cheap;
  Loo loo = leave_one_out(posterior, fit, scored ? &study.fit_data->scores : nullptr, stop);
  if (loo.terms.empty()) return std::nullopt;
  return LooSummary{study.observation, std::move(loo)};
}

// Converts from SI to the unit in which log densities are reported.
void to_density_unit(const DensityUnit& unit, LooSummary& summary) {
  summary.density_unit = unit.text;
  std::vector<LooTerm>& terms = summary.loo.terms;
  if (unit.terms.empty()) return;
  if (unit.terms.size() != terms.size())
    throw std::logic_error("units of log densities are not those of the factors of the likelihood");
  for (std::size_t i = 0; i < terms.size(); ++i) {
    terms[i].elpd += unit.terms[i];
    terms[i].lpd += unit.terms[i];
  }
}

// The number in BIC: the observations that the likelihood counts.
double observations_of(const PosteriorStudy& study, const Posterior& posterior,
                       const std::optional<LooSummary>& loo) {
  if (loo) return loo->loo.observations();
  double counted = 0;
  for (const int each : posterior.likelihood()->pointwise_counts()) counted += each;
  return counted > 0 ? counted : static_cast<double>(study.data_rows);
}

// The study, its fit and the derived results, without the checks.
PosteriorSummary described(const PosteriorStudy& study, const FitSettings& settings,
                           const Posterior& posterior, const Fit& fit) {
  const WeightedDraws& nodes = fit.exact ? fit.exact->nodes : fit.pooled;
  PosteriorSummary result;
  result.version = WEARWELL_VERSION;
  result.title = study.title;
  result.model = study.model;
  result.equation = study.equation;
  result.data_file = study.data_file;
  result.data_rows = study.data_rows;
  result.data_remarks = study.data_layout.remarks;
  result.density_unit = study.density.text;
  result.data_fingerprint = fingerprint(study.quantity, study.observed);
  result.method = method_name(fit.method);
  result.chains = settings.run.chains;
  result.warmup = fit.method == Method::exact ? 0 : fit.run.warmup;
  result.draws = fit.run.draws;
  result.seed = settings.run.seed;
  result.quantity = study.quantity;
  result.parameters = summarize_parameters(posterior, fit);
  for (std::size_t i = 0; i < study.parameters.size(); ++i) {
    result.parameters[i].meaning = study.meanings[i];
    result.parameters[i].prior = prior_text(study.parameters[i]);
    result.parameters[i].prior_is_default = study.parameters[i].is_default;
  }
  result.nothing_seen = study.nothing_seen;
  if (study.curve) result.curve = study.curve(nodes);
  result.predictions = summarize(study.predictions, fit);
  result.quantities = summarize_quantities(study, fit);
  result.pointwise = study.pointwise;
  if (study.addition && proper(fit)) result.added = study.addition(fit);
  if (study.life) result.life = summarize(*study.life, fit);
  if (study.coverage) result.coverage = study.coverage(nodes);
  if (fit.exact) {
    result.log_evidence = fit.exact->log_evidence;
    if (result.log_evidence) *result.log_evidence += study.density.total + study.log_prior_constant;
    result.quadrature = {settings.exact.tolerance, fit.exact->error,
                         static_cast<std::size_t>(fit.exact->nodes.values.rows())};
  }
  return result;
}

// One fit for each data set except the last, whose stage is `final`. `plots`, if given, receives
// the densities.
void add_stages(const PosteriorStudy& study, FitSettings settings, const Fit& final,
                PosteriorSummary& result, std::optional<Plots>& plots) {
  if (study.data_rows > most_stages) {
    result.checks.push_back(
        {"stages", Verdict::warn,
         fmt::format("none: {} data sets exceed the limit of {} for updates after each data set",
                     study.data_rows, most_stages),
         "Omit update.stages."});
    return;
  }
  const std::size_t last = study.data_rows - 1;
  result.stages.resize(study.data_rows);
  result.stages[last] =
      summarize_stage(study, study.data_rows, result.parameters, result.checks, final);
  std::vector<WeightedDraws> densities(plots ? study.data_rows : 0);
  settings.exact.progress = nullptr;
  Progress* const progress = std::exchange(settings.run.progress, nullptr);
  if (progress) progress->begin("data sets", static_cast<long long>(last));
  tbb::parallel_for(std::size_t{0}, last, [&](std::size_t i) {
    result.stages[i] = run_stage(study, settings, i + 1, plots ? &densities[i] : nullptr);
    if (progress) progress->advance(1);
  });
  if (!plots) return;
  densities[last] = final.exact ? final.exact->nodes : final.pooled;
  plots->stages = stage_densities(study.parameters.front(), 0, densities);
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

namespace {

std::string sampler_instead(const std::string& why) {
  return why.empty() ? ""
                     : fmt::format(
                           "Method: NUTS instead of quadrature (--method exact): {}; all numbers "
                           "carry Monte Carlo error",
                           why);
}

// Between stages that do not look for a request themselves.
void require_no_stop(const Monitor& monitor) {
  if (monitor.stop.stop_requested()) throw Cancelled();
}

}  // namespace

std::string method_note(const PosteriorStudy& study, const SamplerChoice& choice) {
  return fit_settings(study, choice).method == Method::exact
             ? sampler_instead(beyond_quadrature(study.parameters.size()))
             : "";
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
  if (study.refusal) throw InputError(*study.refusal);
  const auto start = std::chrono::steady_clock::now();
  std::optional<tbb::global_control> limit;
  if (monitor.threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism,
                  static_cast<std::size_t>(monitor.threads));
  }
  FitSettings settings = fit_settings(study, choice);
  const bool wants_quadrature = settings.method == Method::exact;
  if (!method_note(study, choice).empty()) settings.method = Method::nuts;
  Progress progress(monitor, "iterations");
  settings.run.progress = &progress;
  settings.exact.progress = &progress;
  settings.exact.stop = monitor.stop;

  const Posterior whole(study.parameters, study.likelihood(study.data_rows));
  Fit final = fit(whole, settings);
  const std::shared_ptr<const Posterior> quick = final.quick;
  const Posterior& posterior = quick ? *quick : whole;
  require_no_stop(monitor);
  std::optional<Plots> plots;
  if (with_plots) {
    progress.begin("curves");
    plots = plot_study(study, posterior, final);
  }
  progress.begin("leave-one-out");
  std::optional<LooSummary> loo = left_out_one_by_one(study, posterior, final, monitor.stop);
  require_no_stop(monitor);
  const NaturalMode natural = constrained_mode(posterior, final);
  for (StageDiagnostic& each : later_stage_diagnostics(whole, final, natural)) {
    final.stage_diagnostics.push_back(std::move(each));
  }

  progress.begin("predictions and checks");
  PosteriorSummary result = described(study, settings, posterior, final);
  if (wants_quadrature) result.method_note = sampler_instead(final.no_exact);
  result.mode =
      summarize_mode(study, posterior, final, natural, observations_of(study, whole, loo));
  require_no_stop(monitor);
  result.checks = all_checks(study, posterior, final, loo);
  if (loo) to_density_unit(study.density, *loo);
  result.loo = std::move(loo);
  if (result.life && result.life->now > 0) result.checks.push_back(limit_check(*result.life));
  if (const auto means = mean_life_check(result.quantities)) result.checks.push_back(*means);
  result.checks.push_back(sense_check(result));
  result.trusted = trusted(result.checks);
  result.posterior_draws = in_units(study, std::move(final.draws));
  if (study.stages) add_stages(study, settings, final, result, plots);
  if (plots) {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    plots->seconds = taken.count();
  }
  result.plots = std::move(plots);
  final.quick.reset();  // it refers to this study
  result.fit = std::make_shared<const Fit>(std::move(final));
  return result;
}

}  // namespace wearwell
