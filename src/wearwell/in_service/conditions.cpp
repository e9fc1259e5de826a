#include "wearwell/in_service/conditions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/input/toml_edit.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/prognosis/data_roles.h"
#include "wearwell/study/scaffold.h"

namespace wearwell::in_service {
namespace {

// The measured columns, and that of the axis.
std::set<std::string> measured_in(const TomlReader& root) {
  std::set<std::string> names;
  if (const auto likelihood = root.table("likelihood"))
    for (const std::string& each : likelihood->keys()) names.insert(each);
  if (const auto predict = root.table("predict"))
    if (predict->is_text("along")) names.insert(predict->required_text("along"));
  return names;
}

const DataColumn* numbers_of(const PosteriorStudy& study, const std::string& name) {
  for (const DataColumn& each : study.data_columns)
    if (each.name == name && !each.values.empty()) return &each;
  return nullptr;
}

// The rest of a line from this column on; columns count characters.
std::string_view at_place(std::string_view text, std::size_t line, std::size_t column) {
  std::size_t i = 0;
  for (; line > 1; --line) i = std::min(text.find('\n', i), text.size() - 1) + 1;
  for (; column > 1 && i < text.size(); --column) {
    ++i;
    while (i < text.size() && (static_cast<unsigned char>(text[i]) & 0xc0) == 0x80) ++i;
  }
  return text.substr(i, text.find('\n', i) - i);
}

// Without the lines from this heading to the next.
std::string without_section(const std::string& text, std::size_t line) {
  std::string kept;
  std::size_t number = 1;
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', i), text.size() - 1) + 1;
    const std::size_t first = text.find_first_not_of(" \t", i);
    if (number == line)
      inside = true;
    else if (inside && first < end && text[first] == '[')
      inside = false;
    if (!inside) kept.append(text, i, end - i);
    i = end;
  }
  return kept;
}

}  // namespace

std::vector<Condition> conditions_of(const Source& source, const PosteriorStudy& study) {
  const TomlReader root = TomlReader::parse(source.study);
  std::set<std::string> other = measured_in(root);
  other.insert({"status", "lower", "upper", "count", "entry", "part"});
  if (const auto modes = root.table("failure_modes"))
    if (modes->is_text("column")) other.insert(modes->required_text("column"));
  if (const auto effects = root.table("random_effects"))
    for (const std::string& each : effects->keys()) other.insert(each);
  std::vector<Condition> found;
  const TomlReader data = root.required_table("data");
  const auto columns = data.table("columns");
  if (!columns || data.has("returns") || root.required_text("model") != "formula") return found;
  const prognosis::DataRoles known = prognosis::data_roles(root, read_table(data, source));
  for (const prognosis::DataRoles::Named& each : known.used)
    if (known.unit == each.column) other.insert(each.name);
  for (const std::string& name : columns->keys()) {
    if (other.count(name)) continue;
    Condition condition{name, ""};
    if (const DataColumn* numbers = numbers_of(study, name)) {
      const auto [low, high] = std::minmax_element(numbers->values.begin(), numbers->values.end());
      condition = {name, numbers->si, numbers->unit, *low, *high};
    }
    found.push_back(std::move(condition));
  }
  return found;
}

double longest_seen(const Source& source, const PosteriorStudy& study) {
  double longest = std::nan("");
  for (const std::string& name : measured_in(TomlReader::parse(source.study))) {
    const DataColumn* const numbers = numbers_of(study, name);
    if (!numbers || study.quantity_groups.empty()) continue;
    const std::string& life = study.quantity_groups.front().requests.front().unit.text;
    try {
      static_cast<void>(read_unit(life, numbers->si));
    } catch (const InputError&) {
      continue;  // the measured wear
    }
    longest = std::fmax(longest, *std::max_element(numbers->values.begin(), numbers->values.end()));
  }
  return longest;
}

TextFile with_conditions(const TextFile& study, const std::map<std::string, std::string>& values) {
  if (values.empty()) return study;
  std::map<std::string, std::string> given = values;
  TextFile edited = study;
  const std::string path = "predict.given";
  for (const TomlReader::Present& each : TomlReader::parse(study).present()) {
    const std::string_view rest = at_place(study.text, each.line, each.column);
    if (each.path == path && rest.starts_with("[")) {
      edited.text = without_section(study.text, each.line);
    } else if (each.path == path && !rest.starts_with("{")) {
      throw InputError(fmt::format(
          "{}: predict.given must be written as a table, given = {{ ... }}", study.path.string()));
    }
    if (!each.path.starts_with(path + ".")) continue;
    const std::string name = each.path.substr(path.size() + 1);
    if (name.find('.') != name.npos || values.contains(name)) continue;
    if (each.is_table)
      throw InputError(fmt::format(
          "{}: predict.given.{} differs between units: the table of units needs a column with its "
          "value for each unit (--columns {}=COLUMN:UNIT)",
          study.path.string(), name, name));
    given[name] = each.text.empty() ? std::string(rest.substr(0, rest.find_first_of(" \t,}#\r")))
                                    : toml_text(each.text);
  }
  std::vector<std::string> entries;
  for (const auto& [name, value] : given) entries.push_back(fmt::format("{} = {}", name, value));
  return with_predict(edited, {{"given", fmt::format("{{ {} }}", fmt::join(entries, ", "))}});
}

}  // namespace wearwell::in_service
