#include "wearwell/models/clutch/clutch_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "wearwell/base/printable.h"
#include "wearwell/input/csv_reader.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/present/html.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell::clutch {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> term_names(const WearMap& map) {
  std::vector<std::string> names;
  for (const int t : map.terms) names.push_back(map.design.terms[static_cast<std::size_t>(t)].name);
  return names;
}

Json to_json(const WearMap& map) {
  return {{"name", map.name},
          {"r", map.r},
          {"q", map.q},
          {"r2", map.fit.r2},
          {"r2p", map.fit.r2p},
          {"rmse", map.fit.rmse / mm3_per_MJ},
          {"rmsep", map.fit.rmsep / mm3_per_MJ},
          {"terms", term_names(map)}};
}

Json to_json(const Validation::Metrics& m) {
  return {{"points", m.points},
          {"r2", m.r2},
          {"rmse", m.rmse / mm3_per_MJ},
          {"bias", m.bias / mm3_per_MJ}};
}

Json to_json(const Validation& validation) {
  Json points = Json::array();
  for (const ValidationPoint& p : validation.points)
    points.push_back({{"point", p.number},
                      {"measured", p.measured / mm3_per_MJ},
                      {"predicted", p.predicted / mm3_per_MJ},
                      {"t", p.t},
                      {"outlier", p.outlier}});
  Json json = {{"critical", validation.critical}, {"points", std::move(points)}};
  if (!validation.points.empty()) {
    json["all"] = to_json(validation.all);
    json["without_outliers"] = to_json(validation.without_outliers);
  }
  return json;
}

Json to_json(const ScatterSearch& scatter) {
  Json candidates = Json::array();
  for (const ScatterFit& fit : scatter.candidates) {
    candidates.push_back({{"kind", name_of(fit.law.kind)},
                          {"formula", formula_of(fit.law.kind)},
                          {"p", fit.law.p},
                          {"negative_log_likelihood", fit.negative_log_likelihood},
                          {"aic", fit.aic},
                          {"ks_distance", fit.kolmogorov.distance},
                          {"ks_p", fit.kolmogorov.p},
                          {"lilliefors_distance", fit.lilliefors.distance},
                          {"lilliefors_p", fit.lilliefors.p}});
  }
  return {{"chosen", name_of(scatter.candidates[scatter.best].law.kind)},
          {"candidates", std::move(candidates)}};
}

/// A plate by its number or its name.
Json plate_json(const ClutchResult& r, int plate) {
  if (r.plate_names.empty()) return plate;
  return r.plate_name(plate);
}

Json to_json(const SequenceResult& sequence, const ClutchResult& r) {
  Json rows = Json::array();
  for (const auto& w : sequence.weighings) {
    Json row = {{"cycle", w.cycle},
                {"energy", w.energy / MJ},
                {"measured", w.measured / mm3},
                {"predicted", w.predicted / mm3},
                {"sd_scatter", w.sd / mm3},
                {"sd_full", w.full_sd / mm3}};
    if (w.realized) row["realized"] = *w.realized / mm3;
    rows.push_back(std::move(row));
  }
  return {{"name", sequence.name},
          {"plate", plate_json(r, sequence.plate)},
          {"final_error", sequence.final_error()},
          {"weighings", std::move(rows)}};
}

Json to_json(const NamedLife& named) {
  Json levels = Json::array();
  for (const LifeAtLevel& at : named.life.levels)
    levels.push_back({{"level", at.level},
                      {"cycles", at.repetitions},
                      {"without_run_in", at.without_run_in},
                      {"interval_scatter", {at.scatter.low, at.scatter.high}},
                      {"interval_full", {at.full.low, at.full.high}},
                      {"sd_scatter", at.sd / mm3},
                      {"sd_full", at.full_sd / mm3},
                      {"relative_scatter", at.relative},
                      {"relative_full", at.full_relative}});
  return {{"name", named.name},
          {"energy", named.life.energy / MJ},
          {"volume", named.life.volume / mm3},
          {"outside", names_of_inputs(named.life.outside)},
          {"levels", std::move(levels)}};
}

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100 * share);
}

}  // namespace

