#include "wearwell/study/json.h"

#include <cmath>

#include "wearwell/study/header_json.h"
#include "wearwell/study/long_tables.h"
#include "wearwell/study/mean_tail.h"

namespace wearwell {
namespace {

using Json = nlohmann::ordered_json;

const char* method_of(bool by_quadrature) {
  return by_quadrature ? "quadrature" : "draws";
}

// The best values available, with those of the draws beside them.
template <class Values, class Write>
void add_best(const Values& drawn, const std::optional<Values>& exact, const Write& write,
              Json& json) {
  json.update(write(exact ? *exact : drawn));
  json["by"] = method_of(exact.has_value());
  if (exact) json["draws"] = write(drawn);
}

Json to_json(const ParameterSummary& p) {
  const ExactSummary best = p.best();
  Json json = {{"unit", p.unit},  {"mean", best.mean}, {"sd", best.sd},
               {"q05", best.q05}, {"q50", best.q50},   {"q95", best.q95}};
  json["by"] = p.drawn ? method_of(p.exact.has_value()) : "least squares";
  if (p.drawn) {
    json["draws"] = {
        {"mean", p.mean}, {"sd", p.sd},   {"mcse", p.mcse},         {"q05", p.q05},
        {"q50", p.q50},   {"q95", p.q95}, {"ess_bulk", p.ess_bulk}, {"ess_tail", p.ess_tail},
        {"rhat", p.rhat}};
  }
  if (!p.prior.empty()) json["prior"] = {{"words", p.prior}, {"default", p.prior_is_default}};
  return json;
}

Json to_json(const Prediction& p) {
  return {{"mean", p.mean}, {"ci05", p.ci05}, {"ci95", p.ci95}, {"pi05", p.pi05}, {"pi95", p.pi95}};
}

Json to_json(const std::vector<PredictionSummary>& predictions) {
  Json json = Json::array();
  for (const PredictionSummary& p : predictions) {
    Json each = {{p.at_name, p.at}, {"quantity", p.quantity}, {"unit", p.unit}};
    add_best(
        p.drawn, p.exact, [](const Prediction& values) { return to_json(values); }, each);
    if (p.measured) each["measured"] = *p.measured;
    if (!p.at_unit.empty()) each["at_unit"] = p.at_unit;
    if (!p.mean_of.empty()) each.update({{"mean_of", p.mean_of}, {"pi_of", p.measured_of}});
    json.push_back(std::move(each));
  }
  return json;
}

// NaN, where an infinite life is never reached: both are null.
bool is_undetermined(const QuantityQuantiles& q) {
  const auto is_nan = [](const std::optional<double>& x) { return !x || std::isnan(*x); };
  return std::isnan(q.q50) && is_nan(q.predictive) && is_nan(q.mean);
}

Json to_json(const QuantityQuantiles& q, bool is_life) {
  Json json = {{"q05", q.q05}, {"q50", q.q50}, {"q95", q.q95}};
  if (is_life) json.update({{"b1", q.b1}, {"b10", q.b10}, {"b50", q.b50}});
  if (q.predictive) json["predictive"] = *q.predictive;
  if (q.bound) json["bound"] = *q.bound;
  if (q.upper_bound) json["upper_bound"] = *q.upper_bound;
  if (q.mean) json["mean"] = *q.mean;
  if (q.mean_tail) {
    json["mean_tail"] = {{"highest", q.mean_tail->highest}};
    if (q.mean_tail->beyond)
      json["mean_tail"].update(
          {{"observed_to", *q.mean_tail->longest}, {"beyond", *q.mean_tail->beyond}});
    if (is_endless_mean(q)) json["mean_tail"]["not_finite"] = reason_of_endless_mean(q);
  }
  if (q.numerical_error) json["numerical_error"] = *q.numerical_error;
  if (is_undetermined(q)) json["undetermined"] = true;
  return json;
}

Json to_json(const std::vector<QuantitySummary>& quantities) {
  Json json = Json::array();
  for (const QuantitySummary& q : quantities) {
    Json each = {{"name", q.name}, {"of", q.of}, {"at", q.at}, {"unit", q.unit}};
    if (q.credible_level) each["credible_level"] = *q.credible_level;
    if (q.credible_level && q.sides != BoundSides::lower)
      each["sides"] = q.sides == BoundSides::both ? "both" : "upper";
    if (q.safe_end) each["safe_end"] = *q.safe_end;
    add_best(
        q.drawn, q.exact,
        [&](const QuantityQuantiles& values) { return to_json(values, q.is_life); }, each);
    json.push_back(std::move(each));
  }
  return json;
}

Json to_json(const CoverageTable& table) {
  Json json = {{"unit", table.unit}};
  if (table.tests > table.rows.size()) json["tests"] = table.tests;
  if (table.rows.size() > most_rows_inline) {
    json["table"] = coverage_table_file;
    return json;
  }
  Json rows = Json::array();
  for (const CoverageRow& row : table.rows) {
    Json each = {
        {"row", row.row}, {"label", row.label}, {"outcome", row.outcome}, {"life", row.life}};
    if (row.until) each["until"] = *row.until;
    each.update(
        {{"probability", row.probability}, {"q05", row.q05}, {"q95", row.q95}, {"b10", row.b10}});
    if (row.failed()) each.update({{"inside", row.inside()}, {"below_b10", row.below_b10()}});
    rows.push_back(std::move(each));
  }
  json["rows"] = std::move(rows);
  return json;
}

Json to_json(const Life& life) {
  return {{"b1", life.b1},        {"b10", life.b10}, {"b50", life.b50},
          {"q05", life.q05},      {"q95", life.q95}, {"inspect_within", life.inspect_within},
          {"passed", life.passed}};
}

Json to_json(const ProfileSummary& profile) {
  Json json = {{"level", profile.level}, {"lower", profile.lower}, {"upper", profile.upper}};
  if (!profile.lower_open.empty()) json["lower_open"] = profile.lower_open;
  if (!profile.upper_open.empty()) json["upper_open"] = profile.upper_open;
  return json;
}

Json to_json(const ModeSummary& mode) {
  if (!mode.problem.empty()) return {{"problem", mode.problem}};
  Json parameters = Json::object();
  for (const ModeParameter& p : mode.parameters) {
    parameters[p.name] = {
        {"unit", p.unit}, {"value", p.value}, {"standard_error", p.standard_error}, {"at", p.at}};
    if (p.profile) parameters[p.name]["profile"] = to_json(*p.profile);
  }
  Json json = {{"parameters", parameters},
               {"log_likelihood", mode.log_likelihood},
               {"log_posterior", mode.log_posterior},
               {"density_unit", mode.density_unit},
               {"maximum_likelihood", mode.maximum_likelihood},
               {"aic", mode.aic},
               {"bic", mode.bic},
               {"observations", std::llround(mode.observations)},
               {"starts", mode.starts},
               {"reached", mode.reached}};
  for (const ModeQuantity& q : mode.quantities) {
    json["quantities"].push_back({{"name", q.name},
                                  {"of", q.of},
                                  {"at", q.at},
                                  {"unit", q.unit},
                                  {"value", q.value},
                                  {"profile", to_json(q.profile)}});
  }
  return json;
}

Json to_json(const LifeSummary& life) {
  Json json = {{"unit", life.unit},
               {"limit", life.limit},
               {"limit_unit", life.limit_unit},
               {"now", life.now},
               {"risk", life.risk}};
  if (!life.of.empty()) json["of"] = life.of;
  add_best(
      life.drawn, life.exact, [](const Life& values) { return to_json(values); }, json);
  return json;
}

Json to_json(const StageSummary& stage) {
  return {{"rows", stage.rows},
          {"parameters", to_json(stage.parameters)},
          {"predictions", to_json(stage.predictions)},
          {"checks", to_json(stage.checks)},
          {"trusted", stage.trusted}};
}

Json to_json(const PointwiseTable& table) {
  Json json = {{"units",
                {{"force", table.force_unit},
                 {"slip", table.slip_unit},
                 {"volume", table.volume_unit},
                 {"k", table.k_unit}}}};
  if (table.rows.size() > most_rows_inline) {
    json["table"] = pointwise_table_file;
    return json;
  }
  Json rows = Json::array();
  for (const PointwiseRow& row : table.rows) {
    rows.push_back({{"cycles", row.cycles},
                    {"force", row.force},
                    {"slip", row.slip},
                    {"volume", row.volume},
                    {"k", row.k}});
  }
  json["rows"] = std::move(rows);
  return json;
}

}  // namespace

Json to_json(const LooSummary& summary) {
  const Loo& loo = summary.loo;
  Json json = {{"elpd", loo.elpd()},
               {"se", loo.se()},
               {"error", loo.error},
               {"density_unit", summary.density_unit},
               {"by_quadrature", loo.by_quadrature},
               {"p_loo", loo.p_loo()},
               {"khat_max", loo.khat_max()},
               {"khat_threshold", loo.threshold},
               {"observation", summary.observation},
               {"observations", std::llround(loo.observations())}};
  if (loo.terms.size() > most_rows_inline) {
    json["table"] = loo_table_file;
    return json;
  }
  Json terms = Json::array();
  for (const LooTerm& term : loo.terms) {
    Json each = {{"elpd", term.elpd}, {"lpd", term.lpd}, {"khat", term.khat}};
    if (term.count != 1) each["count"] = term.count;
    if (term.refitted) each["refitted"] = true;
    if (term.tail < 1) each["tail"] = term.tail;
    terms.push_back(std::move(each));
  }
  json["pointwise"] = std::move(terms);
  return json;
}

Json to_json(const std::vector<ParameterSummary>& parameters) {
  Json json = Json::object();
  for (const ParameterSummary& parameter : parameters) json[parameter.name] = to_json(parameter);
  return json;
}

Json posterior_json(const PosteriorSummary& result) {
  Json json = {{"data", {{"file", result.data_file}}},
               {"sampler",
                {{"method", result.method},
                 {"chains", result.chains},
                 {"warmup", result.warmup},
                 {"draws", result.draws},
                 {"seed", result.seed}}},
               {"parameters", to_json(result.parameters)}};
  if (!result.method_note.empty()) json["sampler"]["note"] = result.method_note;
  if (result.mode) json["mode"] = to_json(*result.mode);
  if (result.loo) json["loo"] = to_json(*result.loo);
  Json stages = Json::array();
  for (const StageSummary& stage : result.stages) stages.push_back(to_json(stage));
  json["stages"] = stages;
  json["predictions"] = to_json(result.predictions);
  if (!result.quantities.empty()) json["quantities"] = to_json(result.quantities);
  if (result.life) json["life"] = to_json(*result.life);
  if (result.pointwise) json["pointwise"] = to_json(*result.pointwise);
  if (result.coverage) json["coverage"] = to_json(*result.coverage);
  if (result.quadrature) {
    json["quadrature"] = {{"tolerance", result.quadrature->tolerance},
                          {"reached", result.quadrature->reached},
                          {"nodes", result.quadrature->nodes}};
  }
  if (result.log_evidence)
    json.update({{"log_evidence", *result.log_evidence}, {"density_unit", result.density_unit}});
  if (!result.added.body.is_null()) json.update(result.added.body);
  return json;
}

}  // namespace wearwell
