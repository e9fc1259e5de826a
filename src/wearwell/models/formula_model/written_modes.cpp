#include "wearwell/models/formula_model/written_modes.h"

#include <fmt/format.h>
#include <algorithm>
#include <regex>
#include <utility>

#include "wearwell/models/formula_model/failure_modes.h"
#include "wearwell/models/formula_model/lines_by_level.h"
#include "wearwell/models/formula_model/written_likelihood.h"

namespace wearwell::formula_model {
namespace {

void refuse_with_modes(const TomlReader& root, const TomlReader& section,
                       const WrittenStudy& study) {
  if (root.has("random_effects"))
    root.fail("random_effects", "is not possible with [failure_modes]");
  if (const auto predict = root.table("predict")) {
    for (const char* key : {"along", "at", "limit", "units", "lives_of"}) {
      if (predict->has(key))
        predict->fail(key, "is for readings along an axis, not for lives with [failure_modes]");
    }
  }
  const std::regex compared("\\b" + section.required_text("column") + R"(\s*(==|!=))");
  for (const std::string& text : study.texts) {
    if (std::regex_search(text, compared))
      section.fail("column", fmt::format("'{}' compares the failure mode; give the mode a table "
                                         "[failure_modes.NAME] with its own expressions",
                                         text));
  }
}

}  // namespace

std::vector<Observed> read_modes(const TomlReader& root, WrittenStudy& study, FormulaModel& model) {
  if (!root.has("failure_modes")) return {};
  const TomlReader section = root.required_table("failure_modes");
  refuse_with_modes(root, section, study);
  const WrittenLikelihood common = study.likelihoods.front();
  std::vector<WrittenLikelihood> all = study.of_modes;
  if (common.form) all.push_back(common);
  for (const WrittenLikelihood& each : all) {
    if (each.process || each.form->counted || !each.form->positive)
      section.fail("", fmt::format("needs families of positive lives, but {} is {}", each.place,
                                   each.form->name));
  }
  if (!measured_column(model.data, common)) fail_without_column(root, model.data, common);
  if (all.empty()) section.fail("", "has no distribution: give [likelihood] or each mode a family");
  const Observed lives = read_observed(model.data, common.column, *all.front().form,
                                       special_columns(model.data), {}, false);
  model.modes = read_failure_modes(root, model.data, lives);
  const FailureModes& modes = *model.modes;
  ObservedModes by_mode = observed_by_mode(modes, lives);
  model.joint = std::move(by_mode.joint);
  model.lives = lives;
  for (std::size_t i = 0; i < lives.rows.size(); ++i) {
    if (modes.possible[lives.rows[i]] == 0) model.lives.responses[i].seen = Censoring::right;
  }
  const LinesByLevel lines(root, modes.name, modes.modes, model.lines);
  model.lines = lines.lines();
  study.likelihoods.clear();
  for (std::size_t k = 0; k < modes.modes.size(); ++k) {
    const auto own = std::find_if(study.of_modes.begin(), study.of_modes.end(),
                                  [&](const auto& each) { return each.mode == modes.modes[k]; });
    if (own == study.of_modes.end() && !common.form)
      section.fail(
          "", fmt::format("mode '{}' has no distribution: give it a table [failure_modes.{}], or "
                          "[likelihood.{}] a family for all modes without one",
                          modes.modes[k], modes.modes[k], common.column));
    study.likelihoods.push_back(own == study.of_modes.end() ? common : *own);
    study.likelihoods.back().mode = modes.modes[k];
    for (auto& [family_parameter, text] : study.likelihoods.back().family_parameters)
      text = lines.text(text, k);
  }
  if (common.form && study.of_modes.size() == modes.modes.size())
    root.required_table("likelihood")
        .fail(common.column,
              "is not used, because each failure mode has a table of its own; leave it empty");
  return std::move(by_mode.of);
}

}  // namespace wearwell::formula_model
