#include "wearwell/study/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/infer/model_weights.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/density_unit.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string number(double x) {
  return plain_number(x);
}

bool same_observations(const LooSummary& a, const LooSummary& b) {
  return std::equal(a.loo.terms.begin(), a.loo.terms.end(), b.loo.terms.begin(), b.loo.terms.end(),
                    [](const LooTerm& x, const LooTerm& y) { return x.count == y.count; });
}

// Why elpd, AIC and BIC of these studies cannot be compared; empty if they can.
std::string obstacle_of(const std::vector<Comparison::Entry>& studies) {
  const auto& first = studies.front();
  for (const auto& each : studies) {
    const SavedResult &a = first.result, &b = each.result;
    if (a.header.data.fingerprint.empty() || b.header.data.fingerprint.empty() || !a.loo ||
        !b.loo) {
      const bool second = !a.header.data.fingerprint.empty() && a.loo;
      return fmt::format(
          "{} has no leave-one-out prediction, so the studies are not ranked. Its posterior is "
          "improper, or an older version of wearwell wrote it.",
          second ? each.name : first.name);
    }
    if (a.header.data.fingerprint != b.header.data.fingerprint) {
      return fmt::format(
          "{} and {} use different data: elpd, AIC and BIC cannot be compared, and no differences "
          "are given. You can compare parameters.",
          first.name, each.name);
    }
    if (a.loo->observation != b.loo->observation || !same_observations(*a.loo, *b.loo)) {
      return fmt::format(
          "{} leaves out one {} at a time, {} one {}: their elpd measure different predictions, "
          "and no differences are given.",
          first.name, a.loo->observation, each.name, b.loo->observation);
    }
    if (a.loo->density_unit != b.loo->density_unit) {
      return fmt::format(
          "Log densities of {} are for data in {}, those of {} for data in {}: give the response "
          "the same unit in both studies.",
          first.name, a.loo->density_unit, each.name, b.loo->density_unit);
    }
  }
  return {};
}

std::vector<std::string> cautions_of(const Comparison& comparison) {
  std::vector<std::string> cautions;
  for (const auto& [name, result, behind, weight] : comparison.studies) {
    if (!result.header.trusted) {
      cautions.push_back(
          fmt::format("{} is not trusted: at least one of its checks failed.", name));
    }
  }
  if (!comparison.comparable) return cautions;
  for (const auto& [name, result, behind, weight] : comparison.studies) {
    const Loo& loo = result.loo->loo;
    const auto bad = std::count_if(loo.terms.begin(), loo.terms.end(),
                                   [&](const LooTerm& term) { return loo.doubtful(term); });
    if (bad > 0) {
      cautions.push_back(fmt::format(
          "elpd of {} is unreliable: Pareto k exceeds {:.2f} for {} of {} observations.", name,
          loo.threshold, bad, loo.terms.size()));
    }
    if (result.mode && result.mode->problem.empty() && !result.mode->maximum_likelihood) {
      cautions.push_back(
          fmt::format("AIC and BIC of {} are computed at the mode of its posterior, because its "
                      "priors are not flat.",
                      name));
    }
  }
  const double n = comparison.studies.front().result.loo->loo.observations();
  if (n < 100) {
    cautions.push_back(
        fmt::format("With {:.0f} observations the standard error of a difference is itself "
                    "uncertain; treat a difference below {:.0f} as small (Sivula et al. 2020).",
                    n, small_elpd_difference));
  }
  return cautions;
}

// Parameters by name and unit, in the order of their first study.
struct NamedParameter {
  std::string name, unit;
  std::vector<const ParameterSummary*> of;  // one per study; null if the study has no such
                                            // parameter
};

std::vector<NamedParameter> parameters_of(const Comparison& comparison) {
  std::vector<NamedParameter> all;
  for (std::size_t s = 0; s < comparison.studies.size(); ++s) {
    for (const ParameterSummary& p : comparison.studies[s].result.parameters) {
      auto found = std::find_if(all.begin(), all.end(), [&](const NamedParameter& each) {
        return each.name == p.name && each.unit == p.unit;
      });
      if (found == all.end()) {
        all.push_back({p.name, p.unit, {}});
        found = all.end() - 1;
        found->of.resize(comparison.studies.size());
      }
      found->of[s] = &p;
    }
  }
  return all;
}

const Loo& loo_of(const Comparison::Entry& entry) {
  return entry.result.loo->loo;
}

