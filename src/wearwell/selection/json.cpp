#include "wearwell/selection/json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "wearwell/selection/text.h"

namespace wearwell {
namespace {

using Json = nlohmann::ordered_json;

Json number(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

Json to_json(const SelectionResult& result, const SubsetModel& model) {
  return {{"terms", result.names(model.terms)},
          {"size", model.terms.size()},
          {"value", number(model.criterion)},
          {"press", number(model.press)},
          {"r2", number(model.r2)},
          {"r2p", number(model.r2p)}};
}

Json best_model(const SelectionResult& result) {
  const SubsetModel& model = result.selection.search.models.front();
  const LinearFit& fit = result.selection.fit;
  const OriginalCoefficients& original = result.selection.original;
  Json json = to_json(result, model);
  json["adjusted_r2"] = number(fit.adjusted_r2);
  json["rmse"] = number(fit.rmse);
  json["rmsep"] = number(fit.rmsep);
  json["has_constant"] = !lacks_constant(result);
  json["sigma"] = number(fit.sigma);
  json["aic"] = number(fit.aic);
  json["aicc"] = number(fit.aicc);
  json["bic"] = number(fit.bic);
  json["intercept"] = {{"value", number(original.intercept)},
                       {"se", number(original.intercept_error)}};
  Json coefficients = Json::object();
  for (const CoefficientRow& each : coefficient_rows(result)) {
    if (!each.selected) continue;
    coefficients[each.term] = {{"value", number(each.original)},
                               {"se", number(each.original_error)},
                               {"scaled", number(each.scaled)},
                               {"scaled_se", number(each.scaled_error)}};
  }
  json["coefficients"] = coefficients;
  return json;
}

}  // namespace

nlohmann::ordered_json to_json(const SelectionResult& result) {
  const Selection& selection = result.selection;
  const SearchResult& search = selection.search;
  Json json;
  json["data"] = {
      {"file", result.data_file},
      {"sha1", result.data_sha1},
      {"rows", result.observed.size()},
      {"response", result.response},
      {"weights", result.weights_column.empty() ? Json() : Json(result.weights_column)}};
  json["criterion"] = name_of(result.settings.search.criterion);
  json["candidates"] = Json::array();
  for (const Term& term : result.design.terms) json["candidates"].push_back(term.name);
  json["forced"] = result.names(result.settings.search.forced);
  json["best"] = search.models.empty() ? Json() : best_model(result);
  const Nested& nested = selection.nested;
  if (nested.problem.empty()) {
    json["nested"] = {{"folds", nested.folds},
                      {"r2", number(nested.r2)},
                      {"r2_error", number(nested.r2_error)},
                      {"rmse", number(nested.rmse)},
                      {"unproven", nested.unproven}};
  } else {
    json["nested"] = {{"problem", nested.problem}};
  }
  json["models"] = Json::array();
  for (std::size_t m = 0; m < search.models.size(); ++m) {
    Json model = to_json(result, search.models[m]);
    if (m < selection.weights.size()) model["weight"] = selection.weights[m];
    if (m < selection.k_fold_press.size())
      model["k_fold_press"] = number(selection.k_fold_press[m]);
    json["models"].push_back(model);
  }
  json["near"] = {{"distance", result.settings.search.near}, {"truncated", search.truncated}};
  json["by_size"] = Json::array();
  for (std::size_t size = 1; size < search.by_size.size(); ++size) {
    const SizeBest& best = search.by_size[size];
    Json each = {{"size", size}};
    if (best.model) {
      each = to_json(result, *best.model);
    } else {
      each["terms"] = nullptr;
    }
    each["proven"] = best.proven;
    json["by_size"].push_back(each);
  }
  json["support"] = Json::object();
  for (std::size_t t = 0; t < result.design.terms.size(); ++t) {
    json["support"][result.design.terms[t].name] = {{"inclusion", selection.support[t].inclusion},
                                                    {"weight", selection.support[t].weight}};
  }
  json["dependences"] = Json::array();
  for (const Dependence& each : search.dependences) {
    json["dependences"].push_back(
        {{"term", result.design.terms[each.column].name}, {"on", result.names(each.on)}});
  }
  json["certified"] = search.certified;
  json["lower_bound"] = number(search.lower_bound);
  json["submodels"] = search.submodels;
  json["nodes"] = search.nodes;
  json["seconds"] = search.seconds;
  return json;
}

std::string models_csv(const SelectionResult& result) {
  const Selection& selection = result.selection;
  std::string csv = fmt::format("rank,size,{},press,r2,r2p,weight,terms\n",
                                name_of(result.settings.search.criterion));
  for (std::size_t m = 0; m < selection.search.models.size(); ++m) {
    const SubsetModel& model = selection.search.models[m];
    const std::string weight =
        m < selection.weights.size() ? fmt::format("{}", selection.weights[m]) : "";
    std::string terms = fmt::format("{}", fmt::join(result.names(model.terms), " "));
    for (std::size_t at = 0; (at = terms.find('"', at)) != std::string::npos; at += 2)
      terms.insert(at, 1, '"');
    csv += fmt::format("{},{},{},{},{},{},{},\"{}\"\n", m + 1, model.terms.size(), model.criterion,
                       model.press, model.r2, model.r2p, weight, terms);
  }
  return csv;
}

}  // namespace wearwell
