#include "wearwell/models/formula_model/written_likelihood.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/shell_word.h"
#include "wearwell/input/table.h"
#include "wearwell/models/formula_model/formula_data.h"
#include "wearwell/models/formula_model/formula_reader.h"
#include "wearwell/prob/log_location_scale.h"
#include "wearwell/study/family_study.h"

namespace wearwell::formula_model {
namespace {

// "mean and sd", for each parameterization of a name.
std::vector<std::string> needed_parameters(const std::string& family) {
  std::vector<std::string> ways;
  const auto add = [&](const ResponseForm& form) {
    if (form.name != family) return;
    std::vector<std::string_view> needed;
    for (const ParameterForm& family_parameter : form.family_parameters) {
      if (!family_parameter.optional) needed.push_back(family_parameter.name);
    }
    std::string way = fmt::format("{}", fmt::join(needed, " and "));
    if (ways.empty() || ways.back() != way) ways.push_back(std::move(way));
  };
  for (const ResponseForm& each : response_forms()) add(each);
  for (const ProcessForm& each : process_forms()) add(each.form);
  return ways;
}

// "best", or a list: who writes it wants a ranking.
void refuse_several_families(const TomlReader& table, const Source& source) {
  static const std::set<std::string> ranking = {"all", "auto", "best"};
  const std::vector<std::string> keys = table.keys();
  if (std::find(keys.begin(), keys.end(), "family") == keys.end()) return;
  if (table.is_text("family") && !ranking.count(table.required_text("family"))) return;
  const std::string file = shell_word(source.study.path.string());
  if (table.is_text("family"))
    table.fail("family", fmt::format("is one family: write the one that the parameters are of. To "
                                     "rank several for the same data, then run: wearwell compare "
                                     "{} --families all",
                                     file));
  std::vector<std::string> ranked = table.texts("family");
  std::erase_if(ranked, [](const std::string& each) {
    const auto known = exchangeable_families();
    return std::find(known.begin(), known.end(), each) == known.end();
  });
  table.fail("family",
             ranked.size() < 2 || ranked.front() != table.texts("family").front()
                 ? fmt::format("is one family; those that `wearwell compare STUDY --families` "
                               "ranks are {}",
                               fmt::join(exchangeable_families(), ", "))
                 : fmt::format("is one family. To rank several for the same data, with parameters "
                               "of the first, run: wearwell compare {} --families {}",
                               file, fmt::join(ranked, ",")));
}

// The family that `standard` names.
const LogLocationScale* log_location_scale(const TomlReader& table, const std::string& family) {
  if (family != LogLocationScale::name) return nullptr;
  std::vector<std::string> standards;
  for (const LogLocationScale& each : log_location_scale_families)
    standards.emplace_back(each.standard);
  const auto standard = table.choice("standard", standards);
  if (!standard)
    table.fail("standard",
               fmt::format("is missing: the distribution of the standardized logarithm, one of {}",
                           fmt::join(standards, ", ")));
  return &*std::find_if(log_location_scale_families.begin(), log_location_scale_families.end(),
                        [&](const auto& each) { return each.standard == *standard; });
}

// The threshold of cumulative exposure; that of a ramp is written later (add_ramp_exposure).
void add_exposure(const TomlReader& table, const std::string& family, bool steps,
                  WrittenLikelihood& likelihood, WrittenStudy& study) {
  const std::string scale = scale_parameter(family);
  std::string text;
  for (const auto& [at, each] : likelihood.family_parameters)
    if (likelihood.form->family_parameters[at].name == scale) text = each;
  if (steps) study.steps = read_step_stress(table, family, text);
  if (!steps) study.ramp = read_ramp_stress(table, family, text);
  const auto& parameters = likelihood.form->family_parameters;
  likelihood.family_parameters.emplace_back(parameters.size() - 1,
                                            steps ? threshold_of(*study.steps) : "0");
}

}  // namespace

void read_shares(const TomlReader& table, WrittenLikelihood& written, WrittenStudy& study) {
  read_shares_of_life(table, written);
  if (written.defective) study.texts.push_back(*written.defective);
  if (written.dead) study.texts.push_back(*written.dead);
}

// The table of a likelihood.
TomlReader table_of(const TomlReader& root, const WrittenLikelihood& written) {
  const std::size_t dot = written.place.find('.');
  const TomlReader table = root.required_table(written.place.substr(0, dot));
  return dot == std::string::npos ? table : table.required_table(written.place.substr(dot + 1));
}

const NumberColumn* measured_column(const FormulaData& data, const WrittenLikelihood& written) {
  const NumberColumn* column = data.number(written.column);
  const std::optional<std::string> lower = special_columns(data).lower;
  return !column && lower ? data.number(*lower) : column;
}

std::string nearest_column(const FormulaData& data, const std::string& name) {
  std::vector<std::string> names;
  for (const NumberColumn& each : data.numbers) names.push_back(each.name);
  return names.empty() ? "" : fmt::format(" (nearest: '{}')", nearest_name(name, names));
}

namespace {

// The first cell that keeps a column of text from being numeric; empty if there is none.
std::string cell_without_number(const Table& table, const LabelColumn& label) {
  const Column& column = table.column(label.column);
  for (std::size_t row = 0; row < table.rows; ++row) {
    try {
      static_cast<void>(cell_value(table, column, row));
    } catch (const InputError& error) {
      return error.what();
    }
  }
  return "";
}

}  // namespace

void fail_without_column(const TomlReader& root, const FormulaData& data,
                         const WrittenLikelihood& written) {
  const TomlReader likelihood = root.required_table("likelihood");
  const LabelColumn* const label = data.label(written.column);
  if (const std::string cell = label ? cell_without_number(data.table, *label) : ""; !cell.empty())
    likelihood.fail(written.column, fmt::format("is not a numeric column: {}", cell));
  likelihood.fail(written.column, fmt::format("is not a numeric column under data.columns{}",
                                              nearest_column(data, written.column)));
}

WrittenLikelihood read_likelihood(const TomlReader& table, const std::string& column,
                                  const std::string& place, const Source& source,
                                  WrittenStudy& study) {
  std::vector<std::string> names;
  for (const ResponseForm& form : response_forms()) {
    if (names.empty() || names.back() != form.name) names.emplace_back(form.name);
  }
  for (const ProcessForm& each : process_forms()) {
    if (names.back() != each.form.name) names.emplace_back(each.form.name);
  }
  names.emplace_back(LogLocationScale::name);
  refuse_several_families(table, source);
  auto family = table.choice("family", names);
  if (!family) table.fail("family", fmt::format("is missing: {}", fmt::join(names, ", ")));
  const LogLocationScale* const named = log_location_scale(table, *family);
  if (named) family = named->family;
  // Not by table.has, which would mark a key that the form does not have as used.
  const std::vector<std::string> keys = table.keys();
  const auto key_of = [&](std::string_view name) {
    return std::string(!named                  ? name
                       : name == named->scale  ? "scale"
                       : name == named->spread ? "sigma"
                                               : name);
  };
  const auto among_keys = [&](std::string_view name) {
    return std::find(keys.begin(), keys.end(), key_of(name)) != keys.end();
  };
  const bool steps = among_keys("steps"), ramp = among_keys("ramp");
  if (steps && ramp) table.fail("ramp", "and steps describe one test; give one of them");
  const auto has = [&](std::string_view name) {
    return among_keys(name) ||
           ((steps || ramp) && name == "threshold" && !scale_parameter(*family).empty());
  };
  const ResponseForm* form = given_form(response_forms(), *family, has);
  const ProcessForm* process = nullptr;
  for (const ProcessForm& each : process_forms()) {
    if (process || form || !given_form({&each.form, 1}, *family, has)) continue;
    process = &each;
  }
  if (process) form = &process->form;
  if (!form) {
    table.fail("family", named ? fmt::format("{} needs scale and sigma", LogLocationScale::name)
                               : fmt::format("{} needs {}", *family,
                                             fmt::join(needed_parameters(*family), ", or ")));
  }
  WrittenLikelihood result = empty_likelihood(column);
  result.place = place;
  result.form = form;
  result.process = process;
  for (std::size_t s = 0; s < form->family_parameters.size(); ++s) {
    const std::string name(form->family_parameters[s].name);
    if (!among_keys(name) || !table.has(key_of(name))) continue;
    std::string text = expression(table, key_of(name));
    if (named && name == named->spread) {
      result.sigma = text;
      if (named->inverse) text = fmt::format("1/({})", text);
    }
    result.family_parameters.emplace_back(s, std::move(text));
    study.texts.push_back(result.family_parameters.back().second);
  }
  if (steps || ramp) add_exposure(table, *family, steps, result, study);
  if (form->family == ResponseFamily::binomial) result.trials = table.required_text("trials");
  if (place.starts_with("likelihood.")) read_shares(table, result, study);
  return result;
}

}  // namespace wearwell::formula_model