// A difference of elpd up to this may be computational error.
double resolution(const Comparison::Entry& a, const Comparison::Entry& b) {
  return 2 * std::hypot(loo_of(a).error, loo_of(b).error);
}

// Best elpd first. Studies whose difference is within the computational error keep the order given,
// and a caution says so.
void rank(Comparison& comparison) {
  auto& studies = comparison.studies;
  std::vector<std::string> given;
  for (const auto& each : studies) given.push_back(each.name);
  std::stable_sort(studies.begin(), studies.end(), [](const auto& a, const auto& b) {
    return loo_of(a).elpd() > loo_of(b).elpd();
  });
  const Comparison::Entry best = studies.front();
  for (auto first = studies.begin(); first != studies.end();) {
    auto end = first + 1;
    while (end != studies.end() &&
           loo_of(*(end - 1)).elpd() - loo_of(*end).elpd() <= resolution(*(end - 1), *end)) {
      ++end;
    }
    if (end - first > 1 && loo_of(*first).elpd() > loo_of(*(end - 1)).elpd()) {
      std::vector<std::string> names;
      double largest = 0;
      for (auto each = first; each + 1 != end; ++each) {
        largest = std::max(largest, resolution(*each, *(each + 1)));
      }
      std::stable_sort(first, end, [&](const auto& a, const auto& b) {
        return std::find(given.begin(), given.end(), a.name) <
               std::find(given.begin(), given.end(), b.name);
      });
      for (auto each = first; each != end; ++each) names.push_back(each->name);
      comparison.cautions.push_back(
          fmt::format("The order of {} is unknown: their elpd differ by less than the "
                      "computational error, {:.2g}. They keep the order given.",
                      fmt::join(names, ", "), largest));
    }
    first = end;
  }
  std::vector<const Loo*> models;
  for (const auto& each : studies) models.push_back(&loo_of(each));
  const std::vector<double> weights = model_weights(models);
  for (std::size_t i = 0; i < studies.size(); ++i) {
    studies[i].behind = elpd_difference(loo_of(best).terms, loo_of(studies[i]).terms);
    studies[i].weight = weights[i];
  }
}

std::string weights_text(const Comparison& comparison) {
  std::vector<std::string> shares;
  for (const auto& each : comparison.studies)
    shares.push_back(fmt::format("{} {:.3f}", each.name, each.weight));
  return fmt::format("Weights of the mixture that predicts best (stacking): {}",
                     fmt::join(shares, ", "));
}

std::optional<ModeSummary> mode_of(const SavedResult& result) {
  return result.mode && result.mode->problem.empty() ? result.mode : std::nullopt;
}

}  // namespace

Comparison compare(std::vector<std::pair<std::string, SavedResult>> results) {
  Comparison comparison;
  for (auto& [name, result] : results) {
    comparison.studies.push_back({name, std::move(result), {}, 0});
  }
  comparison.obstacle = obstacle_of(comparison.studies);
  comparison.comparable = comparison.obstacle.empty();
  if (comparison.comparable) {
    rank(comparison);
  }
  const std::vector<std::string> others = cautions_of(comparison);
  comparison.cautions.insert(comparison.cautions.end(), others.begin(), others.end());
  return comparison;
}

std::string life_label(const QuantitySummary& quantity) {
  return quantity.name + (quantity.of == "unit" ? "" : " of " + quantity.of) +
         (quantity.at.empty() ? "" : " " + quantity.at);
}

const QuantitySummary* same_quantity(const SavedResult& result, const QuantitySummary& wanted) {
  for (const QuantitySummary& each : result.quantities)
    if (each.name == wanted.name && each.of == wanted.of && each.at == wanted.at) return &each;
  return nullptr;
}

