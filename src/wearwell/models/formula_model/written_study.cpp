#include "wearwell/models/formula_model/written_study.h"

#include <fmt/format.h>
#include <algorithm>
#include <regex>

#include "wearwell/models/formula_model/failure_modes.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/models/formula_model/written_likelihood.h"

namespace wearwell::formula_model {
namespace {

// Tables of single subpopulations, and the shares.
void read_subpopulation_tables(const TomlReader& root, const Source& source, WrittenStudy& study) {
  if (!study.subpopulations) return;
  const TomlReader section = root.required_table("subpopulations");
  for (const std::string& name : subpopulations_with_tables(section, *study.subpopulations)) {
    study.of_subpopulations.push_back(
        read_likelihood(section.required_table(name),
                        study.likelihoods.empty() ? "" : study.likelihoods.front().column,
                        "subpopulations." + name, source, study));
    study.of_subpopulations.back().mode = name;
  }
  for (const auto& each : study.subpopulations->share)
    if (each) study.texts.push_back(*each);
}

void read_random_effects(const TomlReader& table, const std::string& label, WrittenStudy& study) {
  WrittenEffects written{label, {}, {}};
  for (const std::string& name : table.keys()) {
    if (name == "correlation") continue;
    const TomlReader effect = table.required_table(name);
    const auto kind = effect.choice("distribution", {"lognormal", "normal"});
    if (!kind) effect.fail("distribution", "is missing: \"lognormal\" or \"normal\"");
    const bool lognormal = *kind == "lognormal";
    const std::string key = lognormal ? "log_sd" : "sd";
    if (!effect.has(key)) {
      effect.fail(key, fmt::format("is missing: a {} distribution of units needs it", *kind));
    }
    written.effects.push_back({name, expression(effect, key), lognormal});
    study.texts.push_back(written.effects.back().scatter);
  }
  if (written.effects.empty()) table.fail("", "has no parameter with a random effect");
  if (table.has("correlation")) {
    if (written.effects.size() != 2)
      table.fail("correlation", "needs two parameters with random effects");
    written.correlation = expression(table, "correlation");
    study.texts.push_back(*written.correlation);
  }
  study.effects.push_back(std::move(written));
}

// If rows follow each other, the one column without a unit that no expression uses identifies the
// units; it would have no purpose otherwise.
std::optional<std::string> idle_column(const TomlReader& root, const WrittenStudy& study) {
  static const std::regex path(R"(\bcum\s*\(|\bd\s*\(\s*\w+\s*\)\s*/)");
  bool follows = std::any_of(study.likelihoods.begin(), study.likelihoods.end(),
                             [](const auto& each) { return each.process != nullptr; });
  std::string all;
  for (const std::string& text : study.texts) all += text + "\n";
  for (const formula::Line& line : study.lines) all += line.name + "\n";
  follows |= std::regex_search(all, path);
  if (!follows) return {};
  if (const auto predict = root.table("predict")) {
    all += predict->text("along").value_or("") + "\n";
  }
  for (const WrittenLikelihood& each : study.likelihoods) {
    all += each.column + "\n" + each.trials.value_or("") + "\n";
  }
  for (const std::string& each : qualifying_columns) all += each + "\n";
  const TomlReader columns = root.required_table("data").required_table("columns");
  std::optional<std::string> found;
  for (const std::string& name : columns.keys()) {
    if (!columns.is_text(name) && columns.required_table(name).has("unit")) continue;
    if (std::regex_search(all, std::regex("\\b" + name + "\\b"))) continue;
    if (found) return {};
    found = name;
  }
  return found;
}

}  // namespace

bool WrittenStudy::measures(const std::string& column) const {
  return std::any_of(likelihoods.begin(), likelihoods.end(),
                     [&](const auto& each) { return each.column == column; });
}

bool WrittenStudy::has_hidden_paths() const {
  return std::any_of(likelihoods.begin(), likelihoods.end(), [](const WrittenLikelihood& each) {
    return each.process && each.process->process != Process::wiener &&
           std::any_of(each.family_parameters.begin(), each.family_parameters.end(),
                       [](const auto& family_parameter) {
                         return family_parameter.first == 2;  // noise
                       });
  });
}

WrittenStudy read_written_study(const TomlReader& root, const Source& source) {
  WrittenStudy study;
  if (const auto lines = root.table("formula")) {
    for (const std::string& name : lines->keys()) {
      study.lines.push_back({name, expression(*lines, name)});
      study.texts.push_back(study.lines.back().text);
    }
  }
  study.subpopulations = read_subpopulations(root);
  const TomlReader likelihoods = root.required_table("likelihood");
  const auto failure_modes = root.table("failure_modes");
  for (const std::string& column : likelihoods.keys()) {
    const TomlReader table = likelihoods.required_table(column);
    const std::vector<std::string> keys = table.keys();
    const bool no_family = std::find(keys.begin(), keys.end(), "family") == keys.end();
    if (failure_modes && keys.empty()) {  // each mode has its own
      study.likelihoods.push_back(empty_likelihood(column));
    } else if (study.subpopulations && no_family) {
      study.likelihoods.push_back(empty_likelihood(column));
      read_shares(table, study.likelihoods.back(), study);
    } else {
      study.likelihoods.push_back(
          read_likelihood(table, column, "likelihood." + column, source, study));
    }
  }
  if (failure_modes && study.likelihoods.size() > 1)
    root.fail("failure_modes", "needs one measured column, the life; [likelihood] has several");
  for (const std::string& mode :
       failure_modes ? modes_with_tables(*failure_modes) : std::vector<std::string>()) {
    study.of_modes.push_back(read_likelihood(failure_modes->required_table(mode),
                                             study.likelihoods.front().column,
                                             "failure_modes." + mode, source, study));
    study.of_modes.back().mode = mode;
  }
  if (const auto rate = root.table(UseRate::name))
    study.use_rate = read_likelihood(*rate, UseRate::name, UseRate::name, source, study);
  read_subpopulation_tables(root, source, study);
  if (study.likelihoods.empty()) {
    root.fail("likelihood", "is empty; give one table for each measured column");
  }
  if (const auto random_effects = root.table("random_effects")) {
    for (const std::string& label : random_effects->keys()) {
      read_random_effects(random_effects->required_table(label), label, study);
    }
  }
  if (const auto predict = root.table("predict")) {
    if (const auto quantities = predict->table("quantities")) {
      for (const std::string& key : quantities->keys()) {
        study.texts.push_back(quantities->is_text(key)
                                  ? quantities->required_text(key)
                                  : quantities->required_table(key).required_text("value"));
      }
    }
  }
  return study;
}

std::map<std::string, std::string> indexed_parameters(const WrittenStudy& study) {
  static const std::regex indexed(R"(([A-Za-z_]\w*)\s*\[\s*([A-Za-z_]\w*)\s*\])");
  std::map<std::string, std::string> labels;
  for (const std::string& text : study.texts)
    for (std::sregex_iterator it(text.begin(), text.end(), indexed), end; it != end; ++it)
      labels[(*it)[1]] = (*it)[2];
  return labels;
}

std::vector<std::string> label_names(const TomlReader& root, const WrittenStudy& study) {
  std::vector<std::string> names;
  for (const WrittenEffects& each : study.effects) names.push_back(each.label);
  names.emplace_back("status");
  if (study.steps) names.push_back(study.steps->label);
  if (const auto unit = idle_column(root, study); unit && study.effects.empty())
    names.push_back(*unit);
  static const std::regex compared(R"re(([A-Za-z_]\w*)\s*(==|!=)\s*")re");
  static const std::regex compared_back(R"re("\s*(==|!=)\s*([A-Za-z_]\w*))re");
  for (const auto& [parameter, label] : indexed_parameters(study)) names.push_back(label);
  for (const std::string& text : study.texts) {
    for (std::sregex_iterator it(text.begin(), text.end(), compared), end; it != end; ++it) {
      names.push_back((*it)[1]);
    }
    for (std::sregex_iterator it(text.begin(), text.end(), compared_back), end; it != end; ++it) {
      names.push_back((*it)[2]);
    }
  }
  return names;
}

}  // namespace wearwell::formula_model
