#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "wearwell/input/study_keys.h"
#include "wearwell/prob/family_form.h"

namespace wearwell {
namespace {

// Forms of priors by name, except those with a threshold, which is optional.
std::vector<const ResponseForm*> forms_of(std::string_view name) {
  std::vector<const ResponseForm*> found;
  for (const ResponseForm& form : prior_forms()) {
    const bool shifted = !form.family_parameters.empty() && form.family_parameters.back().optional;
    if (form.name == name && !shifted) found.push_back(&form);
  }
  return found;
}

bool has_parameter(const ResponseForm& form, std::string_view family_parameter) {
  return std::any_of(form.family_parameters.begin(), form.family_parameters.end(),
                     [&](const ParameterForm& each) { return each.name == family_parameter; });
}

void add_new(std::vector<std::string>& conditions, const std::string& each) {
  if (std::find(conditions.begin(), conditions.end(), each) == conditions.end())
    conditions.push_back(each);
}

// When a distribution needs the parameter: for the first of two parameter forms if another of its
// parameters is given, else for the last.
void add_conditions(std::string_view distribution, const ParameterForm& family_parameter,
                    StudyKey& key) {
  const std::vector<const ResponseForm*> forms = forms_of(distribution);
  const ResponseForm &first = *forms.front(), &last = *forms.back();
  if (has_parameter(last, family_parameter.name)) {
    add_new(key.when, fmt::format(".distribution={}", distribution));
    if (forms.size() == 1) return;
    for (const ParameterForm& each : first.family_parameters)
      add_new(key.unless, fmt::format(".{}", each.name));
    return;
  }
  for (const ParameterForm& each : first.family_parameters) {
    if (each.name == family_parameter.name) continue;
    add_new(key.when, fmt::format(".{}", each.name));
    for (const ResponseForm& other : prior_forms()) {
      if (other.name != distribution && has_parameter(other, each.name) &&
          !has_parameter(other, family_parameter.name))
        add_new(key.unless, fmt::format(".distribution={}", other.name));
    }
  }
}

StudyKey key_of(const ParameterForm& family_parameter) {
  static const std::map<std::string_view, const char*> examples = {{"sd", "\"2 mm^3\""},
                                                                   {"threshold", "\"1 mm^3\""},
                                                                   {"log_sd", "0.5"},
                                                                   {"log10_sd", "0.2"},
                                                                   {"df", "4"}};
  static const std::map<std::string_view, const char*> meanings = {
      {"sd", "standard deviation"},
      {"log_sd", "standard deviation of the natural logarithm"},
      {"log10_sd", "standard deviation of the decimal logarithm"},
      {"df", "degrees of freedom"},
      {"alpha", "first shape"},
      {"beta", "second shape"},
      {"threshold", "value at which the distribution begins"}};
  const auto given = examples.find(family_parameter.name);
  const bool dimensional = family_parameter.kind == ParameterKind::location ||
                           family_parameter.kind == ParameterKind::scale;
  const auto meaning = meanings.find(family_parameter.name);
  std::vector<std::string> distributions;
  StudyKey key;
  for (const ResponseForm& form : prior_forms()) {
    if (!has_parameter(form, family_parameter.name)) continue;
    add_new(distributions, std::string(form.name));
    if (!family_parameter.optional) add_conditions(form.name, family_parameter, key);
  }
  key.path = fmt::format("prior.*.{}", family_parameter.name);
  key.example = given != examples.end() ? given->second : dimensional ? "\"5 mm^3\"" : "2";
  key.meaning = fmt::format(
      "{}, of {}",
      meaning != meanings.end() ? std::string_view(meaning->second) : family_parameter.name,
      fmt::join(distributions, ", "));
  key.needed = !family_parameter.optional;
  return key;
}

}  // namespace

StudyKeys prior_keys() {
  StudyKeys keys = {
      needed_key("prior.*.distribution", "\"normal\"", "distribution: see [priors.md](priors.md)"),
      {"prior.*.unit", "\"mm^3\"", "unit of reports; needed if no quantity has one"},
      needed_key("prior.*.lower", "\"0 mm^3\"", "lower bound; needed by uniform", {},
                 {".distribution=uniform"}),
      needed_key("prior.*.upper", "\"15 mm^3\"", "upper bound; needed by uniform", {},
                 {".distribution=uniform"})};
  std::set<std::string_view> done;
  for (const ResponseForm& form : prior_forms()) {
    for (const ParameterForm& family_parameter : form.family_parameters) {
      if (done.insert(family_parameter.name).second) keys.push_back(key_of(family_parameter));
    }
  }
  return keys;
}

}  // namespace wearwell
