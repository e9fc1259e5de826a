#include "wearwell/prognosis/data_roles.h"

#include <algorithm>
#include <regex>

namespace wearwell::prognosis {
namespace {

bool holds_words(const Column& column) {
  return !column.is_number &&
         std::any_of(column.text.begin(), column.text.end(), [](const auto& text) {
           return !text.empty() && text.find_first_of("0123456789") == std::string::npos;
         });
}

// Headings of the columns with these names in the study.
std::vector<std::string> columns_of(const DataRoles& roles, const std::vector<std::string>& names) {
  std::vector<std::string> columns;
  for (const DataRoles::Named& each : roles.used) {
    if (std::find(names.begin(), names.end(), each.name) != names.end())
      columns.push_back(each.column);
  }
  return columns;
}

std::optional<std::string> column_of(const DataRoles& roles, const std::string& name) {
  const std::vector<std::string> found = columns_of(roles, {name});
  return found.empty() ? std::nullopt : std::optional(found.front());
}

// A label that no expression of a study uses identifies the units.
bool is_idle(const TomlReader& root, const std::string& name) {
  const std::regex word("(^|[^A-Za-z0-9_])" + name + "($|[^A-Za-z0-9_])");
  for (const TomlReader::Present& each : root.present()) {
    if (each.is_table || each.path.starts_with("data.") || each.path == "title") continue;
    if (std::regex_search(each.text, word)) return false;
  }
  return true;
}

void read_formula_roles(const TomlReader& root, const Table& table, DataRoles& roles) {
  const TomlReader likelihood = root.required_table("likelihood");
  const std::vector<std::string> measured = likelihood.keys();
  roles.measured = columns_of(roles, measured);
  const auto predict = root.table("predict");
  const auto along = predict ? predict->text("along") : std::nullopt;
  if (along) roles.axis = column_of(roles, *along);
  std::vector<std::string> candidates;
  if (const auto random_effects = root.table("random_effects")) candidates = random_effects->keys();
  for (const DataRoles::Named& each : roles.used) {
    if (holds_words(table.column(each.column))) roles.words.push_back(each.column);
  }
  const auto is = [&](const DataRoles::Named& each,
                      bool (*rule)(const TomlReader&, const std::string&)) {
    return each.name != "status" && each.name != along && each.unit.empty() &&
           std::find(measured.begin(), measured.end(), each.name) == measured.end() &&
           rule(root, each.name);
  };
  for (const DataRoles::Named& each : roles.used) {
    if (candidates.empty() && is(each, is_idle)) candidates.push_back(each.name);
  }
  if (candidates.empty()) return;
  roles.unit = column_of(roles, candidates.front());
  roles.noun = candidates.front();
  if (roles.unit) roles.words.push_back(*roles.unit);
}

}  // namespace

DataRoles::Named named_column(const TomlReader& columns, const std::string& name) {
  if (columns.is_text(name)) return {name, columns.required_text(name)};
  const TomlReader choice = columns.required_table(name);
  return {name, choice.required_text("column"), choice.text("unit").value_or("")};
}

DataRoles data_roles(const TomlReader& root, const Table& table) {
  DataRoles roles;
  const TomlReader data = root.required_table("data");
  if (data.has("returns"))
    data.fail("returns",
              "is a triangle, to which no rows can be added: replace its file by the newer table "
              "and fit again");
  const TomlReader columns = data.required_table("columns");
  for (const std::string& name : columns.keys()) {
    DataRoles::Named named = named_column(columns, name);
    named.column = table.column(named.column).name;
    roles.used.push_back(std::move(named));
  }
  const std::string model = root.required_text("model");
  roles.words = columns_of(roles, {"bearing", "contact", "label", "part", "status"});
  if (model == "formula") {
    read_formula_roles(root, table, roles);
  } else if (model == "archard-joint") {
    roles.one = true;
    roles.noun = "inspection";
    roles.axis = column_of(roles, "cycles");
    roles.measured = columns_of(roles, {"volume", "dx", "dy"});
  } else if (model == "bearing-wear") {
    roles.unit = column_of(roles, "bearing");
    roles.noun = "bearing";
    roles.axis = column_of(roles, "revolutions");
    if (!roles.axis) roles.axis = column_of(roles, "time");
    roles.measured = columns_of(roles, {"depth"});
  } else {
    roles.noun = "test";
  }
  return roles;
}

}  // namespace wearwell::prognosis
