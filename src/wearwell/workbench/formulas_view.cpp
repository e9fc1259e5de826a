#include "wearwell/workbench/formulas_view.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/formula/typeset.h"

namespace wearwell::workbench {
namespace {

using formula::MathElement;
using nlohmann::ordered_json;

constexpr std::size_t most_formulas = 60, longest_shown = 2000;

ordered_json element_json(const MathElement& element) {
  ordered_json children = ordered_json::array();
  for (const MathElement& each : element.children) children.push_back(element_json(each));
  return {element.tag, printable(element.text), std::move(children)};
}

std::optional<MathElement> typeset_where_possible(const std::string& text) {
  if (text.size() > longest_shown) return {};
  try {
    return formula::typeset({"formula", text});
  } catch (const InputError&) {
    return {};
  }
}

// "d(depth)/d(distance)" is an expression, all other names are names.
std::optional<MathElement> left_side(const std::string& name) {
  return name.find('(') == name.npos ? formula::typeset_name(name) : typeset_where_possible(name);
}

std::string without_quotes(std::string name) {
  std::erase_if(name, [](char c) { return c == '"' || c == '\''; });
  return name;
}

struct Distributed {
  std::string name, family;
  std::size_t line = 0;
  std::vector<std::pair<std::string, std::optional<MathElement>>> parameters;
};

std::optional<MathElement> distributed_element(const Distributed& of) {
  MathElement all{"mrow", "", {formula::typeset_name(of.name), {"mo", "∼"}, {"mtext", of.family}}};
  all.children.push_back({"mo", "("});
  for (const auto& [name, value] : of.parameters) {
    if (!value) return {};
    if (all.children.back().text != "(") all.children.push_back({"mo", ","});
    all.children.push_back({"mtext", name});
    all.children.push_back({"mo", "="});
    all.children.push_back(*value);
  }
  all.children.push_back({"mo", ")"});
  return all;
}

void add_formula(const std::string& path, std::size_t line, const std::optional<MathElement>& math,
                 ordered_json& json) {
  if (json.size() >= most_formulas) return;
  json.push_back(
      {{"path", printable(path)}, {"line", line}, {"math", math ? element_json(*math) : nullptr}});
}

}  // namespace

ordered_json formulas_json(const ordered_json& keys) {
  constexpr std::string_view lines = "formula.", responses = "likelihood.";
  ordered_json json = ordered_json::array();
  std::vector<Distributed> likelihoods;
  for (const ordered_json& each : keys) {
    const std::string path = each.at("path"), value = each.at("value");
    const std::size_t line = each.at("line");
    if (path.starts_with(lines)) {
      const auto left = left_side(without_quotes(path.substr(lines.size())));
      const auto right = typeset_where_possible(value);
      std::optional<MathElement> both;
      if (left && right) both = MathElement{"mrow", "", {*left, {"mo", "="}, *right}};
      add_formula(path, line, both, json);
      continue;
    }
    const std::size_t dot = path.rfind('.');
    if (!path.starts_with(responses) || dot < responses.size()) continue;
    const std::string name = without_quotes(path.substr(responses.size(), dot - responses.size()));
    if (likelihoods.empty() || likelihoods.back().name != name)
      likelihoods.push_back({name, "", line, {}});
    const std::string key = path.substr(dot + 1);
    if (key == "family")
      likelihoods.back().family = value;
    else
      likelihoods.back().parameters.emplace_back(key, typeset_where_possible(value));
  }
  for (const Distributed& each : likelihoods) {
    if (!each.family.empty())
      add_formula("likelihood." + each.name, each.line, distributed_element(each), json);
  }
  return json;
}

}  // namespace wearwell::workbench