std::string comparison_text(const Comparison& comparison) {
  std::string out;
  Rows rows;
  if (comparison.comparable) {
    rows = {{"", "elpd", "se", "behind", "se", "p_loo", "largest k", "AIC", "BIC", "parameters",
             "trusted"}};
  } else {
    rows = {{"", "data", "rows", "parameters", "trusted"}};
  }
  for (const auto& [name, result, behind, weight] : comparison.studies) {
    rows.push_back({name});
    auto& row = rows.back();
    if (comparison.comparable) {
      const Loo& loo = result.loo->loo;
      const auto mode = mode_of(result);
      const auto error = [](double x) { return std::isfinite(x) ? fmt::format("{:.2f}", x) : "-"; };
      row.insert(
          row.end(),
          {fmt::format("{:.2f}", loo.elpd()), error(loo.se()), fmt::format("{:.2f}", behind->value),
           error(behind->se), fmt::format("{:.1f}", loo.p_loo()),
           fmt::format("{:.2f}", loo.khat_max()), mode ? fmt::format("{:.2f}", mode->aic) : "-",
           mode ? fmt::format("{:.2f}", mode->bic) : "-"});
    } else {
      row.insert(row.end(),
                 {result.header.data.names(), fmt::format("{}", result.header.data.rows)});
    }
    row.insert(row.end(),
               {fmt::format("{}", result.parameters.size()), trust_word(result.header.checks)});
  }
  if (!comparison.note.empty()) out += wrapped(printable(comparison.note), 0, 2) + "\n";
  out +=
      (comparison.comparable ? "Prediction of each observation from all others\n" : "Studies\n") +
      text_table(rows);
  if (comparison.comparable) {
    const std::string unit =
        DensityUnit::description(comparison.studies.front().result.loo->density_unit);
    if (!unit.empty()) out += wrapped(printable("Log densities (elpd, AIC, BIC): " + unit), 2, 4);
    out += wrapped(printable(weights_text(comparison)), 2, 4);
  }
  if (!comparison.obstacle.empty()) out += wrapped(printable(comparison.obstacle), 2, 4);

  Rows parameters = {{""}};
  for (const auto& each : comparison.studies) parameters[0].push_back(each.name);
  for (const NamedParameter& p : parameters_of(comparison)) {
    parameters.push_back({p.unit == "1" ? p.name : fmt::format("{} [{}]", p.name, p.unit)});
    for (const ParameterSummary* each : p.of) {
      parameters.back().push_back(
          !each ? "-"
          : each->exact
              ? fmt::format("{} +- {}", number(each->exact->mean), number(each->exact->sd))
              : fmt::format("{} +- {}", number(each->mean), number(each->sd)));
    }
  }
  out += (comparison.note.empty() ? "\nParameters (mean +- sd)\n"
                                  : "\nParameters of the written family (mean +- sd)\n") +
         text_table(parameters);
  if (!comparison.cautions.empty()) out += "\nBear in mind\n";
  for (const std::string& caution : comparison.cautions) {
    out += wrapped(printable(caution), 2, 4);
  }
  return out;
}

nlohmann::ordered_json to_json(const Comparison& comparison) {
  using Json = nlohmann::ordered_json;
  Json studies = Json::array();
  for (const auto& [name, result, behind, weight] : comparison.studies) {
    Json each = {{"study", name},
                 {"title", result.header.title},
                 {"model", result.header.model},
                 {"equation", result.header.equation},
                 {"data",
                  {{"file", result.header.data.names()},
                   {"rows", result.header.data.rows},
                   {"fingerprint", result.header.data.fingerprint}}},
                 {"unknowns", result.parameters.size()},
                 {"trusted", result.header.trusted}};
    if (result.loo) {
      const Loo& loo = result.loo->loo;
      each["loo"] = {{"elpd", loo.elpd()},   {"se", loo.se()},
                     {"error", loo.error},   {"density_unit", result.loo->density_unit},
                     {"p_loo", loo.p_loo()}, {"khat_max", loo.khat_max()}};
    }
    if (behind) {
      each["behind"] = {{"elpd", behind->value}, {"se", behind->se}};
      each["weight"] = weight;
    }
    if (const auto mode = mode_of(result)) {
      each["mode"] = {{"log_likelihood", mode->log_likelihood},
                      {"density_unit", mode->density_unit},
                      {"maximum_likelihood", mode->maximum_likelihood},
                      {"aic", mode->aic},
                      {"bic", mode->bic}};
    }
    Json parameters = Json::object();
    for (const ParameterSummary& p : result.parameters) {
      const ExactSummary b = p.best();
      parameters[p.name] = {{"unit", p.unit}, {"mean", b.mean}, {"sd", b.sd},
                            {"q05", b.q05},   {"q50", b.q50},   {"q95", b.q95}};
    }
    each["parameters"] = parameters;
    studies.push_back(std::move(each));
  }
  Json json = {{"comparable", comparison.comparable}};
  if (!comparison.obstacle.empty()) json["obstacle"] = comparison.obstacle;
  if (!comparison.note.empty()) json["note"] = comparison.note;
  json["cautions"] = comparison.cautions;
  json["studies"] = studies;
  if (!comparison.conclusion.empty()) json["conclusion"] = comparison.conclusion;
  return json;
}

}  // namespace wearwell
