#include "wearwell/workbench/families_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/life_groups.h"
#include "wearwell/prob/standard_distribution.h"
#include "wearwell/study/family_study.h"
#include "wearwell/workbench/family_papers.h"

namespace wearwell::workbench {
namespace {

using formula_model::FormulaModel;
using formula_model::LifeGroup;
using nlohmann::ordered_json;

constexpr std::size_t most_drawn = 400;
constexpr double ticks[] = {0.001, 0.01, 0.05, 0.1, 0.2, 0.5, 0.8, 0.9, 0.99, 0.999};

// Why the lives of a study are not of one family under one condition; empty if they are.
std::string obstacle(const FormulaModel& model) {
  if (model.modes) return "it has failure modes";
  if (model.use_rate) return "it has a use rate";
  if (model.subpopulations || !model.measured.front().life.plain()) return "it is of a mixture";
  if (model.has_random_effects() || !model.drawn.empty()) return "it has random effects";
  if (model.has_process() || model.has_exposure() || model.measured.front().reporting)
    return "its lives follow from a path";
  if (model.measured.size() != 1) return "it has several likelihoods";
  if (!model.measured.front().form->positive) return "its values may be negative";
  return "";
}

LifeGroup lives_of(const TomlReader& root, const FormulaModel& model) {
  if (const std::string why = obstacle(model); !why.empty())
    root.fail("likelihood", fmt::format("families are compared for lives of one family under one "
                                        "condition: {}",
                                        why));
  std::vector<LifeGroup> groups = formula_model::life_groups(model, 1);
  if (groups.size() != 1)
    root.fail("likelihood",
              "families are compared for lives of one family under one condition: these lives "
              "depend on conditions");
  std::set<double> failures;
  for (const Response& each : groups.front().responses)
    if (each.seen != Censoring::right)
      failures.insert(each.seen == Censoring::interval ? each.until : each.at);
  if (failures.size() < 2)
    root.fail("likelihood",
              "families are compared by lives with at least two failures that differ");
  return std::move(groups.front());
}

double exact_failures(const LifeGroup& lives) {
  double n = 0;
  for (std::size_t i = 0; i < lives.responses.size(); ++i)
    if (lives.responses[i].seen == Censoring::none) n += lives.counts[i];
  return n;
}

ordered_json places_json(const std::vector<PlottingPosition>& places, const Unit& unit) {
  ordered_json json = ordered_json::array();
  for (const PlottingPosition& each : places) json.push_back({from_si(unit, each.at), each.p});
  return json;
}

// Densities are per unit of the lives, as in reports.
void add_fit(const FittedFamily& fitted, const LifeGroup& lives, const Unit& unit,
             ordered_json& json) {
  const double per_unit = exact_failures(lives) * std::log(unit.scale);
  json["log_likelihood"] = fitted.log_likelihood + per_unit;
  json["aic"] = fitted.aic() - 2 * per_unit;
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const ParameterForm& each = fitted.form->family_parameters[i];
    const bool of_life = each.kind == ParameterKind::scale || each.kind == ParameterKind::location;
    json["parameters"].push_back(
        {{"name", std::string(each.name)},
         {"value", of_life ? from_si(unit, fitted.parameters[i]) : fitted.parameters[i]},
         {"unit", of_life ? unit.text : "1"}});
  }
}

ordered_json family_json(std::string_view name, const Source& study, const LifeGroup& lives,
                         const std::vector<PlottingPosition>& positions, const Unit& unit) {
  const ResponseForm& form = form_named(name);
  ordered_json json = {{"name", std::string(name)},
                       {"text", study_with_family(study, name).study.text},
                       {"parameters", ordered_json::array()},
                       {"paper", std::string(form.paper.name)},
                       {"ticks", ordered_json::array()}};
  const auto [first, last] = std::minmax_element(
      positions.begin(), positions.end(),
      [](const PlottingPosition& a, const PlottingPosition& b) { return a.p < b.p; });
  const double low = positions.empty() ? 0.01 : std::clamp(0.5 * first->p, 1e-4, 0.5),
               high = positions.empty() ? 0.99 : std::clamp(0.5 + 0.5 * last->p, 0.5, 0.999);
  json["points"] = places_json(on_paper(form.paper, positions, most_drawn), unit);
  for (const double share : ticks)
    if (low <= share && share <= high)
      json["ticks"].push_back({{"at", quantile(form.paper.distribution, share)}, {"share", share}});
  if (const auto fitted = fitted_family(form, lives.responses, lives.counts)) {
    add_fit(*fitted, lives, unit, json);
    json["line"] = places_json(line_on_paper(*fitted, low, high), unit);
  } else {
    json["problem"] = "its likelihood has no maximum";
  }
  return json;
}

}  // namespace

ordered_json families_json(const std::filesystem::path& file, const std::string& text) {
  const Source study{TextFile{file, text}};
  const TomlReader root = TomlReader::parse(study.study);
  const std::string family = written_family(study);
  const auto model = formula_model::read_formula_model(root, study);
  const LifeGroup lives = lives_of(root, *model);
  const Unit& unit = model->measured.front().unit;
  const auto positions = plotting_positions(lives.responses, lives.counts);
  double items = 0;
  for (const int each : lives.counts) items += each;
  std::vector<ordered_json> families;
  for (const std::string_view name : exchangeable_families())
    families.push_back(family_json(name, study, lives, positions, unit));
  // With its comments.
  for (ordered_json& each : families)
    if (each["name"] == family) each["text"] = text;
  std::stable_sort(families.begin(), families.end(), [](const auto& a, const auto& b) {
    return a.value("aic", HUGE_VAL) < b.value("aic", HUGE_VAL);
  });
  return {{"family", family},
          {"unit", unit.text},
          {"life", printable(model->measured.front().column)},
          {"lives", items},
          {"failures", lives.failures()},
          {"families", families}};
}

}  // namespace wearwell::workbench