Json summary_body(const ClutchStudy& study, const ClutchResult& r) {
  Json json = {{"simulated", study.simulated}};
  json["units"] = {{"w", "mm^3/MJ"}, {"volume", "mm^3"}, {"energy", "MJ"}};
  json["data"] = {{"cycles", study.campaign.cycles.size()},
                  {"weighings", study.campaign.weighings.size()},
                  {"points", r.points.size()},
                  {"held_out", r.held_out.size()},
                  {"flags", r.blocks.flags}};
  Json run_in;
  for (int i = 0; i < RunInFit::size; ++i) {
    const RunInConstant& constant = run_in_constants[static_cast<std::size_t>(i)];
    run_in[constant.name] = {{"value", r.run_in.parameters[i] / constant.si},
                             {"error", std::sqrt(r.run_in.covariance(i, i)) / constant.si}};
  }
  run_in["cycle_sd"] = r.run_in.cycle_sd / mm3_per_MJ;
  run_in["plate_sd"] = r.run_in.plate_sd;
  run_in["starts"] = r.run_in.starts;
  run_in["agreeing"] = r.run_in.agreeing;
  for (const PlateFactor& p : r.run_in.plates)
    run_in["plates"].push_back({{"plate", plate_json(r, p.plate)},
                                {"factor", std::exp(p.log_factor)},
                                {"log_error", p.standard_error},
                                {"used", p.factor()}});
  json["run_in"] = std::move(run_in);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    json["correlations"][inputs[i].name] = r.correlations[i];
  for (const WearMap& map : r.maps) json["maps"].push_back(to_json(map));
  const PairBest& best = r.search.pairs[r.search.best];
  json["nested"] = {{"r2", r.nested.r2},
                    {"r2_error", r.nested.r2_error},
                    {"rmse", r.nested.rmse / mm3_per_MJ},
                    {"folds", r.nested.folds}};
  json["search"] = {{"pairs", r.search.pairs.size()},
                    {"submodels_of_each", r.search.submodels},
                    {"r", best.r},
                    {"q", best.q},
                    {"r2p", best.r2p}};
  for (const SurrogateResult& s : r.surrogates)
    json["surrogates"].push_back({{"name", name_of(s.surrogate)},
                                  {"r", s.best.r},
                                  {"q", s.best.q},
                                  {"r2p", s.best.r2p},
                                  {"temperature_levels", s.levels},
                                  {"r2p_at_levels", s.r2p},
                                  {"mean_r2p", s.mean_r2p}});
  json["scatter"] = to_json(r.scatter);
  json["validation"] = to_json(r.validation);
  double largest = 0;
  for (const double change : r.averaging.change) largest = std::max(largest, std::abs(change));
  json["averaging"] = {{"total", r.averaging.total}, {"largest", largest}};
  json["sequences"] = Json::array();
  for (const SequenceResult& s : r.sequences) json["sequences"].push_back(to_json(s, r));
  json["life"] = Json::array();
  for (const NamedLife& each : r.lives) json["life"].push_back(to_json(each));
  return json;
}

std::string sequences_csv(const ClutchResult& r) {
  std::string csv =
      "sequence,plate,cycle,energy [MJ],measured [mm^3],predicted [mm^3],sd_scatter [mm^3],"
      "sd_full [mm^3]\n";
  for (const SequenceResult& s : r.sequences) {
    for (const auto& w : s.weighings)
      fmt::format_to(std::back_inserter(csv), "{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n",
                     printable_csv_cell(s.name), printable_csv_cell(r.plate_name(s.plate)), w.cycle,
                     w.energy / MJ, w.measured / mm3, w.predicted / mm3, w.sd / mm3,
                     w.full_sd / mm3);
  }
  return csv;
}

namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string section(const char* title, const Rows& rows) {
  return fmt::format("\n{}\n{}", title, text_table(rows));
}

// The purpose of the campaign: one line per life.
std::string answers_text(const ClutchResult& r) {
  if (r.lives.empty()) return "";
  std::string out = "\nAnswers\n";
  for (const NamedLife& each : r.lives) {
    const LifeAtLevel& at = each.life.levels.back();
    out += wrapped(fmt::format("Operating point {}: {} % worn after {} cycles; {} cycles (95 %).",
                               printable(each.name), plain_given(100 * at.level),
                               plain_given(std::round(at.repetitions)), description(at.full)),
                   2, 4);
  }
  return out;
}

std::string lives_text(const ClutchResult& r) {
  if (r.lives.empty()) return "";
  Rows rows = {
      {"operating point", "worn", "cycles", "95 % scatter", "95 % total", "without run-in"}};
  for (const NamedLife& each : r.lives) {
    for (const LifeAtLevel& at : each.life.levels)
      rows.push_back({each.name, fmt::format("{:.0f} %", 100 * at.level),
                      plain_given(std::round(at.repetitions)), description(at.scatter),
                      description(at.full), plain_given(std::round(at.without_run_in))});
  }
  return section("Life (cycles)", rows);
}

std::string run_in_text(const ClutchResult& r) {
  Rows rows = {{""}, {"fitted"}, {"standard error"}};
  for (int i = 0; i < RunInFit::size; ++i) {
    const RunInConstant& constant = run_in_constants[static_cast<std::size_t>(i)];
    rows[0].push_back(constant.name);
    rows[1].push_back(fmt::format("{:.4g}", r.run_in.parameters[i] / constant.si));
    rows[2].push_back(fmt::format("{:.2g}", std::sqrt(r.run_in.covariance(i, i)) / constant.si));
  }
  return section("Run-in (mm^3/MJ, MJ)", rows);
}

std::string maps_text(const ClutchResult& r) {
  Rows rows = {{"model", "r", "q", "terms", "R2", "R2p", "RMSE", "RMSEp"}};
  for (const WearMap& map : r.maps) {
    const bool surrogate = map.r > 0;
    rows.push_back({map.name, surrogate ? fmt::format("{:.1f}", map.r) : "-",
                    surrogate ? fmt::format("{:.1f}", map.q) : "-",
                    fmt::format("{}", map.terms.size()), fmt::format("{:.3f}", map.fit.r2),
                    fmt::format("{:.3f}", map.fit.r2p),
                    fmt::format("{:.2f}", map.fit.rmse / mm3_per_MJ),
                    fmt::format("{:.2f}", map.fit.rmsep / mm3_per_MJ)});
  }
  std::string out = section("Wear rate (mm^3/MJ)", rows);
  const std::vector<std::string> selected = term_names(r.maps.front());
  out += fmt::format("selected terms: {}", fmt::join(selected, " "));
  if (std::find(selected.begin(), selected.end(), "1") == selected.end())
    out +=
        "\n"
        "(without the constant 1: the selection depends on the origin of the inputs)";
  out += fmt::format("\nR2 of points left out of the whole search: {:.3f} +- {:.3f} ({} parts)",
                     r.nested.r2, r.nested.r2_error, r.nested.folds);
  return out + fmt::format(
                   "\nthe best by leave-one-out of {} submodels at each of {} pairs of "
                   "exponents\n",
                   plain_given(r.search.submodels), r.search.pairs.size());
}

std::string scatter_text(const ClutchResult& r) {
  Rows rows = {{"sigma_w", "-log L", "AIC", "KS p", "Lilliefors p"}};
  for (const ScatterFit& fit : r.scatter.candidates)
    rows.push_back({formula_of(fit.law.kind), fmt::format("{:.2f}", fit.negative_log_likelihood),
                    fmt::format("{:.2f}", fit.aic), fmt::format("{:.3f}", fit.kolmogorov.p),
                    fmt::format("{:.2f}", fit.lilliefors.p)});
  return section("Scatter", rows);
}

std::string validation_text(const ClutchResult& r) {
  if (r.validation.points.empty()) return "";
  Rows rows = {{"held-out points", "points", "R2", "RMSE [mm^3/MJ]"}};
  const auto add = [&](const char* name, const Validation::Metrics& m) {
    rows.push_back({name, fmt::format("{}", m.points), fmt::format("{:.3f}", m.r2),
                    fmt::format("{:.2f}", m.rmse / mm3_per_MJ)});
  };
  add("all", r.validation.all);
  if (r.validation.without_outliers.points < r.validation.all.points)
    add("without outliers", r.validation.without_outliers);
  return section("Validation", rows);
}

std::string sequences_text(const ClutchResult& r) {
  if (r.sequences.empty()) return "";
  Rows rows = {{"sequence", "cycles", "measured [mm^3]", "predicted", "error", "95 % scatter",
                "95 % total"}};
  for (const SequenceResult& s : r.sequences) {
    const auto& last = s.weighings.back();
    rows.push_back({s.name, plain_given(static_cast<double>(last.cycle)),
                    plain_given(std::round(last.measured / mm3)),
                    plain_given(std::round(last.predicted / mm3)), percent(s.final_error()),
                    "+- " + percent(2 * last.sd / last.predicted),
                    "+- " + percent(2 * last.full_sd / last.predicted)});
  }
  return section("Sequences, at their end", rows);
}

std::string checks_text(const ClutchResult& r) {
  Rows rows = {{"check", "verdict", "results"}};
  for (const Check& check : r.checks)
    rows.push_back({check.name, verdict_kind(check.verdict), check.detail});
  return "\nChecks\n" + text_table(rows, true);
}

}  // namespace

std::string summary_text(const ClutchStudy& study, const ClutchResult& r) {
  const std::string trust = wrapped(printable(trust_line(r.checks)), 0, 2);
  std::string out = wrapped(printable(study.title), 0, 2) +
                    fmt::format("{} cycles, {} weighings; {} points to fit, {} held out\n",
                                plain_given(static_cast<double>(study.campaign.cycles.size())),
                                plain_given(static_cast<double>(study.campaign.weighings.size())),
                                r.points.size(), r.held_out.size());
  if (study.simulated) out += "Simulated from a known truth, not measured.\n";
  out += "\n" + trust + answers_text(r) + lives_text(r) + run_in_text(r) + maps_text(r) +
         scatter_text(r) + validation_text(r) + sequences_text(r) + checks_text(r) + "\n" + trust;
  return printable_lines(out);
}

}  // namespace wearwell::clutch
